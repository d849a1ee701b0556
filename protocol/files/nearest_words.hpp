// Which known name was meant by one that is not known.
#pragma once

#include <string>
#include <vector>

namespace furrow {

/// Number of letters to insert, remove, replace or swap with their neighbour, whatever their case.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Of `known`, what looks like `word`: best first, at most three.
std::vector<std::string> nearest_words(const std::string& word, const std::vector<std::string>& known);

/// What to say of an unknown name: "is unknown, expected 'SIMILAR'?", or all known names where none is similar.
std::string unknown_text(const std::vector<std::string>& similar, const std::vector<std::string>& known);

}  // namespace furrow
