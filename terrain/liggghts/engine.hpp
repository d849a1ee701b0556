// Interface between Furrow and a distributed engine of grains. The engine is in a separate library (plugin/), which is
// loaded while the program runs (engine_library.hpp). Both sides share only this header and the contact laws.
//
// Each rank of the terrain has an Engine and owns the grains in its part of the bin. A grain that moves into another
// part moves to that part's rank, with all that it carries. All ranks call all functions together, except those with
// "own" in their name.
//
// A step evaluates the forces at the present positions, then kicks and drifts the grains:
//   v ← v + kick (F/m + g),   ω ← ω + kick T/I,   x ← x + dt v.
#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"

namespace furrow::terrain::liggghts {

/// Changes with this header; a library made for another number is refused.
inline constexpr int kEngineVersion = 7;
/// Symbols of the library: kMakeEngine makes an engine, kEngineVersionOf returns kEngineVersion.
inline constexpr char kMakeEngine[] = "furrow_make_engine";
inline constexpr char kEngineVersionOf[] = "furrow_engine_version";

/// The history of a grain's contact with a wall or a tire. It belongs to the grain and moves with it.
struct Carried {
  double partner = 0.0;                // a wall of dem/bin.hpp, or kWalls + the number of the tire
  std::array<double, 3> normal{};      // of the previous step; only for tires
  std::array<double, 3> tangential{};  // spring force on the grain, N
  double root_overlap = 0.0;           // √δ of the previous step, √m; 0: apart
  std::array<double, 3> rolling{};     // spring torque, N m
};
struct CarriedBy {
  int grain = -1;  // its number
  Carried contact;
};
using CarriedList = std::pmr::vector<Carried>;
inline constexpr int kMostCarried = 64;  // by one grain

/// The grains that a rank owns now, in the engine's order. Pointers are valid until the next step.
struct OwnGrains {
  int count = 0;
  const double (*position)[3] = nullptr;  // m
  const double (*velocity)[3] = nullptr;  // m/s
  const double (*spin)[3] = nullptr;      // rad/s
  const double* radius = nullptr;         // m
  const int* id = nullptr;
  double (*force)[3] = nullptr;    // N, to which forces are added
  double (*torque)[3] = nullptr;   // N m
  CarriedList* carried = nullptr;  // of each grain
};

/// Sums over the pairs of grains that a rank evaluated in one step. If the other grain belongs to another rank, both
/// ranks evaluate the pair and each counts it half.
struct PairSums {
  double elastic = 0.0;  // normal springs and cohesion, J
  double contacts = 0.0;
  double max_overlap = 0.0;            // m
  double max_share = 0.0;              // largest overlap over the diameter of the smaller grain, -
  std::array<double, 3> hardest_at{};  // a grain of the contact with the largest share, m
  dem::ContactSample sample;           // if it was asked for
};

/// Sums over the grains that a rank owns, at their positions. Each grain is weighted by its volume relative to that of
/// the reference radius, V = (r/r₀)³; rotation is weighted by V (r/r₀)².
struct MotionSums {
  double volume = 0.0;               // Σ V
  double speed2 = 0.0, spin2 = 0.0;  // Σ V v², m²/s²; Σ V (r/r₀)² ω², rad²/s²
  Vec3 speed = Vec3::Zero();         // Σ V v, m/s
  Vec3 place = Vec3::Zero();         // Σ V x, m

  void add(const double* x, const double* v, const double* w, double of_volume, double of_spread) {
    volume += of_volume;
    speed2 += of_volume * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    spin2 += of_spread * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int k = 0; k < 3; ++k) speed[k] += of_volume * v[k], place[k] += of_volume * x[k];
  }
};
void visit_fields(FieldsOf<MotionSums> auto& s, auto&& visit) {
  visit(s.volume, Field{"volume"});
  visit(s.speed2, Field{"speed2", "m²/s²"});
  visit(s.spin2, Field{"spin2", "rad²/s²"});
  visit(s.speed, Field{"speed", "m/s"});
  visit(s.place, Field{"place", "m"});
}

/// Sums that are wanted of a step besides its forces.
struct StepWish {
  bool losses = false;
  bool motion = false;  // the sums of motion after the step
};

