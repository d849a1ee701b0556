// Empirical soil: a grid of nodes that sink after Bekker and Wong and hold sideways after Mohr, Coulomb and Janosi.
// What it knows of a soil are plate and shear tests; a run costs little more than its tire.
//
// Each node of the grid under a surface (terrain/scm/footprint.hpp) carries the pressure p of its sinkage over the area
// A of a cell, and shear τ (terrain/scm/pressure_sinkage.hpp, janosi_shear.hpp). With n the normal into the surface,
//
//   F = p A n/|n_z| − τ_max m A/|n_z|:
//
// pressure and shear act on the inclined area A/|n_z|, so that p's work is p A dz of the node, sideways motion
// included: compaction makes the resistance of a wheel. F goes to the vertices of the triangle above the node.
//
// The mobilized share m belongs to the soil that clings to the surface and moves along with it over the nodes:
//
//   ∂m/∂t + w·∇m = (v̂ − m) |v|/K,  w the surface's velocity along the ground,
//
// first order upwind. In steady rolling that is Wong & Reece's j, counted along the wheel's rim from where it enters; m
// kept at the node would give j/(1 − slip). Surface that comes down on a node brings m = 0.
//
// Everything is summed in one order by one thread: the bits do not depend on the number of threads.
#pragma once

#include <memory>

#include "terrain/scm/scm_options.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain::scm {

/// @throws Error(bad_input) when a value is out of range or the grid has more nodes than can be counted
std::unique_ptr<Terrain> make_scm_ground(const ScmOptions& options);

/// @throws Error(bad_input) likewise
void check_scm_options(const ScmOptions& options);

/// @param width of a surface that the ground has to bear, m
/// @throws Error(bad_input) where the grid is too coarse for it, or the soil bears nothing of its width
void check_scm_width(const ScmOptions& options, double width);

/// Nodes of the grid. @pre check_scm_options found nothing wrong
std::int64_t scm_nodes(const ScmOptions& options);

/// Of the running terrain and of a checkpoint's part, bytes per node.
inline constexpr double kMemoryPerNode = 32.0, kSavedPerNode = 24.0;

}  // namespace furrow::terrain::scm
