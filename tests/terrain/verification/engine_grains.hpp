// A few grains as the engine runs them: the law between grains in single precision, all else in double.
#pragma once

#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::verification {

struct EngineGrains : terrain::dem::FewGrains {
  EngineGrains() { precision = terrain::dem::Precision::mixed; }
};

/// A surface that stays where it is.
inline void attach(terrain::dem::GrainSolver& s, const testing::Surface& surface,
                   const terrain::dem::ContactCoefficients& k) {
  s.surfaces().attach(surface.mesh, {}, k, testing::at_rest(surface));
  s.surfaces().move_to(0.0);
}

}  // namespace furrow::verification
