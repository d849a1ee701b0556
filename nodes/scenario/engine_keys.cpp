#include "nodes/scenario/engine_keys.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "terrain/terrains.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr const char* kSection = "terrain";

std::string engine_of(const json& section) {
  return section.value("engine", terrain::CommonOptions().engine);
}

/// Keys of the section that other engines take and its own does not.
std::vector<std::string> keys_of_others(const json& section) {
  const std::string engine = engine_of(section);
  std::vector<std::string> keys;
  for (const auto& [key, value] : section.items()) {
    const std::vector<std::string> engines = terrain::engines_of_key(key);
    if (!engines.empty() && std::find(engines.begin(), engines.end(), engine) == engines.end())
      keys.push_back(key);
  }
  return keys;
}

/// Completed scenarios of earlier versions hold the keys of all engines; nobody writes that by hand.
bool holds_every_key(const json& section, const Schema& schema) {
  const std::vector<std::string> keys = schema.keys(kSection);
  return std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
    return section.contains(key.substr(key.rfind('.') + 1));
  });
}

Error belongs_to_others(const json& section, const std::vector<std::string>& keys,
                        const std::filesystem::path& file) {
  const std::string engine = engine_of(section);
  std::string text;
  for (const std::string& key : keys) {
    const Error one = input_error(
        file.string(), fmt::format("{}.{}", kSection, key),
        fmt::format("is a key of engine '{}', but {}.engine is '{}', expected keys of that engine alone",
                    fmt::join(terrain::engines_of_key(key), "', '"), kSection, engine));
    text += (text.empty() ? "" : "\n") + std::string(one.what());
  }
  return Error(ExitCode::bad_input, text);
}

}  // namespace

std::string set_aside_keys(json& document, const Schema& schema, const std::filesystem::path& file,
                           const std::vector<std::pair<std::string, std::string>>& settings) {
  if (!document.contains(kSection)) return {};
  json& section = document[kSection];
  const bool chosen = std::any_of(settings.begin(), settings.end(), [](const auto& setting) {
    return setting.first == std::string(kSection) + ".engine";
  });
  const bool may_be_set_aside = chosen || holds_every_key(section, schema);
  std::vector<std::string> stated;
  for (const std::string& key : keys_of_others(section)) {
    const json* node = schema.find(fmt::format("{}.{}", kSection, key));
    if (!node || section[key] != node->value("default", json())) stated.push_back(key);
  }
  if (!stated.empty() && !may_be_set_aside) throw belongs_to_others(section, stated, file);
  remove_keys_of_other_engines(document);
  if (stated.empty()) return {};
  return input_error(file.string(), std::string(kSection) + ".engine",
                     fmt::format("is '{}'; keys of other engines are set aside: {}", engine_of(section),
                                 fmt::join(stated, ", ")))
      .what();
}

void remove_keys_of_other_engines(json& document) {
  const auto section = document.find(kSection);
  if (section == document.end() || !section->is_object()) return;
  for (const std::string& key : keys_of_others(*section)) section->erase(key);
}

}  // namespace furrow::scenario
