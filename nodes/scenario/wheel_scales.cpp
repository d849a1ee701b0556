#include "nodes/scenario/wheel_scales.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/files/digits.hpp"
#include "terrain/bulk_cohesion.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::scenario {
namespace {

using terrain::dem::DemOptions;

constexpr double kG = kStandardGravity;
// Strength of grains; see the header.
constexpr double kAngle = 26.0 * std::numbers::pi / 180.0, kAngleOfRolling = 25.0 * std::numbers::pi / 180.0;
constexpr double kRough = 0.5;  // friction beyond which the angle does not grow
// Solid fraction of a bed as it falls, its decrease with rolling friction, its value without friction; increase of the
// angle with it.
constexpr double kFallen = 0.585, kFallenOfRolling = 0.075, kSmooth = 0.65;
constexpr double kAngleOfPacking = 110.0 * std::numbers::pi / 180.0;  // per solid fraction
constexpr double kShearBand = 10.0;                                   // grain diameters
constexpr double kConeDepth = 0.15;     // over which a cone index is the mean, m: a narrow wheel feels less of the soil
constexpr double kTimesToSettle = 4.0;  // z/v: F grows with depth while the damper lowers the wheel
// μ(I) = μ_s + (μ_2 − μ_s)/(1 + I_0/I) [Jop, Forterre & Pouliquen 2006, doi:10.1038/nature04801].
constexpr double kStatic = 0.38, kFast = 0.64, kInertial0 = 0.279;

// Limits beyond which a scale binds the answer.
constexpr double kGrains = 5.0;          // diameters in the contact, either way
constexpr double kDeepEnough = 8.0;      // sinkages
constexpr double kBesideTread = 0.5;     // tread widths
constexpr double kNearEnd = 0.1;         // of the averaging window
constexpr double kRateEffect = 0.05;     // of the friction, of the pressure
constexpr double kLeastModulus = 0.3;    // of empirical soil under a wheel, of k_φ
constexpr double kNodesInContact = 5.0;  // of empirical soil in the contact's length

constexpr double kLeapfrog = 0.5;  // ω H of a prompt force at which the rule's error is about 1 %

struct Strength {
  double cohesion = 0.0, angle = 0.0, weight = 0.0;  // Pa; rad; N/m³
};

double fallen_fraction(const DemOptions& o) { return kFallen - kFallenOfRolling * std::sqrt(o.rolling_friction); }

double solid_fraction(const DemOptions& o) {
  if (o.solid_fraction > 0.0) return o.solid_fraction;
  const double fallen = fallen_fraction(o);
  if (o.settling_friction < 0.0 || o.settling_friction >= o.friction) return fallen;
  return kSmooth - (kSmooth - fallen) * std::pow(o.settling_friction / o.friction, 0.75);
}

Strength strength_of(const DemOptions& o) {
  const double rough = std::min(1.0, std::sqrt(o.friction / kRough));
  const double loose = rough * (kAngle + kAngleOfRolling * std::pow(std::min(o.rolling_friction, kRough), 2));
  const double denser = solid_fraction(o) - fallen_fraction(o);
  return {terrain::kBulkCohesionShare * o.cohesion, std::max(loose + kAngleOfPacking * denser, 0.5 * loose),
          solid_fraction(o) * o.density * kG};
}

double contact_length(double radius, double sinkage) { return std::sqrt(2.0 * radius * sinkage); }

double bearing_pressure(const Strength& s, double radius, double width, double sinkage) {
  const double t = std::tan(s.angle);
  if (!(t > 1e-6)) return s.cohesion * (std::numbers::pi + 2.0) + s.weight * sinkage;
  const double n_q = std::exp(std::numbers::pi * t) * std::pow(std::tan(0.25 * std::numbers::pi + 0.5 * s.angle), 2);
  const double n_c = (n_q - 1.0) / t, n_gamma = 2.0 * (n_q + 1.0) * t;
  return s.cohesion * n_c + s.weight * sinkage * n_q +
         0.5 * s.weight * std::min(width, contact_length(radius, sinkage)) * n_gamma;
}

/// Sinkage by bisection; at most one radius.
double sinkage_of(const Strength& s, double load, double radius, double width) {
  FURROW_ASSERT(radius > 0.0 && width > 0.0, radius, width);
  double low = 0.0, high = radius;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    const bool carried = width * contact_length(radius, z) * bearing_pressure(s, radius, width, z) >= load;
    (carried ? high : low) = z;
  }
  return high;
}

