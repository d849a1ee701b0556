// Interface between Furrow and the library that steps grains on a GPU (plugin/): C functions in one table, plain data,
// no exceptions across. Both sides share only this header, the bin and the contact laws.
//
// A step evaluates the forces at the present positions, then kicks and drifts the grains:
//   v ← v + kick (F/m + g),   ω ← ω + kick T/I,   x ← x + dt v.
// Grains are named by their numbers 0 … count − 1; arrays of grains are in that order. All results depend on the state
// alone: not on the order in which a device runs its threads, nor on when lists of neighbours were made.
#pragma once

#include <cstdint>

#include "terrain/dem/contact/laws.hpp"

namespace furrow::terrain::gpu {

/// Changes with this header; a library made for another number is refused.
inline constexpr int kAbi = 3;
/// The library's only symbol: a function of type GetApi.
inline constexpr char kApiSymbol[] = "furrow_gpu_api";

enum class Status : std::int32_t {
  done = 0,
  no_device = 1,  // no driver, or no device that it finds
  memory = 2,     // the device's memory is exhausted
  failed = 3,     // the device or its driver failed
  fault = 4,      // of the library
};

/// Why a call did not succeed, one line.
struct Why {
  char text[512];
};

struct DeviceInfo {
  char name[256];
  std::int32_t driver, runtime;  // CUDA version that the driver supports, that of the library: 1000 major + 10 minor
  std::int64_t memory;           // bytes
  std::int32_t emulated;         // 1: the processor runs the kernels
};

struct Setup {
  double length, width;  // of the bin, m
  std::int32_t periodic_x, periodic_y;
  double radius, mass, inertia;  // of every grain, m, kg, kg m²
  double gravity[3];             // m/s²
  double skin;                   // neighbours are listed if their surfaces are closer than this, m
  std::int32_t law;              // index in dem::Laws
  std::int32_t rolling;          // 1: grains resist rolling
  std::int32_t order;            // of threads in the emulation: 0 forward, 1 reversed, 2 shuffled
};

/// Histories have the springs on grain i; in the arrays of pairs i < j.
struct Pair {
  std::int32_t i, j;
  float tangential[3], root_overlap, rolling[3];  // N, √m, N m
};
struct WallTouch {
  std::int32_t grain, wall;                        // the wall's number as in dem/bin.hpp
  double tangential[3], root_overlap, rolling[3];  // N, √m, N m
};
struct FacetTouch {
  std::int32_t grain, surface;
  double normal[3], tangential[3], root_overlap, rolling[3];  // -, N, √m, N m
};

/// The surface of a tire. `neighbour`, `boundary` and `around` are those of SurfaceTopology, patches those of
/// SurfacePatches.
struct Surface {
  std::int32_t vertices, triangles;
  const std::int32_t (*triangle)[3];
  const std::int32_t (*neighbour)[3];
  const std::uint8_t* boundary;
  const std::int32_t *around_first, *around;  // vertices + 1 entries; 3 triangles entries
  const std::int32_t *patch_first, *patch;    // triangles + 1 entries; as many as its last
  const double (*position)[3];                // m
};

/// Cells with lists of the triangles that a grain in them may touch (SurfaceGrid). @param listed triangles in any cell
struct FacetGrid {
  double origin[3], inverse_cell;
  std::int32_t cells[3];
  const std::int32_t* first;  // of each cell, and the end of the last
  const std::int32_t* entry;
  std::int32_t listed_count;
  const std::int32_t* listed;
  double low[3], high[3];  // box of the surface in the coming interval, grown by a grain's radius, m
};

/// Equal whole steps, or a part of one.
struct Run {
  std::int32_t steps;
  double dt, since;   // s: of each, and of the part before the first
  double share;       // of the surfaces' interval at which the first begins
  double share_each;  // of a step
  double most;        // stop before a step in which contacts may overlap by more, m; infinite: never
  double drag;        // extra damping of all motion, 1/s
};

enum class Stop : std::int32_t { none = 0, overlap = 1, lost = 2 };
struct RunResult {
  std::int32_t done;  // steps
  Stop stop;
  std::int32_t lost;                // number of a grain that left the bin or is not finite
  double max_overlap;               // largest that was evaluated, m
  double last_overlap, last_speed;  // largest of the last step, m, m/s
};

/// The deepest contacts at the present positions (dem/refinement/hard_contacts.hpp).
struct Hardest {
  std::int64_t count, past;
  double overlap, coming, share;
  // of the contact with the largest share:
  std::int32_t grain;
  std::int32_t kind;     // 0 two grains, 1 a wall, 2 a surface
  std::int32_t partner;  // wall or surface
};

/// Sums over all grains and contacts at the present positions, except as stated.
struct Sums {
  double speed2, spin2;         // Σ v², Σ ω², m²/s², rad²/s²
  double speed[3], place[3];    // Σ v, Σ x, m/s, m
  double elastic;               // normal springs and cohesion, J
  double contacts, listed;      // pairs and others that touch, pairs in lists
  double contact_force;         // Σ |F| over contacts, N
  double net_force;             // Σ |F + m g| over grains, N
  double cohesion, tangential;  // stored, J
  double losses[5];             // W, in the order of dem::Losses; with the step `dt`
  double floor_force;           // in the last step, N
  std::int64_t rebuilds;        // of the lists, since the library's engine was made
  std::int64_t bytes;           // of device memory
  double top;                   // height that no grain exceeds, m
};

/// Sums over one surface since the last call.
struct SurfaceSums {
  double normal[3], tangential[3];   // impulse on the surface, N s
  double moment_gap[3];              // Σ x × f of the vertices less that of contacts, N m s
  double force_scale, moment_scale;  // Σ|f| , Σ|x × f|, times time
  std::int64_t contacts, sliding;    // in the last step
};

struct Engine;

struct Api {
  int abi;
  Status (*device)(DeviceInfo*, Why*);
  Status (*make)(const Setup*, Engine**, Why*);
  void (*destroy)(Engine*);

