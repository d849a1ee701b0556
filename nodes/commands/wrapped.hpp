// Text for people at the width of their terminal.
#pragma once

#include <cstddef>
#include <string>

namespace furrow::commands {

/// @returns the text with lines of at most `width` columns, broken between words. The rest of a line begins below its
/// second column, which two blanks or more separate from the first, or else below its first word.
std::string wrapped(const std::string& text, std::size_t width);

/// What print_text() does where standard output is no terminal.
enum class Piped {
  wrap,        // as on a terminal of 120 columns
  whole_lines  // every line as it is, so that grep finds an entry together with its name
};

/// Prints to standard output: on a terminal at its width, but at most 120 columns wide.
void print_text(const std::string& text, Piped piped);

}  // namespace furrow::commands
