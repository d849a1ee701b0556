// A few grains as the engine runs them: the law between grains in single precision, all else in double.
#pragma once

#include "tests/terrain/few_grains.hpp"

namespace furrow::verification {

struct EngineGrains : terrain::dem::FewGrains {
  EngineGrains() { precision = terrain::dem::Precision::mixed; }
};

}  // namespace furrow::verification