double slip_of(const rigs::WheelDescription& wheel) {
  const double tread = std::abs(wheel.tread_speed);
  return tread > 0.0 ? std::max(0.0, 1.0 - std::abs(wheel.speed) / tread) : 0.0;
}

/// √(z/d) = 1/B_n + s/(2 √B_n); at most one radius.
double sinkage_by_cone(double cone_index, double load, double radius, double width, double slip) {
  FURROW_ASSERT(cone_index > 0.0, cone_index);
  const double d = 2.0 * radius, number = cone_index * width * d / load / (1.0 + 3.0 * width / d),
               slope = 1.0 / number + 0.5 * slip / std::sqrt(number);
  return std::clamp(d * slope * slope, 1e-9 * radius, radius);
}

/// Distance to which a footing of this length moves the soil in front of it: Prandtl's mechanism.
double reach_of_failure(double angle, double length) {
  return length * std::tan(0.25 * std::numbers::pi + 0.5 * angle) * std::exp(0.5 * std::numbers::pi * std::tan(angle));
}

WheelScales::OnGrains on_grains(const Scenario& s, const DemOptions& o, const tire::TireDescription& tire,
                                const rigs::WheelDescription& wheel, double load, double height) {
  const Strength soil = strength_of(o);
  const double diameter = 2.0 * o.radius, width = tire.tread_width;
  WheelScales::OnGrains g;
  g.by_cone_index = o.cone_index > 0.0 && !s.terrain->describe().cohesive && tire.width >= kConeDepth;
  g.sinkage = g.by_cone_index ? sinkage_by_cone(o.cone_index, load, tire.radius, tire.width, slip_of(wheel))
                              : sinkage_of(soil, load, tire.radius, width);
  g.contact_length = contact_length(tire.radius, g.sinkage);
  g.pressure = load / (width * g.contact_length);
  g.grains_wide = width / diameter;
  g.grains_long = g.contact_length / diameter;
  g.reach = g.sinkage + tire.grouser_height;
  g.depth_ratio = height / g.reach;
  if (!o.periodic_y()) g.beside = 0.5 * o.width - std::abs(wheel.lateral) - wheel.across;
  const bool forward = wheel.to >= wheel.from;
  g.ahead = (forward ? o.length - wheel.to : wheel.to) - wheel.along;
  const double contact_to_wall = g.ahead + wheel.along - g.contact_length,
               reach = reach_of_failure(soil.angle, std::min(width, g.contact_length)),
               averaged = std::abs(wheel.speed) * (s.run.end - s.run.average_from);
  if (averaged > 0.0) g.near_end = std::clamp((reach - contact_to_wall) / averaged, 0.0, 1.0);
  const double sliding = std::abs(wheel.tread_speed - wheel.speed);
  g.inertial = sliding / kShearBand * std::sqrt(o.density / g.pressure);
  const double entering = std::abs(wheel.speed) * std::sqrt(2.0 * g.sinkage / tire.radius);
  g.impact = solid_fraction(o) * o.density * entering * entering / g.pressure;
  return g;
}

/// Wheels with the same bound share one entry.
class Bounds {
 public:
  void begin(const std::string& wheel) { wheel_ = wheel; }
  void add(bool binds, const std::string& key, const std::string& what) {
    if (!binds) return;
    auto at = std::find_if(all_.begin(), all_.end(),
                           [&](const Bound& bound) { return bound.key == key && bound.what == what; });
    if (at == all_.end()) at = all_.insert(all_.end(), {key, what});
    if (!wheel_.empty()) at->wheels.push_back(wheel_);
  }
  std::vector<Bound> take() { return std::move(all_); }

 private:
  std::vector<Bound> all_;
  std::string wheel_;
};

