// Signals that ask for a stop: TERM, INT, HUP and USR1 only raise a flag that loops check. Ctrl-Z also raises a flag if
// it must reach other processes.
#pragma once

#include <vector>

namespace furrow::launch {

/// Ends the program with a message and the exit code of a stop when a stop signal comes, until catch_stop_signals() is
/// called. Signals that this process was started to ignore stay ignored.
void end_on_stop_signals();

/// Ends the program with the exit code of its own faults, and a message, when it aborts: on a precondition that does
/// not hold, which FURROW_ASSERT has printed.
void end_on_abort();

/// Counts stop signals from now on instead of ending the program, except those that this process was started to ignore.
/// A write to a closed pipe becomes an error.
void catch_stop_signals();
bool catches_stop_signals();
/// Ends this process silently when USR1 comes, until catch_stop_signals() is called again. A launcher passes USR1 to a
/// rank that is starting only if the supervisor was killed. MPI may hang then, and nothing has begun.
void end_on_loss_of_supervisor();

int stop_signals();
inline bool stop_signalled() { return stop_signals() > 0; }

/// Lets Ctrl-Z raise a flag from now on, unless this process was started to ignore it: it must stop its children first.
void catch_pause();
/// Checks whether Ctrl-Z came since the last call.
bool pause_asked();
/// Stops this process until it is continued. If this process ends meanwhile, the processes `stopped` and their children
/// are continued, because nobody else would do so.
void pause_here(const std::vector<int>& stopped);

/// Restores the signals for a new program, in a child between fork and exec.
void restore_signals();

/// Ends this process with `signal` when its parent ends; at once if the parent is no longer `parent`.
void die_with_parent(int signal, int parent);

}  // namespace furrow::launch
