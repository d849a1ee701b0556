// The scenario schema in use: finds and describes mistakes, fills in defaults, explains keys.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace furrow::scenario {

/// A mistake in the value at a dotted key ("tires.0.pressure"), and the expected value.
struct Problem {
  std::string key;
  std::string what;
};

class Schema {
 public:
  explicit Schema(nlohmann::json text) : root_(std::move(text)) {}
  /// The schema of scenarios (scenario_schema.hpp), made once.
  static const Schema& of_scenarios();

  /// Makes equal scenarios identical: 15.0 becomes 15 for a whole number, and 450 becomes 450.0 for any number.
  void normalize(nlohmann::json& document) const { normalize(document, root_); }
  std::vector<Problem> problems(const nlohmann::json& document) const;
  /// Allowed values outside their usual magnitudes, for warnings.
  std::vector<Problem> unusual(const nlohmann::json& document) const;
  void fill_defaults(nlohmann::json& document) const { fill_defaults(document, root_); }
  /// Removes the defaults that fill_defaults would add; entries of lists stay, even if empty.
  void remove_defaults(nlohmann::json& document) const { remove_defaults(document, root_); }

  /// The schema of a dotted key, references resolved; null if there is none.
  const nlohmann::json* find(const std::string& key) const;
  /// All dotted keys of a section ("": all) with values or lists, sorted; for a list the keys of its entry 0.
  std::vector<std::string> keys(const std::string& section = "") const;
  /// Keys similar to this one, best first, at most three.
  std::vector<std::string> nearest(const std::string& key) const;

 private:
  const nlohmann::json& resolved(const nlohmann::json& node) const;
  const nlohmann::json* member(const nlohmann::json& node, const std::string& name) const;
  void describe(const nlohmann::json& node, const nlohmann::json& value, const std::string& path,
                std::vector<Problem>& out) const;
  void normalize(nlohmann::json& value, const nlohmann::json& node) const;
  void unusual(const nlohmann::json& value, const nlohmann::json& node, const std::string& path,
               std::vector<Problem>& out) const;
  void fill_defaults(nlohmann::json& value, const nlohmann::json& node) const;
  void remove_defaults(nlohmann::json& value, const nlohmann::json& node) const;
  void add_keys(const nlohmann::json& node, const std::string& path, std::vector<std::string>& out) const;

  nlohmann::json root_;
};

}  // namespace furrow::scenario
