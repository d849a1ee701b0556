#include "nodes/output/lag_json.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/output/averaging_window.hpp"
#include "nodes/output/lag_watch.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/files/json_number.hpp"

namespace furrow::output {

using Json = nlohmann::ordered_json;

Json lag_json(const SummaryInput& in, double from) {
  Json entries = Json::array();
  double worst = 0.0, all = 0.0, weight = 0.0;
  const auto add = [&](const std::string& name, double made, double passed, double load, double radius) {
    const double share = lag_share(made, passed, load, radius);
    worst = std::max(worst, share);
    entries.push_back({{"name", name},
                       {"energy_J", json_number(made)},
                       {"work_J", json_number(passed)},
                       {"share", json_number(share)}});
  };
  const rigs::RigDescription rig = scenario::describe_rig(in.scenario);
  for (std::size_t k = 0; k < in.end.wheels.size(); ++k) {
    const Window window = averaging_window(in.tables[k], from, in.scenario.tires[k]->describe().facets);
    if (window.rows.empty()) continue;
    const std::string wheel = scenario::wheel_name(rig, k);
    const double load = in.end.wheels[k].load, radius = in.cards[1 + k].tire_radius;
    const InterfaceEnergies begin = interface_energies(window.before), end = interface_energies(window.rows.back());
    add(wheel + " ground", end.ground - begin.ground, end.passed - begin.passed, load, radius);
    add(wheel + " rim", end.rim - begin.rim, end.passed - begin.passed, load, radius);
    all += end.passed - begin.passed;
    weight += load * radius;
  }
  const Table& accounts = in.tables.back();
  const std::vector<double> times = accounts.column("time_s"), left = accounts.column("rig_residual_J");
  std::size_t first = 0;
  while (first + 1 < times.size() && times[first + 1] < from) ++first;
  if (!entries.empty() && first + 1 < times.size()) add("driveline", left[first] - left.back(), all, weight, 1.0);
  const bool known = !entries.empty();
  Json json = {{"share", known ? json_number(worst) : Json(nullptr)},
               {"ok", known ? Json(worst <= kGoodShare) : Json()}};
  if (worst > kGoodShare)
    json["better_step_s"] =
        better_step(in.scenario.run.step, worst, scenario::smallest_coupling_step(in.scenario).step);
  json["entries"] = entries;
  return json;
}

}  // namespace furrow::output
