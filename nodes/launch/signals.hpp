// Signals that ask for a stop: TERM, INT, HUP and USR1 only raise a flag, which loops look at. So does Ctrl-Z where it
// must reach others too.
#pragma once

#include <vector>

namespace furrow::launch {

/// Ends the program with a message and the exit code of a stop when a stop signal comes, until catch_stop_signals() is
/// called; but for those that this process was started to ignore.
void end_on_stop_signals();

/// Counts stop signals from now on instead of dying of them, except those that this process was started to ignore; a
/// write to a closed pipe becomes an error.
void catch_stop_signals();
/// Whether this process does.
bool catches_stop_signals();
/// Ends this process without a word when USR1 comes, until catch_stop_signals() is called again: a launcher hands it on
/// to a rank that is being started only when the supervisor was killed. MPI may be stuck, and nothing has begun.
void end_on_loss_of_supervisor();

/// How many have come.
int stop_signals();
inline bool stop_signalled() { return stop_signals() > 0; }

/// Ctrl-Z raises a flag from now on, unless this process was started to ignore it: who started others stops them first.
void catch_pause();
/// Whether it came since this was last asked.
bool pause_asked();
/// Stops this process until it is continued. What it has stopped before, and the children of these, goes on if this
/// process ends meanwhile: nobody else would let it.
void pause_here(const std::vector<int>& stopped);

/// As a new program wants them, in a child between fork and exec.
void restore_signals();

/// This process ends with `signal` when its parent does; at once if the parent is not `parent` any more.
void die_with_parent(int signal, int parent);

}  // namespace furrow::launch