/// Called in each step on each rank: adds the forces of walls and tires.
class StepWork {
 public:
  virtual ~StepWork() = default;
  /// Call after the lists of pairs were made for these positions. Until the next call each grain moves by half a skin
  /// at most.
  /// @param order  indices in OwnGrains: neighbours in it are neighbours in space
  virtual void lists_made(const OwnGrains& grains, std::span<const std::int32_t> order) = 0;
  /// Call before indices in OwnGrains change and lists are rebuilt: histories must move into `carried` now.
  virtual void numbers_change(const OwnGrains& grains) = 0;
  virtual StepWish begin_step() = 0;
  /// Adds forces to the grains at order[first] to order[last − 1], after their pairs were evaluated, so that their data
  /// are in the cache. The parts of a step start at first = 0, rise, and cover all grains; a rank without grains gets
  /// no call.
  /// @param losses  as begin_step asked
  virtual void add_forces(const OwnGrains& grains, int first, int last, bool losses) = 0;
  /// Receives the sums over the step's pairs after all grains have moved. @param motion  valid if begin_step wanted it
  virtual void end_step(const PairSums& pairs, const MotionSums& motion, bool losses) = 0;
};

struct NewGrain {
  int id = 0;
  double radius = 0.0;                        // m
  std::array<double, 3> position{};           // m
  std::array<double, 3> list_position{};      // position when its rank's lists were made, m
  std::array<double, 3> exchange_position{};  // position when grains could last change their rank, m
  std::array<double, 3> velocity{};           // m/s
  std::array<double, 3> spin{};               // rad/s
};

/// History of two touching grains, with the spring on grain i; i < j are numbers of grains.
struct PairRecord {
  std::int32_t i = 0, j = 0;
  std::array<double, 3> tangential{};  // N
  double root_overlap = 0.0;           // √m
  std::array<double, 3> rolling{};     // N m
};

/// One number for a pair of grains, or for a grain and a wall.
inline std::uint64_t pair_key(std::int32_t i, std::int32_t j) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 | static_cast<std::uint32_t>(j);
}

/// Times of the interval to which the step belongs.
struct StepTimes {
  double dt = 0.0;     // time by which grains drift, s
  double since = 0.0;  // time since forces were last evaluated, for which histories grow, s
  double kick = 0.0;   // s
};

struct EngineSetup {
  std::optional<int> communicator;  // of the ranks, as MPI_Comm_f2c takes it; none: a single rank
  dem::Bin bin;
  double top = 0.0;      // height that no grain exceeds at the beginning, m
  double skin = 0.0;     // m
  double largest = 0.0;  // radius, m
  dem::LawKind law{};
  bool rolling = false;
  bool sizes = false;               // radii differ
  dem::GrainProperties grain;       // of the reference radius
  std::array<double, 3> gravity{};  // m/s²
  std::vector<double> borders;      // between the ranks' parts along x, m; empty: parts of equal length
};

/// An error message of LIGGGHTS. Thrown on every rank, or on one alone, in which case the others wait for it for ever.
class EngineError : public std::runtime_error {
 public:
  EngineError(const std::string& text, bool on_all) : std::runtime_error(text), on_all(on_all) {}
  bool on_all;
};

class Engine {
 public:
  virtual ~Engine() = default;

  /// Places grains. Each rank takes those in its part, in the given order. @param own_only  all grains are this rank's
  virtual void place(std::span<const NewGrain> grains, bool own_only) = 0;
  /// Sets histories of touching grains, before the first run. A rank uses those of its own grains.
  virtual void remember(std::span<const PairRecord> records) = 0;
  /// Makes the lists. @param exchange  as returned by exchange_due()  @throws EngineError
  virtual void begin(StepWork& work, bool exchange) = 0;

  virtual void set_coefficients(const dem::ContactCoefficients& pair) = 0;
  /// @throws EngineError
  virtual void run(int steps, const StepTimes& times) = 0;

  /// Changes the ranks' parts: grains move to their ranks with all that they carry. @throws EngineError
  virtual void move_borders(std::span<const double> borders) = 0;

  /// Whether grains will change ranks in the next step; the same on all ranks.
  virtual bool exchange_due() const = 0;

  virtual OwnGrains own() = 0;
  virtual std::vector<NewGrain> own_state() = 0;
  virtual std::vector<PairRecord> own_pairs() = 0;
  virtual int own_ghosts() const = 0;
  virtual std::int64_t list_builds() const = 0;
  /// For tests of its effects: runs a line of LIGGGHTS' own language.
  virtual void command(const std::string& line) = 0;
};

/// @throws EngineError
using MakeEngine = Engine* (*)(const EngineSetup& setup);

}  // namespace furrow::terrain::liggghts
