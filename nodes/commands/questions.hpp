// Commands that answer before anything runs.
#pragma once

#include <string>
#include <vector>

#include "nodes/commands/typed.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

/// `furrow validate` of a scenario, a vehicle or a calibration study (validate.cpp). @throws Error
ExitCode validate_command(Typed& typed);

/// `furrow ranks` (validate.cpp). @param command_line as it was typed @throws Error
ExitCode ranks_command(Typed& typed, const SlurmArguments& slurm, const std::vector<std::string>& command_line);

/// `furrow validate` of a calibration study (calibrate.cpp). @throws Error
ExitCode validate_calibration(const std::string& name, bool json);

/// `furrow explain` (explain.cpp). @param key empty: all keys of a scenario @throws Error
ExitCode explain_command(const std::string& key);

}  // namespace furrow::commands
