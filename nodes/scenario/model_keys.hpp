// Keys of the sections `terrain` and `rig` belong to certain engines and types: how keys of another one are treated.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario/scenario.hpp"
#include "nodes/scenario/schema.hpp"

namespace furrow::scenario {

/// A section of the scenario in which one key chooses the model that uses the others.
struct ModelSection {
  const char* name;      // "terrain"
  const char* chooser;   // "engine"
  std::string standard;  // the model if the key is missing
  /// The models that have a key of the section; empty for keys that all share.
  std::vector<std::string> (*owners)(const std::string& key);
  /// Checks whether a model refuses a key of others even with its default, because it cannot do what the default asks.
  bool (*denies)(std::string_view model, std::string_view key) = nullptr;
};
std::span<const ModelSection> model_sections();

/// Checks whether the dotted key chooses a model: "terrain.engine", "rig.type".
bool chooses_model(const std::string& key);

/// Removes the keys of other models from the sections of the document. A scenario for one model must not state keys of
/// another. They are only set aside if the command line has chosen the model, and in completed scenarios, which have
/// the key `completed_by`. Default values do not count, unless the model cannot do what they ask.
/// @param settings of the command line. Returns a warning for each section with keys set aside
/// @throws Error(bad_input) naming each key of another model, and that model
std::vector<std::string> set_aside_keys(nlohmann::json& document, const Schema& schema,
                                        const std::filesystem::path& file, const Settings& settings,
                                        std::span<const ModelSection> sections = model_sections());

/// Removes keys of other models from a completed scenario, whatever their values.
void remove_foreign_keys(nlohmann::json& document, std::span<const ModelSection> sections = model_sections());

}  // namespace furrow::scenario
