#include "nodes/scenario/schema.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr double kMaxWhole = 9007199254740992.0;  // 2^53
constexpr std::size_t kMaxProblems = 20;          // that are reported at once

std::string joined(const std::string& path, const std::string& name) { return path.empty() ? name : path + "." + name; }

bool allows(const json& node, const std::string& type) {
  if (!node.contains("type")) return true;
  const json& types = node["type"];
  return types.is_array() ? std::find(types.begin(), types.end(), type) != types.end() : types == type;
}

bool has_allowed_type(const json& node, const json& value) {
  if (value.is_null()) return allows(node, "null");
  if (value.is_boolean()) return allows(node, "boolean");
  if (value.is_string()) return allows(node, "string");
  if (value.is_array()) return allows(node, "array");
  if (value.is_object()) return allows(node, "object");
  if (value.is_number_integer()) return allows(node, "integer") || allows(node, "number");
  return allows(node, "number");
}

bool is_whole(double value) { return value == std::round(value) && std::abs(value) <= kMaxWhole; }

/// The same with numbers beyond 64-bit integers cut there: valijson converts them where a multiple is asked for, which
/// is undefined. No bound of a schema is as large.
json within_int64(json value) {
  constexpr double kMost = 9e18;
  if (value.is_structured()) {
    for (json& inner : value) inner = within_int64(std::move(inner));
  } else if (value.is_number_float() && !(std::abs(value.get<double>()) <= kMost)) {
    value = std::copysign(kMost, value.get<double>());
  }
  return value;
}

bool in_range(const json& node, const json& value) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (node.contains("minLength") && text.size() < node["minLength"].get<std::size_t>()) return false;
    return !node.contains("pattern") || "^" + text + "$" == node["pattern"];
  }
  if (value.is_array()) {
    return value.size() >= node.value("minItems", std::size_t{0}) &&
           value.size() <= node.value("maxItems", value.size());
  }
  if (!value.is_number()) return true;
  const double x = value.get<double>();
  const auto bound = [&](const char* name) { return node[name].get<double>(); };
  if (node.contains("minimum") && !(x >= bound("minimum"))) return false;
  if (node.contains("maximum") && !(x <= bound("maximum"))) return false;
  if (node.contains("exclusiveMinimum") && !(x > bound("exclusiveMinimum"))) return false;
  if (node.contains("exclusiveMaximum") && !(x < bound("exclusiveMaximum"))) return false;
  return !node.contains("multipleOf") || std::fmod(x, bound("multipleOf")) == 0.0;
}

std::string list_text(const json& node) {
  const int least = node.value("minItems", 0), most = node.value("maxItems", 0);
  return fmt::format("a list of {}{} {}", least == most ? "" : fmt::format("{} to ", least), most,
                     node.value("entries", "entries"));
}

std::string with_unit(const std::string& text, const json& node) {
  const std::string unit = node.value("unit", std::string("-"));
  return unit == "-" ? text : text + " " + unit;
}

/// What the writer may have meant in another unit: kilo, milli, bar, mega, micro; NaN if nothing fits.
double likely_meaning(double value, double low, double high) {
  for (const double factor : {1e3, 1e-3, 1e5, 1e6, 1e-6})
    if (std::abs(value) * factor >= low && std::abs(value) * factor <= high) return value * factor;
  return NAN;
}

/// valijson's words for a place, {"<root>", "[tires]", "[0]"}, as the parts of a key.
std::vector<std::string> key_parts(const std::vector<std::string>& context) {
  std::vector<std::string> parts;
  for (const std::string& entry : context)
    if (entry.size() > 2 && entry.front() == '[') parts.push_back(entry.substr(1, entry.size() - 2));
  return parts;
}

}  // namespace

