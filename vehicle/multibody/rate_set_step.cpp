// Rows in speeds within one half of the step: axes, impulses, residuals, bounds.
#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "vehicle/multibody/rate_set.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kTolerance = 1e-14;      // of a held row's speed, relative to the speeds in its sum
constexpr double kSideTolerance = 1e-12;  // by which a slipping row may have passed its target
constexpr double kLeastSpeed = 1.0;       // rad/s; slower speeds are compared with this one
constexpr int kFreeRounds = 8;            // rounds in which all rows may change sides at once

/// Whether the bounds are equal, so that the torque is given.
bool fixed(const RateControl& control) { return !(control.lower < control.upper); }

}  // namespace

void RateSet::prepare(int first_row, std::size_t body_count) {
  first_row_ = first_row;
  spin_sides_.clear();
  shaft_sides_.clear();
  first_spin_.assign(1, 0);
  first_shaft_.assign(1, 0);
  for (int i = 0; i < row_count(); ++i) {
    const auto need = [&](int body) {
      if (body == kGround) return;
      const auto first = spin_sides_.begin() + first_spin_.back();
      if (std::none_of(first, spin_sides_.end(), [&](const SpinSide& side) { return side.body == body; }))
        spin_sides_.push_back({first_row + i, body, Vec3::Zero()});
    };
    for (const ShaftTerm& term : rows_[i].shafts) {
      shaft_sides_.push_back({first_row + i, term.shaft, term.factor});
      need(shafts_[term.shaft].carrier);
    }
    for (const SpinTerm& term : rows_[i].spins) need(term.a), need(term.b);
    first_spin_.push_back(static_cast<int>(spin_sides_.size()));
    first_shaft_.push_back(static_cast<int>(shaft_sides_.size()));
  }
  end_sides_ = spin_sides_;
  base_.resize(shafts_.size());
  speed_before_.assign(rows_.size(), 0.0);
  law_forces_.assign(rows_.size(), ElementForce{});
  law_damping_.assign(rows_.size(), 0.0);
  rotor_momentum_.assign(body_count, Vec3::Zero());
  has_rotor_.assign(body_count, false);
  for (const Shaft& shaft : shafts_)
    if (shaft.carrier != kGround) has_rotor_[shaft.carrier] = true;
}

// u = Σ f (Ω − ω_C·a_C) + Σ f (ω_B − ω_A)·a_B
void RateSet::turn(std::vector<SpinSide>& sides, std::span<const Body> bodies) const {
  for (SpinSide& side : sides) side.w.setZero();
  for (int i = 0; i < row_count(); ++i) {
    const auto add = [&](int body, const Vec3& w) {
      if (body == kGround) return;
      for (int k = first_spin_[i]; k < first_spin_[i + 1]; ++k)
        if (sides[k].body == body) sides[k].w += w;
    };
    for (const ShaftTerm& term : rows_[i].shafts) {
      const Shaft& shaft = shafts_[term.shaft];
      if (shaft.carrier != kGround) add(shaft.carrier, -term.factor * (bodies[shaft.carrier].R * shaft.axis));
    }
    for (const SpinTerm& term : rows_[i].spins) {
      const Vec3 axis = term.b == kGround ? term.axis : Vec3(bodies[term.b].R * term.axis);
      add(term.b, term.factor * axis);
      add(term.a, -term.factor * axis);
    }
  }
}

void RateSet::update_axes(std::span<const Body> bodies) { turn(spin_sides_, bodies); }

double RateSet::speed(int row, const std::vector<SpinSide>& sides, std::span<const Body> bodies) const {
  FURROW_ASSERT(in_range(row, rows_.size()), row, rows_.size());
  double sum = 0.0;
  for (int k = first_shaft_[row]; k < first_shaft_[row + 1]; ++k)
    sum += shaft_sides_[k].factor * shafts_[shaft_sides_[k].shaft].state.speed;
  for (int k = first_spin_[row]; k < first_spin_[row + 1]; ++k)
    sum += sides[k].w.dot(bodies[sides[k].body].state.angular_velocity);
  return sum;
}

