// Scenario files on disk, for tests of their readers.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "nodes/scenario/load_scenario.hpp"
#include "protocol/core/error.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow::testing {

/// The smallest valid scenario.
inline constexpr const char* kSmallest = R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {}})";

class ScenarioFile {
 public:
  explicit ScenarioFile(const std::string& text) : path_(folder_.path() / "test.json") { std::ofstream(path_) << text; }
  const std::filesystem::path& path() const { return path_; }
  scenario::Scenario load(const std::vector<std::pair<std::string, std::string>>& settings = {},
                          scenario::Purpose purpose = scenario::Purpose::run) const {
    return scenario::load_scenario(path_, settings, purpose);
  }
  /// The error of load(), without the name of the file (this one); empty if there is none.
  std::string complaint(const std::vector<std::pair<std::string, std::string>>& settings = {},
                        const std::filesystem::path& file = {}) const {
    try {
      load(settings);
    } catch (const Error& error) {
      const std::string text = error.what(), name = file.empty() ? path_.string() : file.string();
      return text.starts_with(name) ? text.substr(name.size()) : text;
    }
    return {};
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace furrow::testing
