// The command line of `furrow`. Results for programs go to standard output, everything else to standard error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/supervisor.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

using scenario::Settings;

struct RunArguments {
  std::filesystem::path scenario;
  Settings settings;
  std::filesystem::path out;  // empty: a new folder under results/
  bool overwrite = false;
  bool profile = false;
  bool plots = true;         // at the end
  bool resume = false;       // continues the run in `out`; `scenario` is not used
  std::optional<int> seeds;  // number of beds; none: only the scenario's own
  std::optional<int> jobs;   // beds at once; none: 1
};

/// @throws Error
ExitCode run_command_line(int argc, char** argv);

/// `furrow run` or `furrow resume` as one rank of MPI (rank.cpp).
ExitCode run_as_rank(const RunArguments& arguments, int argc, char** argv);
/// Starts the ranks of a run in its folder and watches them (run.cpp). @pre require_launch, launch::catch_stop_signals
/// @throws Error
launch::LaunchResult supervise_ranks(const scenario::Scenario& scenario, launch::RunDirectory& directory,
                                     const RunArguments& arguments, launch::ProgressDisplay& display);
/// Checks whether this machine can start the ranks of a run. @throws Error with the obstacle
void require_launch(const scenario::Scenario& scenario);
/// `furrow run --seeds N` (seeds.cpp). @throws Error
ExitCode run_on_beds(const RunArguments& arguments);

/// Reports that a run has already finished. @param ended s
void tell_finished(const std::filesystem::path& run, double ended);

/// Checks whether this command line runs as a rank of MPI: run and resume do so if a launcher's variables are set. All
/// other commands ignore them.
bool runs_as_rank(int argc, char** argv);

/// Waits before a rank reports a failure. mpirun ends all ranks as soon as one has failed, even the rank that is about
/// to report the reason.
/// @returns false if nobody ended this rank meanwhile: then it should report too
bool first_rank_speaks();

/// Makes the plots and the page of a run (report.cpp). The results do not need them, so an error is only a warning.
/// @returns the files, none if something went wrong
std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run);
/// `furrow validate` of a vehicle's file (vehicle.cpp). @throws Error
ExitCode validate_vehicle(const std::string& name, bool json);
/// `furrow validate` of a calibration study (calibrate.cpp). @throws Error
ExitCode validate_calibration(const std::string& name, bool json);

/// The text that ends a run, from summary.json (result.cpp).
std::string result_text(const std::filesystem::path& run, const scenario::Scenario& scenario);

/// Compares a result with the scenario's expected one; empty if it expects nothing. The tolerance for means over `beds`
/// is smaller than that for one bed, by √beds.
std::string expected_text(const scenario::ExpectedResult& expected, int beds, double pull, double sinkage,
                          double rut_depth);

/// @throws Error(bad_input) naming the option
inline void require_option(bool ok, const char* option, const std::string& what) {
  if (!ok) throw input_error("command line", option, what);
}

/// "furrow: error: …", one line for every line of `text`.
void print_error(const std::string& text);
void print_warning(const std::string& text);
template <class First, class... More>
void print_warning(fmt::format_string<First, More...> text, First&& first, More&&... more) {
  print_warning(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...));
}
/// Prints the warnings of a refused scenario before the error.
void print_error(const Error& error);

}  // namespace furrow::commands
