// A scenario: what the user's JSON file says, validated, completed with the schema's defaults, and made into
// the options of each room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "rigs/drawbar_spec.hpp"
#include "rigs/rig_spec.hpp"
#include "terrain/terrains.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::scenario {

/// `run.*`
struct RunOptions {
  double step = 4e-5;         // communication step H, s
  double end = 1.5;           // s
  double average_from = 0.8;  // start of the averaging window, s
  int threads = 0;            // terrain's OpenMP threads; 0: auto
  std::uint64_t seed = 1;
  double peer_timeout = 60.0;  // s
  std::int64_t steps() const;  // round(end / step)
  /// In an interval, which is rounded to a whole number of steps, at least one; 0 for an interval of 0.
  std::int64_t steps_in(double interval) const;
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<RunOptions> auto& s) {
  visit(Field{"step", "s", role::key}, s.step);
  visit(Field{"end", "s", role::key}, s.end);
  visit(Field{"average_from", "s", role::key}, s.average_from);
  visit(Field{"threads", "", role::key | role::harmless}, s.threads);
  visit(Field{"seed", "", role::key}, s.seed);
  visit(Field{"peer_timeout", "s", role::key | role::harmless}, s.peer_timeout);
}

/// `output.*`
struct OutputOptions {
  double series_interval = 1e-3;  // s
  double frame_interval = 0.02;   // s; 0: none
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<OutputOptions> auto& s) {
  visit(Field{"series_interval", "s", role::key}, s.series_interval);
  visit(Field{"frame_interval", "s", role::key}, s.frame_interval);
}

/// `checkpoint.*`
struct CheckpointOptions {
  double wall_interval = 600.0;  // s of wall time; 0: none
  double interval = 0.0;         // s of simulated time; 0: none
  int keep = 2;
  bool at_end = true;
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<CheckpointOptions> auto& s) {
  visit(Field{"wall_interval", "s", role::key | role::harmless}, s.wall_interval);
  visit(Field{"interval", "s", role::key | role::harmless}, s.interval);
  visit(Field{"keep", "", role::key | role::harmless}, s.keep);
  visit(Field{"at_end", "", role::key | role::harmless}, s.at_end);
}

/// `press.*`, optional: what `furrow press` takes where its options do not say it.
struct PressKeys {
  std::string on = "plate";  // plate | cleat
  double deflection = 0.02;  // largest, m
  int points = 10;           // of the curve up to it
  double load = -1.0;        // of the footprint, N; negative: what the scenario's first wheel carries
  double camber = 0.0;       // of the wheel, rad
  double cleat_height = 0.025, cleat_width = 0.025;  // m
  double cleat_position = 0.0;                       // of its middle, forward of the axle, m
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<PressKeys> auto& s) {
  visit(Field{"on", "", role::key | role::harmless}, s.on);
  visit(Field{"deflection", "m", role::key | role::harmless}, s.deflection);
  visit(Field{"points", "", role::key | role::harmless}, s.points);
  visit(Field{"load", "N", role::key | role::harmless}, s.load);
  visit(Field{"camber", "rad", role::key | role::harmless}, s.camber);
  visit(Field{"cleat_height", "m", role::key | role::harmless}, s.cleat_height);
  visit(Field{"cleat_width", "m", role::key | role::harmless}, s.cleat_width);
  visit(Field{"cleat_position", "m", role::key | role::harmless}, s.cleat_position);
}

/// `expected.*`, optional: what the shipped scenarios print beside their result. A spread is of runs on one bed; the
/// mean over n beds is expected within spread/√n. A spread of 0: nothing is expected of this figure.
struct ExpectedResult {
  bool given = false;
  double drawbar_pull = 0.0;         // N
  double drawbar_pull_spread = 0.0;  // ± N
  double sinkage = 0.0;              // m
  double sinkage_spread = 0.0;       // ± m
  double rut_depth = 0.0;            // m
  double rut_depth_spread = 0.0;     // ± m
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ExpectedResult> auto& s) {
  visit(Field{"drawbar_pull", "N", role::key | role::harmless}, s.drawbar_pull);
  visit(Field{"drawbar_pull_spread", "N", role::key | role::harmless}, s.drawbar_pull_spread);
  visit(Field{"sinkage", "m", role::key | role::harmless}, s.sinkage);
  visit(Field{"sinkage_spread", "m", role::key | role::harmless}, s.sinkage_spread);
  visit(Field{"rut_depth", "m", role::key | role::harmless}, s.rut_depth);
  visit(Field{"rut_depth_spread", "m", role::key | role::harmless}, s.rut_depth_spread);
}

/// What a run will take, about, bytes.
struct MemoryNeed {
  double all = 0.0;      // ranks together
  double terrain = 0.0;  // a rank of the terrain
};

/// A file whose content decides results.
struct InputFile {
  std::string key;  // that names it: "tires.2.file"
  std::filesystem::path path;
};

struct Scenario {
  std::filesystem::path file;
  std::string name;       // file name without extension
  std::string completed;  // the whole scenario as JSON text with defaults filled in; can be read from any folder
  std::string digest;     // hash of all in `completed` that decides the results, and of the tire files
  std::shared_ptr<const rigs::RigSpec> rig = rigs::drawbar_spec({{}});
  int rig_substeps = 1;
  double drop_height = 0.0;                                  // of all tires above the ground at t = 0, m
  std::vector<std::shared_ptr<const tire::TireSpec>> tires;  // one per wheel
  bool tires_listed = false;                                 // as entries of `tires`, not by one `tire` for all
  int tire_substeps = 1;
  std::shared_ptr<const terrain::TerrainSpec> terrain = terrain::default_terrain();
  int terrain_ranks = 1;
  int terrain_substeps = 1;
  int settle_threads = 1;  // OpenMP threads of the terrain while a bed settles
  RunOptions run;
  OutputOptions output;
  CheckpointOptions checkpoint;
  PressKeys press;
  ExpectedResult expected;
  MemoryNeed memory;
  std::vector<std::string> warnings;  // what looks wrong but is allowed

  /// Key of the tire of wheel k: "tire.pressure", "tires.2.pressure".
  std::string tire_key(std::size_t wheel, const std::string& name) const;
  double terrain_step() const { return run.step / terrain_substeps; }  // s
  /// What the run supplies to its terrain, with as many threads as a bed settles with.
  terrain::TerrainContext terrain_context() const;
  /// The options of the terrain's grains, with what the run supplies.
  /// @throws Error(bad_input) unless the terrain is made of grains; `what` says why it must be
  terrain::dem::DemOptions grains(const std::string& what) const;

  /// Of what the tire files, the terrain's and the rig's files hold, in this order.
  std::vector<std::string> file_hashes() const;
  /// Those files, in the same order.
  std::vector<InputFile> input_files() const;
};

}  // namespace furrow::scenario
