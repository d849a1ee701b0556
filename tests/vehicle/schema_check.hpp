// Checks a document with a JSON schema: the part of draft 7 that the vehicle schema uses.
#pragma once

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

namespace furrow::testing {

class SchemaCheck {
 public:
  explicit SchemaCheck(const nlohmann::json& schema) : root_(schema) {}

  /// The first place where the document does not follow the schema, or nothing.
  std::string complaint(const nlohmann::json& document) const { return check(root_, document, ""); }

  const nlohmann::json& resolved(const nlohmann::json& node) const {
    if (!node.contains("$ref")) return node;
    return root_.at(nlohmann::json::json_pointer(node["$ref"].get<std::string>().substr(1)));
  }

 private:
  using json = nlohmann::json;

  static bool is_of_type(const json& value, const std::string& type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "number" && value.is_number()) || (type == "string" && value.is_string()) ||
           (type == "boolean" && value.is_boolean()) || (type == "null" && value.is_null());
  }

  std::string check(const json& given, const json& value, const std::string& path) const {
    const json& node = resolved(given);
    if (node.contains("oneOf")) {
      int fitting = 0;
      std::string complaints;
      for (const json& option : node["oneOf"])
        if (const std::string one = check(option, value, path); one.empty())
          ++fitting;
        else
          complaints += one + "; ";
      return fitting == 1 ? "" : path + ": fits " + std::to_string(fitting) + " definitions: " + complaints;
    }
    if (node.contains("const") && value != node["const"]) return path + ": is not the constant";
    if (node.contains("enum") && std::find(node["enum"].begin(), node["enum"].end(), value) == node["enum"].end())
      return path + ": is none of the values";
    if (node.contains("type") && !is_of_type(value, node["type"])) return path + ": is of another type";
    if (value.is_number()) return check_number(node, value.get<double>(), path);
    if (value.is_array()) return check_array(node, value, path);
    if (value.is_object()) return check_object(node, value, path);
    return value.is_string() && value.get<std::string>().size() < node.value("minLength", 0u) ? path + ": is too short"
                                                                                              : "";
  }
  static std::string check_number(const json& node, double value, const std::string& path) {
    const bool fits = value >= node.value("minimum", -1e300) && value <= node.value("maximum", 1e300) &&
                      value > node.value("exclusiveMinimum", -1e300) && value < node.value("exclusiveMaximum", 1e300);
    return fits ? "" : path + ": is out of range";
  }
  std::string check_array(const json& node, const json& value, const std::string& path) const {
    if (value.size() < node.value("minItems", 0u) || value.size() > node.value("maxItems", 1000000u))
      return path + ": has another size";
    for (std::size_t i = 0; i < value.size(); ++i)
      if (const std::string one = check(node["items"], value[i], path + "/" + std::to_string(i)); !one.empty())
        return one;
    return "";
  }
  std::string check_object(const json& node, const json& value, const std::string& path) const {
    for (const json& key : node.value("required", json::array()))
      if (!value.contains(key.get<std::string>())) return path + ": lacks " + key.get<std::string>();
    for (const auto& [key, member] : value.items()) {
      if (!node["properties"].contains(key)) return path + ": has " + key;
      if (const std::string one = check(node["properties"][key], member, path + "/" + key); !one.empty()) return one;
    }
    return "";
  }

  const nlohmann::json& root_;
};

}  // namespace furrow::testing
