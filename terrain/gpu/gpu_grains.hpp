// Grains on a GPU, through the library that steps them (gpu_interface.hpp), which is loaded when it is first needed.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/vec.hpp"
#include "terrain/dem/grain_solver.hpp"
#include "terrain/gpu/gpu_interface.hpp"

namespace furrow::terrain::gpu {

/// Why there is no library of the GPU beside this program, for messages; empty if there is one. Loads nothing.
std::string gpu_library_problem();
/// @throws Error(bad_input) without a library, a driver or a device
DeviceInfo gpu_device();

struct Histories {
  std::vector<Pair> pairs;
  std::vector<WallTouch> walls;
  std::vector<FacetTouch> facets;
};

/// Arrays of grains are in the order of their numbers.
struct GrainMotion {
  std::vector<Vec3> position, velocity, spin;  // m, m/s, rad/s
};

/// All functions throw Error: (limit) when memory runs out, (rank_lost) when the device fails.
class GpuGrains {
 public:
  /// @param order of the threads in an emulation, for tests
  explicit GpuGrains(const dem::SolverParams& params, int order = 0);

  void place(const GrainMotion& grains);
  void remember(const Histories& histories);
  void set_coefficients(const dem::SolverCoefficients& c);
  int count() const { return count_; }

  void attach(const Surface& surface);
  void set_surface_coefficients(int k, const dem::ContactCoefficients& c, bool rolls);
  void set_surface_motion(int k, std::span<const Vec3> end, double duration, const FacetGrid& grid, bool same_grid);
  void move_surfaces(double share);
  SurfaceSums surface_result(int k, std::span<Vec3> impulse);

  RunResult run(const Run& run);
  Hardest hardest(double above, double ahead);
  Sums sums(bool losses, double dt);
  Vec3 wall_impulse();
  /// @param all  velocities and spins too
  GrainMotion motion(bool all) const;
  Histories histories() const;

 private:
  struct Destroy {
    void operator()(Engine* engine) const;
  };
  std::unique_ptr<Engine, Destroy> engine_;
  int count_ = 0;
};

}  // namespace furrow::terrain::gpu
