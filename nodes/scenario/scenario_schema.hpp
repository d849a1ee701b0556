// The schema of scenarios, made from the lists of keys of all their sections.
#pragma once

#include <nlohmann/json.hpp>

namespace furrow::scenario {

/// A JSON schema (draft 7). Besides, each key may have `unit`, `usual` (outside of it: a warning) and `entries` (what a
/// list holds).
nlohmann::ordered_json scenario_schema();

}  // namespace furrow::scenario
