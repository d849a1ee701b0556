#include "nodes/commands/options.hpp"

#include <cmath>
#include <cstdlib>

#include "protocol/files/printable.hpp"
#include "terrain/dem/contact/laws.hpp"

namespace furrow::commands {

CLI::Validator above_zero() {
  const auto problem = [](const std::string& text) -> std::string {
    const double value = std::strtod(text.c_str(), nullptr);
    return std::isfinite(value) && value > 0.0 ? "" : "is " + excerpt(text) + ", expected a number above 0";
  };
  return {problem, "POSITIVE"};
}

CLI::Option* add_folder_options(CLI::App& command, std::filesystem::path& out, bool& overwrite,
                                const std::string& usual) {
  CLI::Option* option =
      command.add_option("--out", out, "Write the results to this new folder (default: results/" + usual + ").");
  command.add_flag("--overwrite", overwrite, "Replace the results of an earlier run in the folder of --out.");
  return option;
}

void add_grain_bench(CLI::App& command, GrainBench& bench) {
  command
      .add_option("--bed", bench.bed,
                  "Read the bed from this CSV file: columns x_m,y_m,z_m, centres of grains of 6 mm, x ≥ 0, "
                  "y from 0 to 0.6 and z ≥ 0. 'default' is the reference bed.")
      ->capture_default_str();
  command.add_option("--law", bench.law, "Choose the contact law: " + terrain::dem::law_names() + ".")
      ->capture_default_str();
  command.add_option("--precision", bench.precision, "Choose the precision of the contact law: mixed or double.")
      ->capture_default_str();
  command.add_option("--cohesion", bench.cohesion, "Set the cohesion of the contacts, Pa.")->capture_default_str();
  command.add_option("--rolling-friction", bench.rolling_friction, "Set the coefficient of rolling resistance.")
      ->capture_default_str();
  command.add_option("--threads", bench.threads, "Use this number of threads.")->capture_default_str();
  command.add_option("--steps", bench.steps, "Time this number of steps.")->capture_default_str();
  command.add_option("--warm", bench.warm, "Take this number of steps before the timed ones.")->capture_default_str();
  command.add_option("--settle", bench.settle, "Let the bed settle first, for at most this time, s.")
      ->capture_default_str();
  command.add_option("--save-bed", bench.save, "Write the positions before the timed steps to this CSV file.");
  command.add_option("--step", bench.step, "Set the time step, s.")->capture_default_str();
}

void add_tire_bench(CLI::App& command, TireBench& bench) {
  command.add_option("--tire", bench.tire, "Read this tire file. 'default' is the layered tire.")
      ->capture_default_str();
  command.add_option("--threads", bench.threads, "Use this number of threads.")->capture_default_str();
  command.add_option("--steps", bench.steps, "Time this number of steps; 0 means one revolution.")
      ->capture_default_str();
  command.add_option("--step", bench.step, "Set the time step, s.")->capture_default_str();
  command
      .add_option("--warm", bench.warm, "Roll for this time before the timed steps, so that the touch-down is over, s.")
      ->capture_default_str();
  command.add_option("--pressure", bench.pressure, "Set the inflation pressure (gauge), Pa.")->capture_default_str();
  command.add_option("--load", bench.load, "Set the mass that the tire carries, kg.")->capture_default_str();
  command.add_option("--speed", bench.speed, "Set the angular speed of the rim, rad/s.")->capture_default_str();
  command
      .add_option("--tolerance", bench.tolerance,
                  "Set the tolerance of the free residual, relative to the norm of the pressure forces.")
      ->capture_default_str();
  command
      .add_option("--renewal", bench.renewal,
                  "Renew a sector's part of the factor once its shape has changed by this share; 0 renews it "
                  "in every step.")
      ->capture_default_str();
  command
      .add_option("--elements-circumference", bench.columns,
                  "Set the number of elements around the tire; 0 keeps the file's.")
      ->capture_default_str();
  command
      .add_option("--elements-width", bench.width, "Set the number of elements across the tire; 0 keeps the file's.")
      ->capture_default_str();
}

void add_press_options(CLI::App& command, PressArguments& press) {
  add_folder_options(command, press.out, press.overwrite, "<scenario>-press-NNN");
  command.add_option("--on", press.on, "Choose the obstacle: plate, cleat or profile (press.on).");
  command.add_option("--deflection", press.deflection, "Press up to this deflection, m (press.deflection).");
  command.add_option("--points", press.points,
                     "Compute this number of points of the load–deflection curve (press.points).");
  command.add_option("--load", press.load, "Compute the footprint at this load, N (press.load).");
  command.add_option("--camber", press.camber,
                     "Tilt the wheel about its forward axis, rad; positive leans the top to the right of "
                     "travel. Shell tires only (press.camber).");
  command.add_option("--cleat-height", press.cleat_height, "Set the height of the cleat, m (press.cleat_height).");
  command.add_option("--cleat-width", press.cleat_width,
                     "Set the width of the cleat's top along the direction of travel, m (press.cleat_width).");
  command.add_option("--cleat-position", press.cleat_position,
                     "Set the position of the cleat's middle, forward of the axle, m (press.cleat_position).");
  command.add_option(
      "--profile", press.profile,
      "Read the ground's profile, seen from the axle, from this CSV file with columns x_m,z_m. It needs --on "
      "profile and a flexible ring or planar tire.");
}

void add_modes_options(CLI::App& command, ModesArguments& modes) {
  command.add_option("TIRE", modes.tire, "Read this tire file (JSON), as given or in tire/data/.")->required();
  CLI::Option* out = add_folder_options(command, modes.out, modes.overwrite, "<tire>-modes-NNN");
  command.add_option("--orders", modes.orders,
                     "Compute circumferential orders from 0 to this one (default: 8, or half of the elements around).");
  command.add_option(
      "--count", modes.count,
      "Compute this number of frequencies of each order (default: 3, or all that a section of the tire has).");
  command.add_option("--pressure", modes.pressure, "Set the inflation pressure (gauge), Pa (default: the file's).");
  command.add_option("--elements-circumference", modes.around,
                     "Set the number of elements around the tire (default: the file's).");
  command.add_option("--elements-width", modes.across,
                     "Set the number of elements across the tire (default: the file's).");
  command.add_flag_callback(
      "--no-plots", [&modes] { modes.plots = false; }, "Make no plots; 'furrow report' makes them later.");
  CLI::Option* csv =
      command.add_flag("--csv", modes.csv, "Print the frequencies as CSV and make no folder.")->excludes(out);
  command.add_flag("--json", modes.json, "Print the frequencies as JSON and make no folder.")
      ->excludes(out)
      ->excludes(csv);
}

void add_soil_options(CLI::App& command, SoilArguments& soil) {
  add_folder_options(command, soil.out, soil.overwrite, "<scenario>-soil-NNN");
  command.add_option("--seeds", soil.seeds, "Repeat each test on this number of beds, with run.seed, run.seed + 1, …")
      ->capture_default_str();
  command.add_option("--speed", soil.speed, "Move plate, shear box and cone at this speed, m/s.")
      ->capture_default_str();
  command
      .add_option("--only", soil.only, "Run this test only: plate, shear, cone or repose. The option may be repeated.")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--stress", soil.stresses,
                  "Shear under this normal stress, Pa. Repeat the option: two stresses or more are needed "
                  "(default: 20, "
                  "50 and 100 kPa, less for soft grains).")
      ->take_all()
      ->allow_extra_args(false);
  command.add_flag("--quick", soil.quick,
                   "Use small boxes and one seed, for an impression within seconds. Do not quote its results.");
}

