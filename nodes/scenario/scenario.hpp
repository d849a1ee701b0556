// A scenario: the user's JSON file, validated, completed with the schema's defaults, and converted into the options of
// each module.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/drawbar_spec.hpp"
#include "rigs/rig_spec.hpp"
#include "terrain/terrains.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::scenario {

/// Keys by their dotted paths, with the values of `--set key=value`.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// `run.*`
struct RunOptions {
  double step = 4e-5;         // communication step H, s
  double end = 1.5;           // s
  double average_from = 0.8;  // start of the averaging window, s
  int threads = 0;            // terrain's OpenMP threads; 0: auto
  std::uint64_t seed = 1;
  double peer_timeout = 60.0;  // s
  std::string on_lag = "end";  // end | warn
  std::int64_t steps() const;  // round(end / step)
  /// Steps in an interval, rounded to a whole number of at least one; 0 for an interval of 0.
  std::int64_t steps_in(double interval) const;
};

void visit_fields(FieldsOf<RunOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.step, key("step", "s", above(0).to(0.1).usual(1e-7, 1e-3),
                    "Communication step: the interval at which all nodes exchange motions and forces."));
  visit(s.end, key("end", "s", above(0).to(1e5),
                   "Simulated time at which the run ends. It is rounded to a whole number of run.step."));
  visit(s.average_from, key("average_from", "s", from(0, 1e5),
                            "Start of the window over which the summary averages; the window ends with the run."));
  visit(
      s.threads,
      key("threads", "", role::harmless,
          from(1, 1024).shaped(R"({"type": ["integer", "string"], "pattern": "^auto$", "default": "auto"})"),
          "Number of threads of the terrain. auto: as many as the other ranks leave; where they leave at most half of "
          "the cores, the run times that and all cores now and then. Results do not depend on it."));
  visit(s.seed, key("seed", "", from(0, 9007199254740991), "Seed of the bed's random grain positions."));
  visit(s.peer_timeout,
        key("peer_timeout", "s", role::harmless, from(1, 1e6),
            "Time after which a rank counts as lost that gives no sign of life while another waits for it."));
  visit(s.on_lag,
        key("on_lag", "", role::harmless, words("end warn"),
            "What happens where forces that come one step late make or take more than a tenth of the work that passes "
            "a wheel, over a bounce of the wheel. end: the run ends with code 3 and names a step that would do. warn: "
            "it goes on, and its results are marked."));
}

/// `output.*`
struct OutputOptions {
  double series_interval = 1e-3;  // s
  double frame_interval = 0.02;   // s; 0: none
};

void visit_fields(FieldsOf<OutputOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.series_interval, key("series_interval", "s", above(0).to(1e5),
                               "Time between lines of timeseries.csv. In a line forces are means over the interval, "
                               "positions, energies and counts are instants, impulses and works are sums since the "
                               "start. It is rounded to a whole number of run.step, at least one."));
  visit(s.frame_interval, key("frame_interval", "s", from(0, 1e5),
                              "Time between frames of grains and tire surface. It is rounded to a whole number of "
                              "run.step, at least one. 0: no frames."));
}

/// `checkpoint.*`
struct CheckpointOptions {
  double wall_interval = 600.0;  // s of wall time; 0: none
  double interval = 0.0;         // s of simulated time; 0: none
  int keep = 2;
  bool at_end = true;
};

void visit_fields(FieldsOf<CheckpointOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.wall_interval, key("wall_interval", "s", role::harmless, from(0, 1e7),
                             "Wall time between checkpoints. The first ones come after 30, 60, 120, … s. 0: no "
                             "checkpoints by wall time."));
  visit(s.interval, key("interval", "s", role::harmless, from(0, 1e5),
                        "Simulated time between checkpoints. It is rounded to a whole number of run.step, at least "
                        "one. 0: no checkpoints by simulated time."));
  visit(s.keep, key("keep", "", role::harmless, from(1, 1000), "How many checkpoints are kept: the newest."));
  visit(s.at_end, key("at_end", "", role::harmless,
                      "Write a checkpoint at the end of the run too. It lets the run continue with a later run.end, "
                      "and the next pass of a study start from its terrain."));
}

/// `press.*`, optional: defaults for the options of `furrow press`.
struct PressKeys {
  std::string on = "plate";  // plate | cleat
  double deflection = 0.02;  // largest, m
  int points = 10;           // of the curve up to it
  double load = -1.0;        // of the footprint, N; negative: the load of the scenario's first wheel
  double camber = 0.0;       // of the wheel, rad
  double cleat_height = 0.025, cleat_width = 0.025;  // m
  double cleat_position = 0.0;                       // of its middle, forward of the axle, m
};

