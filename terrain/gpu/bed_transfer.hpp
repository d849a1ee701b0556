// Grains and their histories between the solver of terrain/dem and a GPU.
#pragma once

#include "terrain/dem/grain_solver.hpp"
#include "terrain/gpu/gpu_grains.hpp"

namespace furrow::terrain::gpu {

/// Places the solver's grains on the GPU, with all that they remember. Positions are rounded to the GPU's grid.
void send_bed(const dem::GrainSolver& solver, GpuGrains& to);

/// Sets the solver's grains from the GPU.
void fetch_bed(const GpuGrains& from, dem::GrainSolver& solver);
/// The same from what was read from the GPU or a file. @pre grains have the solver's radius
void set_bed(const GrainMotion& grains, const Histories& histories, dem::GrainSolver& solver);

}  // namespace furrow::terrain::gpu
