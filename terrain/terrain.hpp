// The interface of every terrain: something that pushes back on the contact surfaces of tires.
//
// A terrain may span several ranks (TerrainContext::group). Each rank then has an object of its own, and every verb but
// save, restore and grains_here is called on all of them, in the same order and with the same arguments. What the verbs
// return holds for the whole terrain and counts on the leader, rank 0; frame gives each rank's own share. An advance
// that fails returns the same outcome on every rank; a rank that fails alone throws.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/progress_call.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"

namespace furrow::terrain {

/// Points for pictures: what a frame file holds.
struct TerrainFrame {
  std::vector<float> position;  // x y z per grain, m
  std::vector<float> speed;     // |v| per grain, m/s
  std::vector<float> radius;    // per grain, m
};

class Terrain {
 public:
  virtual ~Terrain() = default;

  /// Generates and settles the bed, or loads it from the cache. Returns its wall time, s.
  /// @throws Error(physics) when it cannot settle.
  virtual double prepare(const ProgressCall& progress) = 0;

  /// Highest point over the rectangle, m.
  virtual double top_height(double x_min, double x_max, double y_min, double y_max) const = 0;
  /// Mean surface height over the rectangle, m: mean over cells of 2r of the highest grain top.
  virtual double mean_height(double x_min, double x_max, double y_min, double y_max) const = 0;
  virtual double floor_height() const = 0;
  virtual HeightField height_field() const = 0;

  /// Declares the surface of tire `k` (k = 0, 1, … in order) before the first advance.
  /// @throws Error(bad_input) when mesh and positions do not belong together (terrain/surface/surface_check.hpp), the
  /// terrain's law has no use for the material, or the surface starts inside the terrain's solid boundary.
  virtual void attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) = 0;

  /// Advances by `duration` in `substeps` equal steps, or in more where its contacts need it. Each vertex moves
  /// linearly from where the terrain last had it to x + v·duration of targets[k], and its contact velocity is that
  /// motion's. forces[k] and contact[k] receive the interval's means.
  /// @returns failure when a grain is lost, a surface leaves the terrain or is not finite, or no step is stable
  /// @pre targets, forces and contact have one entry for each attached surface; duration > 0, substeps > 0
  virtual Outcome advance(std::span<const SurfaceState> targets, double duration, int substeps,
                          std::span<NodalForces> forces, std::span<ContactSums> contact) = 0;

  virtual TerrainState state() const = 0;
  virtual std::int64_t size() const = 0;                       // grains
  virtual std::int64_t grains_here() const { return size(); }  // on this rank now
  virtual void frame(TerrainFrame& out) const = 0;

  /// State for a continuation, including contact history and attached surfaces' last positions: of several ranks each
  /// its own. Bit for bit where the engine says so (TerrainDescription::exact_restart).
  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;
};

}  // namespace furrow::terrain
