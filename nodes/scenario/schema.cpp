#include "nodes/scenario/schema.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "nodes/scenario/scenario_schema.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr double kMaxWhole = 9007199254740992.0;  // 2^53
constexpr std::size_t kMaxProblems = 20;          // reported at once

std::string joined(const std::string& path, const std::string& name) { return path.empty() ? name : path + "." + name; }

bool is_whole(double value) { return value == std::round(value) && std::abs(value) <= kMaxWhole; }

/// Limits numbers beyond 64-bit integers: valijson converts them if a multiple is required, which is undefined. No
/// bound of a schema is as large.
json within_int64(json value) {
  constexpr double kMost = 9e18;
  if (value.is_structured()) {
    for (json& inner : value) inner = within_int64(std::move(inner));
  } else if (value.is_number_float() && !(std::abs(value.get<double>()) <= kMost)) {
    value = std::copysign(kMost, value.get<double>());
  }
  return value;
}

/// Converts valijson's words for a place, {"<root>", "[tires]", "[0]"}, to the parts of a key.
std::vector<std::string> key_parts(const std::vector<std::string>& context) {
  std::vector<std::string> parts;
  for (const std::string& entry : context)
    if (entry.size() > 2 && entry.front() == '[') parts.push_back(entry.substr(1, entry.size() - 2));
  return parts;
}

}  // namespace

const Schema& Schema::of_scenarios() {
  static const Schema schema(scenario_schema());
  return schema;
}

const json& Schema::resolved(const json& node) const {
  if (!node.contains("$ref")) return node;
  return root_.at(json::json_pointer(node["$ref"].get<std::string>().substr(1)));
}

const json* Schema::member(const json& node, const std::string& name) const {
  if (node.contains("properties") && node["properties"].contains(name)) return &resolved(node["properties"][name]);
  const bool index =
      !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
  return index && node.contains("items") ? &resolved(node["items"]) : nullptr;
}

const json* Schema::find(const std::string& key) const {
  const json* node = &root_;
  for (std::size_t from = 0; node && from <= key.size();) {
    const std::size_t to = std::min(key.find('.', from), key.size());
    node = member(*node, key.substr(from, to - from));
    from = to + 1;
  }
  return node;
}

void Schema::describe(const json& node, const json& value, const std::string& path, std::vector<Problem>& out) const {
  if (const std::string what = mistake(node, value); !what.empty()) return out.push_back({path, what});
  if (!value.is_object()) return;
  for (const auto& [name, unused] : value.items()) {
    if (member(node, name)) continue;
    if (out.size() >= kMaxProblems) return;
    const std::string key = joined(path, name);
    std::vector<std::string> known;
    for (const auto& [known_name, known_node] : node["properties"].items()) known.push_back(known_name);
    out.push_back({key, unknown_text(nearest(key), known)});
  }
  if (node.contains("required"))
    for (const json& name : node["required"])
      if (!value.contains(name)) {
        const json& missing = *member(node, name);
        out.push_back({joined(path, name), fmt::format("is missing, expected {}: {}", expectation(missing),
                                                       missing.value("description", std::string()))});
      }
}

std::vector<Problem> Schema::problems(const json& document) const {
  valijson::Schema compiled;
  const valijson::adapters::NlohmannJsonAdapter schema_adapter(root_);
  valijson::SchemaParser().populateSchema(schema_adapter, compiled);
  valijson::Validator validator;
  valijson::ValidationResults results;
  const json bounded = within_int64(document);
  const valijson::adapters::NlohmannJsonAdapter adapter(bounded);
  if (validator.validate(compiled, adapter, &results)) return {};

  std::vector<Problem> found;
  std::set<std::string> seen;
  valijson::ValidationResults::Error error;
  std::string fallback = "does not follow the schema";
  while (found.size() < kMaxProblems && results.popError(error)) {
    fallback = error.description;
    const json *node = &root_, *value = &document;
    std::string path;
    for (const std::string& part : key_parts(error.context)) {
      node = member(*node, part);
      value = value->is_array() ? &value->at(std::stoul(part)) : &value->at(part);
      path = joined(path, part);
      if (!node) break;
    }
    if (node && seen.insert(path).second) describe(*node, *value, path, found);
  }
  if (found.empty()) found.push_back({"", fallback});
  if (found.size() >= kMaxProblems)
    found.push_back({"", fmt::format("these are the first {} mistakes, there are more", kMaxProblems)});
  return found;
}

