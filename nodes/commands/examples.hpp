// What the help of each command ends with: examples of command lines, and the exit codes.
#pragma once

#include <string>
#include <string_view>

namespace furrow::commands {

/// @param command "run", "bench tire"; empty: the program itself
std::string closing_words(std::string_view command);

}  // namespace furrow::commands
