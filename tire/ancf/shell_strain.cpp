#include "tire/ancf/shell_strain.hpp"

namespace furrow::tire {
namespace {

using Row = Eigen::Matrix<double, 8, 1>;  // a linear functional of the nodal scalars

constexpr std::array<double, 4> kXi{-1, 1, 1, -1}, kEta{-1, -1, 1, 1};

/// Shape functions of positions (s = 0) or directors (s = 1).
Row shape(double xi, double eta, int s) {
  Row row = Row::Zero();
  for (int n = 0; n < 4; ++n) row[2 * n + s] = 0.25 * (1 + kXi[n] * xi) * (1 + kEta[n] * eta);
  return row;
}
Row along_xi(double eta, int s) {
  Row row = Row::Zero();
  for (int n = 0; n < 4; ++n) row[2 * n + s] = 0.25 * kXi[n] * (1 + kEta[n] * eta);
  return row;
}
Row along_eta(double xi, int s) {
  Row row = Row::Zero();
  for (int n = 0; n < 4; ++n) row[2 * n + s] = 0.25 * kEta[n] * (1 + kXi[n] * xi);
  return row;
}

/// H of the product a·b of two functionals: a·b = ½ qᵀ (a bᵀ + b aᵀ) q.
NodeMatrix product(const Row& a, const Row& b) { return a * b.transpose() + b * a.transpose(); }

std::array<NodeMatrix, kStrains> make_forms() {
  std::array<NodeMatrix, kStrains> h;
  const double gauss[2] = {-kGaussPoint, kGaussPoint}, side[2] = {-1.0, 1.0};
  const auto plane = [&](int first, const Row& a, const Row& da, const Row& b, const Row& db, double scale) {
    h[first] = scale * product(a, b);
    h[first + 1] = scale * (product(a, db) + product(da, b));
    h[first + 2] = scale * product(da, db);
  };
  for (int k = 0; k < 2; ++k) {
    const Row a1 = along_xi(gauss[k], 0), d1 = along_xi(gauss[k], 1);
    const Row a2 = along_eta(gauss[k], 0), d2 = along_eta(gauss[k], 1);
    plane(e11(k), a1, d1, a1, d1, 0.5);
    plane(e22(k), a2, d2, a2, d2, 0.5);
    for (int l = 0; l < 2; ++l) plane(e12(k, l), a1, d1, along_eta(gauss[l], 0), along_eta(gauss[l], 1), 1.0);
    h[e13(k)] = product(along_xi(side[k], 0), shape(0, side[k], 1));
    h[e13(k) + 1] = product(along_xi(side[k], 1), shape(0, side[k], 1));
    h[e23(k)] = product(along_eta(side[k], 0), shape(side[k], 0, 1));
    h[e23(k) + 1] = product(along_eta(side[k], 1), shape(side[k], 0, 1));
  }
  for (int n = 0; n < 4; ++n) h[e33(n)] = 0.5 * product(shape(kXi[n], kEta[n], 1), shape(kXi[n], kEta[n], 1));
  return h;
}

}  // namespace

const std::array<NodeMatrix, kStrains>& strain_forms() {
  static const std::array<NodeMatrix, kStrains> forms = make_forms();
  return forms;
}

StrainVector raw_strains(const ElementNodes& q) {
  StrainVector e;
  for (int k = 0; k < kStrains; ++k) e[k] = 0.5 * (q.transpose() * strain_forms()[k] * q).trace();
  return e;
}

Eigen::Matrix<double, 6, kStrains> covariant_map(int k, int l, double z) {
  Eigen::Matrix<double, 6, kStrains> map = Eigen::Matrix<double, 6, kStrains>::Zero();
  const double xi = l == 0 ? -kGaussPoint : kGaussPoint, eta = k == 0 ? -kGaussPoint : kGaussPoint;
  double power = 1.0;
  for (int m = 0; m < 3; ++m, power *= z) {
    map(0, e11(k) + m) = power;
    map(1, e22(l) + m) = power;
    map(2, e12(k, l) + m) = power;
    if (m == 2) break;
    for (int b = 0; b < 2; ++b) {
      map(4, e13(b) + m) = 0.5 * (1 + (2 * b - 1) * eta) * power;
      map(5, e23(b) + m) = 0.5 * (1 + (2 * b - 1) * xi) * power;
    }
  }
  for (int n = 0; n < 4; ++n) map(3, e33(n)) = 0.25 * (1 + kXi[n] * xi) * (1 + kEta[n] * eta);
  return map;
}

}  // namespace furrow::tire
