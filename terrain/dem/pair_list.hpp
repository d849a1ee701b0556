// Who may touch whom: fixed blocks of neighbouring grains, each with the list of its pairs.
//
// Grains are sorted by grid cell, x slowest, so that a block of kBlockGrains consecutive grains is a slab of the bin
// and most of its pairs (i, j > i) stay inside. Data flow of one step:
//   1. each block (one thread) filters its pairs by distance, evaluates the law on the touching ones, adds the forces
//      of inner pairs to its own grains, and leaves the reaction of outer pairs (j in a later block) in a slot;
//   2. each block adds the slots that point to it, in fixed order, and integrates.
// No thread writes another's grain, and the order of every sum is fixed by the list: the bits do not depend on the
// number of threads. A listed pair that does not touch keeps zero history and a zero slot.
#pragma once

#include <cstdint>
#include <vector>

#include "terrain/dem/grains.hpp"

namespace furrow::dem {

inline constexpr int kBlockGrains = 1024;

/// A grain near a wall of the bin.
struct WallContact {
  std::int32_t grain = 0;
  std::int32_t wall = 0;
  Quad tangential;  // history: spring force, N; w = √δ of the step before
  Quad rolling;     // history: rolling spring, N m
};

/// Where a block finds a reaction: slot of another block, for a grain of its own.
struct Incoming {
  std::int32_t block = 0;
  std::int32_t slot = 0;
  std::int32_t grain = 0;
};

/// Sums over a block's contacts and grains in one step.
struct BlockSums {
  double power = 0.0;          // Σ F·v_rel at the step's start, W
  double elastic = 0.0;        // J
  double contact_force = 0.0;  // Σ |F|, N, when measured
  double net_force = 0.0;      // Σ |contact forces + weight| of grains, N, when measured
  double max_overlap = 0.0;    // m
  Quad wall_force;             // on the grains, N
  double floor_force = 0.0;    // N
  double surface_power = 0.0;  // Σ F·v_rel against tires, W
  std::int64_t contacts = 0;
  double kinetic = 0.0;    // after the step, J
  double height = 0.0;     // Σ z after the step, m
  Quad velocity;           // Σ v after the step, m/s
  double step_work = 0.0;  // Σ F·a + T·α: half of it times dt² belongs to the power at mid-step, N²/kg
  double max_travel2 = 0.0;  // since listed, m²
  std::int32_t lost = -1;    // index of a grain outside the bin or not finite
};

struct PairBlock {
  std::int32_t first = 0, last = 0;  // grains
  // Pairs, inner ones first; both parts padded to a multiple of kLanes with (first, stranger).
  std::int32_t inner = 0, pairs = 0;  // padded counts
  std::vector<std::int32_t> i, j;
  std::vector<std::uint8_t> touching;  // bit k of entry p/4: pair p touched in the last step
  std::vector<Quad> tangential;        // history per pair: spring force on i, N; w = √δ
  std::vector<Quad> rolling;           // history per pair, N m; empty without rolling resistance
  std::vector<Quad> slot_force;        // per outer pair: force on i, N
  std::vector<Quad> slot_torque;       // per outer pair: torque on j, N m
  std::vector<Incoming> incoming;
  std::vector<WallContact> walls;
  double x_min = 0.0, x_max = 0.0;  // of the centres when listed, m
  BlockSums sums;
};

/// The five walls of the bin as n·x ≥ offset, n inward.
inline constexpr int kWalls = 5;
inline constexpr int kFloor = 4;
struct Bin {
  double length = 0.0;  // x from 0, m
  double width = 0.0;   // y from −width/2, m
  /// Distance of a point from wall w: 0 x=0, 1 x=length, 2 y=−width/2, 3 y=width/2, 4 floor.
  double distance(int wall, const Quad& p) const {
    switch (wall) {
      case 0:
        return p.x;
      case 1:
        return length - p.x;
      case 2:
        return p.y + 0.5 * width;
      case 3:
        return 0.5 * width - p.y;
      default:
        return p.z;
    }
  }
  static Triple<double> normal(int wall) {
    constexpr Triple<double> kNormal[kWalls] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    return kNormal[wall];
  }
};

class PairList {
 public:
  struct Options {
    double radius = 0.0;   // m
    double skin = 0.0;     // pairs closer than 2 r + skin are listed, m
    bool history = true;   // keep tangential history
    bool rolling = false;  // keep rolling history
    Bin bin;
  };

  explicit PairList(const Options& options) : options_(options) {}

  /// Sorts the grains by cell and lists all pairs, carrying the history over. `order[new] = old` index of each grain.
  void rebuild(Grains& grains, int threads, std::vector<std::int32_t>& order);

  const Options& options() const { return options_; }
  std::vector<PairBlock>& blocks() { return blocks_; }
  const std::vector<PairBlock>& blocks() const { return blocks_; }
  std::int64_t rebuilds() const { return rebuilds_; }
  void set_rebuilds(std::int64_t n) { rebuilds_ = n; }

  /// Completes blocks whose pairs, history and walls were read from a saved state.
  void finish(const Grains& grains);
  /// Gives a block its arrays for `inner` + `pairs − inner` pairs.
  void size_block(PairBlock& block) const;

 private:
  struct Cells {
    double x0 = 0.0, y0 = 0.0, inverse = 0.0;
    int nx = 1, ny = 1, nz = 1;
    std::vector<std::int32_t> start;  // first grain of each cell, z fastest
    std::vector<std::int32_t> cell;   // of each grain
  };
  void sort_by_cell(Grains& grains, int threads, std::vector<std::int32_t>& order);
  void list_block(const Grains& grains, PairBlock& block) const;
  void list_walls(const Grains& grains, PairBlock& block) const;
  void carry_history(const Grains& grains, const std::vector<PairBlock>& old,
                     const std::vector<std::int32_t>& order, int threads);
  void link_slots();

  Options options_;
  std::vector<PairBlock> blocks_;
  Cells cells_;
  std::int64_t rebuilds_ = 0;
};

}  // namespace furrow::dem
