// The command line of `furrow`. Results for machines go to standard output, everything else to standard
// error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/commands/arguments.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

using Settings = std::vector<std::pair<std::string, std::string>>;  // --set key=value

struct RunArguments {
  std::filesystem::path scenario;
  Settings settings;
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  bool profile = false;
  bool plots = true;    // at the end
  bool resume = false;  // continues the run in `out`; `scenario` is not used
  int seeds = 0;        // beds; 0: the scenario's own alone
  int jobs = 1;         // beds at once
};

/// Everything that `furrow` does. @throws Error
ExitCode run_command_line(int argc, char** argv);

/// `furrow run` outside MPI (run.cpp) and as one of its ranks (rank.cpp).
ExitCode run_supervised(const RunArguments& arguments);
/// @throws Error with what can be said against starting the ranks of a run on this machine
void require_launch(const scenario::Scenario& scenario);
/// `furrow run --seeds N` (seeds.cpp). @throws Error
ExitCode run_on_beds(const RunArguments& arguments);
/// `furrow resume` outside MPI.
ExitCode resume_supervised(const RunArguments& arguments);
ExitCode run_as_rank(const RunArguments& arguments, int argc, char** argv);

/// Whether this command line runs as a rank of MPI: run and resume do where a launcher's variables are set. All other
/// commands ignore them.
bool runs_as_rank(int argc, char** argv);

/// mpirun ends all ranks as soon as one has failed, even the one that is about to say why: the others wait here.
/// @returns false when nobody ended this rank meanwhile: then it should say it, too
bool first_rank_speaks();

/// `furrow ranks --slurm`: a batch script (slurm.cpp). @throws Error(bad_input)
std::string slurm_script(const scenario::Scenario& scenario, const SlurmArguments& job, const Settings& settings);

struct ReportArguments {
  std::vector<std::filesystem::path> runs;  // one: its plots and page; several: a page that compares them
  std::filesystem::path out = {};           // folder of what is made; empty: that of the run
  bool unasked = false;                     // by another command: no messages, and no longer than a minute
};

/// As typed.
struct ReportRequest {
  std::string run;                  // folder
  std::vector<std::string> others;  // folders of runs, on one page with it
  std::filesystem::path out;        // empty: the run's folder
  std::string soil, vtk;            // soil.json to add the theory of; folder for VTP files; empty: none
};

/// `furrow report` (report.cpp). @throws Error
ExitCode report_command(const ReportRequest& asked);

/// Plots and page of a run, or the page of several. @returns none if the
/// script said why. @throws Error
std::vector<std::filesystem::path> make_report(const ReportArguments& report);
/// The same after a command whose results stand without plots: what goes wrong is a warning.
std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run);
/// `furrow report --vtk`: writes the frames of a run as VTP files into a new folder, and prints the names of the lists
/// of these files (report.cpp). @returns how it ended; the script has said what was wrong. @throws Error
ExitCode write_vtk(const std::filesystem::path& run, const std::filesystem::path& folder);

struct EventsArguments {
  std::filesystem::path directory;
  std::optional<double> from, to;  // window of the means, s
  bool json = false;
};

/// `furrow events` (events.cpp). @throws Error
ExitCode events_command(const EventsArguments& arguments);

struct SweepArguments {
  std::filesystem::path study;
  std::filesystem::path out;  // empty: results/<study>
  int jobs = 1;
};

/// `furrow sweep` (sweep.cpp). @throws Error
ExitCode sweep_command(const SweepArguments& arguments);

struct CalibrateArguments {
  std::filesystem::path study;
  std::filesystem::path out;  // empty: results/<study>
  bool overwrite = false;
  bool plots = true;
};

/// `furrow calibrate` (calibrate.cpp). @throws Error
ExitCode calibrate_command(const CalibrateArguments& arguments);

/// `furrow soil` (soil.cpp). @throws Error
ExitCode soil_command(const scenario::Scenario& scenario, const SoilArguments& arguments);

/// `furrow press` (press.cpp). @throws Error
ExitCode press_command(const scenario::Scenario& scenario, const PressArguments& arguments);

/// `furrow modes` (modes.cpp). @throws Error
ExitCode modes_command(const ModesArguments& arguments);

struct KinematicsArguments {
  std::string vehicle;
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  bool plots = true;
  bool csv = false, json = false;  // printed, in place of a folder
  double travel = 0.0;             // up and down, m; 0: a fifth of the smallest tire's radius
  int points = 21;                 // of each motion
};

/// `furrow kc` (vehicle.cpp). @throws Error
ExitCode kinematics_command(const KinematicsArguments& arguments);
/// `furrow validate` of a vehicle's file (vehicle.cpp). @throws Error
ExitCode validate_vehicle(const std::string& name, bool json);

/// `furrow schema` (schema.cpp). @param kind of files @throws Error(bad_input)
ExitCode schema_command(const std::string& kind);

/// `furrow list` (catalogue.cpp). @param only a kind, or empty: all @throws Error
ExitCode list_command(const std::string& only, bool json);

struct NewArguments {
  std::filesystem::path name;
  std::string tire, soil, vehicle;  // files; empty: see scenario::StarterOptions
  bool rigid = false;
  std::optional<double> load;  // of the wheel, N
};

/// `furrow new` (catalogue.cpp). @throws Error
ExitCode new_command(const NewArguments& arguments);

/// `furrow bed` (bed.cpp). @throws Error
ExitCode bed_command(const scenario::Scenario& scenario);

/// The text that ends a run, from summary.json (result.cpp).
std::string result_text(const std::filesystem::path& run, const scenario::Scenario& scenario);

/// Whether a result is what the scenario is known to give; empty where it says nothing. Means over `beds` are expected
/// closer to it than those of one bed, by √beds.
std::string expected_text(const scenario::ExpectedResult& expected, int beds, double pull, double sinkage,
                          double rut_depth);

/// "furrow: error: …", one line for every line of `text`.
void print_error(const std::string& text);
void print_warning(const std::string& text);
/// Before it, what looks odd about the scenario that is refused with it.
void print_error(const Error& error);

}  // namespace furrow::commands