Schema Schema::load() {
  const std::filesystem::path file = data_folder() / "rigs" / "scenario.schema.json";
  try {
    return Schema(load_json(file, "the scenario schema"));
  } catch (const Error& error) {
    throw Error(ExitCode::io, std::string(error.what()) + " (FURROW_HOME names the folder that holds rigs/)");
  }
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

std::string Schema::range(const json& node) {
  const bool low = node.contains("minimum"), above = node.contains("exclusiveMinimum");
  const bool high = node.contains("maximum"), below = node.contains("exclusiveMaximum");
  const auto bound = [&](const char* name) { return number_text(node[name].get<double>()); };
  std::string text;
  if (low && high && node["minimum"] == node["maximum"]) return bound("minimum");
  if (low && high)
    text = bound("minimum") + " to " + bound("maximum");
  else if (low)
    text = bound("minimum") + " or more";
  else if (above)
    text = "above " + bound("exclusiveMinimum");
  if (!(low && high)) {
    const std::string separator = text.empty() ? "" : above && high ? " up to " : " and ";
    if (high) text += separator + (above ? "" : "at most ") + bound("maximum");
    if (below) text += separator + "below " + bound("exclusiveMaximum");
  }
  if (node.contains("multipleOf")) text += ", a multiple of " + bound("multipleOf");
  return text;
}

std::string Schema::expectation(const json& node) {
  if (node.contains("enum")) return one_of(node["enum"]);
  std::vector<std::string> words;
  const std::string bounds = range(node);
  const bool whole = allows(node, "integer") && !allows(node, "number");
  if (node.contains("minimum") && node.contains("maximum") && node["minimum"] == node["maximum"]) return bounds;
  if (whole || allows(node, "number"))
    words.push_back(with_unit((whole ? "a whole number" : "a number") + (bounds.empty() ? "" : ", " + bounds), node));
  if (allows(node, "string")) {
    const auto pattern = node.value("pattern", std::string());
    words.push_back(pattern.size() > 2           ? "'" + pattern.substr(1, pattern.size() - 2) + "'"
                    : node.contains("minLength") ? "a text that is not empty"
                                                 : "a text");
  }
  if (allows(node, "boolean")) words.push_back("true or false");
  if (allows(node, "object")) words.push_back("an object { }");
  if (allows(node, "array")) words.push_back(list_text(node));
  if (allows(node, "null")) words.push_back("null");
  return fmt::format("{}", fmt::join(words, " or "));
}

void Schema::describe(const json& node, const json& value, const std::string& path, std::vector<Problem>& out) const {
  const bool listed =
      !node.contains("enum") || std::find(node["enum"].begin(), node["enum"].end(), value) != node["enum"].end();
  if (!has_allowed_type(node, value) || !listed || !in_range(node, value)) {
    const std::string shown = value.is_number() ? with_unit(value_text(value), node) : value_text(value);
    out.push_back({path, "is " + shown + ", expected " + expectation(node)});
    return;
  }
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

void Schema::normalize(json& document) const { normalize(document, root_); }

void Schema::normalize(json& value, const json& node) const {
  if (value.is_structured()) {
    for (auto it = value.begin(); it != value.end(); ++it) {
      const json* child = member(node, value.is_object() ? it.key() : std::string("0"));
      if (child) normalize(*it, *child);
    }
    return;
  }
  if (!value.is_number()) return;
  if (allows(node, "number"))
    value = value.get<double>();
  else if (value.is_number_float() && allows(node, "integer") && is_whole(value.get<double>()))
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
  const double x = value.get<double>(), low = node["usual"][0].get<double>(), high = node["usual"][1].get<double>();
  const bool small = low >= 0.0 ? std::abs(x) < low : x < low;
  if (x == 0.0 || (!small && x <= high)) return;
  const double meant = likely_meaning(x, std::max(low, 0.0), high);
  out.push_back(
      {path,
       fmt::format("{} is unusually {}, usual is {} to {}{}", with_unit(number_text(x), node),
                   small ? "small" : "large", number_text(low), with_unit(number_text(high), node),
                   std::isfinite(meant) && low > 0.0 ? fmt::format(": did you mean {}?", number_text(meant)) : "")});
}

void Schema::fill_defaults(json& document) const { fill_defaults(document, root_); }

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

void Schema::remove_defaults(json& document) const { remove_defaults(document, root_); }

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
  // The right name in the wrong section, or without any.
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
