// Limits that the system sets to processes (ulimit), and what to say when one was reached. Memory is in
// protocol/files/memory_limit.hpp.
#pragma once

#include <string>

namespace furrow::launch {

/// Stack that the program needs, bytes; a shell gives 8 MB.
inline constexpr long kStack = 1 << 20;
/// Open files that the launcher of a few ranks needs; a shell gives 1024.
inline constexpr long kFiles = 64;

/// A smaller stack is made larger where the system allows it, for which the program starts again: threads take theirs
/// from what the limit was in the beginning. @throws Error(limit) where it does not
void require_stack(char** argv);

/// @throws Error(limit) when mpirun could not open the files and pipes that it needs
void require_files(std::size_t ranks);

/// What ended a process that died of `signal`, beside its name; empty: nothing is known. `processor_time`: that it and
/// its like have used, s. @param certain  whether a limit was the cause
std::string cause_of(int signal, double processor_time, bool& certain);

/// That the folder in which mpirun and its ranks keep their temporary files is all but full; empty: it is not.
std::string little_room();

/// Processor time of all children that have ended and theirs, s.
double processor_time_of_children();

/// Whether nobody reads standard output any more, as in `furrow soil SCENARIO | head`.
bool reader_is_gone();

/// The line that the program ends with where memory runs out in a place from which no exception can leave, such as a
/// parallel region: to `descriptor`, with exit code 6. It is kept ready, since nothing can be made then.
void end_where_memory_runs_out(const std::string& line, int descriptor = 2);
inline constexpr const char* kOutOfMemory = "furrow: error: out of memory\n";

/// Likewise a line of its own where the limit of processor time is reached, of which a second is kept for that.
void end_where_processor_time_runs_out();

/// Likewise the line where OpenMP can start no thread, for which it ends the program by exit(1), a code that is none of
/// ours. Said before whatever asked for the program's end until now, such as a session of MPI, is ended: that would
/// wait for the other ranks.
void end_where_no_thread_starts(const std::string& line, int descriptor = 2);
inline constexpr const char* kNoThread =
    "threads could not be started (ulimit -u, ulimit -v, or no memory), expected a higher limit or fewer --threads";

}  // namespace furrow::launch
