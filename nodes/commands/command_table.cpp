#include "nodes/commands/command_table.hpp"

namespace furrow::commands {

std::vector<Command> all_commands() {
  return {
      list_entry(),       new_entry(),                                               //
      run_entry(),        resume_entry(),                                            //
      validate_entry(),   ranks_entry(),        explain_entry(),    schema_entry(),  //
      bed_entry(),        soil_entry(),         press_entry(),      modes_entry(),   //
      kinematics_entry(),                                                            //
      sweep_entry(),      calibrate_entry(),    report_entry(),     events_entry(),  //
      bench_entry(),      bench_grains_entry(), bench_tire_entry(), bench_rig_entry(),
  };
}

}  // namespace furrow::commands
