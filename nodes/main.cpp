// furrow: the program. Every error ends here with one message and the exit code that scripts rely on.
#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "nodes/commands/commands.hpp"
#include "nodes/launch/limits.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/thread_setup.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "protocol/mpi_transport.hpp"

namespace {

int fail(const furrow::Error& error, bool as_rank) {
  const bool first = !as_rank || furrow::launched_rank() == 0;
  if (first || !furrow::commands::first_rank_speaks()) furrow::commands::print_error(error);
  return static_cast<int>(error.code());
}

}  // namespace

int main(int argc, char** argv) {
  furrow::launch::occupy_closed_streams();
  const bool as_rank = furrow::commands::runs_as_rank(argc, argv);
  // Without the signal, a file that exceeds the limit of file sizes is reported as an error. A rank is killed by the
  // signal, and its supervisor reports that.
  if (!as_rank) std::signal(SIGXFSZ, SIG_IGN);
  // A daemon may pass SIGCHLD on as ignored; then the exit codes of children are lost.
  std::signal(SIGCHLD, SIG_DFL);
  if (!as_rank) furrow::launch::end_on_stop_signals();
  if (!as_rank) furrow::launch::end_on_abort();  // mpirun passes on how a rank ended
  try {
    furrow::launch::end_where_memory_runs_out(furrow::launch::kOutOfMemory);
    if (!as_rank)  // a rank reports its errors after MPI has begun, whose failures have the same status
      furrow::launch::end_where_no_thread_starts(std::string("furrow: error: ") + furrow::launch::kNoThread + "\n");
    furrow::launch::require_stack(argv);
    // Threads that spin while they wait slow down a short bed as soon as the machine does other work.
    const std::string command = argc > 1 ? argv[1] : "";
    if (command == "bed" || command == "sweep" || as_rank) furrow::launch::wait_passively(argv);
    if (!as_rank) furrow::launch::end_where_processor_time_runs_out();  // the program must not restart after this
    const furrow::ExitCode code = furrow::commands::run_command_line(argc, argv);
    if (!std::cout.flush() && !furrow::launch::reader_is_gone())
      throw furrow::io_error("standard output", "cannot be written, expected room for the result");
    return static_cast<int>(code);
  } catch (const furrow::Error& error) {
    return fail(error, as_rank);
  } catch (const std::bad_alloc&) {
    return fail(furrow::scenario::out_of_memory(), as_rank);
  } catch (const std::exception& error) {
    return fail(furrow::fault_error(error.what()), as_rank);
  }
}
