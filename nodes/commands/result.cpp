// The last lines of a run: what it found, from its summary.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/files/digits.hpp"

namespace furrow::commands {
namespace {

using json = nlohmann::ordered_json;

double number(const json& object, const char* key) {
  return object.is_object() && object.contains(key) && object[key].is_number() ? object[key].get<double>()
                                                                               : NAN;
}

json summary_of(const std::filesystem::path& run) {
  json summary = checkpoint::read_summary(run);
  if (summary.is_null()) throw io_error(run.string(), "holds no summary of the run that can be read");
  return summary;
}

std::string pull_line(const json& summary, const scenario::Scenario& scenario) {
  const json pull = summary.value("drawbar_pull_N", json::object());
  const double mean = number(pull, "mean"), load = number(summary, "vertical_load_N");
  const json force = summary.value("net_terrain_force_N", json::array());
  if (force.size() == 3 && force[2].is_number() && force[2].get<double>() == 0.0)
    return "furrow: the tire did not touch the terrain in the averaging window: nothing was measured\n";
  std::string text =
      fmt::format("furrow: drawbar pull {} N, {:.1f} % of the load of {} N, mean over {:.3g} to {:.3g} s\n",
                  with_error(mean, number(pull, "sem")), 100.0 * mean / load, digits(load),
                  number(pull, "from_s"), number(pull, "to_s"));
  if (pull.value("steady", false)) {
    text += "furrow: the pull is steady\n";
  } else {
    std::string why;
    for (const json& reason : pull.value("unsteady_because", json::array()))
      why += (why.empty() ? "" : "; ") + reason.get<std::string>();
    text += "furrow: the pull is not steady" + (why.empty() ? "" : ": " + why) + "\n";
    text +=
        "furrow: another stretch of the run may give another mean; average over more of it with a later "
        "run.end and a longer terrain.length (rigs/README.md, \"Steady or not\")\n";
  }
  if (scenario.expected.given) {
    const double off = std::abs(mean - scenario.expected.drawbar_pull);
    text += fmt::format("furrow: expected {} N: {}\n",
                        with_error(scenario.expected.drawbar_pull, scenario.expected.drawbar_pull_spread),
                        off <= scenario.expected.drawbar_pull_spread ? "within" : "NOT within");
  }
  return text;
}

std::string ranks_line(const json& summary) {
  std::vector<std::string> parts;
  for (const json& rank : summary.value("ranks", json::array()))
    parts.push_back(fmt::format("{} {:.0f} % busy", rank.value("node", std::string("?")),
                                100.0 * number(rank, "busy_share")));
  return parts.empty() ? "" : fmt::format(": {}", fmt::join(parts, ", "));
}

/// Whether the run's accounts close, and what fails if they do not.
std::string accounts_line(const json& summary) {
  const json accounts = summary.value("accounts", json::object());
  const json energy = accounts.value("energy", json::object()),
             momentum = accounts.value("momentum", json::object());
  if (!std::isfinite(number(energy, "turnover"))) return "";
  std::string text = fmt::format(
      "furrow: accounts: energy residual {:.2g} % of {} J turned over, momentum residual {:.2g} of the "
      "largest "
      "impulse, {} N s\n",
      100.0 * number(energy, "residual_share"), digits(number(energy, "turnover")),
      number(momentum, "residual_share"), digits(number(momentum, "largest")));
  if (!energy.value("closes", false)) {
    const json parts = energy.value("residual_of", json::object());
    text += fmt::format(
        "furrow: WARNING: the account of energy does not close: {:.3g} J are left over, expected at most "
        "{:.3g} J "
        "(terrain {:.3g}, tires {:.3g}, rig {:.3g} J); halve run.step and compare, or report it "
        "(nodes/output/README.md, \"Accounts\")\n",
        number(energy, "residual"), number(energy, "bound"), number(parts, "terrain"), number(parts, "tires"),
        number(parts, "rig"));
  }
  if (!momentum.value("closes", false))
    text +=
        "furrow: WARNING: the account of momentum does not close: see accounts.momentum of summary.json, and "
        "report it (nodes/output/README.md, \"Accounts\")\n";
  return text;
}

}  // namespace

std::string result_text(const std::filesystem::path& run, const scenario::Scenario& scenario) {
  const json summary = summary_of(run);
  std::string text;
  const json wheels = summary.value("wheels", json::array());
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const json& wheel = wheels[k];
    const auto millimetres = [&](const char* key) { return 1e3 * number(wheel, key); };
    if (wheels.size() > 1) text += fmt::format("furrow: wheel {}\n", k);
    if (wheel.contains("drawbar_pull_N")) text += pull_line(wheel, scenario);
    text += fmt::format("furrow: sinkage {} mm", digits(millimetres("sinkage_m")));
    if (std::isfinite(millimetres("rut_width_m")))
      text += fmt::format(", rut {} mm deep, {} mm wide", digits(millimetres("rut_depth_m")),
                          digits(millimetres("rut_width_m")));
    else if (const json why = wheel.value("rut_missing_because", json()); why.is_string())
      text += ", no rut measured: " + why.get<std::string>();
    text += "\n";
  }
  if (const double added = number(summary, "substeps_added"); added > 0.0)
    text += fmt::format(
        "furrow: hard contacts: the terrain took {:.0f} more substeps, in {:.2g} % of the time, of at least "
        "1/{:.0f} "
        "of the step\n",
        added, 100.0 * number(summary, "substeps_refined_share"), number(summary, "substeps_most_parts"));
  text += accounts_line(summary);
  text += fmt::format("furrow: {:.1f} s for {:g} simulated s, {:.1f} s to prepare the bed{}\n",
                      number(summary, "wall_s"), number(summary, "simulated_s"),
                      number(summary, "settle_wall_s"), ranks_line(summary));
  return text;
}

}  // namespace furrow::commands
