// Impulse that a tire with contact tangents owes its terrain: the impulse that acted on each vertex, less the impulse
// that the terrain then reported for the same interval. A share of it is returned in each step,
//
//   L ← L + H (F_n − f̄_n),      f_{n+1} = f̄_n − β L/H,
//
// so the ledger holds Σ impulses on the tire − Σ impulses on the terrain. β is small: a difference due to the vertex's
// acceleration, if returned quickly, would act like a negative mass.
#pragma once

#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::ranks {

class ImpulseLedger {
 public:
  ImpulseLedger() = default;
  explicit ImpulseLedger(int vertices) : owed_(vertices, Vec3::Zero()) {}

  /// Subtracts the impulse that the terrain reports for the last interval, H = `duration`.
  void settle(const NodalForces& reported, double duration);
  /// Changes reported forces into those of the next interval. At most half of a force is taken back; vertices that no
  /// longer touch anything also get their share. @pre settled
  void hand_back(NodalForces& forces, double duration);
  /// Adds the impulse that acted over an interval. @pre duration > 0, here and above; all vertices are the ledger's
  void book(const NodalForces& acted, double duration);

  Vec3 sum() const;                            // now, N s
  double settled() const { return settled_; }  // |sum| when last settled, N s
  double largest() const { return largest_; }  // of these, N s

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  friend void visit_fields(FieldsOf<ImpulseLedger> auto& s, auto&& visit) {
    visit(s.settled_, Field{"settled", "N s"});
    visit(s.largest_, Field{"largest", "N s"});
  }

  std::vector<Vec3> owed_;  // L of each vertex, N s
  double settled_ = 0.0, largest_ = 0.0;
  NodalForces next_;  // work
};

}  // namespace furrow::ranks
