// `furrow bench tire`: the tire's own time on hard ground, under the coupling rule of a run.
//
// The ground's forces act one step late. A carriage holds the driven wheel (rigs/rolling_tire.hpp), which turns at
// constant speed and rolls without pull.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "nodes/commands/command_table.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "rigs/rolling_tire.hpp"
#include "tire/tires.hpp"

namespace furrow::commands {
namespace {

struct TireBench {
  std::string tire = "default";  // tire file, or default: the layered tire
  double pressure = 200e3;       // gauge, Pa
  double load = 465.0;           // carried by the spindle, kg
  double speed = 8.56;           // of the rim's spin, rad/s
  double step = 4e-5;            // s
  double tolerance = 1e-4;       // of the free residual, relative to the norm of the pressure forces
  double renewal = 0.01;         // change of shape at which a sector of the factor is renewed
  int columns = 0, width = 0;    // elements around and across; 0: the file's
  int threads = 1;
  int steps = 0;      // timed; 0: one revolution
  double warm = 0.6;  // touch-down and transients before that, s
};
constexpr double kTouchdown = 20e3;      // N s/m, vertical damper of the carriage during the touch-down
constexpr double kTouchdownShare = 0.8;  // of the time before the timed steps

/// Processor time of a step, which does not depend on other programs.
double own_time() { return processor_time(CLOCK_THREAD_CPUTIME_ID); }

struct Spent {
  double wall = 0.0, processor = 0.0;  // s
};

void check(const TireBench& bench) {
  const auto require = [](bool ok, const char* key, const char* expected) {
    if (!ok) throw input_error("command line", key, std::string("expected ") + expected);
  };
  require(bench.threads >= 1 && bench.threads <= 1024, "--threads", "1 to 1024");
  require(bench.steps >= 0, "--steps", "0 (one revolution) or more");
  require(bench.warm >= 0.0, "--warm", "0 or more, s");
  require(bench.step > 0.0 && bench.step <= 1e-2, "--step", "a positive number, at most 0.01 s");
  require(bench.speed >= 0.0 && (bench.speed > 0.0 || bench.steps > 0), "--speed", "above 0 rad/s, or 0 and --steps");
  require(bench.pressure >= 0.0, "--pressure", "0 or more, Pa");
  require(bench.columns == 0 || (bench.columns >= 8 && bench.columns <= 2000), "--elements-circumference",
          "8 to 2000, or 0 for the file's");
  require(bench.width == 0 || (bench.width >= 6 && bench.width <= 400), "--elements-width",
          "6 to 400, or 0 for the file's");
  require(bench.load > 0.0, "--load", "a positive number, kg");
  require(bench.tolerance > 0.0 && bench.tolerance < 1.0, "--tolerance", "between 0 and 1");
  require(bench.renewal >= 0.0 && bench.renewal <= 10.0, "--renewal", "0 to 10");
}

/// Takes one step. @returns the tire's time in it
Spent step(rigs::RollingTire& rolling, double damper) {
  rolling.push();
  const double begin = wall_clock(), begin_processor = own_time();
  rolling.roll();
  const Spent spent{wall_clock() - begin, own_time() - begin_processor};
  rolling.follow(damper);
  return spent;
}

std::unique_ptr<tire::TireSpec> read_tire(const TireBench& bench) {
  tire::TireOptions options;
  options.file = bench.tire == "default" ? data_folder() / "tire" / "data" / "hmmwv_layered.json"
                                         : find_file(bench.tire, "--tire", "command line");
  options.pressure.knots = {{0.0, bench.pressure}};
  options.elements_circumference = bench.columns;
  options.elements_width = bench.width;
  return tire::read_tire(options);
}

/// Processor time of the tire's parts per step since `before`, and the rest of `total`, ms.
nlohmann::ordered_json parts(const tire::Tire& tire, const tire::NamedValues& before, long steps, double total) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  double rest = total;
  for (const tire::NamedValue& part : tire.times()) {
    const double spent = 1e3 * (part.value - before.of(part.name)) / static_cast<double>(steps);
    json[part.name] = spent;
    rest -= spent;
  }
  json["other"] = rest;
  return json;
}

/// The tire rolls freely on hard ground under a carriage. Times per step are those of the tire alone: wall time, and
/// processor time of the calling thread, also by parts. @param progress may throw
std::string bench_tire(const TireBench& bench, const ProgressCall& progress) {
  check(bench);
  const std::unique_ptr<tire::TireSpec> spec = read_tire(bench);
  const std::unique_ptr<tire::Tire> tire =
      spec->make({.threads = bench.threads, .tolerance = bench.tolerance, .renewal = bench.renewal});
  rigs::RollingTire rolling(*tire, {.load = bench.load, .spin = bench.speed, .step = bench.step});

  const auto warm = static_cast<long>(std::lround(bench.warm / bench.step));
  for (long n = 0; n < warm; ++n) {
    progress("touching down", static_cast<double>(n) / static_cast<double>(warm));
    step(rolling, static_cast<double>(n) < kTouchdownShare * static_cast<double>(warm) ? kTouchdown : 0.0);
  }

  const double turn = 2.0 * std::numbers::pi;
  const long steps =
      bench.steps > 0 ? bench.steps : std::lround(std::ceil(turn / (std::max(bench.speed, 1.0) * bench.step)));
  const tire::NamedValues times = tire->times(), start = tire->figures();
  std::vector<double> wall(steps), processor(steps);
  double load = 0.0, pull = 0.0, moment = 0.0, height = 0.0, worst = 0.0;
  for (long n = 0; n < steps; ++n) {
    progress("rolling", static_cast<double>(n) / static_cast<double>(steps));
    const Spent spent = step(rolling, 0.0);
    wall[n] = 1e3 * spent.wall, processor[n] = 1e3 * spent.processor;
    load += rolling.wrench().force.z() / static_cast<double>(steps);
    pull += rolling.wrench().force.x() / static_cast<double>(steps);
    moment += rolling.wrench().moment.y() / static_cast<double>(steps);
    height += rolling.height() / static_cast<double>(steps);
    worst = std::max(worst, tire->figures().of("residual"));
  }
  const tire::NamedValues end = tire->figures();
  const auto since = [&](const char* figure) { return end.of(figure) - start.of(figure); };
  const double total = std::accumulate(processor.begin(), processor.end(), 0.0) / static_cast<double>(steps),
               total_wall = std::accumulate(wall.begin(), wall.end(), 0.0) / static_cast<double>(steps);
  std::sort(wall.begin(), wall.end());
  std::sort(processor.begin(), processor.end());
  Hash hash;
  tire->add_state(hash);
  const nlohmann::ordered_json json = {
      {"ms_per_step", total_wall},
      {"median_ms", quantile(wall, 0.5)},
      {"p99_ms", quantile(wall, 0.99)},
      {"processor_ms_per_step", total},
      {"processor_median_ms", quantile(processor, 0.5)},
      {"processor_p99_ms", quantile(processor, 0.99)},
      {"parts_ms", parts(*tire, times, steps, total)},
      {"factorizations", static_cast<std::int64_t>(since("factorizations"))},
      {"factorizations_whole", since("factorizations_whole")},
      {"newton_iterations_mean", since("newton_iterations") / static_cast<double>(steps)},
      {"max_residual", worst},
      {"residual_tolerance", bench.tolerance},
      {"renewal", bench.renewal},
      {"deflection_m", tire->radius() - height},
      {"spindle_load_N", load},
      {"pull_N", pull},
      {"rolling_moment_Nm", moment},
      {"layers", static_cast<int>(spec->describe().model.of("layers"))},
      {"revolutions", static_cast<double>(steps) * bench.step * bench.speed / turn},
      {"coordinates", tire->coordinates()},
      {"step_s", bench.step},
      {"steps", steps},
      {"threads", bench.threads},
      {"state_hash", hash.hex()}};
  return json.dump(2) + "\n";
}

Action add_bench_tire_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<TireBench>();
  command.option_defaults()->always_capture_default();
  command.add_option("--tire", arguments->tire, "Read this tire file. 'default' is the layered tire.");
  command.add_option("--threads", arguments->threads, "Use this number of threads.");
  command.add_option("--steps", arguments->steps, "Time this number of steps; 0 means one revolution.");
  command.add_option("--step", arguments->step, "Set the time step, s.");
  command.add_option("--warm", arguments->warm,
                     "Roll for this time before the timed steps, so that the touch-down is over, s.");
  command.add_option("--pressure", arguments->pressure, "Set the inflation pressure (gauge), Pa.");
  command.add_option("--load", arguments->load, "Set the mass that the tire carries, kg.");
  command.add_option("--speed", arguments->speed, "Set the angular speed of the rim, rad/s.");
  command.add_option("--tolerance", arguments->tolerance,
                     "Set the tolerance of the free residual, relative to the norm of the pressure forces.");
  command.add_option(
      "--renewal", arguments->renewal,
      "Renew a sector's part of the factor once its shape has changed by this share; 0 renews it in every step.");
  command.add_option("--elements-circumference", arguments->columns,
                     "Set the number of elements around the tire; 0 keeps the file's.");
  command.add_option("--elements-width", arguments->width,
                     "Set the number of elements across the tire; 0 keeps the file's.");
  return [arguments] {
    return run_bench(arguments->threads,
                     [&](const ProgressCall& progress) { return bench_tire(*arguments, progress); });
  };
}

}  // namespace

Command bench_tire_entry() {
  return {.name = "bench tire",
          .task = nullptr,
          .purpose = "Time the parts of a step of a loaded tire that rolls on hard ground.",
          .options = add_bench_tire_options,
          .examples = {{"bench tire --tire hmmwv_lumped.json", "Time the steps of this tire."}}};
}

}  // namespace furrow::commands
