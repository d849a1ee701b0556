// A study: a scenario and a table of runs that differ in some keys.
//
//   {"scenario": "drawbar_pull_small.json",          relative to the study, then to the data folders
//    "set": {"run.end": 1.2},                        for all runs
//    "grid": {"rig.slip": [0, 0.3], "terrain.cohesion": [40e3, 80e3]},   every combination, the last key fastest
//    "list": [{"rig.slip": 0.1}, …],                 or these
//    "passes": 3, "rest": 0.2,                       number of passes of each run over one bed
//    "results": ["drawbar_pull_N.mean", …],          of summary.json; columns of the collected table
//    "plot": {"x": "rig.slip", "y": "drawbar_pull_N.mean", "error": "drawbar_pull_N.sem", "lines": "terrain.cohesion",
//             "mean_over": "run.seed"}}                  points are means over these runs, bars their 95 % intervals
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/scenario/scenario.hpp"

namespace furrow::study {

struct Study {
  std::filesystem::path file;
  std::string name;                          // file name without extension
  std::string description;                   // empty: none
  std::filesystem::path scenario;            // resolved
  nlohmann::ordered_json common;             // keys and values for all runs
  std::vector<nlohmann::ordered_json> runs;  // keys and values of each
  std::vector<std::string> names;            // folders of the runs; empty: named after their digests
  std::vector<std::string> results;          // of summary.json; always includes whether a mean is steady
  std::vector<std::string> chosen_results;   // those that the user asked for
  nlohmann::ordered_json plot;               // null: none
  int passes = 0;     // of each run; each pass is on the bed of the previous one; 0: separate beds
  double rest = 0.2;  // s, simulated, between passes
};

/// @param name of a file, or of one that comes with the program. @throws Error(bad_input) naming file and key
Study load_study(const std::filesystem::path& name);

/// Makes a study of one scenario on several beds with the seeds `seed`, `seed` + 1, …: runs in the folders seed1,
/// seed2, ….
/// @param settings of the command line, for all runs
/// @pre beds > 0
Study study_of_beds(const std::filesystem::path& scenario, const std::string& name, const scenario::Settings& settings,
                    std::uint64_t seed, int beds);

/// Converts values to the form of `--set key=value`.
scenario::Settings settings_of(const nlohmann::ordered_json& values);

/// "rig.slip=0.3, terrain.cohesion=80000".
std::string text_of(const nlohmann::ordered_json& values);

}  // namespace furrow::study
