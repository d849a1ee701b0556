#include "nodes/scenario/rank_table.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/messages.hpp"
#include "terrain/dem/dem_terrain.hpp"

namespace furrow::scenario {

std::vector<RankEntry> rank_table(const Scenario& s) {
  FURROW_ASSERT(s.rig && s.terrain && s.terrain_ranks > 0, s.terrain_ranks);
  std::vector<RankEntry> table;
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  table.push_back({0, "rig", fmt::format("{}; writes the results; 1 thread", describe_rig(s, tires).text)});
  for (std::size_t k = 0; k < s.tires.size(); ++k)
    table.push_back({static_cast<int>(k) + 1, fmt::format("tire {}", k),
                     fmt::format("{}, {}; 1 thread", s.tires[k]->options().file.filename().string(), tires[k].name)});
  const auto grains = static_cast<double>(s.terrain->estimate(s.terrain_context()).grains);
  std::string threads = "as many threads as there are cores left";
  if (s.run.threads > 0)
    threads = fmt::format("{} thread{}", s.run.threads, s.run.threads > 1 ? "s" : "");
  else if (terrain::useful_threads(2, grains) == 2)
    threads += ", or all cores where few are left and that is faster";
  const std::string what = s.terrain->describe().name;
  for (int i = 0; i < s.terrain_ranks; ++i)
    table.push_back(
        {static_cast<int>(table.size()), to_string(Address{Role::terrain, i}, s.terrain_ranks), what + "; " + threads});
  return table;
}

std::string rank_table_text(const Scenario& scenario) {
  const std::vector<RankEntry> table = rank_table(scenario);
  std::size_t width = 8;
  for (const RankEntry& entry : table) width = std::max(width, entry.node.size());
  std::string text;
  for (const RankEntry& entry : table)
    text += fmt::format("  {:>3}  {:<{}} {}\n", entry.rank, entry.node, width, entry.does);
  return text;
}

std::string shell_quoted(const std::string& argument) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || std::string("_-./=:,+@%").find(static_cast<char>(c)) != std::string::npos;
  };
  if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) return argument;
  std::string quoted(1, '\'');
  for (const char c : argument) {
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  }
  quoted += '\'';
  return quoted;
}

std::string shell_path(const std::string& path) { return shell_quoted(path.starts_with('-') ? "./" + path : path); }

std::string launch_lines(const Scenario& scenario, const std::vector<std::string>& arguments) {
  const std::size_t ranks = rank_table(scenario).size();
  std::string tail;
  for (const std::string& argument : arguments) tail += " " + shell_quoted(argument);
  const char* as_root = geteuid() == 0 ? " --allow-run-as-root" : "";
  return fmt::format("mpirun -n {} --oversubscribe --bind-to none{}{}\nsrun -n {} --mpi=pmix -K1 --cpu-bind=none{}\n",
                     ranks, as_root, tail, ranks, tail);
}

}  // namespace furrow::scenario
