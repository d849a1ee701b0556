// Text for users at the width of their terminal.
#pragma once

#include <cstddef>
#include <string>

namespace furrow::commands {

/// @returns the text with lines of at most `width` columns, broken between words. The rest of a line begins below its
/// second column, which two or more blanks separate from the first, or otherwise below its first word.
std::string wrapped(const std::string& text, std::size_t width);

/// Behaviour of print_text() if standard output is not a terminal.
enum class Piped {
  wrap,        // as on a terminal of 120 columns
  whole_lines  // every line unchanged, so that grep finds an entry with its name
};

/// Prints to standard output: at the terminal's width, but at most 120 columns wide.
void print_text(const std::string& text, Piped piped);

}  // namespace furrow::commands
