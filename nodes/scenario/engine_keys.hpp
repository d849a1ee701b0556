// Keys of the section `terrain` belong to the engines that take them: what becomes of those of another engine.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario/schema.hpp"

namespace furrow::scenario {

/// Removes the keys of other engines than the document's own from its section `terrain`. A scenario that is written
/// for one engine must not state those of another. They are set aside where the command line has chosen the engine,
/// and in completed scenarios of earlier versions, which hold every key. Values that are the default do not count.
/// @param settings of the command line. Returns a warning that lists what was set aside; empty if nothing was
/// @throws Error(bad_input) naming each key that is another engine's, and whose
std::string set_aside_keys(nlohmann::json& document, const Schema& schema, const std::filesystem::path& file,
                           const std::vector<std::pair<std::string, std::string>>& settings);

/// Removes them from a completed scenario, whatever their values.
void remove_keys_of_other_engines(nlohmann::json& document);

}  // namespace furrow::scenario
