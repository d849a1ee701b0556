#include "nodes/scenario/coupling_step.hpp"

#include <cmath>

#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"

namespace furrow::scenario {
namespace {

void take(CouplingStep& least, double step, const char* because) {
  if (step < least.step) least = {step, because};
}

/// Of a spring and a mass; where one is not known there is none.
void take_spring(CouplingStep& least, double stiffness, double inertia, const char* because) {
  if (stiffness > 0.0 && inertia > 0.0) take(least, std::sqrt(inertia / stiffness), because);
}

}  // namespace

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
      if (tire.grip_damping > 0.0)
        take(least, inertia / (tire.grip_damping * tire.radius * tire.radius),
             "the spin of its wheel on a tire without relaxation length");
    }
    all.push_back(least);
  }
  return all;
}

}  // namespace furrow::scenario
