#include "protocol/files/key_schema.hpp"

#include <cmath>

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow {
namespace {

using nlohmann::json;
using Json = nlohmann::ordered_json;

Json listed(const char* words) {
  Json list = Json::array();
  std::istringstream text(words);
  for (std::string word; text >> word;) list.push_back(word);
  return list;
}

bool has_allowed_type(const json& node, const json& value) {
  if (value.is_null()) return allows_type(node, "null");
  if (value.is_boolean()) return allows_type(node, "boolean");
  if (value.is_string()) return allows_type(node, "string");
  if (value.is_array()) return allows_type(node, "array");
  if (value.is_object()) return allows_type(node, "object");
  if (value.is_number_integer()) return allows_type(node, "integer") || allows_type(node, "number");
  return allows_type(node, "number");
}

bool in_range(const json& node, const json& value) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (node.contains("minLength") && text.size() < node["minLength"].get<std::size_t>()) return false;
    return !node.contains("pattern") || "^" + text + "$" == node["pattern"].get<std::string>();
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

constexpr int kDeepest = 3;  // nested levels of a value written on one line

int depth(const Json& value) {
  int deepest = 0;
  if (value.is_structured())
    for (const Json& inner : value) deepest = std::max(deepest, depth(inner));
  return value.is_structured() ? deepest + 1 : 0;
}

/// Writes objects of keys, and values nested too deeply for one line, with a line for each entry.
std::string text_of(const Json& value, const std::string& indent) {
  if (value.is_number_float()) return number_text(value.get<double>());
  if (!value.is_structured()) return value.dump();
  const bool object = value.is_object();
  const auto is_object = [](const Json& inner) { return inner.is_object(); };
  const bool of_keys = object && (value.contains("properties") ||
                                  (!value.empty() && std::all_of(value.begin(), value.end(), is_object)));
  const bool broken = indent.empty() || of_keys || depth(value) > kDeepest;
  const std::string inner = indent + "  ";
  std::string text;
  for (auto it = value.begin(); it != value.end(); ++it)
    text += (text.empty() ? ""
             : broken     ? ","
                          : ", ") +
            (broken ? "\n" + inner : "") + (object ? Json(it.key()).dump() + ": " : "") + text_of(*it, inner);
  return (object ? "{" : "[") + text + (broken ? "\n" + indent : "") + (object ? "}" : "]");
}

}  // namespace

Json key_schema(const Key& key, const char* type, const Json& standard) {
  Json node = *key.shape ? Json::parse(key.shape) : Json::object();
  const auto add = [&](const char* name, const Json& value) {
    if (!node.contains(name)) node[name] = value;
  };
  if (*type && !node.contains("const")) add("type", type);
  if (*key.texts) add("enum", listed(key.texts));
  if (std::isfinite(key.low)) add(key.above_low ? "exclusiveMinimum" : "minimum", key.low);
  if (std::isfinite(key.high)) add(key.below_high ? "exclusiveMaximum" : "maximum", key.high);
  if (key.divisor != 1) add("multipleOf", key.divisor);
  if (!key.takes_empty) add("minLength", 1);
  if (key.usual_low != key.usual_high) add("usual", {key.usual_low, key.usual_high});
  if (key.takes_null) {
    if (node["type"].is_string()) node["type"] = {node["type"]};
    node["type"].push_back("null");
    if (node.contains("enum")) node["enum"].push_back(nullptr);
    add("default", nullptr);
  }
  if (key.missing == Missing::standard && !standard.is_discarded()) add("default", standard);
  if (*key.unit) add("unit", key.unit);
  if (*key.description) add("description", key.description);
  return node;
}

std::string word_of(const Key& key, int value) { return listed(key.texts).at(value); }

int word_number(const Key& key, const std::string& word) {
  const Json words = listed(key.texts);
  return static_cast<int>(std::find(words.begin(), words.end(), word) - words.begin());
}

void add_key(Json& object, const Key& key, const Json& node) {
  Json& properties = object["properties"];
  FURROW_ASSERT(!properties.contains(key.name) || properties[key.name] == node, key.name);
  properties[key.name] = node;
  if (key.missing == Missing::mistake) object["required"].push_back(key.name);
}

Json object_schema(const char* description) {
  return {{"type", "object"},
          {"additionalProperties", false},
          {"description", description},
          {"properties", Json::object()}};
}

std::string schema_text(const Json& schema) { return text_of(schema, "") + "\n"; }

std::string with_unit(const std::string& text, const json& node) {
  const std::string unit = node.value("unit", std::string("-"));
  return unit == "-" ? text : text + " " + unit;
}

bool allows_type(const json& node, const std::string& type) {
  if (!node.contains("type")) return true;
  const json& types = node["type"];
  return types.is_array() ? std::find(types.begin(), types.end(), type) != types.end() : types == type;
}

std::string range_text(const json& node) {
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

std::string expectation(const json& node) {
  if (node.contains("enum")) return one_of(node["enum"]);
  std::vector<std::string> words;
  const std::string bounds = range_text(node);
  const bool whole = allows_type(node, "integer") && !allows_type(node, "number");
  if (node.contains("minimum") && node.contains("maximum") && node["minimum"] == node["maximum"]) return bounds;
  if (whole || allows_type(node, "number"))
    words.push_back(with_unit((whole ? "a whole number" : "a number") + (bounds.empty() ? "" : ", " + bounds), node));
  if (allows_type(node, "string")) {
    const auto pattern = node.value("pattern", std::string());
    words.push_back(pattern.size() > 2           ? "'" + pattern.substr(1, pattern.size() - 2) + "'"
                    : node.contains("minLength") ? "a text that is not empty"
                                                 : "a text");
  }
  if (allows_type(node, "boolean")) words.push_back("true or false");
  if (allows_type(node, "object")) words.push_back("an object { }");
  if (allows_type(node, "array")) words.push_back(list_text(node));
  if (allows_type(node, "null")) words.push_back("null");
  return fmt::format("{}", fmt::join(words, " or "));
}

std::string mistake(const json& node, const json& value) {
  const bool listed =
      !node.contains("enum") || std::find(node["enum"].begin(), node["enum"].end(), value) != node["enum"].end();
  if (has_allowed_type(node, value) && listed && in_range(node, value)) return {};
  const std::string shown = value.is_number() ? with_unit(value_text(value), node) : value_text(value);
  return "is " + shown + ", expected " + expectation(node);
}

std::string mistake(const Key& key, const json& value) {
  Key plain = key;
  plain.shape = "";
  const char* type = value.is_string() ? "string" : value.is_number_integer() ? "integer" : "number";
  return mistake(json(key_schema(plain, type, Json::value_t::discarded)), value);
}

void check_value(const Key& key, const json& value, const std::string& file, const std::string& section) {
  if (const std::string what = mistake(key, value); !what.empty())
    throw input_error(file, section + "." + key.name, what);
}

}  // namespace furrow
