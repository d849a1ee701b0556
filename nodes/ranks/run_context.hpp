// Inputs of a rank besides its scenario.
#pragma once

#include <filesystem>
#include <functional>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/launch/held_folder.hpp"
#include "nodes/launch/progress.hpp"
#include "protocol/core/archive.hpp"

namespace furrow::ranks {

struct RunContext {
  std::filesystem::path directory;                  // existing run directory; empty: write nothing (tests)
  launch::HeldFolder* held = nullptr;               // on that directory; null: nobody moves it (tests)
  int threads = 1;                                  // OpenMP threads of this node while stepping
  int other_threads = 0;                            // that the terrain may try instead; 0: none
  bool profile = false;                             // record the time of steps
  std::function<bool()> stop_requested;             // a signal asked for a stop
  launch::ProgressSink progress;                    // called by the rig's node
  std::function<void(const std::string&)> note;     // shows the user a note
  const checkpoint::ResumePoint* resume = nullptr;  // where the run continues; null: it begins
  const Archive* saved = nullptr;                   // this node's part of that checkpoint; run_node reads it
};

}  // namespace furrow::ranks
