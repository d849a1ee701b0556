// Text of foreign files and command lines as messages show it: nothing in it moves the cursor of a terminal.
#pragma once

#include <string>

namespace furrow {

/// The text with control characters, marks that turn the direction of writing, and bytes that are no UTF-8 written
/// out: \n, \x1b, \u202e.
std::string printable(const std::string& text);

/// As printable, and at most `most` bytes of it, with an ellipsis where there was more.
std::string excerpt(const std::string& text, std::size_t most = 60);

}  // namespace furrow
