// `furrow explain`: the meaning of a scenario key.
#pragma once

#include <string>

namespace furrow::scenario {

/// Returns meaning, unit, range and default of a key, the keys of a section, or all keys for an empty key.
/// @throws Error(bad_input) for an unknown key, with similar ones
std::string explain(const std::string& key);

}  // namespace furrow::scenario