void add_bin(const WheelScales::OnGrains& g, double width, Bounds& to) {
  to.add(
      std::min(g.grains_wide, g.grains_long) < kGrains, "terrain.radius",
      fmt::format("the contact is about {:.1f} grains long and {:.1f} wide, expected {:g} or more: under a wheel of "
                  "58 mm radius on dry sand grains of 2.5 instead of 3.5 mm radius changed the pull by 8 % of the load",
                  g.grains_long, g.grains_wide, kGrains));
  to.add(
      g.depth_ratio < kDeepEnough, "terrain.layers",
      fmt::format("the bed is about {:.1f} times as deep as the wheel will reach ({} mm), expected {:g} or more: the "
                  "floor carries too; a bed twice as deep gave 43 % more sinkage and 8 % less pull on cohesive "
                  "grains, one 1.5 times as deep 15 % more sinkage and 10 % more pull on LETE sand",
                  g.depth_ratio, digits(1e3 * g.reach), kDeepEnough));
  to.add(g.beside && *g.beside < kBesideTread * width, "terrain.width",
         fmt::format("{} m are left between wheel and side wall, expected half a tread width, {} m, or terrain.sides "
                     "periodic: with 0.6 tread widths left, a bin half as wide again changed the pull by -4.6 ± 5.2 %",
                     digits(g.beside.value_or(0.0)), digits(kBesideTread * width)));
  to.add(g.near_end > kNearEnd, "terrain.length",
         fmt::format("{} m are left ahead of the wheel at the end: in {:.0f} % of the averaging window the end wall "
                     "lies within the soil that fails in front of it (Prandtl), expected at most {:.0f} %",
                     digits(g.ahead), 100.0 * g.near_end, 100.0 * kNearEnd));
}

void add_rates(const WheelScales::OnGrains& g, Bounds& to) {
  const double rate = (kFast - kStatic) / kStatic / (1.0 + kInertial0 / std::max(g.inertial, 1e-12));
  to.add(rate > kRateEffect, "rig.slip",
         fmt::format("the inertial number is about {:.2g}: grains sheared so fast have {:.0f} % more friction than "
                     "slow ones (Jop, Forterre & Pouliquen 2006), expected below {:.0f} %",
                     g.inertial, 100.0 * rate, 100.0 * kRateEffect));
  to.add(g.impact > kRateEffect, "rig.speed",
         fmt::format("the wheel enters the soil so fast that its inertia adds about {:.0f} % to the pressure, expected "
                     "below {:.0f} %: drive more slowly",
                     100.0 * g.impact, 100.0 * kRateEffect));
}

double load_of(const Scenario& s, const rigs::WheelDescription& wheel, const tire::TireDescription& tire) {
  return -(wheel.carried_mass + tire.mass.mass) * s.rig->gravity().z();
}

void take(CouplingStep& least, double step, const char* because) {
  if (step < least.step) least = {step, because};
}

/// Takes the step of a spring and a mass, if both are known.
void take_spring(CouplingStep& least, double stiffness, double inertia, const char* because) {
  if (stiffness > 0.0 && inertia > 0.0) take(least, kLeapfrog * std::sqrt(inertia / stiffness), because);
}

}  // namespace

std::vector<double> wheel_loads(const Scenario& s) {
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  std::vector<double> loads;
  for (std::size_t k = 0; k < tires.size(); ++k) loads.push_back(load_of(s, rig.wheels[k], tires[k]));
  return loads;
}

std::vector<WheelScales> wheel_scales(const Scenario& s) {
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  const DemOptions* grains = s.terrain->grains();
  const double height = s.terrain->estimate(s.terrain_context()).expected_height;
  std::vector<WheelScales> all;
  for (std::size_t k = 0; k < tires.size(); ++k) {
    const rigs::WheelDescription& wheel = rig.wheels[k];
    WheelScales w;
    w.load = load_of(s, wheel, tires[k]);
    w.froude = std::max(std::abs(wheel.speed), std::abs(wheel.tread_speed)) / std::sqrt(kG * tires[k].radius);
    if (grains) w.grains = on_grains(s, *grains, tires[k], wheel, w.load, height);
    if (wheel.lowering_time > 0.0 && wheel.lowering_speed > 0.0)
      w.lowering_needs = (s.drop_height + kTimesToSettle * (w.grains ? w.grains->sinkage : 0.0)) / wheel.lowering_speed;
    all.push_back(w);
  }
  return all;
}

