#include "nodes/study/pass_bed.hpp"

#include <utility>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/archive_file.hpp"
#include "terrain/dem/beds/bed_cache.hpp"

namespace furrow::study {

terrain::dem::SettleResult make_pass_bed(const std::filesystem::path& run, double rest, const ProgressCall& progress,
                                         const std::filesystem::path& file) {
  const checkpoint::ResumePoint point = checkpoint::last_checkpoint(run);
  const scenario::Scenario scenario = scenario::load_scenario(run / "scenario.json", {});
  const terrain::dem::DemOptions grains = scenario.grains("only grains keep a rut");
  if (point.manifest.step != checkpoint::finished_at(run))
    throw input_error(run.string(), "", "has no checkpoint of its end, expected checkpoint.at_end");
  terrain::dem::SettleResult result;
  std::vector<Archive> parts;
  for (int rank = 0; rank < scenario.terrain_ranks; ++rank)
    parts.push_back(read_archive(point.folder / checkpoint::part_name({Role::terrain, rank})));
  const Archive state = scenario.terrain->joined_state(std::move(parts), scenario.terrain_context());
  terrain::dem::write_bed(file, terrain::dem::bed_after_run(state, grains, rest, progress, result));
  return result;
}

}  // namespace furrow::study
