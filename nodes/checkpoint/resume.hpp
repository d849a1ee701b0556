// Continuing a run: the checkpoint, the scenario, and the changes that are allowed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::checkpoint {

struct ResumePlan {
  scenario::Scenario scenario;  // from <run>/scenario.json and the settings
  bool finished = false;        // nothing is left to do
  double ended = 0.0;           // of a finished run, s
  ResumePoint point;            // unless finished
  std::vector<std::string> warnings;
};

/// Chooses the newest complete checkpoint, and compares its scenario with the one to be continued. It changes nothing,
/// so every rank finds the same.
/// @throws Error(bad_input) if `run` holds no run or no checkpoint, or a key that affects the results has changed;
///         Error(io) if every checkpoint is damaged
ResumePlan plan_resume(const std::filesystem::path& run, const scenario::Settings& settings);

/// Restores a lost scenario.json of a run from its newest checkpoint. @returns a warning; empty: nothing was restored.
/// @throws Error(io) if no checkpoint is complete or the file cannot be written
std::string restore_scenario(const std::filesystem::path& run);

/// The newest complete checkpoint. @throws as plan_resume
ResumePoint last_checkpoint(const std::filesystem::path& run);

}  // namespace furrow::checkpoint
