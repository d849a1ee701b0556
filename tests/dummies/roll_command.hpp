// Dummy of a command: `furrow roll` prints the angular speed of a freely rolling wheel, ω = v/R.
#pragma once

#include "nodes/commands/command.hpp"

namespace furrow::commands {

Command roll_entry();

}  // namespace furrow::commands
