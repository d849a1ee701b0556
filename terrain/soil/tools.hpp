// The tools of soil tests: rigid triangulated surfaces, moved as a whole.
#pragma once

#include "protocol/core/assert.hpp"
#include "protocol/core/surface.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain::soil {

class Tool {
 public:
  Tool(SurfaceMesh mesh, std::vector<Vec3> vertices) : mesh_(std::move(mesh)) {
    state_.position = std::move(vertices);
    state_.velocity.assign(state_.position.size(), Vec3::Zero());
    mesh_.vertex_count = static_cast<int>(state_.position.size());
  }

  const SurfaceMesh& mesh() const { return mesh_; }
  const SurfaceState& state() const { return state_; }  // input of Terrain::advance

  void set_velocity(const Vec3& v) { state_.velocity.assign(state_.velocity.size(), v); }
  void set_velocity(std::size_t vertex, const Vec3& v) {
    FURROW_ASSERT(in_range(vertex, state_.velocity.size()), vertex, state_.velocity.size());
    state_.velocity[vertex] = v;
  }
  /// Moves the tool to the end of an interval.
  void moved(double duration) {
    FURROW_ASSERT(duration > 0.0, duration);
    for (std::size_t a = 0; a < state_.position.size(); ++a) state_.position[a] += duration * state_.velocity[a];
  }

 private:
  SurfaceMesh mesh_;
  SurfaceState state_;
};

/// A plate b wide along x about x = centre, from y = −half to half, its lower face at z, with sides `height` high.
Tool strip_plate(double centre, double width, double half, double z, double height);
/// A round plate about (x, y), its lower face at z, with sides `height` high: a polygon with the area of the circle.
Tool disc_plate(double x, double y, double diameter, double z, double height);

/// A sheet from x = from to `to` and y = −half to half with flats at z and ridges across x, one every `pitch`. Their
/// section is a triangle 2·`tooth` wide and `tooth` high. The outside and the teeth face up (sign 1) or down (sign −1).
/// @pre from < to; pitch, tooth > 0
Tool toothed_sheet(double from, double to, double half, double z, double pitch, double tooth, int sign);

/// A flat sheet over the same rectangle, with its outside down.
Tool flat_sheet(double from, double to, double half, double z);
/// The flat sheet with closely packed half-spheres of this radius glued to it, made of facets a third of the radius
/// wide.
/// @pre from < to; radius > 0
Tool studded_sheet(double from, double to, double half, double z, double radius);

/// A cone of this base diameter and total angle (rad), point down at (x, y, z), with a shaft of `shaft` × its diameter.
Tool cone_on_shaft(const Vec3& point, double diameter, double angle, double shaft, double shaft_length);
/// Height of such a cone, m.
double cone_height(double diameter, double angle);
/// Area of the cone's base as meshed, m².
double cone_base_area(double diameter);

/// Material as rough as the grains, without cohesion.
ContactMaterial rough_material(const dem::DemOptions& grains);
/// Polished steel: friction of the grains, at most 0.3.
ContactMaterial smooth_material(const dem::DemOptions& grains);

}  // namespace furrow::terrain::soil
