// Commands that are asked before anything runs, of calibration studies and keys.
#pragma once

#include <string>

#include "protocol/core/error.hpp"

namespace furrow::commands {

/// `furrow validate` of a calibration study (calibrate.cpp). @throws Error
ExitCode validate_calibration(const std::string& name, bool json);

/// `furrow explain` (explain.cpp). @param key empty: all keys of a scenario @throws Error
ExitCode explain_command(const std::string& key);

}  // namespace furrow::commands
