// furrow: the program. Every error ends here, as one message and the exit code that users script against.
#include <csignal>
#include <exception>
#include <iostream>
#include <string>

#include "nodes/commands/commands.hpp"
#include "nodes/launch/thread_setup.hpp"
#include "protocol/mpi_transport.hpp"

int main(int argc, char** argv) {
  // Threads that spin while they wait make a short bed slow as soon as the machine has something else to do.
  const std::string command = argc > 1 ? argv[1] : "";
  const bool settles = command == "bed" || command == "sweep";
  if (settles || furrow::launched_by_mpi()) furrow::launch::wait_passively(argv);
  // A file that outgrows the limit of file sizes is told; a rank is lost of it, and its supervisor tells that.
  if (!furrow::launched_by_mpi()) std::signal(SIGXFSZ, SIG_IGN);
  furrow::ExitCode code = furrow::ExitCode::done;
  try {
    code = furrow::commands::run_command_line(argc, argv);
    if (!std::cout.flush())
      throw furrow::io_error("standard output", "cannot be written, expected room for the result");
  } catch (const furrow::Error& error) {
    if (!furrow::launched_by_mpi() || furrow::launched_rank() == 0)
      furrow::commands::print_error(error.what());
    else
      furrow::commands::let_first_rank_speak();
    code = error.code();
  } catch (const std::exception& error) {
    furrow::commands::print_error(std::string("unexpected: ") + error.what());
    code = furrow::ExitCode::physics;
  }
  return static_cast<int>(code);
}
