// Launchers that nobody watches any more: their supervisor was killed, their ranks have ended, and they do not end
// themselves, as Open MPI 4.1's at times does not (end_watch.hpp). They would keep the folder of their run for ever.
#pragma once

#include <sys/types.h>

namespace furrow::launch {

/// Of a process of this machine. False where the system does not tell, and of srun, whose ranks are not its children.
bool is_left_launcher(pid_t process);

}  // namespace furrow::launch
