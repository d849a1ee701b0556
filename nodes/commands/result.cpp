// The last lines of a run: its results, from its summary.
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::commands {
namespace {

using json = nlohmann::ordered_json;
using checkpoint::number_at;

constexpr double kDeep = 0.5, kHigh = 0.05;  // sinkage, radii, beyond which a warning is printed

json summary_of(const std::filesystem::path& run) {
  json summary = checkpoint::read_summary(run);
  if (summary.is_null()) throw io_error(run.string(), "holds no summary of the run that can be read");
  return summary;
}

/// The verdict on the communication step; empty if it is good.
std::string step_line(const json& summary, const scenario::Scenario& scenario) {
  const json judged = summary.value("interface", json::object());
  if (judged.value("ok", json()) != json(false)) return "";
  json worst;
  for (const json& entry : judged.value("entries", json::array()))
    if (worst.is_null() || number_at(entry, "share") > number_at(worst, "share")) worst = entry;
  return fmt::format(
      "furrow: THE STEP IS TOO LARGE: at the interface '{}' late forces {} {:.3g} J, {:.1f} % of the work there in the "
      "averaging window, expected at most 1 %; take a run.step of {} s or less{} (now {} s)\n",
      worst.value("name", ""), number_at(worst, "energy_J") > 0.0 ? "made" : "took",
      std::abs(number_at(worst, "energy_J")), 100.0 * number_at(worst, "share"),
      number_text(number_at(judged, "better_step_s")),
      worst.value("name", "").ends_with("ground") ? scenario::other_help(scenario) : "",
      number_text(scenario.run.step));
}

/// The slip from its three zeros, and the pull by published regressions, with those that do not hold here apart; empty
/// without a cone index.
std::string regressions_lines(const json& wheel) {
  const json found = wheel.value("regressions", json());
  if (!found.is_object()) return "";
  std::vector<std::string> within, outside;
  for (const auto& [key, of] : found.items())
    if (of.is_object() && std::isfinite(number_at(of, "net_N")))
      (of.value("in_range", false) ? within : outside)
          .push_back(fmt::format("{} {} N", of.value("name", key), digits(number_at(of, "net_N"))));
  std::string text;
  if (std::isfinite(number_at(wheel, "slip")))
    text = fmt::format(
        "furrow: slip {} from the undeformed radius, {} from rolling without torque, {} from no pull on hard ground\n",
        digits(number_at(wheel, "slip")), digits(number_at(wheel, "slip_of_free_rolling")),
        digits(number_at(wheel, "slip_of_no_pull")));
  text += fmt::format("furrow: regressions of the pull at a cone index of {} kPa: {}",
                      digits(1e-3 * number_at(found, "cone_index_Pa")),
                      within.empty() ? "none holds here" : fmt::format("{}", fmt::join(within, ", ")));
  if (!outside.empty()) text += fmt::format("; outside of their range {}", fmt::join(outside, ", "));
  return text + "\n";
}

std::string pull_line(const json& summary, const scenario::Scenario& scenario) {
  const json pull = summary.value("drawbar_pull_N", json::object());
  const double mean = number_at(pull, "mean"), load = number_at(summary, "vertical_load_N");
  const json force = summary.value("net_terrain_force_N", json::array());
  if (force.size() == 3 && force[2].is_number() && force[2].get<double>() == 0.0)
    return "furrow: the tire did not touch the terrain in the averaging window: nothing was measured\n";
  std::string text =
      fmt::format("furrow: drawbar pull {} N, {:.1f} % of the load of {} N, mean over {:.3g} to {:.3g} s\n",
                  with_error(mean, number_at(pull, "sem")), 100.0 * mean / load, digits(load),
                  number_at(pull, "from_s"), number_at(pull, "to_s"));
  if (const terrain::dem::DemOptions* grains = scenario.terrain->grains())
    text += fmt::format("furrow: ± is one standard error within this bed; {}\n",
                        grains->bed.empty() ? "the spread from bed to bed is not in it: furrow run --seeds 5"
                                            : "how much other beds differ is not in it");
  if (pull.value("steady", false)) {
    text += "furrow: the pull is steady\n";
  } else {
    const json reasons = pull.value("unsteady_because", json::array());
    if (reasons.empty()) text += "furrow: the pull is not steady\n";
    for (const json& reason : reasons) text += "furrow: the pull is not steady: " + reason.get<std::string>() + "\n";
    text +=
        "furrow: another stretch of the run may give another mean (scripts/docs/results.md, \"Steady or not\")\n"
        "furrow: average over more of it: set a later run.end";
    const bool ends = json::parse(scenario.completed)["terrain"].contains("length");  // hard ground has none
    text += ends ? " and a longer terrain.length\n" : "\n";
  }
  return text +
         expected_text(scenario.expected, 1, mean, number_at(summary, "sinkage_m"), number_at(summary, "rut_depth_m")) +
         regressions_lines(summary);
}

/// Time of each rank; a table if there are more than rig, one tire and terrain.
std::string ranks_text(const json& summary) {
  std::vector<std::string> parts;
  const json ranks = summary.value("ranks", json::array());
  if (ranks.size() > 3) {
    std::string table = fmt::format("\nfurrow: {:<10} {:>9} {:>9} {:>7} {:>9} {:>9} {:>9} {:>6}\n", "node", "size",
                                    "step, s", "threads", "comp., s", "comm., s", "wait, s", "busy");
    for (const json& rank : ranks)
      table += fmt::format("furrow: {:<10} {:>9} {:>9.3g} {:>7} {:>9.1f} {:>9.1f} {:>9.1f} {:>4.0f} %\n",
                           rank.value("node", std::string("?")), rank.value("size", std::int64_t{0}),
                           number_at(rank, "step_s"), rank.value("threads", 0), number_at(rank, "compute_s"),
                           number_at(rank, "communicate_s"), number_at(rank, "wait_s"),
                           100.0 * number_at(rank, "busy_share"));
    return table;
  }
  for (const json& rank : summary.value("ranks", json::array()))
    parts.push_back(
        fmt::format("{} {:.0f} % busy", rank.value("node", std::string("?")), 100.0 * number_at(rank, "busy_share")));
  return parts.empty() ? "\n" : fmt::format(": {}\n", fmt::join(parts, ", "));
}

/// Whether the run's accounts close; if not, what does not.
std::string accounts_line(const json& summary) {
  const json accounts = summary.value("accounts", json::object());
  const json energy = accounts.value("energy", json::object()), momentum = accounts.value("momentum", json::object());
  if (!std::isfinite(number_at(energy, "turnover"))) return "";
  std::string text = fmt::format(
      "furrow: accounts: energy residual {:.2g} % of {} J turned over, momentum residual {:.2g} of the largest "
      "impulse, {} N s\n",
      100.0 * number_at(energy, "residual_share"), digits(number_at(energy, "turnover")),
      number_at(momentum, "residual_share"), digits(number_at(momentum, "largest")));
  if (!energy.value("closes", false)) {
    const json parts = energy.value("residual_of", json::object());
    text += fmt::format(
        "furrow: WARNING: the account of energy does not close: {:.3g} J are left over, expected at most {:.3g} J "
        "(terrain {:.3g}, tires {:.3g}, rig {:.3g} J); halve run.step and compare, or report it "
        "(scripts/docs/results.md, \"Accounts\")\n",
        number_at(energy, "residual"), number_at(energy, "bound"), number_at(parts, "terrain"),
        number_at(parts, "tires"), number_at(parts, "rig"));
  }
  if (!momentum.value("closes", false))
    text +=
        "furrow: WARNING: the account of momentum does not close: see accounts.momentum of summary.json, and report it "
        "(scripts/docs/results.md, \"Accounts\")\n";
  return text;
}

/// Lines on tables other than a wheel's: distance and power of a vehicle.
std::string subject_lines(const json& summary, double average_from) {
  std::string text;
  const json subjects = summary.value("subjects", json::object());
  for (const auto& [name, figures] : subjects.items()) {
    const auto told = [&, &of = figures](const char* key) { return digits(number_at(of, key)); };
    if (std::isfinite(number_at(figures, "distance_m")))
      text += fmt::format(
          "furrow: {}: {} m in all; from {:g} s on {} m/s on average, engine {} W, wheels {} W, tires and ground {} "
          "W\n",
          name, told("distance_m"), average_from, told("speed_m_s"), told("power_W"), told("wheel_power_W"),
          told("soil_power_W"));
  }
  return text;
}

/// Warning for a wheel in a place where no wheel drives.
/// @param grousers  their height, m @param yields  the ground gives way, so no wheel can climb it
std::string place_warning(const json& wheel, double grousers, bool yields) {
  if (number_at(wheel, "interface_work_J") == 0.0) return "";  // it has not touched the ground yet
  const double share = number_at(wheel, "sinkage_m") / number_at(wheel, "tire_radius_m");
  if (share > kDeep)
    return fmt::format(
        "furrow: WARNING: the wheel has sunk in by {:.2g} radii: the ground does not bear its load, or it spins itself "
        "in; see whether it comes to rest with less load (rig.carrier_mass), slip or run.step, or on stronger soil\n",
        share);
  if (yields && share + grousers / number_at(wheel, "tire_radius_m") < -kHigh)
    return fmt::format(
        "furrow: WARNING: the wheel is {:.2g} radii above the ground as it was: it bounces or was thrown off; take a "
        "smaller run.step or ground less stiff for its step, and look at its height in the plots\n",
        -share);
  return "";
}

std::string end_lines(const json& summary, const scenario::Scenario& scenario) {
  const std::string reason = summary.value("end_reason", std::string("run_end"));
  if (reason == "run_end") return "";
  const std::string why = reason == "overturned" ? "the vehicle has turned over"
                                                 : fmt::format("a tire came near {} wall (rig.stop_before_wall)",
                                                               reason == "end_wall" ? "the end" : "a side");
  std::string text = fmt::format("furrow: the run ended at {:g} s, before {:g} s: {}\n",
                                 number_at(summary, "end_time_s"), scenario.run.end, why);
  if (number_at(summary, "average_from_s") != scenario.run.average_from)
    text += fmt::format("furrow: so means are from {:.3g} s on, not from run.average_from = {:g} s\n",
                        number_at(summary, "average_from_s"), scenario.run.average_from);
  return text;
}

/// For each kind of event its number, its first time, and its total duration.
std::string event_lines(const json& summary) {
  struct Kind {
    int count = 0;
    double first = 0.0, time = 0.0;
    std::string wheel;
  };
  std::map<std::string, Kind> kinds;
  for (const json& event : summary.value("events", json::array())) {
    Kind& kind = kinds[event.value("event", std::string("?"))];
    if (kind.count++ == 0) {
      kind.first = number_at(event, "from_s");
      if (event.contains("wheel")) kind.wheel = fmt::format(", wheel {}", event.value("wheel", 0));
    }
    const double to = number_at(event, "to_s");
    kind.time += (std::isfinite(to) ? to : number_at(summary, "end_time_s")) - number_at(event, "from_s");
  }
  std::string text;
  for (const auto& [name, kind] : kinds)
    text += fmt::format("furrow: {}: {} times, {:.3g} s in all, first at {:g} s{}\n", name, kind.count, kind.time,
                        kind.first, kind.wheel);
  return text;
}

}  // namespace

std::string expected_text(const scenario::ExpectedResult& expected, int beds, double pull, double sinkage,
                          double rut_depth) {
  FURROW_ASSERT(beds > 0, beds);
  if (!expected.given) return "";
  struct Figure {
    const char* name;
    double value, spread, found, scale;
    const char* unit;
  };
  std::vector<std::string> parts, outside;
  for (const Figure& f : {Figure{"pull", expected.drawbar_pull, expected.drawbar_pull_spread, pull, 1.0, "N"},
                          Figure{"sinkage", expected.sinkage, expected.sinkage_spread, sinkage, 1e3, "mm"},
                          Figure{"rut", expected.rut_depth, expected.rut_depth_spread, rut_depth, 1e3, "mm"}}) {
    if (f.spread <= 0.0) continue;  // not stated
    const double spread = f.spread / std::sqrt(beds);
    parts.push_back(fmt::format("{} {} {}", f.name, with_error(f.scale * f.value, f.scale * spread), f.unit));
    if (!(std::abs(f.found - f.value) <= spread)) outside.emplace_back(f.name);
  }
  if (parts.empty()) return "";
  return fmt::format("furrow: expected {}: {}\n", fmt::join(parts, ", "),
                     outside.empty() ? "within" : fmt::format("NOT within: {}", fmt::join(outside, ", ")));
}

std::string result_text(const std::filesystem::path& run, const scenario::Scenario& scenario) {
  const json summary = summary_of(run);
  std::string text;
  text += step_line(summary, scenario);
  const json wheels = summary.value("wheels", json::array());
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const json& wheel = wheels[k];
    const auto millimetres = [&](const char* key) { return 1e3 * number_at(wheel, key); };
    if (wheels.size() > 1) text += fmt::format("furrow: wheel {}\n", k);
    if (wheel.contains("drawbar_pull_N")) text += pull_line(wheel, scenario);
    const auto told = [&](const char* key, const char* sem) {
      const double error = millimetres(sem);
      return std::isfinite(error) ? with_error(millimetres(key), error) : digits(millimetres(key));
    };
    text += fmt::format("furrow: sinkage {} mm", told("sinkage_m", "sinkage_sem_m"));
    if (std::isfinite(millimetres("rut_width_m")))
      text += fmt::format(", rut {} mm deep, {} mm wide", told("rut_depth_m", "rut_depth_sem_m"),
                          digits(millimetres("rut_width_m")));
    else if (const json why = wheel.value("rut_missing_because", json()); why.is_string())
      text += ", no rut measured: " + why.get<std::string>();
    text +=
        "\n" + place_warning(wheel, scenario.tires[k]->describe().grouser_height, scenario.terrain->describe().yields);
  }
  if (const double added = number_at(summary, "substeps_added"); added > 0.0)
    text += fmt::format(
        "furrow: hard contacts: the terrain took {:.0f} more substeps, in {:.2g} % of the time, of at least 1/{:.0f} "
        "of the step\n",
        added, 100.0 * number_at(summary, "substeps_refined_share"), number_at(summary, "substeps_most_parts"));
  text += subject_lines(summary, number_at(summary, "average_from_s"));
  text += end_lines(summary, scenario) + event_lines(summary);
  text += accounts_line(summary);
  text +=
      fmt::format("furrow: {:.1f} s for {:g} simulated s, {:.1f} s to prepare the bed{}", number_at(summary, "wall_s"),
                  number_at(summary, "simulated_s"), number_at(summary, "settle_wall_s"), ranks_text(summary));
  return text;
}

}  // namespace furrow::commands
