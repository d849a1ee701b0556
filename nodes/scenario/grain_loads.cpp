#include "nodes/scenario/grain_loads.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/digits.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/refinement/step_refinement.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::scenario {
namespace {

namespace dem = terrain::dem;

constexpr double kCount = 0.6;         // A, see the header
constexpr double kLargest = 8.0;       // the largest force of a run over the mean one
constexpr double kSoundOverlap = 0.2;  // of the diameter: the overlap that advice aims at

/// A contact without motion.
struct Contact {
  dem::LawKind law;
  dem::ContactCoefficients coefficients;

  double force(double overlap) const {
    return dem::with_law(law, [&](auto of) { return of.resting_force(coefficients.of<decltype(of)>(), overlap); });
  }
  double overlap(double force) const {
    return dem::with_law(law, [&](auto of) { return of.resting_overlap(coefficients.of<decltype(of)>(), force); });
  }
};

struct Pressed {
  double force = 0.0;   // p d², N
  double grains = 0.0;  // n
  Contact pair, tire;
};

std::vector<Pressed> pressed_grains(const Scenario& s, const dem::DemOptions& o) {
  const dem::GrainProperties grain = dem::grain_properties(o.radius, o.density);
  const dem::LawKind law = dem::law_from(o.law);
  const ContactMaterial material = dem::grain_material(o);
  const Contact pair{law, dem::mix(material, material, dem::Partner::grain, grain, o)};
  const std::vector<WheelScales> scales = wheel_scales(s);
  std::vector<Pressed> all;
  for (std::size_t k = 0; k < scales.size(); ++k) {
    FURROW_ASSERT(scales[k].grains.has_value(), k);
    const WheelScales::OnGrains& g = *scales[k].grains;
    all.push_back({4.0 * g.pressure * o.radius * o.radius,
                   g.grains_wide * g.grains_long,
                   pair,
                   {law, dem::mix(material, s.tires[k]->shape().material, dem::Partner::surface, grain, o)}});
  }
  return all;
}

/// Share of the time in which a contact is deeper than `overlap`, m.
double share_beyond(const std::vector<Pressed>& wheels, double overlap) {
  double count = 0.0;
  for (const Pressed& wheel : wheels)
    count +=
        kCount * wheel.grains * std::exp(-std::min(wheel.pair.force(overlap), wheel.tire.force(overlap)) / wheel.force);
  return 1.0 - std::exp(-count);
}

void add_refinement(const Scenario& s, const dem::DemOptions& o, const std::vector<Pressed>& wheels, GrainLoads& to) {
  dem::StepRefinement refinement(o);
  refinement.set_step(s.terrain_step());
  const double deepest = 2.0 * dem::kDeepestShare * dem::largest_radius(o);
  for (int level = 0; level < dem::kFinestLevel && refinement.limit(level) < deepest; ++level) {
    const double share = share_beyond(wheels, refinement.limit(level));
    if (level == 0) to.refined = share;
    to.parts += std::ldexp(share, level);
  }
}

}  // namespace

GrainLoads grain_loads(const Scenario& s) {
  GrainLoads loads;
  const dem::DemOptions* const keys = s.terrain->grains();
  if (!keys || keys->allow_unstable_step) return loads;
  const dem::DemOptions o = dem::with_context(*keys, s.terrain_context());
  const std::vector<Pressed> wheels = pressed_grains(s, o);
  for (std::size_t k = 0; k < wheels.size(); ++k)
    for (const bool on_tire : {false, true}) {
      const Contact& contact = on_tire ? wheels[k].tire : wheels[k].pair;
      const double overlap = 0.5 * contact.overlap(kLargest * wheels[k].force) / o.radius;
      if (overlap > loads.overlap) loads.overlap = overlap, loads.on_tire = on_tire, loads.wheel = k;
    }
  add_refinement(s, o, wheels, loads);
  return loads;
}

std::optional<Bound> too_hard(const Scenario& s, const GrainLoads& loads) {
  if (!(loads.overlap > dem::kDeepestShare)) return std::nullopt;
  const std::string what = fmt::format(
      "the deepest contact between {} is expected to overlap by {:.0f} % of a grain's diameter, and a run ends above "
      "{:.0f} %: ",
      loads.on_tire ? "a grain and a tire" : "two grains", 100.0 * loads.overlap, 100.0 * dem::kDeepestShare);
  std::vector<std::string> wheels;
  if (const std::string label = wheel_label(describe_rig(s), loads.wheel); !label.empty()) wheels.push_back(label);
  // As StiffnessKey describes.
  const double stiffer = std::pow(loads.overlap / kSoundOverlap, 1.5);
  if (loads.on_tire)
    return Bound{"tire.file",
                 what + fmt::format("expected {} times the contact.young_modulus of the tire's file", digits(stiffer)),
                 wheels};
  dem::DemOptions other = dem::with_context(*s.terrain->grains(), s.terrain_context());
  const dem::StiffnessKey key = dem::stiffness_key(other);
  *key.value *= stiffer;
  return Bound{"terrain." + key.name,
               what + fmt::format("expected about {:.2g} {}, which needs a step of the terrain of at most {:.2g} s",
                                  *key.value, key.unit, dem::stable_at(other, dem::stated_overlap(other)).step),
               wheels};
}

}  // namespace furrow::scenario
