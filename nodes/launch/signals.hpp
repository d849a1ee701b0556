// Signals that ask for a stop: TERM, INT, HUP and USR1 only raise a flag, which loops look at.
#pragma once

namespace furrow::launch {

/// Counts stop signals from now on instead of dying of them, except those that this process was started to ignore; a
/// write to a closed pipe becomes an error.
void catch_stop_signals();
/// Whether this process does.
bool catches_stop_signals();

/// How many have come.
int stop_signals();
inline bool stop_signalled() { return stop_signals() > 0; }

/// As a new program wants them, in a child between fork and exec.
void restore_signals();

/// This process ends with `signal` when its parent does; at once if the parent is not `parent` any more.
void die_with_parent(int signal, int parent);

}  // namespace furrow::launch
