// The spin of a patch of vertices, and couples on it as forces (surface_patches.hpp). Like facets.hpp, for the
// processor and for a GPU.
#pragma once

#include <cstdint>

#include "protocol/core/triple.hpp"

namespace furrow::terrain {

/// A symmetric matrix.
struct Symmetric {
  double xx, yy, zz, xy, xz, yz;

  FURROW_HD simd::Triple<double> times(const simd::Triple<double>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// Inverse of a positive semidefinite matrix on the axes along which it is not zero, by Jacobi's rotations.
FURROW_HD inline Symmetric pseudo_inverse(const Symmetric& m) {
  constexpr double kNothing = 4.0 * 2.220446049250313e-16, kDiagonal = 1e-18;
  const auto size_of = [](double v) { return v < 0.0 ? -v : v; };
  double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < 12; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (size_of(a[p][q]) <= kDiagonal * simd::smaller(size_of(a[p][p]), size_of(a[q][q]))) continue;
        const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double bounded = simd::smaller(simd::larger(theta, -1e150), 1e150);
        const double t = (bounded < 0.0 ? -1.0 : 1.0) / (size_of(bounded) + simd::root(bounded * bounded + 1.0));
        const double c = 1.0 / simd::root(t * t + 1.0), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y;
          v[k][q] = s * x + c * y;
        }
      }
  const double largest = simd::larger(a[0][0], simd::larger(a[1][1], a[2][2]));
  Symmetric out{0, 0, 0, 0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    if (!(a[k][k] > kNothing * largest)) continue;
    const double by = 1.0 / a[k][k];
    out.xx += by * (v[0][k] * v[0][k]), out.yy += by * (v[1][k] * v[1][k]), out.zz += by * (v[2][k] * v[2][k]);
    out.xy += by * (v[0][k] * v[1][k]), out.xz += by * (v[0][k] * v[2][k]), out.yz += by * (v[1][k] * v[2][k]);
  }
  return out;
}

/// The vertices of a patch. Coordinates of a vertex follow each other.
struct PatchVertices {
  using Vector = simd::Triple<double>;

  const std::int32_t* vertex;
  std::int32_t count;
  const double* position;  // of all vertices, m

  FURROW_HD static Vector of(const double* values, std::int32_t v) {
    return {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
  }
  FURROW_HD Vector centre() const {
    Vector sum{0, 0, 0};
    for (std::int32_t k = 0; k < count; ++k) sum += of(position, vertex[k]);
    return (1.0 / count) * sum;
  }
  /// J⁻¹ with J = Σ (|x|² I − x xᵀ), x from the centre, 1/m².
  FURROW_HD Symmetric inverse(const Vector& centre) const {
    Symmetric j{0, 0, 0, 0, 0, 0};
    for (std::int32_t k = 0; k < count; ++k) {
      const Vector x = of(position, vertex[k]) - centre;
      const double square = dot(x, x);
      j.xx += square - x.x * x.x, j.yy += square - x.y * x.y, j.zz += square - x.z * x.z;
      j.xy -= x.x * x.y, j.xz -= x.x * x.z, j.yz -= x.y * x.z;
    }
    return pseudo_inverse(j);
  }
  /// J⁻¹ b, with one step of iterative refinement, because J of a sliver is ill-conditioned.
  FURROW_HD Vector solved(const Vector& centre, const Symmetric& inverse, const Vector& b) const {
    const Vector first = inverse.times(b);
    Vector moment{0, 0, 0};
    for (std::int32_t k = 0; k < count; ++k) {
      const Vector x = of(position, vertex[k]) - centre;
      moment += cross(x, cross(first, x));
    }
    return first + inverse.times(b - moment);
  }
  /// ω_s, rad/s. @param velocity of all vertices, m/s
  FURROW_HD Vector spin(const Vector& centre, const Symmetric& inverse, const double* velocity) const {
    Vector circulation{0, 0, 0};
    for (std::int32_t k = 0; k < count; ++k)
      circulation += cross(of(position, vertex[k]) - centre, of(velocity, vertex[k]));
    return solved(centre, inverse, circulation);
  }
};

}  // namespace furrow::terrain
