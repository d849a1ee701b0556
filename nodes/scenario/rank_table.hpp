// Tasks of the MPI ranks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct RankEntry {
  int rank = 0;
  std::string node;  // "rig", "tire 0", "terrain"
  std::string does;  // its task, for users
};

/// World rank 0 is the rig, 1…k the tires, the rest the terrain.
std::vector<RankEntry> rank_table(const Scenario& scenario);
/// The rank of the terrain, or of its leader if the terrain has several ranks.
inline std::size_t terrain_rank(const Scenario& scenario) { return 1 + scenario.tires.size(); }

std::string rank_table_text(const Scenario& scenario);

/// The lines that start the run by hand, without and with a batch system.
std::string launch_lines(const Scenario& scenario, const std::vector<std::string>& arguments);

/// Quotes an argument for a shell.
std::string shell_quoted(const std::string& argument);
/// A file or folder as an argument of a command: never read as an option, even if its name begins with a hyphen.
std::string shell_path(const std::string& path);

}  // namespace furrow::scenario
