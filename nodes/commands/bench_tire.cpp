// `furrow bench tire`: the tire's own time on hard ground, under the coupling rule of a run.
//
// The ground answers one step late; the carriage m is free along x and z, so that the driven wheel, which turns at
// constant speed, rolls without pull.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>

#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "tire/ancf/ancf_tire.hpp"
#include "tire/reach.hpp"
#include "tire/read_tire_file.hpp"

namespace furrow::commands {
namespace {
constexpr double kGap = 1e-3;            // m, between ground and undeformed tire at the start
constexpr double kTouchdown = 20e3;      // N s/m, vertical damper of the carriage during the touch-down
constexpr double kTouchdownShare = 0.8;  // of the time before the timed steps
constexpr double kGroundStep = 4e-5;     // s, up to which the default ground is stable under a tread vertex
constexpr double kFriction = 0.9, kVelocityScale = 50.0;  // -, s/m: the ground of rigs/rigid_ground.json

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of this thread: what a step costs whoever else uses the machine.
double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

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
  require(bench.speed >= 0.0 && (bench.speed > 0.0 || bench.steps > 0), "--speed",
          "above 0 rad/s, or 0 and --steps");
  require(bench.pressure >= 0.0, "--pressure", "0 or more, Pa");
  require(bench.columns == 0 || (bench.columns >= 8 && bench.columns <= 2000), "--elements-circumference",
          "8 to 2000, or 0 for the file's");
  require(bench.width == 0 || (bench.width >= 6 && bench.width <= 400), "--elements-width",
          "6 to 400, or 0 for the file's");
  require(bench.load > 0.0, "--load", "a positive number, kg");
  require(bench.tolerance > 0.0 && bench.tolerance < 1.0, "--tolerance", "between 0 and 1");
  require(bench.renewal >= 0.0 && bench.renewal <= 10.0, "--renewal", "0 to 10");
}

/// A tire under a carriage on the plane z = 0.
class RollingTire {
 public:
  RollingTire(tire::AncfTire& tire, const TireBench& bench) : tire_(tire), bench_(bench) {
    terrain::TerrainOptions options;
    options.engine = "rigid";
    // Forces come one step late: the ground is softened with the step (terrain/rigid/rigid_ground.hpp).
    const double slower = std::max(1.0, bench.step / kGroundStep);
    options.ground_stiffness /= slower * slower;
    options.ground_shear_stiffness /= slower * slower;
    options.ground_damping /= slower;
    options.friction = kFriction;
    options.friction_velocity_scale = kVelocityScale;
    ground_ = terrain::make_rigid_ground(options);
    rim_.position = Vec3(0.0, 0.0, tire::inflated_reach(tire, 0.0) + kGap);
    rim_.velocity = Vec3(bench.speed * tire.radius(), 0.0, 0.0);
    rim_.angular_velocity = Vec3(0.0, bench.speed, 0.0);
    trajectory_ = tire::RimTrajectory(rim_);
    tire.place(rim_);
    tire.surface(surface_);
    ground_->attach(tire.mesh(), tire.material(), surface_);
  }

  /// @returns what the tire took
  Spent step(double damper) {
    const NodalForces forces = forces_;  // the ground's of the last step
    const Outcome pushed = ground_->advance({&surface_, 1}, bench_.step, 1, {&forces_, 1}, {&contact_, 1});
    if (!pushed.ok) throw physics_error(pushed, "ground");
    trajectory_.extend(rim_, bench_.step);
    const double begin = now(), begin_processor = processor_time();
    const Outcome moved = tire_.advance(trajectory_, forces, 1);
    tire_.surface(surface_);
    const Spent spent{now() - begin, processor_time() - begin_processor};
    if (!moved.ok) throw physics_error(moved, "tire");
    move_carriage(damper);
    return spent;
  }

  const Wrench& wrench() const { return wrench_; }
  double height() const { return rim_.position.z(); }

 private:
  void move_carriage(double damper) {
    const double h = bench_.step;
    const Vec3 before = wrench_.force;  // as known to the carriage, one step late
    wrench_ = tire_.spindle_wrench();
    rim_.velocity.x() += h * before.x() / bench_.load;
    rim_.velocity.z() += h * ((before.z() - damper * rim_.velocity.z()) / bench_.load - kStandardGravity);
    rim_.position += h * rim_.velocity;
    rim_.orientation =
        (Quat(Eigen::AngleAxisd(h * bench_.speed, Vec3::UnitY())) * rim_.orientation).normalized();
  }

  tire::AncfTire& tire_;
  const TireBench& bench_;
  std::unique_ptr<terrain::Terrain> ground_;
  RimState rim_;
  tire::RimTrajectory trajectory_;
  SurfaceState surface_;
  NodalForces forces_;
  ContactSums contact_;
  Wrench wrench_;
};

int most_layers(const tire::TireFile& file) {
  return static_cast<int>(
      std::max({file.bead.layers.size(), file.sidewall.layers.size(), file.tread.layers.size()}));
}

/// Value below which the share `p` of the sorted values lies.
double quantile(const std::vector<double>& sorted, double p) {
  FURROW_ASSERT(!sorted.empty() && std::is_sorted(sorted.begin(), sorted.end()), sorted.size());
  FURROW_ASSERT(p >= 0.0 && p <= 1.0, p);
  return sorted[std::min(sorted.size() - 1,
                         static_cast<std::size_t>(p * static_cast<double>(sorted.size())))];
}

}  // namespace

