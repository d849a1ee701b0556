#include "nodes/scenario/run_time.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "nodes/scenario/estimate.hpp"
#include "nodes/scenario/grain_loads.hpp"
#include "nodes/scenario/terrain_threads.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/beds/bed_tiling.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/liggghts/rank_cost.hpp"

namespace furrow::scenario {
namespace {

// Factors from measured runs over the rates of the machine, whose bed fits a cache and whose tire rolls on hard ground.
constexpr double kSettled = 1.2;       // a grain-step of a bed that settles
constexpr double kRolled = 1.95;       // a grain-step of a bed that is rolled on
constexpr double kPackings = 2.5;      // number of beds until one has the wanted solid fraction, and their sample
constexpr double kOnSoil = 1.2;        // a step of a tire
constexpr double kRolls = 1.35;        // a grain-step with rolling resistance over one without
constexpr double kDouble = 1.5;        // a grain-step in double precision over one in mixed
constexpr double kSettling = 0.6;      // simulated time in which a new bed settles, s
constexpr double kJoints = 0.15;       // settling of joints between tiles, as if all grains were awake
constexpr double kAwake = 2.0;         // tire radii around an axle within which grains are awake,
constexpr double kParcel = 4.0;        // and grain radii beyond them: half a parcel
constexpr double kMeshExponent = 1.1;  // of a tire's step time over its unknowns
constexpr double kRigidTire = 4e-5;    // of a step: moving the surface, s
constexpr double kMessages = 8e-5;     // for each tire, in its rank and the rig's: send, receive and write, s
constexpr double kFewRanks = 3.0;      // for a core: with more of them messages take longer
constexpr double kCrowd = 0.8;         // by this share with each doubling
constexpr double kStart = 0.45;        // until mpirun has begun, and until it has ended, s
constexpr double kRankStart = 0.05;    // of each rank of a core, s
constexpr double kPairStart = 0.004;   // of each pair of ranks of a core, to find each other, s
constexpr double kFrameFile = 1.6e-3;  // of a frame: made, named and flushed to the disk, s
constexpr double kPart = 6e-3;         // of a checkpoint: like a frame, and its checksum, s
constexpr double kManifest = 1e-3;     // and folders of a checkpoint, and of the checkpoint removed for it, s
constexpr double kByte = 2.5e-9;       // of either, s
constexpr double kVertex = 8e-8;       // of a tire, in the terrain: finding its contacts, messages, s
constexpr double kLatency = 5e-5;      // until a message is noticed, s
constexpr int kPlaces = 9;             // along the axles' paths for the mean of the awake share
constexpr int kCells = 100;            // of the ground either way for it

/// Mean share of the ground that is within reach of an axle. The sides of a narrow bin hold its grains.
double awake_share(const Scenario& s, const std::vector<tire::TireDescription>& tires,
                   const terrain::dem::DemOptions& o) {
  const rigs::RigDescription rig = describe_rig(s, tires);
  FURROW_ASSERT(rig.wheels.size() == tires.size(), rig.wheels.size(), tires.size());
  int near = 0;
  for (int place = 0; place < kPlaces; ++place)
    for (int i = 0; i < kCells * kCells; ++i) {
      const double x = o.length * (i / kCells + 0.5) / kCells, y = o.width * ((i % kCells + 0.5) / kCells - 0.5);
      for (std::size_t k = 0; k < tires.size(); ++k) {
        const rigs::WheelDescription& wheel = rig.wheels[k];
        const double axle = wheel.from + (wheel.to - wheel.from) * place / (kPlaces - 1.0);
        const double reach = std::min(kAwake * tires[k].radius + kParcel * o.radius, o.width);
        if (std::hypot(x - axle, y - wheel.lateral) > reach) continue;
        ++near;
        break;
      }
    }
  return static_cast<double>(near) / (kPlaces * kCells * kCells);
}

/// Grain-steps for settling the bed; 0 if it is in the cache.
double settling(const terrain::dem::DemOptions& o) {
  namespace dem = terrain::dem;
  std::error_code error;
  const auto is_kept = [&](const dem::DemOptions& of) {
    return of.cache && std::filesystem::exists(dem::bed_cache_file(dem::bed_digest(of)), error);
  };
  if (!dem::bed_is_settled_anew(o) || is_kept(o)) return 0.0;
  const auto steps = [](const dem::DemOptions& of, double time) {
    return dem::expected_grains(of) * time / dem::settle_step(of);
  };
  double time = kSettling * (o.compaction_pressure > 0.0 ? 2.0 : 1.0);
  if (o.solid_fraction > 0.0) time *= kPackings;
  if (!dem::is_tiled(o)) return steps(o, time);
  const dem::DemOptions piece = dem::piece_of(o);
  return (is_kept(piece) ? 0.0 : steps(piece, time)) + steps(o, kJoints);
}

/// Factor by which messages take longer with several ranks per core: a rank that has slept finds its caches cold, and a
/// core switches between ranks for each message. Measured with 3 to 66 ranks on two cores.
double crowd(double ranks_per_core) { return 1.0 + kCrowd * std::max(0.0, std::log2(ranks_per_core / kFewRanks)); }

/// Time for all frames and checkpoints, s. Every rank writes a part of a checkpoint; tires and terrain each write a
/// frame.
double writing(const Scenario& s, int ranks, int cores) {
  const Estimate e = estimate(s);
  const auto files = [&](int count, double each) { return each * count / std::min(count, cores); };
  return e.frames * (files(ranks - 1, kFrameFile) + kByte * e.frame_bytes) +
         e.checkpoints * (kManifest + files(ranks, kPart) + kByte * e.checkpoint_bytes);
}

}  // namespace

RunTime run_time(const Scenario& s, const MachineSpeed& machine) {
  FURROW_ASSERT(machine.cores > 0 && machine.tire_coordinates > 0, machine.cores, machine.tire_coordinates);
  RunTime t;
  t.cores = machine.cores;
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const int count = static_cast<int>(tires.size());
  t.threads = s.run.threads;
  t.ranks = s.terrain_ranks;
  if (t.threads == 0)
    t.threads = auto_terrain_threads(t.cores, count, s.terrain_ranks, s.terrain->estimate(s.terrain_context()).grains);
  const int all_ranks = 1 + count + s.terrain_ranks;
  t.writing = writing(s, all_ranks, t.cores);
  const double ranks_per_core = static_cast<double>(all_ranks) / t.cores;
  t.start = kStart + ranks_per_core * (kRankStart + kPairStart * ranks_per_core);
  const double messages = kMessages * crowd(ranks_per_core);
  double all = messages * (1.0 + count), surfaces = 0.0;
  for (const tire::TireDescription& tire : tires) {
    const double mesh = static_cast<double>(tire.coordinates) / machine.tire_coordinates;
    const double step =
        s.tire_substeps *
        (tire.coordinates > 0 ? kOnSoil * machine.tire_step * std::pow(mesh, kMeshExponent) : kRigidTire);
    t.tire = std::max(t.tire, step + kMessages);
    all += step + messages;
    surfaces += kVertex * tire.vertices;
  }
  t.bed_is_kept = true;
  if (const terrain::dem::DemOptions* const keys = s.terrain->grains()) {
    const terrain::dem::DemOptions o = terrain::dem::with_context(*keys, s.terrain_context());
    const double grain =
        machine.grain_step * (o.precision == "double" ? kDouble : 1.0) * (o.rolling_friction > 0.0 ? kRolls : 1.0);
    const double settled = settling(o);
    t.bed_is_kept = settled == 0.0;
    t.bed = settled * kSettled * grain / std::clamp(o.settle_threads, 1, t.cores);
    if (terrain::dem::solver_params(o).activity && !s.terrain->describe().core_per_rank)
      t.awake = awake_share(s, tires, o);
    const GrainLoads loads = grain_loads(s);
    t.refined = loads.refined;
    const double steps = s.terrain_substeps * loads.parts;
    if (s.terrain->describe().core_per_rank) {
      const terrain::liggghts::RankLoad load = terrain::liggghts::rank_load(o, s.terrain_ranks);
      t.ghosts = load.ghosts;
      t.terrain = steps * terrain::liggghts::rank_step(load, machine.grain_step);
      all += t.terrain * s.terrain_ranks;
    } else {
      const double terrain = steps * t.awake * terrain::dem::expected_grains(o) * kRolled * grain;
      t.terrain = terrain / std::min(t.threads, t.cores);
      all += terrain;
    }
  }
  t.terrain += surfaces;
  all += surfaces;
  t.step = std::max({t.tire, t.terrain, all / t.cores}) + kLatency;
  t.run = t.step * static_cast<double>(s.run.steps());
  return t;
}

}  // namespace furrow::scenario
