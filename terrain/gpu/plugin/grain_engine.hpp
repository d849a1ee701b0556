// Grains on a device: their state, lists and contacts, and the order of the kernels of a step.
//
// A step: move the surfaces; forces of pairs, walls, surfaces, in this order on each grain; move the grains; decide
// whether the next step may begin (ControlKernel). The host launches all steps of an interval and then waits once. If a
// step may not begin, the kernels launched after it do nothing; the host makes new lists and launches the rest.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "terrain/dem/contact/laws.hpp"
#include "terrain/gpu/plugin/facet_kernels.hpp"
#include "terrain/gpu/plugin/list_kernels.hpp"
#include "terrain/gpu/plugin/measure.hpp"
#include "terrain/gpu/plugin/motion_kernels.hpp"

namespace furrow::terrain::gpu {

class GrainEngine {
 public:
  explicit GrainEngine(const Setup& setup);

  void place(i32 count, const double (*position)[3], const double (*velocity)[3], const double (*spin)[3]);
  void remember(i64 pairs, const Pair* pair, i64 walls, const WallTouch* wall, i64 facets, const FacetTouch* facet);
  void set_coefficients(const dem::ContactCoefficients& pair, const dem::ContactCoefficients& floor,
                        const dem::ContactCoefficients& side);
  void attach(const gpu::Surface& surface);
  void set_surface_coefficients(int k, const dem::ContactCoefficients& c, bool rolls);
  void set_surface_motion(int k, const double (*end)[3], double duration, const FacetGrid& grid, bool same_grid);
  void move_surfaces(double share);
  void surface_result(int k, double (*impulse)[3], SurfaceSums& sums);
  RunResult run(const Run& run);
  Hardest hardest(double above, double ahead, double deepest);
  Sums sums(bool losses, double dt);
  void take_wall_impulse(double (&impulse)[3]);
  void motion(double (*position)[3], double (*velocity)[3], double (*spin)[3]);
  void read_histories();

  std::vector<Pair> pairs;
  std::vector<WallTouch> walls;
  std::vector<FacetTouch> facets;

 private:
  /// The state of all grains, twice: sorting copies it from one to the other.
  struct State {
    Buffer<Low> low, built;
    Buffer<High> high;
    Buffer<Motion> motion;
    Buffer<MotionRow> row;
    Buffer<Load> load;
    Buffer<u32> list, listed, touching;
    Buffer<SpringRow> spring, roll;
  };
  struct NearWalls {
    i32 count = 0;
    Buffer<u32> grain, entry_of;
    Buffer<WallSpring> spring;
    Buffer<i64> impulse;
    Buffer<double> floor;
    WallPointers pointers() const { return {count, grain.data(), spring.data(), impulse.data(), floor.data()}; }
  };
  struct NearSurface {
    i32 count = 0;
    Buffer<u32> grain, entry_of, touched;
    Buffer<FacetSpring> spring;
    Buffer<i64> sums;
  };
  struct TireSurface {
    i32 vertices = 0, triangles = 0;
    double duration = 1.0, fastest = 0.0;  // s, m/s
    bool rolls = false;
    double low[3] = {}, high[3] = {};                       // box of the coming interval, grown by a grain's radius, m
    double listed_low[3] = {1, 1, 1}, listed_high[3] = {};  // box for which grains near it were listed
    dem::ContactCoefficients coefficients;
    std::vector<Vector> end_host;
    Buffer<i32[3]> triangle, neighbour;
    Buffer<std::uint8_t> boundary;
    Buffer<i32> around_first, around, patch_first, patch_vertex, grid_first, grid_entry, grid_listed;
    Buffer<Vector> position, velocity, start, end;
    Buffer<FacetPlane> plane;
    Buffer<Patch> patch;
    Buffer<i64> impulse;
    FacetGridView grid{};
    i64 sums[kFacetSums] = {};  // of entries that there are no longer
    NearSurface near;
    SurfaceView view() const;
  };

  Pointers pointers(const State& s) const;
  Images images() const;
  void reserve(State& s, i64 count);
  void build();
  /// Lists the neighbours. @returns whether there was room for all
  bool list_neighbours(const Cells& cells);
  void find_near_walls(bool carry);
  void find_near_surface(TireSurface& s, const u32* order);
  void flush_walls();
  void flush_surface(TireSurface& s);
  /// Sums over entries of `width` numbers each.
  void add_entries(const i64* from, i64 count, i32 width, i64* to);
  i32 list_marked(Buffer<u32>& grain, Buffer<u32>& entry_of);
  void move_vertices(TireSurface& s, double share);
  void launch_forces(double dt, double kick);
  Control read_control();
  void write_control();
  /// Calls f(law, rolling) with the law itself and a std::bool_constant.
  template <class F>
  void with_law(const F& f) const {
    dem::with_law(dem::LawKind{setup_.law}, setup_.rolling != 0, false,
                  [&](auto law, auto rolling, auto) { f(law, rolling); });
  }
  template <class Law>
  PairParams<Law> pair_params(double dt) const;
  template <class Law>
  WallParams<Law> wall_params(double dt, double kick) const;
  template <class Law>
  FacetParams<Law> facet_params(const TireSurface& s, double dt, double kick) const;
  double fastest_vertex() const;
  /// Whether pairs have springs, and those that resist rolling.
  bool has_springs() const { return dem::has_history(dem::LawKind{setup_.law}); }
  bool has_rolls() const { return has_springs() && setup_.rolling != 0; }

  Setup setup_;
  dem::Bin bin_;
  Device device_;
  double unit_, per_unit_;
  i32 count_ = 0, slots_ = 16;
  i64 max_slots_ = 0, rebuilds_ = 0;
  bool listed_ = false;
  double top_height_ = 0.0;  // of the grains when lists were made, m
  dem::ContactCoefficients pair_, floor_, side_;
  Control control_{};  // copy on the host
  Buffer<Control> control_at_;
  State state_, spare_;
  NearWalls near_walls_, spare_walls_;
  NearSurface spare_near_;
  i64 wall_sums_[3] = {};
  std::vector<std::unique_ptr<TireSurface>> surfaces_;
  Buffer<u32> key_, place_, sorted_key_, order_, start_, flag_, flag_sums_, most_;
  Buffer<u64> top_;
  Buffer<Measured> measured_, pieces_, more_pieces_;
  Buffer<i64> added_, more_added_;
  Buffer<HardResult> hard_;
};

}  // namespace furrow::terrain::gpu