std::string wheel_name(const rigs::RigDescription& rig, std::size_t wheel) {
  FURROW_ASSERT(wheel < rig.wheels.size(), wheel, rig.wheels.size());
  return rig.wheels[wheel].name.empty() ? fmt::format("wheel {}", wheel) : rig.wheels[wheel].name;
}

std::string wheel_label(const rigs::RigDescription& rig, std::size_t wheel) {
  return rig.wheels.size() == 1 ? "" : wheel_name(rig, wheel);
}

std::vector<Bound> scale_bounds(const Scenario& s) {
  const std::vector<WheelScales> scales = wheel_scales(s);
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  Bounds bounds;
  for (std::size_t k = 0; k < scales.size(); ++k) {
    const WheelScales& w = scales[k];
    const double until = rig.wheels[k].lowering_time;
    bounds.begin(wheel_label(rig, k));
    bounds.add(w.lowering_needs > until, "rig.move_from",
               fmt::format("the wheel moves from {} s on, but lowering it takes about {} s: expected to stand by then; "
                           "lower it faster or move later",
                           digits(until), digits(w.lowering_needs)));
    if (const double nodes = s.terrain->nodes_under(tires[k].radius, tires[k].tread_width, w.load); !tires[k].deflects)
      bounds.add(
          nodes < kNodesInContact, "terrain.grid_spacing",
          fmt::format("the contact is about {:.1f} nodes long, expected {:g} or more: with two nodes a wheel of 58 "
                      "mm rolled with 84 % more resistance than with ten",
                      nodes, kNodesInContact));
    const double share = s.terrain->modulus_under(tires[k].radius, tires[k].tread_width, w.load);
    bounds.add(share < kLeastModulus, "terrain.bekker_k_c",
               fmt::format("k_c/b + k_phi is {:.2g} times k_phi with the b of this contact, expected {:g} or more: a "
                           "negative k_c that was fitted to wider plates does not hold here, and below 0.05 the run "
                           "takes 0.05; give terrain.patch_width, or plates of this size",
                           share, kLeastModulus));
    if (!w.grains) continue;
    add_bin(*w.grains, tires[k].tread_width, bounds);
    add_rates(*w.grains, bounds);
  }
  return bounds.take();
}

std::vector<CouplingStep> coupling_steps(const Scenario& s) {
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  const std::vector<double> loads = wheel_loads(s);
  std::vector<CouplingStep> all;
  for (std::size_t k = 0; k < tires.size(); ++k) {
    const tire::TireDescription& tire = tires[k];
    const rigs::WheelDescription& wheel = rig.wheels[k];
    CouplingStep least;
    if (!s.prompt(k)) {
      if (tire.step_share > 0.0 && tire.damping_time > 0.0)
        take(least, tire.step_share * tire.damping_time, "the damping time of its tire");
    } else {
      const double mass = wheel.unsprung_mass + tire.mass.mass, inertia = wheel.spin_inertia + tire.mass.inertia(1, 1);
      if (tire.own_contact.empty())
        take_spring(least, s.terrain->stiffness_under(tire.radius, tire.tread_width, loads[k]), mass,
                    "the bounce of its wheel on the ground's stiffness");
      take_spring(least, tire.vertical_stiffness, mass, "the bounce of its wheel on the tire's stiffness");
      take_spring(least, tire.grip_stiffness * tire.radius * tire.radius, inertia,
                  "the spin of its wheel on the tire's grip");
      if (tire.grip_damping > 0.0 && inertia > 0.0)  // else it is missing, and a run is refused
        take(least, inertia / (tire.grip_damping * tire.radius * tire.radius),
             "the spin of its wheel on a tire without relaxation length");
    }
    all.push_back(least);
  }
  return all;
}

CouplingStep smallest_coupling_step(const Scenario& s) {
  CouplingStep least;
  for (const CouplingStep& one : coupling_steps(s))
    if (one.step < least.step) least = one;
  return least;
}

std::string other_help(const Scenario& s) {
  const auto helps = [](const auto& tire) {
    return tire->describe().takes_tangents && !tire->options().contact_tangent;
  };
  return std::ranges::any_of(s.tires, helps) ? ", or tire.contact_tangent" : "";
}

}  // namespace furrow::scenario
