// `furrow bench grains`: its command line, and the result as JSON.
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "nodes/commands/command_table.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/grain_bench.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::commands {
namespace {

struct GrainBench {
  std::string bed = "default";      // CSV of positions (x_m,y_m,z_m), or default: the reference bed, from the cache
  std::string law = "mindlin";      // mindlin | hertz_tanh
  std::string precision = "mixed";  // mixed | double
  std::string device = "cpu";       // cpu | gpu
  double cohesion = 0.0;            // Pa
  double rolling_friction = 0.0;    // -
  double step = 4e-5;               // s
  int threads = 1;
  int steps = 1000;
  int warm = 100;       // steps before the timed ones
  double settle = 0.0;  // longest settling before that, s
  std::string save;     // CSV that receives the positions before the timed steps; empty: none
};

void check(const GrainBench& bench) {
  const auto require = [](bool ok, const char* key, const std::string& expected) {
    if (!ok) throw input_error("command line", key, "expected " + expected);
  };
  bool known = false;
  terrain::dem::for_each_law([&](auto law) { known |= bench.law == law.kName; });
  require(known, "--law", terrain::dem::law_names());
  require(bench.precision == "mixed" || bench.precision == "double", "--precision", "mixed or double");
  require(bench.device == "cpu" || bench.device == "gpu", "--device", "cpu or gpu");
  require(bench.device == "cpu" || bench.precision == "mixed", "--precision", "mixed with --device gpu");
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
  options.device = bench.device;
  options.step = bench.step;
  options.threads = options.settle_threads = bench.threads;
  const terrain::dem::StableStep stable = terrain::dem::stable_at(options, terrain::dem::stated_overlap(options));
  if (bench.step > stable.step)
    throw input_error("command line", "--step", "is {:g} s, expected at most the stable step of {:.3g} s ({})",
                      bench.step, stable.step, stable.reason);
  return options;
}

/// Integrates every grain and evaluates every contact in every step. @param progress may throw
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
                                       {"device", r.device},
                                       {"driver", r.driver},
                                       {"law", bench.law},
                                       {"precision", bench.precision},
                                       {"cohesion_Pa", bench.cohesion},
                                       {"rolling_friction", bench.rolling_friction},
                                       {"state_hash", r.state_hash}};
  return json.dump(2) + "\n";
}

Action add_bench_grains_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<GrainBench>();
  command.option_defaults()->always_capture_default();
  command.add_option(
      "--bed", arguments->bed,
      "Read the bed from this CSV file: columns x_m,y_m,z_m, centres of grains of radius 6 mm, x ≥ 0, y from 0 to "
      "0.6 and z ≥ 0. 'default' is the reference bed.");
  command.add_option("--law", arguments->law, "Choose the contact law: " + terrain::dem::law_names() + ".");
  command.add_option("--precision", arguments->precision, "Choose the precision of the contact law: mixed or double.");
  command.add_option("--device", arguments->device, "Step the grains on this device: cpu or gpu.");
  command.add_option("--cohesion", arguments->cohesion, "Set the cohesion of the contacts, Pa.");
  command.add_option("--rolling-friction", arguments->rolling_friction, "Set the coefficient of rolling resistance.");
  command.add_option("--threads", arguments->threads, "Use this number of threads.");
  command.add_option("--steps", arguments->steps, "Time this number of steps.");
  command.add_option("--warm", arguments->warm, "Take this number of steps before the timed ones.");
  command.add_option("--settle", arguments->settle, "Let the bed settle first, for at most this time, s.");
  command.add_option("--save-bed", arguments->save, "Write the positions before the timed steps to this CSV file.");
  command.add_option("--step", arguments->step, "Set the time step, s.");
  return [arguments] {
    return run_bench(arguments->threads,
                     [&](const ProgressCall& progress) { return bench_grains(*arguments, progress); });
  };
}

}  // namespace

Command bench_grains_entry() {
  return {.name = "bench grains",
          .task = nullptr,
          .purpose = "Time the steps of a settled bed, with every grain integrated in every step.",
          .options = add_bench_grains_options,
          .examples = {
              {"bench grains --cohesion 5000 --threads 2", "Time the reference bed with cohesion, on two cores."}}};
}

}  // namespace furrow::commands
