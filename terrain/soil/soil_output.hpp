// Output of `furrow soil`: soil.json and one CSV per test.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "terrain/soil/soil_tests.hpp"

namespace furrow::terrain::soil {

struct SoilRun {
  std::string scenario, scenario_digest;  // name of the scenario, and its digest
  const SoilOptions& options;
  const SoilPlan& plan;
  const SoilResults& results;
  double wall_s = 0.0;
};

/// Contents of soil.json. Names of numbers include their unit; null if a test was not run or an error is not known.
nlohmann::ordered_json soil_json(const SoilRun& run);

/// Writes plate.csv, shear.csv, cone.csv and repose.csv of the tests that were run. @throws Error(io)
void write_soil_tables(const std::filesystem::path& folder, const SoilRun& run);

/// A few lines for users.
std::string soil_text(const nlohmann::ordered_json& soil);

}  // namespace furrow::terrain::soil
