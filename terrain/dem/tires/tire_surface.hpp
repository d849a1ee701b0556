// The surface of a tire among grains: its motion within an interval, and its saved state.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"
#include "terrain/surface/surface_check.hpp"
#include "terrain/surface/surface_collider.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain::dem {

struct TireSurface {
  SurfaceCollider collider;
  NodalForceSum sum;
  ContactMaterial material;
  double mass_share;             // as for surface_scale
  std::vector<Vec3> start, end;  // of the interval, m
  ContactCoefficients coefficients;
  SurfaceBox near;  // bounds now, grown by the largest radius
  std::vector<SurfaceContactForce> forces;

  /// @param reach radius of the largest grain, m  @param tangents whether tangents are wanted
  TireSurface(const SurfaceMesh& mesh, double reach, bool tangents, const GrainProperties& grain,
              const ContactMaterial& of_tire, const SurfaceState& at)
      : collider(mesh, reach),
        sum(mesh.vertex_count, tangents, SurfacePatches(mesh, at.position, grain.radius)),
        material(of_tire),
        mass_share(dem::mass_share(grain, of_tire)),
        start(at.position),
        end(at.position) {
    collider.set_motion(start, end, 1.0);
  }
  /// Begins an interval. @returns the displacement of the fastest vertex, m
  double set_target(const SurfaceState& target, double duration) {
    FURROW_ASSERT(duration > 0.0, duration);
    start.swap(end);
    double farthest2 = 0.0;
    for (std::size_t a = 0; a < end.size(); ++a) {
      end[a] = target.position[a] + duration * target.velocity[a];
      farthest2 = std::max(farthest2, (end[a] - start[a]).squaredNorm());
    }
    collider.set_motion(start, end, duration);
    return std::sqrt(farthest2);
  }
  /// Moves the surface to a share of the interval. @param largest radius of a grain, m
  void move_to(double share, double largest) {
    collider.move_to(share);
    near = collider.bounds();
    near.lo.array() -= largest, near.hi.array() += largest;
  }
  /// The patch on which a couple at the point acts; none if the surface does not resist rolling.
  std::optional<PatchTurn> patch_at(const SurfaceHit& hit, bool rolling) const {
    if (!rolling) return std::nullopt;
    return std::optional<PatchTurn>(std::in_place, sum.patches().of(hit.triangle), collider.positions());
  }
  /// Coefficients against a grain of this radius.
  template <class Law>
  auto against(double reference, double radius) const {
    return sized_surface<Law>(coefficients.of<Law>(), reference, radius, mass_share);
  }
};

/// @param word name of one of them in the saved state
template <class Surfaces>
void save_surfaces(Archive& archive, const std::string& word, const Surfaces& surfaces) {
  archive.put(word + "s/count", static_cast<std::int64_t>(surfaces.size()));
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const Archive::Scope scope(archive, word + std::to_string(k) + "/");
    save_fields(archive, "mesh", surfaces[k].collider.mesh());
    save_value(archive, "position", surfaces[k].end);
    save_fields(archive, "material", surfaces[k].material);
    save_fields(archive, "patches", surfaces[k].sum.patches());
  }
}

/// Replaces the surfaces through attach(mesh, material, start); if there are any, they must be those of the same tires.
/// @throws Error(io) when they are different
template <class Surfaces, class Attach>
void restore_surfaces(const Archive& archive, const std::string& word, Surfaces& surfaces, const Attach& attach) {
  const auto count = archive.get_int(word + "s/count");
  if (count < 0 || (!surfaces.empty() && static_cast<std::size_t>(count) != surfaces.size()))
    throw Error(ExitCode::io, fmt::format("saved state holds {} {}s, expected {}", count, word, surfaces.size()));
  const Surfaces before = std::exchange(surfaces, {});
  for (std::int64_t k = 0; k < count; ++k) {
    const Archive::Scope scope(archive, word + std::to_string(k) + "/");
    SurfaceMesh mesh;
    SurfaceState start;
    ContactMaterial material;
    restore_fields(archive, "mesh", mesh);
    restore_value(archive, "position", start.position, mesh.vertex_count);
    restore_fields(archive, "material", material);
    check_surface(mesh, start, static_cast<int>(k));
    if (!before.empty() && start.position.size() != before[k].end.size())
      throw Error(ExitCode::io, fmt::format("saved state of {} {} is of another tire", word, k));
    attach(mesh, material, start);
    SurfacePatches patches;
    restore_fields(archive, "patches", patches);
    surfaces.back().sum.set_patches(std::move(patches));
  }
}

}  // namespace furrow::terrain::dem
