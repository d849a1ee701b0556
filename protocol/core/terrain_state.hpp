// What a terrain measures: of itself, of its contacts with each tire, and of its surface.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Sums over the contacts of one tire, interval means; force = normal + tangential, on the tire by the terrain.
struct ContactSums {
  Vec3 force = Vec3::Zero();             // N
  Vec3 normal = Vec3::Zero();            // N
  Vec3 tangential = Vec3::Zero();        // N
  Vec3 moment = Vec3::Zero();            // about the world origin, N m
  double transfer_force_residual = 0.0;  // |Σ nodal − Σ contact| / Σ|f|, this interval's largest
  double transfer_moment_residual =
      0.0;            // |Σ x×nodal − Σ x×contact| / Σ|x×f|, taken about the surface's mean vertex
  double work = 0.0;  // this interval: Σ_substeps f·Δx̃ of the vertices, J
  std::int64_t contacts = 0;  // of the last substep
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ContactSums> auto& s) {
  visit(Field{"force", "N"}, s.force);
  visit(Field{"normal", "N"}, s.normal);
  visit(Field{"tangential", "N"}, s.tangential);
  visit(Field{"moment", "N m"}, s.moment);
  visit(Field{"transfer_force_residual"}, s.transfer_force_residual);
  visit(Field{"transfer_moment_residual"}, s.transfer_moment_residual);
  visit(Field{"work", "J"}, s.work);
  visit(Field{"contacts"}, s.contacts);
}

/// What the terrain measures of itself; cumulative since the run began unless stated.
struct TerrainState {
  double kinetic_energy = 0.0;       // J, now
  double potential_energy = 0.0;     // of gravity, J, now
  double elastic_energy = 0.0;       // of normal springs, J, now
  double dissipation = 0.0;          // −∫ contact forces · relative velocity dt − Δ elastic energy, J
  double energy_removed = 0.0;       // by the activity switch, J
  Vec3 momentum = Vec3::Zero();      // kg m/s, now
  Vec3 momentum_removed = Vec3::Zero();  // by the activity switch, kg m/s
  Vec3 wall_impulse = Vec3::Zero();  // by walls and floor on the grains, N s
  Vec3 surface_impulse = Vec3::Zero();  // by tires on the grains, N s
  double floor_force = 0.0;             // vertical, N, last substep
  std::int64_t contacts = 0;            // now
  std::int64_t active = 0;              // grains awake
  std::int64_t list_rebuilds = 0;
  std::int64_t substeps_added = 0;  // beyond terrain.substeps, where contacts were too hard for them
  double refined_time = 0.0;        // in which substeps were taken in parts, s
  std::int32_t most_parts = 1;      // of one substep
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TerrainState> auto& s) {
  visit(Field{"kinetic_energy", "J"}, s.kinetic_energy);
  visit(Field{"potential_energy", "J"}, s.potential_energy);
  visit(Field{"elastic_energy", "J"}, s.elastic_energy);
  visit(Field{"dissipation", "J"}, s.dissipation);
  visit(Field{"energy_removed", "J"}, s.energy_removed);
  visit(Field{"momentum", "kg m/s"}, s.momentum);
  visit(Field{"momentum_removed", "kg m/s"}, s.momentum_removed);
  visit(Field{"wall_impulse", "N s"}, s.wall_impulse);
  visit(Field{"surface_impulse", "N s"}, s.surface_impulse);
  visit(Field{"floor_force", "N"}, s.floor_force);
  visit(Field{"contacts"}, s.contacts);
  visit(Field{"active"}, s.active);
  visit(Field{"list_rebuilds"}, s.list_rebuilds);
  visit(Field{"substeps_added"}, s.substeps_added);
  visit(Field{"refined_time", "s"}, s.refined_time);
  visit(Field{"most_parts"}, s.most_parts);
}

/// Terrain surface on a regular grid: mean of the highest grain tops per cell; NaN where no grain is.
struct HeightField {
  double x0 = 0.0, y0 = 0.0;  // centre of the first cell, m
  double cell = 0.0;          // m
  std::int32_t nx = 0, ny = 0;
  std::vector<double> height;  // m, [ix * ny + iy]
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<HeightField> auto& s) {
  visit(Field{"x0", "m"}, s.x0);
  visit(Field{"y0", "m"}, s.y0);
  visit(Field{"cell", "m"}, s.cell);
  visit(Field{"nx"}, s.nx);
  visit(Field{"ny"}, s.ny);
  visit(Field{"height", "m"}, s.height);
}

}  // namespace furrow
