// One scenario on several beds, which differ in the seed of their grains: `furrow run --seeds N`. A run on one bed does
// not show the spread between beds; means over beds do.
//
//   <folder>/seed1, seed2, …  the folder of each run, with run.seed, run.seed + 1, …; seed1.log: its output
//   <folder>/sweep.csv, sweep.json  as of a study (sweep.hpp)
//   <folder>/summary.json     the means over beds; summary_failed.json instead if a run failed
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "nodes/launch/run_directory.hpp"
#include "nodes/scenario/scenario.hpp"
#include "nodes/study/sweep.hpp"

namespace furrow::study {

/// @throws Error(bad_input) if a seed makes no difference (no grains, or a bed of the user's own), or if `beds` seeds
/// leave the range of seeds
void require_beds(const scenario::Scenario& scenario, int beds);

/// Prepares the folder for the beds of this scenario. Existing beds stay, unless `overwrite`: then all that furrow
/// wrote into the folder and into those of its beds is set aside.
/// @param digest of the scenario on the first bed
/// @throws Error(bad_input) if it holds another study, or without `overwrite` beds of another scenario
void begin_beds(launch::RunDirectory& directory, const std::string& digest, bool overwrite);

/// @throws Error(bad_input) if the folder holds beds, which a study would mix with its runs
void require_no_beds(const std::filesystem::path& folder);

/// Mean of independent values with half of its 95 % interval, Student's t · sd/√n; NaN if there are too few values.
struct OverBeds {
  int n = 0;
  double mean = 0.0, sd = 0.0, half_width = 0.0;
};
OverBeds over_beds(std::span<const double> values);

/// Combines the summaries of the beds: for each wheel and figure `mean`, `sd`, `half_width_95` over the finished beds,
/// the beds that are not steady, and those that failed. The figures of a single wheel also appear at the top level.
nlohmann::ordered_json summary_of_beds(const scenario::Scenario& scenario, std::span<const Sweep::Outcome> beds);

/// Writes it: summary.json, or summary_failed.json if a bed failed. @throws Error(io)
void write_summary_of_beds(const std::filesystem::path& folder, const nlohmann::ordered_json& summary);

}  // namespace furrow::study
