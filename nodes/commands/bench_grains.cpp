// `furrow bench grains`: what the command line says, and the result as JSON.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/grain_bench.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::commands {
namespace {

void check(const GrainBench& bench) {
  const auto require = [](bool ok, const char* key, const std::string& expected) {
    if (!ok) throw input_error("command line", key, "expected " + expected);
  };
  bool known = false;
  terrain::dem::for_each_law([&](auto law) { known |= bench.law == law.kName; });
  require(known, "--law", terrain::dem::law_names());
  require(bench.precision == "mixed" || bench.precision == "double", "--precision", "mixed or double");
  require(bench.threads >= 1 && bench.threads <= 1024, "--threads", "1 to 1024");
  require(bench.steps >= 1, "--steps", "1 or more");
  require(bench.warm >= 0, "--warm", "0 or more");
  require(bench.cohesion >= 0.0, "--cohesion", "0 or more, Pa");
  require(bench.rolling_friction >= 0.0, "--rolling-friction", "0 or more");
  require(bench.step > 0.0 && bench.step < 1.0, "--step", "above 0 and below 1 s");
  require(bench.save.empty() || bench.save != bench.bed, "--save-bed", "another file than --bed");
  require(bench.settle >= 0.0, "--settle", "0 or more, s");
}

terrain::dem::DemOptions grain_options(const GrainBench& bench) {
  terrain::dem::DemOptions options;
  options.law = bench.law;
  options.cohesion = bench.cohesion;
  options.rolling_friction = bench.rolling_friction;
  options.precision = bench.precision;
  options.step = bench.step;
  options.threads = options.settle_threads = bench.threads;
  const terrain::dem::StableStep stable = terrain::dem::stable_at(options, terrain::dem::stated_overlap(options));
  if (bench.step > stable.step)
    throw input_error("command line", "--step",
                      fmt::format("is {:g} s, expected at most the stable step of {:.3g} s ({})", bench.step,
                                  stable.step, stable.reason));
  return options;
}

}  // namespace

std::string bench_grains(const GrainBench& bench, const ProgressCall& progress) {
  check(bench);
  const terrain::dem::GrainBenchResult r = terrain::dem::run_grain_bench(
      {grain_options(bench), bench.bed, bench.steps, bench.warm, bench.settle, bench.save}, progress);
  const double n = r.grains, contacts = static_cast<double>(r.contacts);
  const nlohmann::ordered_json json = {{"grain_steps_per_s", n * bench.steps / r.wall},
                                       {"ms_per_step", 1e3 * r.wall / bench.steps},
                                       {"ns_per_contact", 1e9 * r.wall / bench.steps / contacts},
                                       {"grains", r.grains},
                                       {"contacts", r.contacts},
                                       {"coordination", 2.0 * contacts / n},
                                       {"pairs_listed_per_grain", static_cast<double>(r.pairs_listed) / n},
                                       {"floor_force_N", r.floor_force},
                                       {"weight_N", r.weight},
                                       {"kinetic_energy_J", r.kinetic_energy},
                                       {"force_residual", r.force_residual},
                                       {"settled_s", r.settled},
                                       {"list_rebuilds", r.list_rebuilds},
                                       {"bytes_per_grain", r.bytes / n},
                                       {"steps", bench.steps},
                                       {"threads", bench.threads},
                                       {"law", bench.law},
                                       {"precision", bench.precision},
                                       {"cohesion_Pa", bench.cohesion},
                                       {"rolling_friction", bench.rolling_friction},
                                       {"state_hash", r.state_hash}};
  return json.dump(2) + "\n";
}

}  // namespace furrow::commands