std::string bench_tire(const TireBench& bench, const ProgressCall& progress) {
  check(bench);
  const std::string path = bench.tire == "default"
                               ? (data_folder() / "tire" / "data" / "hmmwv_layered.json").string()
                               : bench.tire;
  tire::TireFile file = tire::read_tire_file(path);
  file.pressure = bench.pressure;
  if (bench.columns > 0) file.elements_circumference = bench.columns;
  if (bench.width > 0) tire::set_elements_width(file, bench.width);
  tire::ShellIntegratorParams params;
  params.tolerance = bench.tolerance;
  params.age = bench.renewal;
  params.threads = bench.threads;
  tire::AncfTire tire(file, params);
  RollingTire rolling(tire, bench);

  const auto warm = static_cast<long>(std::lround(bench.warm / bench.step));
  for (long n = 0; n < warm; ++n) {
    progress("touching down", static_cast<double>(n) / static_cast<double>(warm));
    rolling.step(static_cast<double>(n) < kTouchdownShare * static_cast<double>(warm) ? kTouchdown : 0.0);
  }

  const double turn = 2.0 * std::numbers::pi;
  const long steps = bench.steps > 0
                         ? bench.steps
                         : std::lround(std::ceil(turn / (std::max(bench.speed, 1.0) * bench.step)));
  const tire::ShellIntegrator::Times before = tire.integrator().times();
  const tire::TireDiagnostics start = tire.diagnostics();
  const double work = tire.integrator().factor_work();
  std::vector<double> wall(steps), processor(steps);
  double load = 0.0, pull = 0.0, moment = 0.0, height = 0.0, worst = 0.0;
  for (long n = 0; n < steps; ++n) {
    progress("rolling", static_cast<double>(n) / static_cast<double>(steps));
    const Spent spent = rolling.step(0.0);
    wall[n] = 1e3 * spent.wall, processor[n] = 1e3 * spent.processor;
    load += rolling.wrench().force.z() / static_cast<double>(steps);
    pull += rolling.wrench().force.x() / static_cast<double>(steps);
    moment += rolling.wrench().moment.y() / static_cast<double>(steps);
    height += rolling.height() / static_cast<double>(steps);
    worst = std::max(worst, tire.integrator().residual());
  }
  const tire::TireDiagnostics end = tire.diagnostics();
  const tire::ShellIntegrator::Times& t = tire.integrator().times();
  const double per_step = 1e3 / static_cast<double>(steps);
  const double force = per_step * (t.force - before.force),
               jacobian = per_step * (t.jacobian - before.jacobian),
               factorize = per_step * (t.factorize - before.factorize),
               solve = per_step * (t.solve - before.solve);
  const double total = std::accumulate(processor.begin(), processor.end(), 0.0) / static_cast<double>(steps),
               total_wall = std::accumulate(wall.begin(), wall.end(), 0.0) / static_cast<double>(steps);
  std::sort(wall.begin(), wall.end());
  std::sort(processor.begin(), processor.end());
  Hash hash;
  hash.add(std::span<const double>(tire.integrator().q()));
  hash.add(std::span<const double>(tire.integrator().v()));
  const nlohmann::ordered_json json = {
      {"ms_per_step", total_wall},
      {"median_ms", quantile(wall, 0.5)},
      {"p99_ms", quantile(wall, 0.99)},
      {"processor_ms_per_step", total},
      {"processor_median_ms", quantile(processor, 0.5)},
      {"processor_p99_ms", quantile(processor, 0.99)},
      {"parts_ms",
       {{"force", force},
        {"jacobian", jacobian},
        {"factorize", factorize},
        {"solve", solve},
        {"other", total - force - jacobian - factorize - solve}}},
      {"factorizations", end.factorizations - start.factorizations},
      {"factorizations_whole", tire.integrator().factor_work() - work},
      {"newton_iterations_mean",
       static_cast<double>(end.newton_iterations - start.newton_iterations) / static_cast<double>(steps)},
      {"max_residual", worst},
      {"residual_tolerance", bench.tolerance},
      {"renewal", bench.renewal},
      {"deflection_m", tire.radius() - height},
      {"spindle_load_N", load},
      {"pull_N", pull},
      {"rolling_moment_Nm", moment},
      {"layers", most_layers(file)},
      {"revolutions", static_cast<double>(steps) * bench.step * bench.speed / turn},
      {"coordinates", tire.coordinates()},
      {"step_s", bench.step},
      {"steps", steps},
      {"threads", bench.threads},
      {"state_hash", hash.hex()}};
  return json.dump(2) + "\n";
}

}  // namespace furrow::commands
