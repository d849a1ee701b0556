// Text of unknown files and command lines in a form for messages: nothing in it moves the cursor of a terminal.
#pragma once

#include <string>

namespace furrow {

/// The text with control characters, marks that change the direction of writing, and bytes that are not UTF-8 replaced
/// by escapes: \n, \x1b, \u202e.
std::string printable(const std::string& text);

/// Like printable(), but at most `most` bytes of it; an ellipsis replaces the rest.
std::string excerpt(const std::string& text, std::size_t most = 60);

}  // namespace furrow