void Schema::normalize(json& value, const json& node) const {
  if (value.is_structured()) {
    for (auto it = value.begin(); it != value.end(); ++it) {
      const json* child = member(node, value.is_object() ? it.key() : std::string("0"));
      if (child) normalize(*it, *child);
    }
    return;
  }
  if (!value.is_number()) return;
  if (allows_type(node, "number"))
    value = value.get<double>();
  else if (value.is_number_float() && allows_type(node, "integer") && is_whole(value.get<double>()))
    value = std::llround(value.get<double>());
}

std::vector<Problem> Schema::unusual(const json& document) const {
  std::vector<Problem> found;
  unusual(document, root_, "", found);
  return found;
}

void Schema::unusual(const json& value, const json& node, const std::string& path, std::vector<Problem>& out) const {
  if (value.is_structured()) {
    std::size_t index = 0;
    for (auto it = value.begin(); it != value.end(); ++it, ++index) {
      const std::string name = value.is_object() ? it.key() : std::to_string(index);
      if (const json* child = member(node, name)) unusual(*it, *child, joined(path, name), out);
    }
    return;
  }
  if (!value.is_number() || !node.contains("usual")) return;
  std::string text = unusual_text(value.get<double>(), node["usual"][0].get<double>(), node["usual"][1].get<double>(),
                                  node.value("unit", std::string("-")));
  if (!text.empty()) out.push_back({path, std::move(text)});
}

void Schema::fill_defaults(json& value, const json& node) const {
  if (value.is_array() && node.contains("items"))
    for (json& entry : value) fill_defaults(entry, resolved(node["items"]));
  if (!value.is_object() || !node.contains("properties")) return;
  for (const auto& [name, entry] : node["properties"].items()) {
    const json& child = resolved(entry);
    if (!value.contains(name) && child.contains("default")) value[name] = child["default"];
    if (value.contains(name)) fill_defaults(value[name], child);
  }
}

void Schema::remove_defaults(json& value, const json& node) const {
  if (value.is_array() && node.contains("items"))
    for (json& entry : value) remove_defaults(entry, resolved(node["items"]));
  if (!value.is_object() || !node.contains("properties")) return;
  for (const auto& [name, entry] : node["properties"].items()) {
    if (!value.contains(name)) continue;
    const json& child = resolved(entry);
    remove_defaults(value[name], child);
    if (child.contains("default") && value[name] == child["default"]) value.erase(name);
  }
}

void Schema::add_keys(const json& node, const std::string& path, std::vector<std::string>& out) const {
  for (const auto& [name, entry] : node["properties"].items()) {
    const json& child = resolved(entry);
    if (child.contains("properties"))
      add_keys(child, joined(path, name), out);
    else
      out.push_back(joined(path, name));
  }
}

std::vector<std::string> Schema::keys(const std::string& section) const {
  std::vector<std::string> names;
  const json* node = section.empty() ? &root_ : find(section);
  if (node && node->contains("items")) return keys(section + ".0");
  if (node && node->contains("properties")) add_keys(*node, section, names);
  return names;
}

std::vector<std::string> Schema::nearest(const std::string& key) const {
  std::vector<std::string> known = keys();
  for (const auto& [name, entry] : root_["properties"].items())
    if (resolved(entry).contains("properties")) known.push_back(name);
  // Finds the right name in the wrong section, or without a section.
  const std::string leaf = key.substr(key.rfind('.') + 1);
  for (const std::string& candidate : known)
    if (candidate.size() > leaf.size() && candidate.ends_with("." + leaf)) return {candidate};
  std::vector<std::string> similar = nearest_words(key, known);
  if (!similar.empty() || key.find('.') != std::string::npos) return similar;
  for (const std::string& candidate : known)
    if (edit_distance(leaf, candidate.substr(candidate.rfind('.') + 1)) <= 2 && leaf.size() > 3)
      similar.push_back(candidate);
  if (similar.size() > 3) similar.resize(3);
  return similar;
}

}  // namespace furrow::scenario