double RateSet::scale(int row, std::span<const Body> bodies) const {
  double sum = base_scale_ + kLeastSpeed;
  for (int k = first_shaft_[row]; k < first_shaft_[row + 1]; ++k)
    sum += std::abs(shaft_sides_[k].factor * shafts_[shaft_sides_[k].shaft].state.speed);
  for (int k = first_spin_[row]; k < first_spin_[row + 1]; ++k)
    sum += std::abs(spin_sides_[k].w.dot(bodies[spin_sides_[k].body].state.angular_velocity));
  return sum;
}

double RateSet::held_speed(int row, std::span<const Body> bodies) const {
  const double u = speed(row, spin_sides_, bodies);
  return stage_ == RateStage::first_half ? 0.5 * (u + speed(row, end_sides_, bodies)) : u;
}

void RateSet::begin(RateStage stage, double h, double mid_time, std::span<const Body> bodies) {
  FURROW_ASSERT(base_.size() == shafts_.size(), base_.size(), shafts_.size());
  stage_ = stage;
  half_step_ = 0.5 * h;
  mid_time_ = mid_time;
  base_scale_ = largest_speed();
  for (const SpinSide& side : spin_sides_)
    base_scale_ = std::max(
        base_scale_, (bodies[side.body].inertia_inverse_W * bodies[side.body].angular_momentum).cwiseAbs().maxCoeff());
  for (std::size_t s = 0; s < shafts_.size(); ++s) base_[s] = shafts_[s].state;
  if (stage == RateStage::assembly) return;
  for (int i = 0; i < row_count(); ++i) speed_before_[i] = speed(i, spin_sides_, bodies);
  evaluate_laws(bodies);
  for (int i = 0; i < row_count(); ++i) law_damping_[i] = law_forces_[i].damping;
}

void RateSet::evaluate_laws(std::span<const Body> bodies) {
  std::vector<double>& speeds = law_speeds_;
  std::vector<ElementForce>& torques = law_torques_;
  for (const Law& law : laws_) {
    speeds.clear();
    for (const int row : law.rows) speeds.push_back(speed(row, spin_sides_, bodies));
    torques.assign(law.rows.size(), ElementForce{});
    law.function(speeds, mid_time_, torques);
    for (std::size_t k = 0; k < law.rows.size(); ++k) law_forces_[law.rows[k]] = torques[k];
  }
}

void RateSet::fill_compliance(std::span<double> compliance) const {
  FURROW_ASSERT(compliance.size() == rows_.size(), compliance.size(), rows_.size());
  for (int i = 0; i < row_count(); ++i) {
    compliance[i] = -1.0;
    if (stage_ == RateStage::none) continue;
    if (stage_ == RateStage::assembly) {
      if (is_ideal(i)) compliance[i] = 0.0;
    } else if (controls_[i].mode == RateMode::hold) {
      if (states_[i].side == 0 && !fixed(controls_[i])) compliance[i] = rows_[i].give / half_step_;
    } else if (controls_[i].mode == RateMode::law && stage_ == RateStage::first_half && law_damping_[i] > 0.0) {
      compliance[i] = 1.0 / (half_step_ * law_damping_[i]);
    }
  }
}

void RateSet::known_impulses(std::span<double> impulses) const {
  FURROW_ASSERT(impulses.size() == rows_.size(), impulses.size(), rows_.size());
  for (int i = 0; i < row_count(); ++i) {
    const RateControl& control = controls_[i];
    impulses[i] = 0.0;
    if (stage_ == RateStage::none || stage_ == RateStage::assembly) continue;
    if (control.mode == RateMode::torque) impulses[i] = half_step_ * control.torque;
    if (control.mode == RateMode::law) impulses[i] = half_step_ * law_forces_[i].force;
    if (control.mode != RateMode::hold) continue;
    if (fixed(control) || states_[i].side > 0) impulses[i] = half_step_ * control.upper;
    if (states_[i].side < 0) impulses[i] = half_step_ * control.lower;
  }
}

