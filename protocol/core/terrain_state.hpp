// Quantities that a terrain measures: its state, its contacts with each tire, and its surface.
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
  double transfer_force_residual = 0.0;  // |Σ nodal − Σ contact| / Σ|f|, this interval's largest
  double transfer_moment_residual = 0.0;  // |Σ x×nodal − Σ x×contact| / Σ|x×f|, taken about the surface's mean vertex
  double work = 0.0;                      // this interval: Σ_substeps f·Δx̃ of the vertices, J
  std::int64_t contacts = 0;              // of the last substep
  std::int64_t sliding = 0;               // of those, at the limit of friction; engine dem
};
void visit_fields(FieldsOf<ContactSums> auto& s, auto&& visit) {
  visit(s.force, Field{"force", "N"});
  visit(s.normal, Field{"normal", "N"});
  visit(s.tangential, Field{"tangential", "N"});
  visit(s.transfer_force_residual, Field{"transfer_force_residual"});
  visit(s.transfer_moment_residual, Field{"transfer_moment_residual"});
  visit(s.work, Field{"work", "J"});
  visit(s.contacts, Field{"contacts"});
  visit(s.sliding, Field{"sliding"});
}

/// Energy of a terrain by its form, and its losses by mechanism, each integrated on its own: no entry is computed as
/// the difference of others. In J, cumulative since the run began unless marked "now". The residual
///   residual = Δ stored() + losses() − surface_work − wall_work
/// is the error of the step (scripts/docs/terrain_models.md, Accounts).
struct TerrainEnergies {
  double kinetic = 0.0;             // ½ m v², now
  double rotational = 0.0;          // ½ I ω², now
  double potential = 0.0;           // of gravity, now
  double elastic_normal = 0.0;      // normal springs, now
  double elastic_tangential = 0.0;  // tangential and rolling springs, now
  double cohesion = 0.0;            // stored in adhesive contacts, now; if negative, parting them takes this energy
  double sliding_loss = 0.0;
  double normal_damping_loss = 0.0;
  double tangential_damping_loss = 0.0;
  double rolling_loss = 0.0;
  double opening_loss = 0.0;  // spring energy given up when contacts are loaded, unloaded and ended
  double sleep_loss = 0.0;    // by resting parts that are not stepped
  double surface_work = 0.0;  // by tires on the terrain
  double wall_work = 0.0;     // by walls and floor on the terrain
  double sample_error = 0.0;  // estimated standard error of losses() from sampling; 0: nothing is sampled

  double losses() const {
    return sliding_loss + normal_damping_loss + tangential_damping_loss + rolling_loss + opening_loss + sleep_loss;
  }
  double stored() const { return kinetic + rotational + potential + elastic_normal + elastic_tangential + cohesion; }
};
void visit_fields(FieldsOf<TerrainEnergies> auto& s, auto&& visit) {
  visit(s.kinetic, Field{"kinetic", "J"});
  visit(s.rotational, Field{"rotational", "J"});
  visit(s.potential, Field{"potential", "J"});
  visit(s.elastic_normal, Field{"elastic_normal", "J"});
  visit(s.elastic_tangential, Field{"elastic_tangential", "J"});
  visit(s.cohesion, Field{"cohesion", "J"});
  visit(s.sliding_loss, Field{"sliding_loss", "J"});
  visit(s.normal_damping_loss, Field{"normal_damping_loss", "J"});
  visit(s.tangential_damping_loss, Field{"tangential_damping_loss", "J"});
  visit(s.rolling_loss, Field{"rolling_loss", "J"});
  visit(s.opening_loss, Field{"opening_loss", "J"});
  visit(s.sleep_loss, Field{"sleep_loss", "J"});
  visit(s.surface_work, Field{"surface_work", "J"});
  visit(s.wall_work, Field{"wall_work", "J"});
  visit(s.sample_error, Field{"sample_error", "J"});
}

/// Momentum of a terrain and the impulses on it since the run began, each from its own forces. The residual
///   Δ grains − gravity_impulse − wall_impulse − surface_impulse − sleep_impulse
/// is round-off while nothing sleeps.
struct TerrainMomenta {
  Vec3 grains = Vec3::Zero();           // kg m/s, now
  Vec3 gravity_impulse = Vec3::Zero();  // N s
  Vec3 wall_impulse = Vec3::Zero();     // by walls and floor on the terrain, N s
  Vec3 surface_impulse = Vec3::Zero();  // by tires on the terrain, N s
  Vec3 sleep_impulse = Vec3::Zero();    // by whatever holds resting parts that are not stepped, N s
};
void visit_fields(FieldsOf<TerrainMomenta> auto& s, auto&& visit) {
  visit(s.grains, Field{"grains", "kg m/s"});
  visit(s.gravity_impulse, Field{"gravity_impulse", "N s"});
  visit(s.wall_impulse, Field{"wall_impulse", "N s"});
  visit(s.surface_impulse, Field{"surface_impulse", "N s"});
  visit(s.sleep_impulse, Field{"sleep_impulse", "N s"});
}

/// Momenta of a terrain without momentum, which the world holds: the walls give it the impulse that tires take.
inline TerrainMomenta held_by_the_world(const Vec3& surface_impulse) {
  TerrainMomenta momenta;
  momenta.surface_impulse = surface_impulse;
  momenta.wall_impulse = -surface_impulse;
  return momenta;
}

/// Measurements of a terrain; cumulative since the run began unless stated.
struct TerrainState {
  // Both are the engine's sums. The parts in `energies` add up to them but for round-off.
  double kinetic_energy = 0.0;  // J, now
  double elastic_energy = 0.0;  // of the springs that the engine sums, J, now
  double floor_force = 0.0;     // vertical, N, last substep
  std::int64_t contacts = 0;    // now
  std::int64_t active = 0;      // grains awake
  std::int64_t list_rebuilds = 0;
  std::int64_t substeps_added = 0;  // substeps beyond terrain.substeps, taken because contacts were too hard
  double refined_time = 0.0;        // time in which substeps were split, s
  std::int32_t most_parts = 1;      // largest number of parts of one substep
  TerrainEnergies energies{};
  TerrainMomenta momenta{};
};
void visit_fields(FieldsOf<TerrainState> auto& s, auto&& visit) {
  visit(s.kinetic_energy, Field{"kinetic_energy", "J"});
  visit(s.elastic_energy, Field{"elastic_energy", "J"});
  visit(s.floor_force, Field{"floor_force", "N"});
  visit(s.contacts, Field{"contacts"});
  visit(s.active, Field{"active"});
  visit(s.list_rebuilds, Field{"list_rebuilds"});
  visit(s.substeps_added, Field{"substeps_added"});
  visit(s.refined_time, Field{"refined_time", "s"});
  visit(s.most_parts, Field{"most_parts"});
  visit(s.energies, Field{"energies", ""});
  visit(s.momenta, Field{"momenta", ""});
}

/// Terrain surface on a regular grid: mean of the highest grain tops per cell; NaN where there is no grain.
struct HeightField {
  double x0 = 0.0, y0 = 0.0;  // centre of the first cell, m
  double cell = 0.0;          // m
  std::int32_t nx = 0, ny = 0;
  std::vector<double> height;  // m, [ix * ny + iy]
};
void visit_fields(FieldsOf<HeightField> auto& s, auto&& visit) {
  visit(s.x0, Field{"x0", "m"});
  visit(s.y0, Field{"y0", "m"});
  visit(s.cell, Field{"cell", "m"});
  visit(s.nx, Field{"nx"});
  visit(s.ny, Field{"ny"});
  visit(s.height, Field{"height", "m"});
}

}  // namespace furrow
