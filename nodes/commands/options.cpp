#include "nodes/commands/options.hpp"

namespace furrow::commands {

void add_grain_bench(CLI::App& command, GrainBench& bench) {
  command
      .add_option("--bed", bench.bed,
                  "CSV x_m,y_m,z_m of centres of grains of 6 mm, x ≥ 0, y from 0 to 0.6, z ≥ 0; or default: "
                  "the reference bed")
      ->capture_default_str();
  command.add_option("--law", bench.law, "contact law: mindlin or hertz_tanh")->capture_default_str();
  command.add_option("--precision", bench.precision, "precision of the contact law: mixed or double")
      ->capture_default_str();
  command.add_option("--cohesion", bench.cohesion, "cohesion, Pa")->capture_default_str();
  command.add_option("--rolling-friction", bench.rolling_friction, "rolling resistance coefficient")
      ->capture_default_str();
  command.add_option("--threads", bench.threads, "threads")->capture_default_str();
  command.add_option("--steps", bench.steps, "timed steps")->capture_default_str();
  command.add_option("--warm", bench.warm, "untimed warm-up steps")->capture_default_str();
  command.add_option("--settle", bench.settle, "let the bed settle first, for at most this time, s")
      ->capture_default_str();
  command.add_option("--save-bed", bench.save, "write the positions before the timed steps to this CSV");
  command.add_option("--step", bench.step, "time step, s")->capture_default_str();
}

void add_tire_bench(CLI::App& command, TireBench& bench) {
  command.add_option("--tire", bench.tire, "tire file, or default: the layered tire")->capture_default_str();
  command.add_option("--threads", bench.threads, "threads")->capture_default_str();
  command.add_option("--steps", bench.steps, "timed steps; 0: one revolution")->capture_default_str();
  command.add_option("--step", bench.step, "time step, s")->capture_default_str();
  command.add_option("--warm", bench.warm, "untimed touch-down and transients, s")->capture_default_str();
  command.add_option("--pressure", bench.pressure, "inflation pressure, gauge, Pa")->capture_default_str();
  command.add_option("--load", bench.load, "mass that the tire carries, kg")->capture_default_str();
  command.add_option("--speed", bench.speed, "angular speed, rad/s")->capture_default_str();
  command
      .add_option("--tolerance", bench.tolerance,
                  "tolerance of the free residual, relative to the norm of the pressure forces")
      ->capture_default_str();
  command
      .add_option(
          "--renewal", bench.renewal,
          "relative change of a sector's shape at which its part of the factor is renewed; 0: every step")
      ->capture_default_str();
  command.add_option("--elements-circumference", bench.columns, "elements around; 0: the file's")
      ->capture_default_str();
  command.add_option("--elements-width", bench.width, "elements across; 0: the file's")
      ->capture_default_str();
}

void add_press_options(CLI::App& command, PressArguments& press) {
  command.add_option("--out", press.out,
                     "new folder for the results (default: results/<scenario>-press-NNN here)");
  command.add_flag("--overwrite", press.overwrite, "let --out replace the results of an earlier run");
  command.add_option("--on", press.obstacle, "obstacle: plate, cleat or profile")->capture_default_str();
  command.add_option("--deflection", press.deflection, "largest deflection, m")->capture_default_str();
  command.add_option("--points", press.points, "points of the load–deflection curve")->capture_default_str();
  command.add_option("--load", press.load, "load of the footprint, N")->capture_default_str();
  command.add_option("--cleat-height", press.cleat_height, "height of the cleat, m")->capture_default_str();
  command.add_option("--cleat-width", press.cleat_width, "width of the cleat's top along the travel, m")
      ->capture_default_str();
  command.add_option("--cleat-position", press.cleat_position, "middle of the cleat, forward of the axle, m")
      ->capture_default_str();
  command.add_option(
      "--profile", press.profile,
      "CSV x_m,z_m of the ground's profile seen from the axle, for --on profile (flexible ring, planar "
      "tire)");
}

void add_soil_options(CLI::App& command, SoilArguments& soil) {
  command.add_option("--out", soil.out,
                     "new folder for the results (default: results/<scenario>-soil-NNN here)");
  command.add_flag("--overwrite", soil.overwrite, "let --out replace the results of an earlier run");
  command.add_option("--seeds", soil.seeds, "beds per test, from run.seed on")->capture_default_str();
  command.add_option("--speed", soil.speed, "speed of plate, shear box and cone, m/s")->capture_default_str();
  command.add_option("--only", soil.only, "this test only: plate, shear, cone or repose; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option(
          "--stress", soil.stresses,
          "normal stress of a shear test, Pa; two or more, repeated (default: 20, 50 and 100 kPa, less "
          "for soft grains)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_flag("--quick", soil.quick,
                   "use small boxes and one seed: an impression within seconds, not a result to quote");
}

void add_slurm_options(CLI::App& command, bool& wanted, SlurmArguments& job) {
  CLI::Option* slurm = command.add_flag("--slurm", wanted,
                                        "print a batch script for sbatch: it saves the run before its time "
                                        "is over, and continues when it is queued again");
  const auto of_slurm = [&](CLI::Option* option) { option->needs(slurm); };
  of_slurm(command.add_option("--nodes", job.nodes, "nodes; the ranks are spread over them in their order")
               ->capture_default_str());
  of_slurm(command
               .add_option("--cores-per-node", job.cores_per_node,
                           "cores of each node (default: whole nodes, whatever they have)")
               ->check(CLI::PositiveNumber));
  of_slurm(command.add_option("--partition", job.partition, "partition (default: the cluster's)"));
  of_slurm(command.add_option(
      "--time", job.time,
      "time of one start of the job: minutes, hh:mm:ss or days-hh:mm:ss; a longer run takes "
      "several (default: the partition's)"));
  of_slurm(command.add_option("--account", job.account, "account that pays (default: your own)"));
  of_slurm(command.add_option(
      "--out", job.out,
      "new folder for the results (default: results/<scenario>-job<number> where you submit)"));
}

}  // namespace furrow::commands
