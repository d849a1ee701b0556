// A few grains as in the engine: the law between grains in single precision, everything else in double.
#pragma once

#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::verification {

struct EngineGrains : terrain::dem::FewGrains {
  EngineGrains() { precision = terrain::dem::Precision::mixed; }
};

/// Attaches a surface that does not move.
inline void attach(terrain::dem::GrainSolver& s, const testing::Surface& surface,
                   const terrain::dem::ContactCoefficients& k) {
  s.surfaces().attach(surface.mesh, {}, k, testing::at_rest(surface));
  s.surfaces().move_to(0.0);
}

}  // namespace furrow::verification
