// A dummy of a command: `furrow roll` prints the angular speed of a wheel that rolls freely, ω = v/R.
#pragma once

#include "nodes/commands/command.hpp"

namespace furrow::commands {

Command roll_entry();

}  // namespace furrow::commands
