// Launchers that nobody watches any more: their supervisor was killed and their ranks have ended, but they do not end
// themselves, as Open MPI 4.1's sometimes do not (end_watch.hpp). They would keep their run's folder forever.
#pragma once

#include <sys/types.h>

namespace furrow::launch {

/// Checks a process of this machine. False if the system gives no data, and for srun, whose ranks are not its children.
bool is_left_launcher(pid_t process);

}  // namespace furrow::launch
