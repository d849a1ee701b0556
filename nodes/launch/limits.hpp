// Limits that the system sets for processes (ulimit), and messages when one is reached. Memory is in
// protocol/files/memory_limit.hpp.
#pragma once

#include <string>

namespace furrow::launch {

/// Stack that the program needs, bytes; a shell gives 8 MB.
inline constexpr long kStack = 1 << 20;
/// Open files that the launcher of a few ranks needs; a shell gives 1024.
inline constexpr long kFiles = 64;

/// Enlarges a smaller stack if the system allows it. The program then starts again, because threads take their stack
/// size from the limit at the start. @throws Error(limit) if the system does not allow it
void require_stack(char** argv);

/// @throws Error(limit) if mpirun could not open the files and pipes that it needs
void require_files(std::size_t ranks);

/// Returns the cause of a process's end by `signal`, in addition to the signal's name; empty if unknown.
/// @param processor_time that the process and its siblings used, s @param certain set if a limit was the cause
std::string cause_of(int signal, double processor_time, bool& certain);

/// Reports that the folder for temporary files of mpirun and its ranks is almost full; empty if it is not.
std::string little_room();

/// Processor time of all children that have ended, and of their children, s.
double processor_time_of_children();

/// Checks whether the reader of standard output is gone, as in `furrow soil SCENARIO | head`.
bool reader_is_gone();

/// Sets the line that the program prints to `descriptor` before it ends with exit code 6, when memory runs out in a
/// place that no exception can leave, such as a parallel region. The line is kept ready, because it could not be made
/// then.
void end_where_memory_runs_out(const std::string& line, int descriptor = 2);
inline constexpr const char* kOutOfMemory = "furrow: error: out of memory\n";

/// Does the same, with a line of its own, for the limit of processor time; one second of it is kept for the line.
void end_where_processor_time_runs_out();

/// Does the same when OpenMP cannot start a thread and therefore calls exit(1), which is not one of our codes. The line
/// is printed before functions that were registered earlier run, such as the end of an MPI session, which would wait
/// for the other ranks.
void end_where_no_thread_starts(const std::string& line, int descriptor = 2);
inline constexpr const char* kNoThread =
    "threads could not be started (ulimit -u, ulimit -v, or no memory), expected a higher limit or fewer --threads";

}  // namespace furrow::launch
