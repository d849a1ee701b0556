// Vectors of the host as plain triples, and arrays of them as plain numbers.
#pragma once

#include <span>

#include "protocol/core/triple.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::terrain {

inline simd::Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 vec(const simd::Triple<double>& v) { return {v.x, v.y, v.z}; }
inline const double* flat(std::span<const Vec3> of) { return reinterpret_cast<const double*>(of.data()); }

}  // namespace furrow::terrain
