#include "nodes/scenario/wheel_geometry.hpp"

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "tire/press/press_curve.hpp"

namespace furrow::scenario {

std::vector<tire::TireDescription> describe_tires(const Scenario& scenario) {
  std::vector<tire::TireDescription> tires;
  for (std::size_t k = 0; k < scenario.tires.size(); ++k)
    // Wheels that share a tire share its description.
    tires.push_back(k > 0 && scenario.tires[k] == scenario.tires[k - 1] ? tires.back() : scenario.tires[k]->describe());
  return tires;
}

std::vector<rigs::WheelSize> wheel_sizes(const std::vector<tire::TireDescription>& tires) {
  std::vector<rigs::WheelSize> sizes;
  for (const tire::TireDescription& tire : tires) sizes.push_back({tire.radius, tire.width, tire.grouser_height});
  return sizes;
}

std::vector<rigs::MountedTire> mounted_tires(const Scenario& scenario,
                                             const std::vector<tire::TireDescription>& tires) {
  FURROW_ASSERT(tires.size() == scenario.tires.size(), tires.size(), scenario.tires.size());
  std::vector<rigs::MountedTire> mounted;
  for (std::size_t k = 0; k < tires.size(); ++k)
    mounted.push_back({tires[k].radius, tires[k].mass.mass, scenario.tires[k]->rim(),
                       scenario.tires[k]->options().file.string(), tires[k].width, tire::hopeless_load(tires[k])});
  return mounted;
}

rigs::RigDescription describe_rig(const Scenario& scenario) { return describe_rig(scenario, describe_tires(scenario)); }

rigs::RigDescription describe_rig(const Scenario& scenario, const std::vector<tire::TireDescription>& tires) {
  rigs::RigDescription rig = scenario.rig->describe(wheel_sizes(tires), scenario.run.end);
  if (rig.wheels.size() != scenario.rig->wheel_count())
    throw input_error(
        scenario.file.string(), "rig.type",
        "the rig '{}' describes {} of its {} wheels, expected all: RigSpec::describe of this type is wrong", rig.kind,
        rig.wheels.size(), scenario.rig->wheel_count());
  return rig;
}

}  // namespace furrow::scenario
