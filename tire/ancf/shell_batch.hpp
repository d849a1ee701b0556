// The element formulas of shell_strain.hpp, written out for a batch of elements side by side around the ring.
#pragma once

#include "tire/ancf/shell_layout.hpp"
#include "tire/ancf/shell_strain.hpp"

namespace furrow::tire {

/// Position and director derivatives of a batch at the sampling places.
struct BatchNodes {
  Triple<Double4> r[4], d[4];

  /// Elements i…i+3 at width position j.
  void read(const ShellLayout& layout, const double* field, int i, int j) {
    const double* low = field + layout.offset(j, 0) + i;
    const double* high = field + layout.offset(j + 1, 0) + i;
    const int s = layout.stride();
    r[0] = {load(low), load(low + s), load(low + 2 * s)};
    r[1] = {load(low + 1), load(low + s + 1), load(low + 2 * s + 1)};
    r[2] = {load(high + 1), load(high + s + 1), load(high + 2 * s + 1)};
    r[3] = {load(high), load(high + s), load(high + 2 * s)};
    d[0] = {load(low + 3 * s), load(low + 4 * s), load(low + 5 * s)};
    d[1] = {load(low + 3 * s + 1), load(low + 4 * s + 1), load(low + 5 * s + 1)};
    d[2] = {load(high + 3 * s + 1), load(high + 4 * s + 1), load(high + 5 * s + 1)};
    d[3] = {load(high + 3 * s), load(high + 4 * s), load(high + 5 * s)};
  }
};

inline constexpr double kNear = 0.5 * (1.0 + kGaussPoint), kFar = 0.5 * (1.0 - kGaussPoint);

/// Edge derivatives: b η = −1, t η = +1, l ξ = −1, r ξ = +1; and at the Gauss lines k, l.
struct BatchSlopes {
  Triple<Double4> ab, at, al, ar, db, dt, dl, dr;
  Triple<Double4> a1[2], d1[2], a2[2], d2[2];

  explicit BatchSlopes(const BatchNodes& n)
      : ab(0.5 * (n.r[1] - n.r[0])),
        at(0.5 * (n.r[2] - n.r[3])),
        al(0.5 * (n.r[3] - n.r[0])),
        ar(0.5 * (n.r[2] - n.r[1])),
        db(0.5 * (n.d[1] - n.d[0])),
        dt(0.5 * (n.d[2] - n.d[3])),
        dl(0.5 * (n.d[3] - n.d[0])),
        dr(0.5 * (n.d[2] - n.d[1])) {
    a1[0] = kNear * ab + kFar * at, a1[1] = kFar * ab + kNear * at;
    d1[0] = kNear * db + kFar * dt, d1[1] = kFar * db + kNear * dt;
    a2[0] = kNear * al + kFar * ar, a2[1] = kFar * al + kNear * ar;
    d2[0] = kNear * dl + kFar * dr, d2[1] = kFar * dl + kNear * dr;
  }
};

inline void batch_strains(const BatchNodes& n, Double4* e) {
  const BatchSlopes s(n);
  for (int k = 0; k < 2; ++k) {
    e[e11(k)] = 0.5 * dot(s.a1[k], s.a1[k]);
    e[e11(k) + 1] = dot(s.a1[k], s.d1[k]);
    e[e11(k) + 2] = 0.5 * dot(s.d1[k], s.d1[k]);
    e[e22(k)] = 0.5 * dot(s.a2[k], s.a2[k]);
    e[e22(k) + 1] = dot(s.a2[k], s.d2[k]);
    e[e22(k) + 2] = 0.5 * dot(s.d2[k], s.d2[k]);
    for (int l = 0; l < 2; ++l) {
      e[e12(k, l)] = dot(s.a1[k], s.a2[l]);
      e[e12(k, l) + 1] = dot(s.a1[k], s.d2[l]) + dot(s.d1[k], s.a2[l]);
      e[e12(k, l) + 2] = dot(s.d1[k], s.d2[l]);
    }
  }
  for (int c = 0; c < 4; ++c) e[e33(c)] = 0.5 * dot(n.d[c], n.d[c]);
  const Triple<Double4> bottom = 0.5 * (n.d[0] + n.d[1]), top = 0.5 * (n.d[3] + n.d[2]);
  const Triple<Double4> left = 0.5 * (n.d[0] + n.d[3]), right = 0.5 * (n.d[1] + n.d[2]);
  e[e13(0)] = dot(s.ab, bottom), e[e13(0) + 1] = dot(s.db, bottom);
  e[e13(1)] = dot(s.at, top), e[e13(1) + 1] = dot(s.dt, top);
  e[e23(0)] = dot(s.al, left), e[e23(0) + 1] = dot(s.dl, left);
  e[e23(1)] = dot(s.ar, right), e[e23(1) + 1] = dot(s.dr, right);
}

/// out = D̂ in, for symmetric D̂ stored by rows.
inline void batch_stress(const double* d, const Double4* in, Double4* out) {
  constexpr int kRows = 6;
  for (int first = 0; first < kStrains; first += kRows) {
    Double4 sum[kRows] = {};
    const double* column = d + first;  // symmetric: column `l` of these rows lies in row `l`
    for (int l = 0; l < kStrains; ++l, column += kStrains)
      for (int r = 0; r < kRows; ++r) sum[r] += column[r] * in[l];
    for (int r = 0; r < kRows; ++r) out[first + r] = sum[r];
  }
}

/// Nodal forces Σ_k S_k ∂e_k/∂q − p ∂V/∂q at the configuration `n`.
struct BatchForces {
  Triple<Double4> r[4], d[4];

