// The commands of `furrow`. The source of each command contains its entry.
#pragma once

#include <vector>

#include "nodes/commands/command.hpp"

namespace furrow::commands {

Command list_entry();
Command new_entry();
Command run_entry();
Command resume_entry();
Command validate_entry();
Command ranks_entry();
Command explain_entry();
Command schema_entry();
Command bed_entry();
Command soil_entry();
Command press_entry();
Command modes_entry();
Command kinematics_entry();
Command sweep_entry();
Command calibrate_entry();
Command report_entry();
Command events_entry();
Command bench_entry();
Command bench_grains_entry();
Command bench_tire_entry();
Command bench_rig_entry();

std::vector<Command> all_commands();

}  // namespace furrow::commands
