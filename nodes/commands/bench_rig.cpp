// `furrow bench rig`: a short run of a scenario by its ranks, without frames and checkpoints, in a temporary folder.
//
// The times are those of its profile (nodes/output/profile.hpp), of the steps after the touch-down. The rig exchanges
// messages with every rank in every step, so its steps are those of the run.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/commands/bench.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/output/profile.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/json_number.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/temporary_folder.hpp"

namespace furrow::commands {
namespace {

using Json = nlohmann::ordered_json;
using checkpoint::number_at, checkpoint::value_at;

struct RigBench {
  std::string scenario = "drawbar_pull.json";
  int steps = 2000;   // timed
  double warm = 0.2;  // simulated before that, s
};
constexpr int kFewestRecorded = 20;  // of the timed steps

/// Times of a step in one rank, s.
struct Recorded {
  double begin = 0.0, exchange = 0.0, advance = 0.0;
};
using Steps = std::map<std::int64_t, Recorded>;

/// The recorded steps from `first` on, by ranks.
std::map<std::string, Steps> read_profile(const std::filesystem::path& file, std::int64_t first) {
  constexpr double kMicrosecond = 1e-6;
  std::map<int, std::string> names;
  std::map<std::string, Steps> ranks;
  for (const Json& event : read_json_if_whole(file).value("traceEvents", Json::array())) {
    const int rank = event["pid"];
    if (event["ph"] == "M") {
      names[rank] = event["args"]["name"];
    } else if (const std::int64_t step = event["args"]["step"]; step >= first) {
      Recorded& recorded = ranks[names[rank]][step];
      const double time = kMicrosecond * event["dur"].get<double>();
      if (event["name"] == "synchronize")
        recorded.begin = kMicrosecond * event["ts"].get<double>(), recorded.exchange = time;
      else
        recorded.advance = time;
    }
  }
  return ranks;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The longest advance of any rank whose name begins like this, of each recorded step, ms.
std::vector<double> slowest(const std::map<std::string, Steps>& ranks, const std::vector<std::string>& names) {
  std::map<std::int64_t, double> longest;
  for (const auto& [name, steps] : ranks)
    if (std::ranges::any_of(names, [&](const std::string& start) { return name.starts_with(start); }))
      for (const auto& [step, recorded] : steps) longest[step] = std::max(longest[step], 1e3 * recorded.advance);
  std::vector<double> times;
  for (const auto& [step, time] : longest) times.push_back(time);
  return times;
}

Json times_json(const std::map<std::string, Steps>& ranks, double step) {
  const Steps& rig = ranks.at("rig");
  const auto first = rig.begin(), last = std::prev(rig.end());
  const double each = (last->second.begin - first->second.begin) / static_cast<double>(last->first - first->first);
  std::vector<double> whole;
  for (const auto& [number, recorded] : rig) whole.push_back(1e3 * (recorded.exchange + recorded.advance));
  std::ranges::sort(whole);
  Json json = {{"s_per_simulated_s", each / step},
               {"ms_per_step", 1e3 * each},
               {"median_ms", quantile(whole, 0.5)},
               {"p99_ms", quantile(whole, 0.99)},
               {"tire_ms", mean(slowest(ranks, {"tire"}))},
               {"terrain_ms", mean(slowest(ranks, {"terrain"}))},
               {"slower_of_both_ms", mean(slowest(ranks, {"tire", "terrain"}))}};
  for (const auto& [name, steps] : ranks) {
    double exchange = 0.0, all = 0.0;
    for (const auto& [number, recorded] : steps)
      exchange += recorded.exchange, all += recorded.exchange + recorded.advance;
    json["waiting_share"][name] = exchange / all;
  }
  json["steps_recorded"] = rig.size();
  return json;
}

std::int64_t steps_before(const RigBench& bench, double step) { return std::llround(bench.warm / step); }

void check(const RigBench& bench, double step) {
  const std::int64_t before = steps_before(bench, step);
  const std::int64_t fewest = kFewestRecorded * output::recorded_every(before + bench.steps);
  require_option(bench.steps >= fewest, "--steps",
                 fmt::format("is {}, expected {} or more after {} steps before them", bench.steps, fewest, before));
}

/// The scenario, ended after the timed steps. @throws Error(bad_input)
RunArguments short_run(const RigBench& bench, const Typed& typed) {
  require_option(bench.steps >= 1, "--steps", "expected 1 or more");
  require_option(bench.warm >= 0.0 && bench.warm <= 1e3, "--warm", "expected 0 to 1000 s");
  RunArguments arguments;
  arguments.scenario = bench.scenario;
  arguments.settings = settings_of(typed);
  arguments.profile = true;
  const double step = scenario::load_scenario(arguments.scenario, arguments.settings).run.step;
  check(bench, step);
  const auto before = static_cast<double>(steps_before(bench, step));
  for (const auto& [key, value] : {std::pair{"run.end", number_text((before + bench.steps) * step)},
                                   {"run.average_from", number_text(before * step)},
                                   {"output.frame_interval", std::string("0")},
                                   {"checkpoint.interval", std::string("0")},
                                   {"checkpoint.at_end", std::string("false")}})
    arguments.settings.emplace_back(key, value);
  return arguments;
}

std::string bench_rig(const RigBench& bench, const RunArguments& arguments, launch::ProgressDisplay& display) {
  const scenario::Scenario scenario = scenario::load_scenario(arguments.scenario, arguments.settings);
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  require_launch(scenario);
  const TemporaryFolder folder;
  launch::RunDirectory directory(scenario.name, folder.path() / "run", false, arguments.scenario);
  const launch::LaunchResult result = supervise_ranks(scenario, directory, arguments, display);
  if (result.code != ExitCode::done) throw Error(result.code, result.error);
  const std::map<std::string, Steps> ranks =
      read_profile(directory.path() / "profile.json", steps_before(bench, scenario.run.step));
  const Json summary = checkpoint::read_summary(directory.path());
  if (!ranks.contains("rig") || ranks.at("rig").size() < 2)
    throw input_error(arguments.scenario.string(), "", "ended after {} s, expected a run of {} s",
                      number_text(number_at(summary, "end_time_s")), number_text(scenario.run.end));
  Json json = times_json(ranks, scenario.run.step);
  json["grains"] = summary["grains"];
  json["awake_share"] = json_number(number_at(summary, "wheels.0.columns.active_share"));
  json["refined_share"] = summary["substeps_refined_share"];
  json["bed_s"] = summary["settle_wall_s"];
  json["tires"] = scenario.tires.size();
  json["tire_coordinates"] = summary["wheels"][0]["tire_coordinates"];
  json["step_s"] = scenario.run.step;
  json["steps"] = bench.steps;
  json["warm_s"] = bench.warm;
  json["threads"] = summary["ranks"].back()["threads"];
  json["scenario"] = scenario.name;
  json["scenario_digest"] = scenario.digest;
  json["state_hash"] = summary["state_hash"];
  return json.dump(2) + "\n";
}

Action add_bench_rig_options(CLI::App& command, Typed& typed) {
  const auto arguments = std::make_shared<RigBench>();
  command.option_defaults()->always_capture_default();
  command.add_option("--scenario", arguments->scenario, "Run this scenario file (JSON), as given or in rigs/.");
  command.add_option("--steps", arguments->steps, "Time this number of steps.");
  command.add_option("--warm", arguments->warm,
                     "Run for this simulated time before the timed steps, so that the wheel rolls, s.");
  command.option_defaults()->always_capture_default(false);
  add_settings(command, typed);
  return [arguments, &typed] {
    const RunArguments run = short_run(*arguments, typed);
    return run_bench(1, [&](launch::ProgressDisplay& display) { return bench_rig(*arguments, run, display); });
  };
}

}  // namespace

Command bench_rig_entry() {
  return {.name = "bench rig",
          .task = nullptr,
          .purpose = "Time the steps of a scenario's ranks: rig, tires and terrain.",
          .options = add_bench_rig_options,
          .examples = {{"bench rig", "Time the reference rig at full size, 379,147 grains."},
                       {"bench rig --scenario first_look.json --steps 1000", "Time another scenario."}}};
}

}  // namespace furrow::commands
