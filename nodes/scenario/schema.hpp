// The scenario schema at work: finds mistakes and says them in words, fills in defaults, explains keys.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace furrow::scenario {

/// What is wrong with the value at a dotted key ("tires.0.pressure"), and what is expected.
struct Problem {
  std::string key;
  std::string what;
};

class Schema {
 public:
  explicit Schema(nlohmann::json text) : root_(std::move(text)) {}
  /// That of scenarios (scenario_schema.hpp), made once.
  static const Schema& of_scenarios();

  /// 15.0 becomes 15 where a whole number is wanted, and 450 becomes 450.0 where any number is: equal scenarios are
  /// equal.
  void normalize(nlohmann::json& document) const { normalize(document, root_); }
  std::vector<Problem> problems(const nlohmann::json& document) const;
  /// Values outside the magnitudes that are usual; to warn of.
  std::vector<Problem> unusual(const nlohmann::json& document) const;
  void fill_defaults(nlohmann::json& document) const { fill_defaults(document, root_); }
  /// Takes away what fill_defaults would add; entries of lists stay, empty perhaps.
  void remove_defaults(nlohmann::json& document) const { remove_defaults(document, root_); }

  /// The schema of a dotted key, references resolved; null when there is none.
  const nlohmann::json* find(const std::string& key) const;
  /// All dotted keys of a section ("": of all) that hold values or lists, sorted; of a list those of its entry 0.
  std::vector<std::string> keys(const std::string& section = "") const;
  /// Known keys that look like this one, best first, at most three.
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