  BatchForces(const BatchNodes& n, const Double4* stress, Double4 pressure) {
    const BatchSlopes s(n);
    Triple<Double4> fa1[2], fd1[2], fa2[2], fd2[2];
    for (int k = 0; k < 2; ++k) {
      const Double4 *s1 = stress + e11(k), *s2 = stress + e22(k);
      fa1[k] = s1[0] * s.a1[k] + s1[1] * s.d1[k];
      fd1[k] = s1[1] * s.a1[k] + s1[2] * s.d1[k];
      fa2[k] = s2[0] * s.a2[k] + s2[1] * s.d2[k];
      fd2[k] = s2[1] * s.a2[k] + s2[2] * s.d2[k];
    }
    for (int c = 0; c < 4; ++c) d[c] = stress[e33(c)] * n.d[c], r[c] = Triple<Double4>{Double4{}, Double4{}, Double4{}};
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l) {
        const Double4* t = stress + e12(k, l);
        fa1[k] += t[0] * s.a2[l] + t[1] * s.d2[l];
        fd1[k] += t[1] * s.a2[l] + t[2] * s.d2[l];
        fa2[l] += t[0] * s.a1[k] + t[1] * s.d1[k];
        fd2[l] += t[1] * s.a1[k] + t[2] * s.d1[k];
        add_pressure(k, l, pressure * cross(s.a1[k], s.a2[l]));
      }
    Triple<Double4> fab = kNear * fa1[0] + kFar * fa1[1], fat = kFar * fa1[0] + kNear * fa1[1];
    Triple<Double4> fdb = kNear * fd1[0] + kFar * fd1[1], fdt = kFar * fd1[0] + kNear * fd1[1];
    Triple<Double4> fal = kNear * fa2[0] + kFar * fa2[1], far = kFar * fa2[0] + kNear * fa2[1];
    Triple<Double4> fdl = kNear * fd2[0] + kFar * fd2[1], fdr = kFar * fd2[0] + kNear * fd2[1];
    add_shear(stress + e13(0), s.ab, s.db, n.d[0], n.d[1], fab, fdb, d[0], d[1]);
    add_shear(stress + e13(1), s.at, s.dt, n.d[3], n.d[2], fat, fdt, d[3], d[2]);
    add_shear(stress + e23(0), s.al, s.dl, n.d[0], n.d[3], fal, fdl, d[0], d[3]);
    add_shear(stress + e23(1), s.ar, s.dr, n.d[1], n.d[2], far, fdr, d[1], d[2]);
    r[0] += -0.5 * (fab + fal), r[1] += 0.5 * (fab - far), r[2] += 0.5 * (fat + far), r[3] += 0.5 * (fal - fat);
    d[0] += -0.5 * (fdb + fdl), d[1] += 0.5 * (fdb - fdr), d[2] += 0.5 * (fdt + fdr), d[3] += 0.5 * (fdl - fdt);
  }

  void add(const ShellLayout& layout, double* field, int i, int j) const {
    double* low = field + layout.offset(j, 0) + i;
    double* high = field + layout.offset(j + 1, 0) + i;
    const int s = layout.stride();
    add_three(low, s, r[0]), add_three(low + 3 * s, s, d[0]);
    add_three(low + 1, s, r[1]), add_three(low + 3 * s + 1, s, d[1]);
    add_three(high + 1, s, r[2]), add_three(high + 3 * s + 1, s, d[2]);
    add_three(high, s, r[3]), add_three(high + 3 * s, s, d[3]);
  }

 private:
  static void add_three(double* p, int stride, const Triple<Double4>& f) {
    add_to(p, f.x), add_to(p + stride, f.y), add_to(p + 2 * stride, f.z);
  }
  /// p n at Gauss point (η_k, ξ_l), shared by N_n there.
  void add_pressure(int k, int l, const Triple<Double4>& pn) {
    const double left = l == 0 ? kNear : kFar, bottom = k == 0 ? kNear : kFar;
    r[0] += -(left * bottom) * pn;
    r[1] += -((1 - left) * bottom) * pn;
    r[2] += -((1 - left) * (1 - bottom)) * pn;
    r[3] += -(left * (1 - bottom)) * pn;
  }
  /// 2E = a·m + z a_d·m with m = ½ (d_first + d_second).
  static void add_shear(const Double4* stress, const Triple<Double4>& a, const Triple<Double4>& ad,
                        const Triple<Double4>& first, const Triple<Double4>& second, Triple<Double4>& fa,
                        Triple<Double4>& fad, Triple<Double4>& f_first, Triple<Double4>& f_second) {
    const Triple<Double4> m = 0.5 * (first + second);
    fa += stress[0] * m;
    fad += stress[1] * m;
    const Triple<Double4> half = 0.5 * (stress[0] * a + stress[1] * ad);
    f_first += half;
    f_second += half;
  }
};

}  // namespace furrow::tire
