#include "tests/tire/planar/planar_motion.hpp"

#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

/// a += factor × b
void add(PlanarField& a, double factor, const PlanarField& b) {
  const int n = static_cast<int>(a.size());
#pragma omp simd
  for (int k = 0; k < n; ++k) a.x[k] += factor * b.x[k], a.z[k] += factor * b.z[k];
}

}  // namespace

PlanarMotion::PlanarMotion(PlanarElements elements, PlanarState start, PlanarIntegrator integrator)
    : elements_(std::move(elements)),
      integrator_(integrator),
      state_(std::move(start)),
      mass_(elements_.mass()),
      force_(mass_.size()),
      rate_(mass_.size()) {
  FURROW_ASSERT(state_.x.size() == mass_.size() && state_.v.size() == mass_.size(), state_.x.size(), state_.v.size(),
                mass_.size());
  if (integrator_ == PlanarIntegrator::runge_kutta_4) stage_ = sum_ = state_, stage_force_ = force_;
}

void PlanarMotion::hold(int node, bool x, bool z) {
  FURROW_ASSERT(in_range(node, mass_.size()), node, mass_.size());
  held_.push_back({node, x, z});
}

bool PlanarMotion::accelerate(const PlanarState& at, double h, PlanarField& force, PlanarField& rate) {
  const bool sound = elements_.force(at.x, at.v, force);
  if (loads_) loads_(at, h, force);
  const int n = static_cast<int>(mass_.size());
#pragma omp simd
  for (int k = 0; k < n; ++k) rate.x[k] = force.x[k] / mass_[k], rate.z[k] = force.z[k] / mass_[k];
  for (const Held& held : held_) {
    if (held.x) rate.x[held.node] = 0.0;
    if (held.z) rate.z[held.node] = 0.0;
  }
  return sound;
}

bool PlanarMotion::euler(double h) {
  const bool sound = accelerate(state_, h, force_, rate_);
  add(state_.v, h, rate_);
  add(state_.x, h, state_.v);
  return sound;
}

bool PlanarMotion::runge_kutta(double h) {
  constexpr double kAt[] = {0.5, 0.5, 1.0}, kWeight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  bool sound = true;
  stage_ = state_, sum_ = state_;
  for (int k = 0; k < 4; ++k) {
    sound = accelerate(stage_, h, k == 0 ? force_ : stage_force_, rate_) && sound;
    add(sum_.x, kWeight[k] * h, stage_.v);
    add(sum_.v, kWeight[k] * h, rate_);
    if (k == 3) break;
    // The next stage's velocity last: its position needs this one's.
    const int n = static_cast<int>(mass_.size());
    const double way = kAt[k] * h;
    for (int a = 0; a < n; ++a) {
      stage_.x.x[a] = state_.x.x[a] + way * stage_.v.x[a], stage_.x.z[a] = state_.x.z[a] + way * stage_.v.z[a];
      stage_.v.x[a] = state_.v.x[a] + way * rate_.x[a], stage_.v.z[a] = state_.v.z[a] + way * rate_.z[a];
    }
  }
  std::swap(state_, sum_);
  return sound;
}

bool PlanarMotion::step(double h) {
  FURROW_ASSERT(h > 0.0, h);
  return integrator_ == PlanarIntegrator::runge_kutta_4 ? runge_kutta(h) : euler(h);
}

double PlanarMotion::kinetic_energy() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < mass_.size(); ++k)
    sum += 0.5 * mass_[k] * (state_.v.x[k] * state_.v.x[k] + state_.v.z[k] * state_.v.z[k]);
  return sum;
}

}  // namespace furrow::tire