  Status (*place)(Engine*, std::int32_t count, const double (*position)[3], const double (*velocity)[3],
                  const double (*spin)[3], Why*);
  /// Sets histories of touching grains, walls and surfaces. @pre grains were placed and surfaces attached
  Status (*remember)(Engine*, std::int64_t pairs, const Pair*, std::int64_t walls, const WallTouch*,
                     std::int64_t facets, const FacetTouch*, Why*);
  Status (*coefficients)(Engine*, const dem::ContactCoefficients* pair, const dem::ContactCoefficients* floor,
                         const dem::ContactCoefficients* side, Why*);

  Status (*attach)(Engine*, const Surface*, Why*);
  Status (*surface_coefficients)(Engine*, std::int32_t surface, const dem::ContactCoefficients*, std::int32_t rolls,
                                 Why*);
  /// The coming interval, s: vertices move from their present positions to `end`.
  Status (*surface_motion)(Engine*, std::int32_t surface, const double (*end)[3], double duration, const FacetGrid*,
                           std::int32_t same_grid, Why*);
  /// Moves all surfaces to a share of the interval.
  Status (*move_surfaces)(Engine*, double share, Why*);
  /// Impulses on the vertices, N s, and sums since the last call.
  Status (*surface_result)(Engine*, std::int32_t surface, double (*impulse)[3], SurfaceSums*, Why*);

  Status (*run)(Engine*, const Run*, RunResult*, Why*);
  /// @param deepest share of a diameter above which contacts are counted in Hardest::past
  Status (*hardest)(Engine*, double above, double ahead, double deepest, Hardest*, Why*);
  /// @param losses 1: of the coming step of `dt`, s
  Status (*sums)(Engine*, std::int32_t losses, double dt, Sums*, Why*);
  /// Impulse of the walls on the grains since the last call, N s.
  Status (*wall_impulse)(Engine*, double impulse[3], Why*);
  Status (*motion)(Engine*, double (*position)[3], double (*velocity)[3], double (*spin)[3], Why*);
  /// Histories of all touching contacts. The arrays belong to the engine until its next call.
  Status (*histories)(Engine*, std::int64_t* pairs, const Pair**, std::int64_t* walls, const WallTouch**,
                      std::int64_t* facets, const FacetTouch**, Why*);
};

using GetApi = const Api* (*)();

}  // namespace furrow::terrain::gpu
