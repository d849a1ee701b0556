#include "nodes/ranks/impulse_ledger.hpp"

#include <algorithm>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::ranks {
namespace {

constexpr double kShare = 0.1;       // β
constexpr double kMaxOfForce = 0.5;  // of a reported force that is taken back at once
constexpr double kNothing = 1e-12;   // N s

}  // namespace

void ImpulseLedger::settle(const NodalForces& reported, double duration) {
  FURROW_ASSERT(duration > 0.0, duration);
  FURROW_ASSERT(reported.force.size() == reported.vertex.size(), reported.force.size(), reported.vertex.size());
  FURROW_ASSERT(
      std::all_of(reported.vertex.begin(), reported.vertex.end(), [&](int v) { return in_range(v, owed_.size()); }),
      owed_.size());
  for (std::size_t k = 0; k < reported.vertex.size(); ++k) owed_[reported.vertex[k]] -= duration * reported.force[k];
  settled_ = sum().norm();
  largest_ = std::max(largest_, settled_);
}

void ImpulseLedger::hand_back(NodalForces& forces, double duration) {
  FURROW_ASSERT(duration > 0.0, duration);
  FURROW_ASSERT(std::is_sorted(forces.vertex.begin(), forces.vertex.end()), forces.vertex.size());
  FURROW_ASSERT(forces.tangent.size() == forces.vertex.size(), forces.tangent.size(), forces.vertex.size());
  next_.clear();
  std::size_t k = 0;
  for (int v = 0; v < static_cast<int>(owed_.size()); ++v) {
    const bool touches = k < forces.vertex.size() && forces.vertex[k] == v;
    Vec3 change = -kShare / duration * owed_[v];
    if (!touches && owed_[v].norm() < kNothing) continue;
    if (touches) {
      const double size = change.norm(), most = kMaxOfForce * forces.force[k].norm();
      if (size > most) change *= most / size;
    }
    next_.vertex.push_back(v);
    next_.force.push_back(touches ? Vec3(forces.force[k] + change) : change);
    next_.tangent.push_back(touches ? forces.tangent[k] : ContactTangent());
    if (touches) ++k;
  }
  std::swap(forces, next_);
}

void ImpulseLedger::book(const NodalForces& acted, double duration) {
  FURROW_ASSERT(duration > 0.0, duration);
  FURROW_ASSERT(acted.force.size() == acted.vertex.size(), acted.force.size(), acted.vertex.size());
  FURROW_ASSERT(std::all_of(acted.vertex.begin(), acted.vertex.end(), [&](int v) { return in_range(v, owed_.size()); }),
                owed_.size());
  for (std::size_t k = 0; k < acted.vertex.size(); ++k) owed_[acted.vertex[k]] += duration * acted.force[k];
}

Vec3 ImpulseLedger::sum() const {
  Vec3 total = Vec3::Zero();
  for (const Vec3& one : owed_) total += one;
  return total;
}

void ImpulseLedger::save(Archive& archive) const {
  save_value(archive, "ledger/owed", owed_);
  save_fields(archive, "ledger", *this);
}

void ImpulseLedger::restore(const Archive& archive) {
  restore_value(archive, "ledger/owed", owed_, owed_.size());
  restore_fields(archive, "ledger", *this);
}

}  // namespace furrow::ranks
