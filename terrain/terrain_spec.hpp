// The terrain of a scenario, read but not yet made: everything that programs ask of a terrain before it exists. The
// engines are listed in terrain/terrains.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/ground_heights.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/rank_group.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain {

namespace dem {
struct DemOptions;
}

/// Inputs of a terrain from its run, in addition to the keys of the scenario.
struct TerrainContext {
  double step = 4e-5;                 // run.step / terrain.substeps, s: the step of the terrain's advance
  std::uint64_t seed = 1;             // run.seed
  int threads = 1;                    // OpenMP threads while stepping
  int settle_threads = 1;             // OpenMP threads while a bed settles
  bool contact_tangents = false;      // tire.contact_tangent of any tire: send them with the forces
  std::shared_ptr<RankGroup> group;   // the terrain's ranks, including this one; null if there is only one
  Vec3 gravity = standard_gravity();  // m/s²; acts on the grains, the rigid ground has no weight
};

/// The keys that every engine shares.
struct CommonOptions {
  std::string engine = "dem";
  int ranks = 1;     // MPI ranks
  int substeps = 1;  // of the terrain in one communication step
};
void visit_fields(FieldsOf<CommonOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.engine, key("engine", "", "Engine of the terrain."));
  visit(s.ranks,
        key("ranks", "", from(1, 4096),
            "Number of MPI ranks of the terrain. Engine liggghts takes up to 4096, each with one core, and parts of "
            "the bed at least three grains long. Engines dem, rigid and scm take one rank; only dem takes more than "
            "one thread."));
  visit(s.substeps,
        key("substeps", "", from(1, 1000), "Number of steps that the terrain takes in one communication step."));
}

/// A terrain ends at the walls of a bin: x from 0 to length, y from −width/2 to width/2.
struct TerrainBounds {
  double length = 0.0, width = 0.0;  // m
};

/// The uneven part of the ground, from x `from` to `to` and from y `right` to `left`, m.
struct UnevenPart {
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
  double right = from, left = to;
};

/// Properties of a terrain that follow from its keys alone.
struct TerrainDescription {
  std::string engine;                  // terrain.engine
  std::string name;                    // for people: "grains, law mindlin"
  std::string law;                     // of contact between grains; empty: there are none
  double grain_radius = 0.0;           // m; 0: there are none
  int most_ranks = 1;                  // that the engine can use
  bool core_per_rank = false;          // each rank computes on one core, and no grain sleeps
  bool exact_restart = true;           // a run continued from a checkpoint has the same bits
  bool gives_tangents = false;         // sends contact tangents beside forces where tires ask for them
  bool yields = true;                  // under a wheel; false: a wheel can climb it
  bool answers_at_once = false;        // so cheap that rig and tires can wait for its forces in each step
  bool takes_stated_contacts = false;  // of tires that know the ground by themselves: Terrain::state_contacts
  std::string uneven_key;              // of the section, whose value makes it uneven; empty: it is level ground
  UnevenPart uneven;                   // where uneven_key is given
  /// Keys of the section whose values are not followed to the letter, and how.
  std::vector<std::pair<std::string, std::string>> remarks;
  bool unstable_step_allowed = false;        // a step above the stable one is warned of, not refused
  std::optional<TerrainBounds> bounds;       // none: unbounded
  std::optional<double> undisturbed_height;  // of the surface from which sinkage counts, m; none: measured
  std::optional<double> cone_index;          // Pa; none: not known
  bool cohesive = false;                     // has more cohesion than dry sand
};

/// Estimated needs of a run, before any grain exists.
struct TerrainEstimate {
  std::string text;                                              // for messages: "about 25260 grains of 6 mm, …"
  double stable_step = std::numeric_limits<double>::infinity();  // s
  std::string stable_reason;                                     // limit of the step: "stiffness", "damping"
  std::int64_t grains = 0;
  double memory_bytes = 0.0;      // of the terrain's rank
  double frame_bytes = 0.0;       // on disk, of one frame
  double checkpoint_bytes = 0.0;  // on disk, of one checkpoint
  double expected_height = 0.0;   // of the surface, m
};

/// A file that a terrain reads. Its contents matter, not its location.
struct TerrainFile {
  std::string key;  // in the section
  std::filesystem::path path;
};

class TerrainSpec {
 public:
  virtual ~TerrainSpec() = default;

  virtual TerrainDescription describe() const = 0;
  /// @throws Error(bad_input) for values out of range.
  virtual TerrainEstimate estimate(const TerrainContext& context) const = 0;
  /// @throws Error(bad_input) for values out of range and for a step above the stable one.
  virtual std::unique_ptr<Terrain> make(const TerrainContext& context) const = 0;
  virtual std::vector<TerrainFile> files() const { return {}; }
  /// What this program lacks to run it, and what is expected, for messages; empty if nothing.
  virtual std::string lacking() const { return {}; }
  /// The key of the section that needs it.
  virtual const char* lacking_key() const { return "engine"; }
  /// The device that the terrain would use here and what it needs of it, for people; empty: processors only.
  virtual std::string device_text(const TerrainContext&) const { return {}; }
  /// Stiffness against a rigid wheel at rest on it, N/m; 0 if not known. @param width m @param load N
  virtual double stiffness_under(double /*radius*/, double /*width*/, double /*load*/) const { return 0.0; }
  /// Heights of ground that takes stated contacts; empty: it is the plane z = 0.
  virtual GroundHeights heights(const TerrainContext&) const { return {}; }
  /// The same where they are alike across.
  virtual GroundProfilePoints profile(const TerrainContext&) const { return {}; }
  /// Length of that wheel's contact in nodes of a grid; infinite where there is no grid.
  virtual double nodes_under(double /*radius*/, double /*width*/, double /*load*/) const {
    return std::numeric_limits<double>::infinity();
  }
  /// Bekker's k_c/b + k_φ over k_φ at that wheel's contact; 1 where there is no such soil.
  virtual double modulus_under(double /*radius*/, double /*width*/, double /*load*/) const { return 1.0; }
  /// @param width overall, of one tire, m
  /// @throws Error(bad_input) naming the key of the terrain that does not allow such a tire
  virtual void check_tire_width(double) const {}
  /// @param thickness of a wheel's grousers, m @throws Error(bad_input) where the terrain cannot tell them from gaps
  virtual void check_grousers(double /*thickness*/) const {}

  /// The grains, for tools that work on them (beds, soil tests, passes); null if this terrain has none.
  virtual const dem::DemOptions* grains() const { return nullptr; }
  /// Joins the saved states of all ranks to one, from which a bed can be made (terrain/dem/beds/bed_after_run.hpp).
  /// @pre grains() is not null. @throws Error(io) when the parts do not fit together
  virtual Archive joined_state(std::vector<Archive> parts, const TerrainContext& context) const;
};

}  // namespace furrow::terrain