void add_slurm_options(CLI::App& command, bool& wanted, SlurmArguments& job) {
  CLI::Option* slurm = command.add_flag("--slurm", wanted,
                                        "Print a batch script for sbatch. It saves the run before its time "
                                        "is over, and continues when it is queued again.");
  const auto of_slurm = [&](CLI::Option* option) { option->needs(slurm); };
  of_slurm(
      command.add_option("--nodes", job.nodes, "Use this number of nodes; the ranks are spread over them in order.")
          ->capture_default_str());
  of_slurm(command
               .add_option("--cores-per-node", job.cores_per_node,
                           "Use this number of cores on each node (default: all of them).")
               ->check(above_zero()));
  of_slurm(command.add_option("--partition", job.partition, "Submit to this partition (default: the cluster's)."));
  of_slurm(command.add_option("--time", job.time,
                              "Limit one start of the job to this time, in minutes, as hh:mm:ss or as "
                              "days-hh:mm:ss. A longer run takes "
                              "several starts (default: the partition's limit)."));
  of_slurm(command.add_option("--account", job.account, "Charge the job to this account (default: your own)."));
  of_slurm(command.add_option(
      "--out", job.out,
      "Write the results to this new folder (default: results/<scenario>-job<number> where you submit)."));
}

}  // namespace furrow::commands
