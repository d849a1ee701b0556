#include "vehicle/driveline/gearbox.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

constexpr int kOutputTerm = 0, kInputTerm = 1;  // of a gear's row: u_out − g u_in

RateControl held(double target = 0.0) { return {.mode = RateMode::hold, .target = target}; }

/// 0 at 0, 1 at 1, C².
double smoothstep(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

}  // namespace

Gearbox::Gearbox(System& system, const std::string& name, int in, int out, const std::vector<double>& ratios,
                 double shift_time, int gear)
    : name_(name), ratios_(ratios), shift_time_(shift_time) {
  FURROW_ASSERT(gear == kNeutral || in_range(gear, ratios.size()), name, gear);
  for (const double ratio : ratios)
    if (ratio == 0.0 || !std::isfinite(ratio))
      throw physics_error("gearbox '" + name + "': the ratio of a gear must not be zero");
  if (!(shift_time >= 0.0) || !std::isfinite(shift_time))
    throw physics_error("gearbox '" + name + "': its shift time must be 0 or a positive time in s");
  state_.gear = gear;
  const double ratio = gear == kNeutral ? 1.0 : ratios_[gear];
  static_assert(kOutputTerm == 0 && kInputTerm == 1);
  const RateRow row{name, {{out, 1.0}, {in, -ratio}}, {}};
  rows_[0] = system.add_rate_row(row, gear == kNeutral ? RateControl{} : held());
  rows_[1] = system.add_rate_row(row);
}

void Gearbox::begin_in(System& system, int gear) {
  FURROW_ASSERT(!shifting() && in_range(gear, ratios_.size()), name_, gear);
  state_.gear = gear;
  system.set_rate_factor(rows_[state_.row], kInputTerm, -ratios_[gear]);
  system.set_rate_control(rows_[state_.row], held());
}

Outcome Gearbox::shift(System& system, int gear) {
  FURROW_ASSERT(!shifting(), name_, state_.gear);
  FURROW_ASSERT(gear == kNeutral || in_range(gear, ratios_.size()), name_, gear);
  if (gear == state_.gear) return {};
  const int old_row = rows_[state_.row];
  state_.old_gear = state_.gear;
  state_.gear = gear;
  state_.redundant = system.redundant_count();
  if (gear == kNeutral) {
    system.set_rate_control(old_row, RateControl{});
    system.recheck_rank();
    return {};
  }
  state_.row = 1 - state_.row;
  const int row = rows_[state_.row];
  system.set_rate_factor(row, kInputTerm, -ratios_[gear]);
  if (shift_time_ == 0.0) {
    system.set_rate_control(old_row, RateControl{});
    return engage(system);
  }
  const double now = system.time();
  // At least the torque that balances the input's torque in the new gear.
  const double old_torque = state_.old_gear == kNeutral ? 0.0 : system.rate_state(old_row).torque;
  const double step = state_.old_gear == kNeutral ? 0.0 : ratios_[state_.old_gear] / ratios_[gear];
  state_.hand_over = old_torque * std::max(1.0, step);
  if (step > 0.0 && state_.hand_over * system.rate_speed(row) < 0.0) {
    RateControl freewheel = held();
    (old_torque > 0.0 ? freewheel.lower : freewheel.upper) = 0.0;
    system.set_rate_control(old_row, freewheel);
    state_.phase = ShiftPhase::torque;
    state_.phase_start = now;
    state_.phase_end = now + 0.5 * shift_time_;
    return {};
  }
  begin_speed_phase(system, now, now + shift_time_);
  return {};
}

void Gearbox::begin_speed_phase(System& system, double start, double end) {
  FURROW_ASSERT(end > start, name_, start, end);
  if (state_.old_gear != kNeutral) {
    system.set_rate_control(rows_[1 - state_.row], RateControl{});
    system.recheck_rank();
  }
  state_.phase = ShiftPhase::speed;
  state_.phase_start = start;
  state_.phase_end = end;
  state_.slip = system.rate_speed(rows_[state_.row]);
}

Outcome Gearbox::advance(System& system, double h) {
  FURROW_ASSERT(h > 0.0, h);
  if (!shifting()) return {};
  const int row = rows_[state_.row];
  const double begin = system.time(), end = begin + h, margin = 0.01 * h;
  if (state_.phase == ShiftPhase::torque) {
    const bool carries = system.rate_state(rows_[1 - state_.row]).side == 0;
    if (carries && begin < state_.phase_end - margin) {
      const double torque = state_.hand_over * smoothstep((begin + 0.5 * h - state_.phase_start) /
                                                          (state_.phase_end - state_.phase_start));
      system.set_rate_control(row, {.mode = RateMode::torque, .torque = torque});
      return {};
    }
    begin_speed_phase(system, begin, state_.phase_start + shift_time_);
  }
  const double slip = system.rate_speed(row);
  if (begin >= state_.phase_end - margin || !(slip * state_.slip > 0.0)) return engage(system);
  const double share = smoothstep((end - state_.phase_start) / (state_.phase_end - state_.phase_start));
  RateControl control = held(state_.slip * (1.0 - share));
  (state_.slip > 0.0 ? control.upper : control.lower) = 0.0;
  system.set_rate_control(row, control);
  return {};
}

Outcome Gearbox::engage(System& system) {
  state_.phase = ShiftPhase::none;
  system.set_rate_control(rows_[state_.row], held());
  system.recheck_rank();
  if (system.redundant_count() > state_.redundant)
    return Outcome::failure("has a gear that closes a loop of gears", "gearbox '" + name_ + "'");
  return {};
}

double Gearbox::output_torque(const System& system) const {
  return system.rate_state(rows_[0]).torque + system.rate_state(rows_[1]).torque;
}

double Gearbox::loss(const System& system) const {
  return -system.rate_state(rows_[0]).work - system.rate_state(rows_[1]).work;
}

void Gearbox::save(Archive& archive) const { save_fields(archive, "gearbox", state_); }

void Gearbox::restore(const Archive& archive) { restore_fields(archive, "gearbox", state_); }

}  // namespace furrow::vehicle
