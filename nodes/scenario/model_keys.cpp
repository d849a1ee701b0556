#include "nodes/scenario/model_keys.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/rigs.hpp"
#include "terrain/terrains.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

std::string chosen_model(const json& document, const ModelSection& of) {
  return document[of.name].value(of.chooser, of.standard);
}

/// Keys in the section that belong to other models only.
std::vector<std::string> foreign_keys(const json& document, const ModelSection& of) {
  std::vector<std::string> keys;
  if (!document.contains(of.name) || !document[of.name].is_object()) return keys;
  const std::string model = chosen_model(document, of);
  for (const auto& [key, value] : document[of.name].items()) {
    const std::vector<std::string> owners = of.owners(key);
    if (!owners.empty() && std::find(owners.begin(), owners.end(), model) == owners.end()) keys.push_back(key);
  }
  return keys;
}

void remove_foreign_keys(json& document, const ModelSection& of) {
  for (const std::string& key : foreign_keys(document, of)) document[of.name].erase(key);
}

std::string belongs_to_others(const json& document, const ModelSection& of, const std::vector<std::string>& keys,
                              const std::filesystem::path& file) {
  std::string text;
  for (const std::string& key : keys) {
    const Error one = input_error(file.string(), fmt::format("{}.{}", of.name, key),
                                  "is a key of {0} {1}, but {2}.{0} is '{3}', expected keys of that {0} alone",
                                  of.chooser, one_of(of.owners(key)), of.name, chosen_model(document, of));
    text += (text.empty() ? "" : "\n") + std::string(one.what());
  }
  return text;
}

}  // namespace

std::span<const ModelSection> model_sections() {
  static const auto sections = std::to_array<ModelSection>({
      {"terrain", "engine", terrain::CommonOptions().engine, terrain::engines_of_key, terrain::engine_denies},
      {"rig", "type", rigs::RigOptions().type, rigs::kinds_of_key},
  });
  return sections;
}

bool chooses_model(const std::string& key) {
  const auto sections = model_sections();
  return std::any_of(sections.begin(), sections.end(),
                     [&](const ModelSection& of) { return key == fmt::format("{}.{}", of.name, of.chooser); });
}

std::vector<std::string> set_aside_keys(json& document, const Schema& schema, const std::filesystem::path& file,
                                        const Settings& settings, std::span<const ModelSection> sections) {
  const bool completed = document.contains("completed_by");
  std::vector<std::string> warnings;
  for (const ModelSection& of : sections) {
    const std::string chooser = fmt::format("{}.{}", of.name, of.chooser);
    const bool chosen =
        std::any_of(settings.begin(), settings.end(), [&](const auto& setting) { return setting.first == chooser; });
    std::vector<std::string> stated;
    for (const std::string& key : foreign_keys(document, of)) {
      const json* node = schema.find(fmt::format("{}.{}", of.name, key));
      const bool denied = of.denies && of.denies(chosen_model(document, of), key);
      if (denied || !node || document[of.name][key] != node->value("default", json())) stated.push_back(key);
    }
    if (!stated.empty() && !chosen && !completed)
      throw Error(ExitCode::bad_input, belongs_to_others(document, of, stated, file));
    remove_foreign_keys(document, of);
    if (!stated.empty())
      warnings.emplace_back(input_error(file.string(), chooser, "is '{}'; keys of other {}s are ignored: {}",
                                        chosen_model(document, of), of.chooser, fmt::join(stated, ", "))
                                .what());
  }
  return warnings;
}

void remove_foreign_keys(json& document, std::span<const ModelSection> sections) {
  for (const ModelSection& of : sections) remove_foreign_keys(document, of);
}

}  // namespace furrow::scenario
