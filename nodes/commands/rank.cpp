// One rank of `furrow run` or `furrow resume`, started by a supervisor or by the user's own mpirun or srun.
#include <unistd.h>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <new>
#include <string>

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "nodes/checkpoint/resume.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/held_folder.hpp"
#include "nodes/launch/limits.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/supervisor_lines.hpp"
#include "nodes/launch/thread_setup.hpp"
#include "nodes/ranks/run_node.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/runnable.hpp"
#include "protocol/abandon_mpi.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/files/hdf5_library.hpp"
#include "protocol/mpi_transport.hpp"

namespace furrow::commands {
namespace {

constexpr auto kTimeForNews = std::chrono::milliseconds(300);
constexpr std::chrono::milliseconds kTimeToSpeak(1500), kTick(50);

/// Reports to the supervisor, or to the user if there is none.
class RankReporter {
 public:
  RankReporter() : supervised_(std::getenv(launch::kSupervisedVariable) != nullptr), rank_(launched_rank()) {}

  bool supervised() const { return supervised_; }
  int rank() const { return rank_; }

  /// Reports a stage: begun, read, started, ended.
  void stage(launch::RankLine::Kind kind, ExitCode code = ExitCode::done) const {
    if (supervised_) send({kind, rank_, {}, code, {}});
  }
  /// Prepares messages for when memory or threads run out and nothing else can be printed.
  void prepare_last_words(void (&end_where)(const std::string&, int), const Error& words) const {
    if (supervised_)
      end_where(launch::encode({launch::RankLine::Kind::error, rank_, words.what(), words.code(), {}}), STDOUT_FILENO);
    else
      end_where(std::string("furrow: error: ") + words.what() + "\n", STDERR_FILENO);
  }
  void note(const std::string& text) {
    if (supervised_)
      send({launch::RankLine::Kind::note, rank_, text, ExitCode::done, {}});
    else
      display_.say("furrow: " + text);
  }
  void error(const Error& error) {
    if (supervised_) {
      send({launch::RankLine::Kind::error, rank_, error.what(), error.code(), {}});
      std::this_thread::sleep_for(kTimeForNews);  // mpirun may drop the last output of a rank that ends at once
      return;
    }
    display_.clear();
    if (error.code() == ExitCode::stopped)
      display_.say_error(std::string("furrow: ") + error.what());
    else
      print_error(error);
  }
  void show(const launch::Progress& progress) {
    if (supervised_)
      send({launch::RankLine::Kind::progress, rank_, {}, ExitCode::done, progress});
    else
      display_.show(progress);
  }
  void clear() { display_.clear(); }

