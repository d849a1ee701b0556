// Motion of grains, their sleep and waking, and the forces on sleeping grains.
#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact/size_scale.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {
namespace {

Double4 lanes_of(const Vec3& v) { return Double4{v.x(), v.y(), v.z(), 0.0}; }

}  // namespace

void GrainSolver::move_parcel(const Strip& strip, Parcel& parcel, const Loads& loads, const StepPart& part,
                              Wanted wanted) {
  if (params_.sizes()) {
    params_.activity ? integrate<true, true>(strip, parcel, loads, part, wanted)
                     : integrate<false, true>(strip, parcel, loads, part, wanted);
  } else {
    params_.activity ? integrate<true, false>(strip, parcel, loads, part, wanted)
                     : integrate<false, false>(strip, parcel, loads, part, wanted);
  }
}

void GrainSolver::load_sleeper(const Strip& strip, Parcel& parcel, const Loads& loads) const {
  const Double4 weight = lanes_of(params_.gravity * params_.grain.mass);
  const double* const force = flat(loads.force);
  const double* const position = flat(grains_.position.data() + strip.first + parcel.part.first);
  const double per_radius = 1.0 / params_.grain.radius;
  Double4 largest{}, held{};
  for (int g = 0; g < kQuad * parcel.part.grains(); g += kQuad) {
    const Double4 f = load_lanes<Double4>(force + g) + cube(position[g + 3] * per_radius) * weight;
    largest = larger(largest, f * f);
    held += f;
  }
  store(parcel.motion.held, held);
  parcel.motion.max_net_force = std::sqrt(sum_of(largest));
}

template <bool kMaySleep, bool kSizes>
void GrainSolver::integrate(const Strip& strip, Parcel& parcel, const Loads& loads, const StepPart& part,
                            Wanted wanted) {
  const double dt = part.dt, kick = part.kick();
  const double mass = params_.grain.mass, inertia = params_.grain.inertia;
  const double radius = params_.grain.radius;
  double per_mass = 1.0 / mass, per_inertia = 1.0 / inertia;
  double m = 1.0, i = 1.0;  // mass and inertia of a grain relative to those of the reference radius
  const double keep = 1.0 / (1.0 + kick * drag_);
  const Double4 gravity = lanes_of(params_.gravity);
  const int n = parcel.part.grains(), first = strip.first + parcel.part.first;
  const double *const force = flat(loads.force), *const torque = flat(loads.torque);
  double* const velocity = flat(grains_.velocity.data() + first);
  double* const spin = flat(grains_.spin.data() + first);
  double* const position = flat(grains_.position.data() + first);
  Double4 moving{}, spinning{}, work{}, momentum{}, moment{}, fastest{}, net{};
  Double4 pushed{}, most_pushed{};  // Σ m a / m₀, largest squares of the acceleration
  for (int g = 0; g < kQuad * n; g += kQuad) {
    const Double4 f = load_lanes<Double4>(force + g), t = load_lanes<Double4>(torque + g);
    if constexpr (kSizes) {
      const double size = position[g + 3] / radius;
      m = cube(size), i = m * size * size;
      per_mass = 1.0 / (mass * m), per_inertia = 1.0 / (inertia * i);
    }
    const Double4 a = f * per_mass + gravity, alpha = t * per_inertia;
    const Double4 v = (load_lanes<Double4>(velocity + g) + kick * a) * keep;
    const Double4 w = (load_lanes<Double4>(spin + g) + kick * alpha) * keep;
    const Double4 x = load_lanes<Double4>(position + g) + dt * v;
    store_lanes(velocity + g, v);
    store_lanes(spin + g, w);
    store_lanes(position + g, x);
    const Double4 v2 = v * v;
    const auto weighed = [](Double4 one, double by) { return kSizes ? by * one : one; };
    moving += weighed(v2, m);
    spinning += weighed(w * w, i);
    work += f * a + t * alpha;
    momentum += weighed(v, m);
    moment += weighed(x, m);
    fastest = larger(fastest, v2);
    if constexpr (kMaySleep) {
      pushed += weighed(a, m);
      most_pushed = larger(most_pushed, weighed(a * a, m * m));
    }
    if (wanted.forces) net[0] += mass * m * std::sqrt(sum_of(a * a));
  }
  MotionTotals& sums = parcel.motion;
  sums.speed2 = sum_of(moving);
  sums.kinetic = 0.5 * (mass * sums.speed2 + inertia * sum_of(spinning));
  sums.spin2 = sum_of(spinning);
  sums.step_work = sum_of(work);
  store(sums.velocity, momentum);
  sums.height = up_.dot(Vec3(moment[0], moment[1], moment[2]));
  store(sums.fastest2, fastest);
  // Not a number if one of the sums is not: the strip is then sorted, and the grain is found.
  sums.max_speed = std::sqrt(sum_of(fastest)) + 0.0 * (sums.kinetic + sum_of(moment));
  sums.max_net_force = mass * std::sqrt(sum_of(most_pushed));
  store(sums.held, mass * pushed);
  sums.net_force = net[0];
  if constexpr (kMaySleep)
    if (part.last) activity_.add_drift(parcel, &grains_.drift[first], &grains_.velocity[first]);
}

void GrainSolver::wake(int grain) {
  FURROW_ASSERT(in_range(grain, grains_.count), grain, grains_.count);
  for (int k = 0; k < strips_.count(); ++k)
    for (Parcel& parcel : strips_[k].parcels) {
      const int at = grain - strips_[k].first;
      if (at < parcel.part.first || at >= parcel.part.last) continue;
      Activity::wake(parcel);
      strips_.sleep_changed(k);
    }
}

void GrainSolver::wake_all() {
  for (int k = 0; k < strips_.count(); ++k) {
    strips_[k].stale = false;
    for (Parcel& parcel : strips_[k].parcels) Activity::wake(parcel);
    strips_.sleep_changed(k);
  }
}

int GrainSolver::sway_steps(double dt) const {
  constexpr double kNever = 1e9;
  if (drag_ > 0.0) return static_cast<int>(kNever);  // settling beds must come to rest, and drag stops swaying
  const double steps = kSwayTime * std::sqrt(params_.grain.radius / params_.gravity.norm()) / dt;
  return static_cast<int>(std::min(std::ceil(steps), kNever));
}

void GrainSolver::change_activity(bool counts) {
  if (!params_.activity) return;
  const double speed = std::sqrt(params_.gravity.norm() * params_.grain.radius);
  activity_.limit({kSleepMeanSpeed * speed, kSleepSpeed * speed, kSwaySpeed * speed, kSleepForce * mean_contact_force_,
                   kWakeForce * mean_contact_force_});
  const double margin = 2.0 * strips_.options().reach;
  const auto near = [&](const Strip& strip, const auto& also) {
    return surfaces_.any_low_between(strip.x_min - margin, strip.x_max + margin, also);
  };
  const Activity::Stopped stopped = activity_.update(
      strips_, grains_, counts, [&](const Strip& strip) { return near(strip, [](double, double) { return true; }); },
      [&](const Strip& strip, int p) {
        return near(strip, [&](double y_min, double y_max) {
          return strips_.parcel_between(p, y_min - margin, y_max + margin);
        });
      });
  accounts_.slept += stopped.kinetic;
  accounts_.momentum_removed += params_.grain.mass * stopped.velocity;
}

}  // namespace furrow::terrain::dem
