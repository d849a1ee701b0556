// Common parts of the files of all tire models.
#pragma once

#include "protocol/files/json_reader.hpp"

namespace furrow::tire {

/// Checks the version of a tire file's layout and takes the keys that every model's file may have: `model`, `rim`,
/// `name`, `source` and `$schema`. The model reads its own keys and then calls finish().
/// @throws Error(bad_input) naming file and key
void take_common_keys(JsonReader& reader);

}  // namespace furrow::tire
