#include "tire/ancf/shell_tangent.hpp"

#include "tire/ancf/shell_batch.hpp"

namespace furrow::tire {
namespace {

/// The batch's unknowns by scalar index 2n + s.
struct Scalars {
  Double4 q[8][3];
  explicit Scalars(const BatchNodes& n) {
    for (int c = 0; c < 4; ++c) {
      q[2 * c][0] = n.r[c].x, q[2 * c][1] = n.r[c].y, q[2 * c][2] = n.r[c].z;
      q[2 * c + 1][0] = n.d[c].x, q[2 * c + 1][1] = n.d[c].y, q[2 * c + 1][2] = n.d[c].z;
    }
  }
};

/// B_k = H_k q.
void strain_gradients(const Scalars& s, Double4 (*b)[24]) {
  for (int k = 0; k < kStrains; ++k) {
    const NodeMatrix& h = strain_forms()[k];
    for (int a = 0; a < 8; ++a) {
      Double4 row[3] = {};
      for (int m = 0; m < 8; ++m)
        if (h(a, m) != 0.0)
          for (int x = 0; x < 3; ++x) row[x] += h(a, m) * s.q[m][x];
      for (int x = 0; x < 3; ++x) b[k][3 * a + x] = row[x];
    }
  }
}

/// ∂²V/∂r_i∂r_m symmetrised = ½ Σ [(N_i N_m,η − N_m N_i,η) [a₁]× − (N_i N_m,ξ − N_m N_i,ξ) [a₂]×]; subtracts
/// `factor` × it.
void subtract_pressure(const BatchSlopes& s, double factor, Double4 (*k)[24]) {
  constexpr double sx[4] = {-1, 1, 1, -1}, se[4] = {-1, -1, 1, 1};
  for (int g = 0; g < 4; ++g) {
    const double eta = g / 2 == 0 ? -kGaussPoint : kGaussPoint, xi = g % 2 == 0 ? -kGaussPoint : kGaussPoint;
    const Triple<Double4>&a1 = s.a1[g / 2], &a2 = s.a2[g % 2];
    double n[4], n1[4], n2[4];
    for (int c = 0; c < 4; ++c) {
      n[c] = 0.25 * (1 + sx[c] * xi) * (1 + se[c] * eta);
      n1[c] = 0.25 * sx[c] * (1 + se[c] * eta);
      n2[c] = 0.25 * se[c] * (1 + sx[c] * xi);
    }
    for (int i = 0; i < 4; ++i)
      for (int m = 0; m < i; ++m) {
        const double u = 0.5 * factor * (n[i] * n2[m] - n[m] * n2[i]), v = 0.5 * factor * (n[i] * n1[m] - n[m] * n1[i]);
        const Triple<Double4> w = u * a1 - v * a2;  // [w]×
        Double4(*block)[24] = k + 6 * i;
        block[0][6 * m + 1] += w.z, block[0][6 * m + 2] -= w.y;
        block[1][6 * m] -= w.z, block[1][6 * m + 2] += w.x;
        block[2][6 * m] += w.y, block[2][6 * m + 1] -= w.x;
      }
  }
}

}  // namespace

void BatchTangent::compute(const StrainMatrix& d, const BatchNodes& nodes, const Double4* stress, double material,
                           double geometric, double pressure) {
  static thread_local Double4 b[kStrains][24], db[kStrains][24];
  strain_gradients(Scalars(nodes), b);
  for (int r = 0; r < kStrains; ++r)
    for (int first = 0; first < 24; first += 8) {
      Double4 sum[8] = {};
      for (int l = 0; l < kStrains; ++l)
        for (int c = 0; c < 8; ++c) sum[c] += d(r, l) * b[l][first + c];
      for (int c = 0; c < 8; ++c) db[r][first + c] = material * sum[c];
    }
  for (auto& row : k)
    for (Double4& entry : row) entry = Double4{};
  for (int r = 0; r < 24; ++r)
    for (int l = 0; l < kStrains; ++l)
      for (int c = 0; c <= r; ++c) k[r][c] += b[l][r] * db[l][c];
  for (int a = 0; a < 8; ++a)
    for (int m = 0; m <= a; ++m) {
      Double4 h = {};
      for (int l = 0; l < kStrains; ++l)
        if (const double form = strain_forms()[l](a, m); form != 0.0) h += form * stress[l];
      for (int x = 0; x < 3; ++x) k[3 * a + x][3 * m + x] += geometric * h;
    }
  subtract_pressure(BatchSlopes(nodes), geometric * pressure, k);
}

}  // namespace furrow::tire