void RateSet::apply(std::span<const double> impulses, std::span<Body> bodies) {
  for (const SpinSide& side : spin_sides_)
    bodies[side.body].angular_momentum += impulses[side.row - first_row_] * side.w;
  for (std::size_t s = 0; s < shafts_.size(); ++s) shafts_[s].state.speed = base_[s].speed;
  for (const ShaftSide& side : shaft_sides_)
    shafts_[side.shaft].state.speed += impulses[side.row - first_row_] * side.factor / shafts_[side.shaft].inertia;
}

void RateSet::move(double h) {
  for (std::size_t s = 0; s < shafts_.size(); ++s) shafts_[s].state.angle = base_[s].angle + h * shafts_[s].state.speed;
}

// A law with damping c is a separate row, P = h/2 f(u), solved by Newton's method with the slope −c:
//   δu + δP 2/(h c) = (h/2 f(u) − P) 2/(h c)
// Without damping P ← h/2 f(u) directly.
bool RateSet::residuals(std::span<double> impulses, std::span<const double> compliance, std::span<const Body> bodies,
                        std::span<double> residual, double& worst) {
  FURROW_ASSERT(stage_ != RateStage::none, rows_.size());
  worst = 0.0;
  if (stage_ == RateStage::first_half) {
    turn(end_sides_, bodies);
    if (!laws_.empty()) evaluate_laws(bodies);
  }
  for (int i = 0; i < row_count(); ++i) {
    residual[i] = 0.0;
    if (controls_[i].mode == RateMode::law && stage_ == RateStage::first_half) {
      const double gap = half_step_ * law_forces_[i].force - impulses[i];
      if (compliance[i] > 0.0)
        residual[i] = gap * compliance[i];
      else
        impulses[i] += gap;
      const double largest = std::max(std::abs(impulses[i]), half_step_);
      worst = std::max(worst, std::abs(gap) / largest);
    } else if (compliance[i] >= 0.0) {
      residual[i] = controls_[i].target - held_speed(i, bodies) - compliance[i] * impulses[i];
      const double reference = scale(i, bodies) + std::abs(controls_[i].target);
      if (residual[i] != 0.0) worst = std::max(worst, std::abs(residual[i]) / reference);
    }
  }
  return worst <= kTolerance;
}

bool RateSet::change_sides(std::span<const double> impulses, std::span<const Body> bodies, int round) {
  bool changed = false;
  for (int i = 0; i < row_count(); ++i) {
    const RateControl& control = controls_[i];
    if (control.mode != RateMode::hold || fixed(control)) continue;
    int& side = states_[i].side;
    const int before = side;
    if (side == 0) {
      const double room = kSideTolerance * half_step_ *
                          (std::isfinite(control.upper - control.lower) ? control.upper - control.lower : 0.0);
      if (impulses[i] > half_step_ * control.upper + room) side = 1;
      if (impulses[i] < half_step_ * control.lower - room) side = -1;
    } else {
      // At the upper bound u may be below the held speed, at the lower bound above it.
      const double held = control.target - rows_[i].give * (side > 0 ? control.upper : control.lower);
      const double passed = side * (held_speed(i, bodies) - held);
      if (passed > kSideTolerance * (scale(i, bodies) + std::abs(control.target))) side = 0;
    }
    changed = changed || side != before;
    if (changed && round >= kFreeRounds) return true;
  }
  return changed;
}

// The work of an impulse in a row is P times the mean of the row's speeds before and after it.
void RateSet::finish(std::span<const double> impulses, std::span<const Body> bodies) {
  const bool first = stage_ == RateStage::first_half;
  for (int i = 0; i < row_count(); ++i) {
    RateState& state = states_[i];
    state.torque = (first ? 0.0 : state.torque) + 0.5 * impulses[i] / half_step_;
    state.work += impulses[i] * 0.5 * (speed_before_[i] + speed(i, spin_sides_, bodies));
  }
}

void RateSet::update_rotors() {
  for (Vec3& p : rotor_momentum_) p.setZero();
  for (const Shaft& shaft : shafts_)
    if (shaft.carrier != kGround) rotor_momentum_[shaft.carrier] += shaft.inertia * shaft.state.speed * shaft.axis;
}

const Vec3* RateSet::rotor_momentum(int body) const {
  return has_rotor_.empty() || !has_rotor_[body] ? nullptr : &rotor_momentum_[body];
}

}  // namespace furrow::vehicle
