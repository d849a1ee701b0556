// A vector quantity of one grain, in the form of a register.
#pragma once

#include "protocol/core/fields.hpp"
#include "protocol/core/simd.hpp"

namespace furrow::terrain::dem {

using namespace simd;

/// A vector quantity of one grain; the owner may use w.
struct alignas(32) Quad {
  double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
};
void visit_fields(FieldsOf<Quad> auto& s, auto&& visit) {
  visit(s.x, Field{"x", ""});
  visit(s.y, Field{"y", ""});
  visit(s.z, Field{"z", ""});
  visit(s.w, Field{"w", ""});
}

inline Double4 load(const Quad& q) {
  Double4 v;
  std::memcpy(&v, static_cast<const void*>(&q), sizeof v);
  return v;
}
inline void store(Quad& q, Double4 v) { std::memcpy(static_cast<void*>(&q), &v, sizeof v); }
inline void add(Quad& q, Double4 v) { store(q, load(q) + v); }

/// Quads are addressed by four times their index, so that the address of a double needs no shift.
inline constexpr int kQuad = 4;
inline const double* flat(const Quad* quads) { return reinterpret_cast<const double*>(quads); }
inline double* flat(Quad* quads) { return reinterpret_cast<double*>(quads); }

}  // namespace furrow::terrain::dem
