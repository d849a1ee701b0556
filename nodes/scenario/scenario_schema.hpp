// The schema of scenarios, made from the lists of keys of all their sections.
#pragma once

#include <nlohmann/json.hpp>

namespace furrow::scenario {

/// Returns a JSON schema (draft 7). In addition, each key may have `unit`, `usual` (a value outside causes a warning)
/// and `entries` (the content of a list).
nlohmann::ordered_json scenario_schema();

}  // namespace furrow::scenario
