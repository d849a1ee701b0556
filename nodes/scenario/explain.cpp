#include "nodes/scenario/explain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/scenario/model_keys.hpp"
#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

std::string meaning(const json& node) { return node.value("description", std::string()); }

std::string key_list(const Schema& schema, const std::string& section) {
  std::string text;
  for (const std::string& key : schema.keys(section))
    text += fmt::format("{:<34} {}\n", key, meaning(*schema.find(key)));
  return text;
}

std::string value_help(const std::string& key, const json& node) {
  std::string text = key + "\n  " + meaning(node) + "\n";
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<8} {}\n", name, value);
  };
  if (node.contains("unit")) line("unit", node["unit"]);
  line("range", expectation(node));
  if (node.contains("usual"))
    line("usual", number_text(node["usual"][0].get<double>()) + " to " + number_text(node["usual"][1].get<double>()));
  line("default", node.contains("default") ? value_text(node["default"]) : std::string("none"));
  for (const ModelSection& of : model_sections()) {
    const std::string section = std::string(of.name) + ".";
    if (!key.starts_with(section)) continue;
    if (const auto owners = of.owners(key.substr(section.size())); !owners.empty())
      line(of.chooser, fmt::format("{}", fmt::join(owners, ", ")));
  }
  return text;
}

}  // namespace

std::string explain(const std::string& key) {
  const Schema& schema = Schema::of_scenarios();
  if (key.empty()) return key_list(schema, "");
  const json* node = schema.find(key);
  if (!node) {
    const std::vector<std::string> similar = schema.nearest(key);
    throw input_error("explain", key,
                      similar.empty() ? "is unknown, expected one of those that 'furrow explain' lists"
                                      : fmt::format("is unknown, expected '{}'?", fmt::join(similar, "' or '")));
  }
  const std::string members = key_list(schema, key);
  return members.empty() ? value_help(key, *node) : key + "\n  " + meaning(*node) + "\n\n" + members;
}

}  // namespace furrow::scenario