 private:
  /// Uses one write, so that lines of several ranks do not mix.
  static void send(const launch::RankLine& line) {
    const std::string text = launch::encode(line);
    if (write(STDOUT_FILENO, text.data(), text.size()) < 0) return;  // nobody listens
  }
  bool supervised_;
  int rank_;
  launch::ProgressDisplay display_;
};

/// Every rank finds a mistake in the scenario; only the first on each machine reports it.
bool first_on_machine() {
  for (const char* variable : {"OMPI_COMM_WORLD_LOCAL_RANK", "MPI_LOCALRANKID", "SLURM_LOCALID"})
    if (const char* value = std::getenv(variable)) return std::atoi(value) == 0;
  return launched_rank() == 0;
}

/// True if a node before this one has the same failure and reports it. A supervisor gets all reports and prints one.
bool told_by_another(Transport& transport, const Error& error, bool supervised) {
  const Address self = transport.self();
  if (supervised || self == Address{Role::rig, 0}) return false;
  std::this_thread::sleep_for(kTimeForNews);
  try {
    transport.check_peers();
  } catch (const PeerFailure& peer) {
    const bool before = std::pair(peer.who().role, peer.who().index) < std::pair(self.role, self.index);
    return before && std::string(peer.what()) == error.what();
  } catch (const Error&) {
  }
  return false;
}

/// Refuses if another run has held the folder until now and continued from the same checkpoint.
void require_same_start(const std::filesystem::path& run, const checkpoint::ResumePoint& resume) {
  if (checkpoint::last_checkpoint(run).manifest.step != resume.manifest.step)
    throw input_error(run.string(), "", "was continued by another run until now, expected furrow resume once more");
}

/// The rig's rank creates the folder, unless a supervisor has, and sends its name to the others.
std::filesystem::path agree_on_directory(Transport& transport, const scenario::Scenario& scenario,
                                         const checkpoint::ResumePoint* resume, const RunArguments& arguments,
                                         const RankReporter& reporter, std::optional<launch::RunDirectory>& made) {
  if (reporter.supervised()) return arguments.out;
  const Address rig{Role::rig, 0};
  if (transport.self() != rig) return receive<RunFolder>(transport, rig).path;
  if (arguments.resume)
    made.emplace(arguments.out);
  else
    made.emplace(scenario.name, arguments.out, arguments.overwrite, arguments.scenario);
  made->lock().share();
  if (resume) require_same_start(arguments.out, *resume);
  const RunFolder folder{std::filesystem::absolute(made->path()).string()};
  for (int k = 0; k < transport.tire_count(); ++k) send(transport, Address{Role::tire, k}, folder);
  for (int k = 0; k < transport.terrain_ranks(); ++k) send(transport, Address{Role::terrain, k}, folder);
  return made->path();
}

/// @param held by ranks with a supervisor, from their start
ExitCode run_this_node(Transport& transport, const scenario::Scenario& scenario, const checkpoint::ResumePoint* resume,
                       const RunArguments& arguments, RankReporter& reporter, std::optional<launch::HeldFolder>& held) {
  std::optional<launch::RunDirectory> made;
  try {
    ranks::RunContext context;
    transport.set_peer_timeout(scenario.run.peer_timeout);
    try {
      context.directory = agree_on_directory(transport, scenario, resume, arguments, reporter, made);
      if (!held) held.emplace(context.directory);
      context.held = &*held;
    } catch (const PeerFailure&) {
      throw;
    } catch (const Error& error) {
      transport.announce_failure(error.code(), error.what());
      throw;
    }
    const launch::ThreadPlan plan = launch::plan_threads(transport, scenario.run.threads,
                                                         scenario.terrain->estimate(scenario.terrain_context()).grains);
    launch::apply(plan);
    if (!plan.note.empty()) reporter.note(plan.note);
    context.threads = plan.threads;
    if (!scenario.terrain->describe().core_per_rank) context.other_threads = plan.other;
    context.profile = arguments.profile;
    context.stop_requested = [] { return launch::stop_signalled(); };
    context.note = [&](const std::string& text) { reporter.note(text); };
    context.resume = resume;
    context.progress = [&](const launch::Progress& progress) { reporter.show(progress); };
    const ExitCode code = ranks::run_node(scenario, transport, context);
    reporter.clear();
    if (made && code == ExitCode::done) launch::say(result_text(made->path(), scenario));
    if (made) std::cout << made->path().string() << std::endl;
    return code;
  } catch (const PeerFailure& failure) {
    if (made && failure.code() == ExitCode::bad_input) made->discard();
    return failure.code();  // the failed rank has informed the user
  } catch (const Error& error) {
    if (made && error.code() == ExitCode::bad_input) made->discard();
    if (!told_by_another(transport, error, reporter.supervised())) reporter.error(error);
    if (error.code() == ExitCode::rank_lost) abandon_mpi(static_cast<int>(error.code()));
    return error.code();
  } catch (const std::bad_alloc&) {
    const Error error = scenario::out_of_memory(scenario.memory.all);
    reporter.error(error);
    return error.code();
  } catch (const std::exception& error) {
    reporter.error(fault_error(error.what()));
    return ExitCode::fault;
  }
}

struct Task {
  std::optional<scenario::Scenario> scenario;
  checkpoint::ResumePlan plan;
};

/// Reads the task; the terrain's machine must have the memory for it.
void read_task(const RunArguments& arguments, Task& task) try {
  if (arguments.resume) task.plan = checkpoint::plan_resume(arguments.out, arguments.settings);
  if (task.plan.finished) return;
  task.scenario =
      arguments.resume ? task.plan.scenario : scenario::load_scenario(arguments.scenario, arguments.settings);
  scenario::require_runnable(*task.scenario);
  if (launched_rank() > static_cast<int>(task.scenario->tires.size())) scenario::require_memory(*task.scenario);
} catch (const std::bad_alloc&) {
  throw scenario::out_of_memory();
}

}  // namespace

bool first_rank_speaks() {
  for (auto left = kTimeToSpeak; left > kTick; left -= kTick) {
    if (launch::stop_signalled()) return true;
    std::this_thread::sleep_for(kTick);
  }
  return launch::stop_signalled();
}

ExitCode run_as_rank(const RunArguments& arguments, int argc, char** argv) {
  launch::die_with_parent(SIGKILL, getppid());
  launch::catch_stop_signals();
  RankReporter reporter;
  if (reporter.supervised()) launch::end_on_loss_of_supervisor();
  if (!launch::supervisor_lives()) return ExitCode::stopped;  // killed before mpirun could pass the signal on
  reporter.stage(launch::RankLine::Kind::begun);
  hdf5::prepare();  // HDF5 opens itself on first use, and would crash if memory has run out by then
  Task task;
  std::optional<launch::HeldFolder> held;
  try {
    if (reporter.supervised()) held.emplace(arguments.out);
    read_task(arguments, task);
  } catch (const Error& error) {
    if (first_on_machine() || !first_rank_speaks()) reporter.error(error);
    return error.code();
  }
  if (task.plan.finished) {
    if (reporter.rank() == 0) tell_finished(arguments.out, task.plan.ended);
    return ExitCode::done;
  }
  const scenario::Scenario& scenario = *task.scenario;
  reporter.prepare_last_words(launch::end_where_memory_runs_out, scenario::out_of_memory(scenario.memory.all));
  if (!reporter.supervised() && reporter.rank() == 0)
    for (const auto* warnings : {&scenario.warnings, &std::as_const(task.plan).warnings})
      for (const std::string& warning : *warnings) print_warning(warning);
  reporter.stage(launch::RankLine::Kind::read);
  fault_point("start");
  std::unique_ptr<Transport> transport;
  try {
    transport = make_mpi_transport(&argc, &argv, static_cast<int>(scenario.tires.size()), scenario.terrain_ranks);
  } catch (const Error& error) {
    if (launched_rank() == 0) reporter.error(error);
    return error.code();
  }
  launch::catch_stop_signals();  // from now on state can be saved
  // Set after the session of MPI has begun: then its end is not waited for, and its failures are not mistaken for
  // these.
  reporter.prepare_last_words(launch::end_where_no_thread_starts, limit_error(launch::kNoThread));
  reporter.stage(launch::RankLine::Kind::started);
  const ExitCode code =
      run_this_node(*transport, scenario, arguments.resume ? &task.plan.point : nullptr, arguments, reporter, held);
  transport.reset();  // leaves MPI
  reporter.stage(launch::RankLine::Kind::ended, code);
  return code;
}

}  // namespace furrow::commands
