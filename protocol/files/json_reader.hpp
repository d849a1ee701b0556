// Reads objects of a tire file key by key. Every complaint names the file, the dotted key, the offending
// value and what is allowed; keys that nobody asked for are errors with the nearest valid key suggested.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace furrow {

/// The parsed file. @throws Error(bad_input) for a missing, empty, malformed or duplicate-keyed file.
nlohmann::json load_json(const std::filesystem::path& file);

/// Of `valid`, the name with the smallest edit distance to `name`; empty when none is near.
std::string nearest_name(const std::string& name, const std::vector<std::string>& valid);

class JsonReader {
 public:
  JsonReader(const nlohmann::json& object, std::string file, std::string path = "");

  bool has(const std::string& key) const { return object_.contains(key); }
  JsonReader child(const std::string& key);
  const nlohmann::json& array(const std::string& key);
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& otherwise);
  bool flag_or(const std::string& key, bool otherwise);
  int count(const std::string& key, int least);

  double number(const std::string& key);        // finite
  double positive(const std::string& key);      // > 0
  double not_negative(const std::string& key);  // ≥ 0
  double not_negative_or(const std::string& key, double otherwise);
  /// `size` finite numbers (any number when size < 0).
  std::vector<double> numbers(const std::string& key, int size = -1);

  /// Takes a key without reading it (comments, names).
  void skip(const std::string& key) { used_.push_back(key); }
  /// @throws Error(bad_input) when a key is left that nothing asked for.
  void finish() const;

  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  const std::string& file() const { return file_; }
  const nlohmann::json& object() const { return object_; }

 private:
  const nlohmann::json& at(const std::string& key);

  const nlohmann::json& object_;
  std::string file_, path_;
  std::vector<std::string> used_;
};

}  // namespace furrow
