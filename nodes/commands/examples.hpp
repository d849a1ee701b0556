// Examples of command lines, for the help of each command.
#pragma once

#include <string>
#include <string_view>

namespace furrow::commands {

/// @param command "run", "bench tire"; empty: the program itself
/// @returns what stands under "Examples:", a line each; empty where a command needs none
std::string examples_of(std::string_view command);

}  // namespace furrow::commands
