#include "tire/ancf/shell_contact.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

std::size_t ShellContact::add(int i, int j, const Vec3& force, const ContactTangent& tangent) {
  FURROW_ASSERT(i >= 0 && j > 0, i, j);
  entries_.push_back({i, j, force, tangent, Vec3::Zero()});
  return entries_.size() - 1;
}

/// Eq. (1), (2).
Vec3 ShellContact::force(const Entry& e, const ShellLayout& layout, const Field& q_force, const Field& v_new) {
  const ContactTangent& t = e.tangent;
  const Vec3 f = e.force - t.stiffness * (layout.get(q_force, e.column, e.row, 0) - t.position) -
                 t.damping * (layout.get(v_new, e.column, e.row, 0) - t.velocity);
  const double size = e.force.norm();
  if (!(size > 0.0)) return Vec3::Zero();
  const Vec3 n = e.force / size;
  const double p = f.dot(n);
  if (!(p > 0.0)) return Vec3::Zero();
  const Vec3 across = f - p * n;
  const double across_size = across.norm();
  return across_size > p ? Vec3(p * n + p / across_size * across) : f;
}

void ShellContact::apply(const ShellLayout& layout, const Field& q_force, const Field& v_new, Field& residual) const {
  for (const Entry& e : entries_)
    layout.set(residual, e.column, e.row, 0,
               layout.get(residual, e.column, e.row, 0) - (force(e, layout, q_force, v_new) - e.force));
}

void ShellContact::accept(const ShellLayout& layout, const Field& q_force, const Field& v_new, double h) {
  FURROW_ASSERT(h > 0.0, h);
  for (Entry& e : entries_) e.impulse += h * force(e, layout, q_force, v_new);
}

void ShellContact::stiffness(const ShellLayout& layout, double h, const Mat3& axes, std::vector<Mat3>& out) const {
  FURROW_ASSERT(h > 0.0, h);
  FURROW_ASSERT(
      std::all_of(entries_.begin(), entries_.end(),
                  [&](const Entry& e) { return in_range(e.column, layout.columns) && in_range(e.row, layout.rows); }),
      entries_.size(), layout.columns, layout.rows);
  out.assign(static_cast<std::size_t>(layout.columns) * layout.rows, Mat3::Zero());
  for (const Entry& e : entries_)
    out[static_cast<std::size_t>(e.column) * layout.rows + e.row] =
        axes.transpose() * (0.5 * e.tangent.stiffness + e.tangent.damping / h) * axes;
}

}  // namespace furrow::tire
