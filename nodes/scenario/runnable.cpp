#include "nodes/scenario/runnable.hpp"

#include <string>

#include "protocol/core/error.hpp"

namespace furrow::scenario {

void require_runnable(const Scenario& scenario) {
  for (std::size_t k = 0; k < scenario.tires.size(); ++k) {
    const tire::TireDescription tire = scenario.tires[k]->describe();
    if (!tire.static_only.empty())
      throw input_error(scenario.file.string(), scenario.tire_key(k, "file"), "is a {}, {}", tire.name,
                        tire.static_only);
  }
  if (const std::string lacking = scenario.terrain->lacking(); !lacking.empty())
    throw input_error(scenario.file.string(), std::string("terrain.") + scenario.terrain->lacking_key(), lacking);
}

}  // namespace furrow::scenario
