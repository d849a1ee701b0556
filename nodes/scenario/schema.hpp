// The scenario schema at work: finds mistakes and says them in words, fills in defaults, explains keys.
#pragma once

#include <filesystem>
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
  /// rigs/scenario.schema.json of the data folder. @throws Error(io) when the installation lacks it
  static Schema load();

  /// 15.0 becomes 15 where a whole number is wanted, and 450 becomes 450.0 where any number is: equal scenarios are
  /// equal.
  void normalize(nlohmann::json& document) const;
  std::vector<Problem> problems(const nlohmann::json& document) const;
  /// Values outside the magnitudes that are usual; to warn of.
  std::vector<Problem> unusual(const nlohmann::json& document) const;
  void fill_defaults(nlohmann::json& document) const;
  /// Takes away what fill_defaults would add; entries of lists stay, empty perhaps.
  void remove_defaults(nlohmann::json& document) const;

  /// The schema of a dotted key, references resolved; null when there is none.
  const nlohmann::json* find(const std::string& key) const;
  /// All dotted keys of a section ("": of all) that hold values or lists, sorted; of a list those of its entry 0.
  std::vector<std::string> keys(const std::string& section = "") const;
  /// Known keys that look like this one, best first, at most three.
  std::vector<std::string> nearest(const std::string& key) const;

  /// "a number above 0 and below 1 m".
  static std::string expectation(const nlohmann::json& node);
  /// "0 to 10", "above 0"; empty without bounds.
  static std::string range(const nlohmann::json& node);

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