void visit_fields(FieldsOf<PressKeys> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.on, key("on", "", role::harmless, words("plate cleat"),
                  "Obstacle. plate: flat. cleat: a flat-topped bar across the direction of travel. A profile is given "
                  "on the command line: furrow press --on profile --profile FILE."));
  visit(s.deflection,
        key("deflection", "m", role::harmless, above(0).to(0.2), "Largest deflection of the load–deflection curve."));
  visit(s.points, key("points", "", role::harmless, from(1, 1000), "Number of points of the curve."));
  visit(s.load,
        key("load", "N", role::harmless, above(0).to(1e7).usual(1, 200000).or_null(),
            "Load at which the footprint is computed. null: the load that the scenario's first wheel carries."));
  visit(s.camber, key("camber", "rad", role::harmless, from(-0.7, 0.7).usual(-0.3, 0.3),
                      "Inclination of the wheel about its forward axis. A positive one leans the top to the right of "
                      "travel. Flexible ring and planar tires are alike across their width and take 0 alone."));
  visit(s.cleat_height, key("cleat_height", "m", role::harmless, above(0).to(0.2), "Height of the cleat."));
  visit(s.cleat_width, key("cleat_width", "m", role::harmless, above(0).to(1),
                           "Width of the cleat's top along the direction of travel."));
  visit(s.cleat_position, key("cleat_position", "m", role::harmless, from(-1, 1),
                              "Position of the cleat's middle, forward of the axle."));
}

/// `expected.*`, optional: what the shipped scenarios print next to their result. A spread is for runs on one bed; the
/// mean over n beds is expected within spread/√n. With a spread of 0 nothing is expected of this figure.
struct ExpectedResult {
  bool given = false;
  double drawbar_pull = 0.0;         // N
  double drawbar_pull_spread = 0.0;  // ± N
  double sinkage = 0.0;              // m
  double sinkage_spread = 0.0;       // ± m
  double rut_depth = 0.0;            // m
  double rut_depth_spread = 0.0;     // ± m
};

void visit_fields(FieldsOf<ExpectedResult> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.drawbar_pull, key("drawbar_pull", "N", role::harmless, from(-1e9, 1e9).required(), "Mean drawbar pull."));
  visit(s.drawbar_pull_spread, key("drawbar_pull_spread", "N", role::harmless, from(0, 1e9).required(),
                                   "Spread ± of the drawbar pull on one bed: between seeds, machines and small "
                                   "changes. Means over n beds are expected within it over √n."));
  visit(s.sinkage, key("sinkage", "m", role::harmless, from(-1e3, 1e3).optional(), "Mean sinkage."));
  visit(s.sinkage_spread, key("sinkage_spread", "m", role::harmless, from(0, 1e3).optional(),
                              "Spread ± of the sinkage on one bed, as of the pull. 0: not stated."));
  visit(s.rut_depth, key("rut_depth", "m", role::harmless, from(-1e3, 1e3).optional(), "Depth of the rut."));
  visit(s.rut_depth_spread, key("rut_depth_spread", "m", role::harmless, from(0, 1e3).optional(),
                                "Spread ± of the rut depth on one bed, as of the pull. 0: not stated."));
}

/// Approximate memory of a run, bytes.
struct MemoryNeed {
  double all = 0.0;      // ranks together
  double terrain = 0.0;  // a rank of the terrain
};

/// A file whose content affects the results.
struct InputFile {
  std::string key;  // key with its name: "tires.2.file"
  std::filesystem::path path;
};

struct Scenario {
  std::filesystem::path file;
  std::string name;       // file name without extension
  std::string completed;  // the whole scenario as JSON text with all defaults; readable from any folder
  std::string digest;     // hash of the tire files and of all in `completed` that affects the results
  std::shared_ptr<const rigs::RigSpec> rig = rigs::drawbar_spec({{}});
  int rig_substeps = 1;
  double drop_height = 0.0;                                  // of all tires above the ground at t = 0, m
  std::vector<std::shared_ptr<const tire::TireSpec>> tires;  // one per wheel
  bool tires_listed = false;                                 // as entries of `tires`, not as one `tire`
  int tire_substeps = 1;
  std::shared_ptr<const terrain::TerrainSpec> terrain = terrain::default_terrain();
  std::optional<double> ground_friction;  // terrain.friction if it is stated, -
  int terrain_ranks = 1;
  int terrain_substeps = 1;
  int settle_threads = 1;  // OpenMP threads of the terrain while a bed settles
  RunOptions run;
  OutputOptions output;
  CheckpointOptions checkpoint;
  PressKeys press;
  ExpectedResult expected;
  MemoryNeed memory;
  std::vector<std::string> warnings;  // unlikely but allowed values

  /// Key of the tire of wheel k: "tire.pressure", "tires.2.pressure".
  std::string tire_key(std::size_t wheel, const std::string& name) const;
  /// Checks whether the forces on the tire of wheel k act in the interval for which they are computed, not one later.
  bool prompt(std::size_t wheel) const;
  /// Checks whether any tire has its own law of contact (TireDescription::own_contact).
  bool has_own_contact() const;
  double terrain_step() const { return run.step / terrain_substeps; }  // s
  /// Values that the run supplies to its terrain, with as many threads as settle a bed.
  terrain::TerrainContext terrain_context() const;
  /// The options of the terrain's grains, with the values that the run supplies.
  /// @throws Error(bad_input) unless the terrain is made of grains; `what` states why it must be
  terrain::dem::DemOptions grains(const std::string& what) const;

  /// Hashes of the contents of the tire files, the terrain's and the rig's files, in this order.
  std::vector<std::string> file_hashes() const;
  /// Those files, in the same order.
  std::vector<InputFile> input_files() const;
};

}  // namespace furrow::scenario
