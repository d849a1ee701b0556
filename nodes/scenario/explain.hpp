// `furrow explain`: what a scenario key means.
#pragma once

#include <string>

namespace furrow::scenario {

/// Meaning, unit, range and default of a key; of a section, its keys; of an empty key, all keys.
/// @throws Error(bad_input) for an unknown key, with those that look like it
std::string explain(const std::string& key);

}  // namespace furrow::scenario
