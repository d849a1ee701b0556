// Contact forces on free nodes of the ring that follow its motion within the step. With the force f that the terrain
// reported for a motion with the means x̄, v̄, and its tangents K, C (protocol/core/surface.hpp),
//
//   F = P[ f − K (q_f − x̄) − C (v' − v̄) ],                                                                   (1)
//
// taken at the middle position q_f and the velocity v' of the step. F is then exactly the terrain's force if the
// terrain's law is linear and the terrain does not move. P prevents pulling: with n along f and p = F·n,
//
//   P[F] = 0 for p ≤ 0,   p n + min(1, p/|F_t|) F_t otherwise,                                                (2)
//
// continuous, and within 45° of the reported force. In the tangent of the step a node has ½ K + C/h.
#pragma once

#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/surface.hpp"
#include "tire/ancf/shell_layout.hpp"

namespace furrow::tire {

class ShellContact {
 public:
  /// Begins an interval without forces.
  void clear() { entries_.clear(); }
  /// A force on the node of column i, row j, and its tangent. @returns its number in the interval
  /// @pre the node is free
  std::size_t add(int i, int j, const Vec3& force, const ContactTangent& tangent);
  bool empty() const { return entries_.empty(); }

  /// Subtracts F − f from the residual.
  void apply(const ShellLayout& layout, const Field& q_force, const Field& v_new, Field& residual) const;
  /// Adds F h to the impulses for an accepted step of size h.
  void accept(const ShellLayout& layout, const Field& q_force, const Field& v_new, double h);
  /// Impulse of entry k since it was added, N s.
  const Vec3& impulse(std::size_t k) const {
    FURROW_ASSERT(in_range(k, entries_.size()), k, entries_.size());
    return entries_[k].impulse;
  }

  /// ½ K + C/h of every node, [i * rows + j], turned into axes R: Rᵀ A R.
  void stiffness(const ShellLayout& layout, double h, const Mat3& axes, std::vector<Mat3>& out) const;

 private:
  struct Entry {
    int column = 0, row = 0;
    Vec3 force = Vec3::Zero();  // f, N
    ContactTangent tangent;
    Vec3 impulse = Vec3::Zero();  // N s
  };
  static Vec3 force(const Entry& e, const ShellLayout& layout, const Field& q_force, const Field& v_new);

  std::vector<Entry> entries_;
};

}  // namespace furrow::tire
