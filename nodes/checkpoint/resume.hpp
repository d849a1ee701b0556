// Continuing a run: which checkpoint, under which scenario, and what may have changed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::checkpoint {

struct ResumePlan {
  scenario::Scenario scenario;  // from <run>/scenario.json and the settings
  bool finished = false;        // there is nothing to do
  double ended = 0.0;           // of a finished run, s
  ResumePoint point;            // unless finished
  std::vector<std::string> warnings;
};

/// Chooses the newest checkpoint that is whole, and compares the scenario that it was computed with to the one that is
/// to be continued. Looks, and changes nothing: every rank finds the same.
/// @throws Error(bad_input) when `run` holds no run or no checkpoint, or a key that decides the results has changed;
///         Error(io) when every checkpoint is damaged
ResumePlan plan_resume(const std::filesystem::path& run, const scenario::Settings& settings);

/// A run whose scenario.json was lost has it again from its newest checkpoint. @returns what to warn of; empty: nothing
/// was restored. @throws Error(io) when no checkpoint is whole or the file cannot be written
std::string restore_scenario(const std::filesystem::path& run);

/// The newest checkpoint that is whole. @throws as plan_resume
ResumePoint last_checkpoint(const std::filesystem::path& run);

}  // namespace furrow::checkpoint
