#include "nodes/pass_bed.hpp"

#include "nodes/archive_file.hpp"
#include "nodes/checkpoint.hpp"
#include "nodes/resume.hpp"
#include "nodes/scenario.hpp"
#include "protocol/error.hpp"
#include "terrain/dem/bed_cache.hpp"

namespace furrow {

dem::RestResult make_pass_bed(const std::filesystem::path& run, double rest, const ProgressCall& progress,
                              const std::filesystem::path& file) {
  const ResumePoint point = last_checkpoint(run);
  Scenario scenario = load_scenario(run / "scenario.json", {});
  if (scenario.terrain.engine != "dem")
    throw input_error(run.string(), "terrain.engine",
                      "is '" + scenario.terrain.engine + "', expected 'dem': only grains keep a rut");
  if (point.manifest.step != scenario.run.steps())
    throw input_error(run.string(), "", "has no checkpoint of its end, expected checkpoint.at_end");
  scenario.terrain.threads = scenario.terrain.settle_threads;
  dem::RestResult result;
  const Archive state = read_archive(point.folder / part_name({Role::terrain, 0}));
  dem::write_bed(file, dem::bed_after_run(state, scenario.terrain, rest, progress, result));
  return result;
}

}  // namespace furrow
