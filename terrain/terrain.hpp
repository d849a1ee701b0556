// The interface of every terrain: a body that exerts forces on the contact surfaces of tires.
//
// A terrain may span several ranks (TerrainContext::group), each with an object of its own. Every rank calls prepare,
// attach, advance and all functions named gather_…, in the same order and with the same arguments. Results describe the
// whole terrain and are valid on the leader, rank 0. An advance that fails returns the same outcome on every rank; a
// rank that fails alone throws.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/progress_call.hpp"
#include "protocol/core/stated_contact.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"

namespace furrow::terrain {

/// Points for pictures; the contents of a frame file.
struct TerrainFrame {
  std::vector<float> position;  // x y z per grain, m
  std::vector<float> speed;     // |v| per grain, m/s
  std::vector<float> radius;    // per grain, m
  // Engine dem fills these if `motion` is set.
  bool motion = false;
  std::vector<float> velocity = {};  // x y z per grain, m/s
  std::vector<float> spin = {};      // x y z per grain, rad/s
};

class Terrain {
 public:
  virtual ~Terrain() = default;

  /// Generates and settles the bed, or loads it from the cache. Returns the wall time of this, s.
  /// @throws Error(physics) when it cannot settle.
  double prepare(const ProgressCall& progress);

  /// Highest point over the rectangle, m.
  virtual double gather_top_height(double x_min, double x_max, double y_min, double y_max) const = 0;
  /// Mean surface height over the rectangle, m: mean over cells of 2r of the highest grain top.
  virtual double gather_mean_height(double x_min, double x_max, double y_min, double y_max) const = 0;
  virtual HeightField gather_height_field() const = 0;
  virtual double floor_height() const = 0;  // m

  /// Declares the surface of tire `k` (k = 0, 1, … in order) before the first advance.
  /// @throws Error(bad_input) when mesh and positions do not belong together (terrain/surface/surface_check.hpp), the
  /// terrain's law cannot use the material, or the surface starts inside the terrain's solid boundary.
  void attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start);

  /// Sets stated contacts for the next advance, one for each attached surface. A surface whose contact is given gets
  /// its forces and no others. @pre none is given unless TerrainDescription::takes_stated_contacts; the vertices exist
  virtual void state_contacts(std::span<const StatedContact> contacts);

  /// Advances by `duration` in `substeps` equal steps, or in more if its contacts need them. Each vertex moves linearly
  /// from its last position in the terrain to x + v·duration of targets[k], and its contact velocity is that of this
  /// motion. forces[k] and contact[k] receive the interval's means.
  /// @returns failure when a grain is lost, a surface leaves the terrain or is not finite, or no step is stable
  /// @pre prepared or restored; targets, forces and contact have one entry for each attached surface, with all its
  /// vertices; duration > 0, substeps > 0
  Outcome advance(std::span<const SurfaceState> targets, double duration, int substeps, std::span<NodalForces> forces,
                  std::span<ContactSums> contact);

  /// Computes with this number of threads from now on, where the engine has threads. Results do not depend on it.
  /// @pre threads > 0
  virtual void set_threads(int threads);

  virtual TerrainState gather_state() const = 0;
  /// Each rank gets its share of the frame, or the leader gets all of it.
  virtual void gather_frame(TerrainFrame& out) const = 0;
  virtual std::int64_t size() const = 0;                       // grains
  virtual std::int64_t grains_here() const { return size(); }  // on this rank now

  /// State for a continuation, with contact history and last positions of the attached surfaces; each rank saves its
  /// own. Exact to the bit if the engine promises this (TerrainDescription::exact_restart).
  virtual void save(Archive& archive) const = 0;
  void restore(const Archive& archive);

 protected:
  /// @param prepared  whether there is nothing to prepare
  explicit Terrain(bool prepared = false) : prepared_(prepared) {}

 private:
  virtual double do_prepare(const ProgressCall& progress) = 0;
  virtual void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) = 0;
  /// Advances, after advance() has checked its arguments.
  virtual Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                             std::span<NodalForces> forces, std::span<ContactSums> contact) = 0;
  virtual void do_restore(const Archive& archive) = 0;
  virtual std::size_t attached() const = 0;               // surfaces
  virtual std::size_t vertices(std::size_t k) const = 0;  // of attached surface k

  bool prepared_;
};

}  // namespace furrow::terrain
