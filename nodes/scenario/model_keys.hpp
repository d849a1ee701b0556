// Keys of the sections `terrain` and `rig` belong to the engines and the types that take them: what becomes of those of
// another one.
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

/// A section of the scenario in which one key chooses the model that takes the others.
struct ModelSection {
  const char* name;      // "terrain"
  const char* chooser;   // "engine"
  std::string standard;  // that is chosen where the key is missing
  /// The models that take a key of the section; empty for those that all share.
  std::vector<std::string> (*owners)(const std::string& key);
  /// Whether the model must not be asked for a key of others even with its default, as it cannot do what that says.
  bool (*denies)(std::string_view model, std::string_view key) = nullptr;
};
std::span<const ModelSection> model_sections();

/// Whether the dotted key chooses a model: "terrain.engine", "rig.type".
bool chooses_model(const std::string& key);

/// Removes the keys of other models than the document's own from its sections. A scenario that is written for one model
/// must not state those of another. They are set aside where the command line has chosen the model, and in completed
/// scenarios, which hold the key `completed_by`. Values that are the default do not count, unless the model cannot do
/// what they say.
/// @param settings of the command line. Returns a warning for each section of which something was set aside
/// @throws Error(bad_input) naming each key that is another model's, and whose
std::vector<std::string> set_aside_keys(nlohmann::json& document, const Schema& schema,
                                        const std::filesystem::path& file, const Settings& settings,
                                        std::span<const ModelSection> sections = model_sections());

/// Removes them from a completed scenario, whatever their values.
void remove_foreign_keys(nlohmann::json& document, std::span<const ModelSection> sections = model_sections());

}  // namespace furrow::scenario
