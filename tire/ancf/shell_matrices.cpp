#include "tire/ancf/shell_matrices.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>

namespace furrow::tire {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::array<double, 3> kGauss3{-0.77459666924148337704, 0.0, 0.77459666924148337704};
constexpr std::array<double, 3> kWeight3{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

// Order of components: 11, 22, 2·12, 33, 2·13, 2·23.
constexpr std::array<std::array<int, 2>, 6> kPair{{{0, 0}, {1, 1}, {0, 1}, {2, 2}, {0, 2}, {1, 2}}};

/// E'_ab = E_ij J_ai J_bj in engineering components.
Mat6 strain_transformation(const Mat3& jac) {
  Mat6 t;
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s < 6; ++s) {
      const int a = kPair[r][0], b = kPair[r][1], i = kPair[s][0], j = kPair[s][1];
      const double value = i == j ? jac(a, i) * jac(b, i) : 0.5 * (jac(a, i) * jac(b, j) + jac(a, j) * jac(b, i));
      t(r, s) = a == b ? value : 2.0 * value;
    }
  return t;
}

/// Columns g₁, g₂, g₃ at a point of the reference.
Mat3 base(const ElementNodes& x, double xi, double eta, double z) {
  const double sx[4] = {-1, 1, 1, -1}, se[4] = {-1, -1, 1, 1};
  Mat3 g = Mat3::Zero();
  for (int n = 0; n < 4; ++n) {
    const Vec3 at_z = (x.row(2 * n) + z * x.row(2 * n + 1)).transpose();
    g.col(0) += 0.25 * sx[n] * (1 + se[n] * eta) * at_z;
    g.col(1) += 0.25 * se[n] * (1 + sx[n] * xi) * at_z;
    g.col(2) += 0.25 * (1 + sx[n] * xi) * (1 + se[n] * eta) * x.row(2 * n + 1).transpose();
  }
  return g;
}

/// Rows: fibre, transverse and normal direction.
Mat3 material_axes(const Mat3& g, double angle) {
  const Vec3 first = g.col(0).normalized(), normal = g.col(0).cross(g.col(1)).normalized();
  const Vec3 second = normal.cross(first);
  Mat3 axes;
  axes.row(0) = (std::cos(angle) * first + std::sin(angle) * second).transpose();
  axes.row(1) = (-std::sin(angle) * first + std::cos(angle) * second).transpose();
  axes.row(2) = normal.transpose();
  return axes;
}

Eigen::Matrix<double, 6, kEnhanced> enhanced_modes(double xi, double eta, double zeta) {
  Eigen::Matrix<double, 6, kEnhanced> m = Eigen::Matrix<double, 6, kEnhanced>::Zero();
  m(0, 0) = xi;
  m(1, 1) = eta;
  m(2, 2) = xi;
  m(2, 3) = eta;
  m(3, 4) = zeta;
  m(3, 5) = zeta * xi;
  m(3, 6) = zeta * eta;
  m(3, 7) = zeta * xi * eta;
  return m;
}

}  // namespace

std::vector<ShellPoint> shell_points(const ElementNodes& x, const std::vector<ShellLayer>& layers) {
  double total = 0.0;
  for (const ShellLayer& layer : layers) total += layer.thickness;
  const Mat3 g0 = base(x, 0, 0, 0);
  const double j0 = g0.determinant();
  const Mat6 t0 = strain_transformation(g0.inverse().transpose());  // covariant → Cartesian at the centre
  std::vector<ShellPoint> points;
  for (int k = 0; k < 2; ++k)
    for (int l = 0; l < 2; ++l) {
      const double xi = l == 0 ? -kGaussPoint : kGaussPoint, eta = k == 0 ? -kGaussPoint : kGaussPoint;
      double bottom = -0.5 * total;
      for (std::size_t layer = 0; layer < layers.size(); ++layer) {
        const double half = 0.5 * layers[layer].thickness;
        for (int c = 0; c < 3; ++c) {
          const double z = bottom + half * (1.0 + kGauss3[c]);
          const Mat3 g = base(x, xi, eta, z), axes = material_axes(g, layers[layer].angle);
          const double j = g.determinant();
          ShellPoint p;
          p.strain_map = strain_transformation(axes * g.inverse().transpose()) * covariant_map(k, l, z);
          p.enhanced_map = strain_transformation(axes) * t0 * enhanced_modes(xi, eta, 2.0 * z / total) * (j0 / j);
          p.volume = j * half * kWeight3[c];
          p.layer = static_cast<int>(layer);
          points.push_back(p);
        }
        bottom += layers[layer].thickness;
      }
    }
  return points;
}

StrainMatrix shell_stiffness(const ElementNodes& reference, const std::vector<ShellLayer>& layers) {
  StrainMatrix d = StrainMatrix::Zero();
  Eigen::Matrix<double, kEnhanced, kStrains> coupling = Eigen::Matrix<double, kEnhanced, kStrains>::Zero();
  Eigen::Matrix<double, kEnhanced, kEnhanced> enhanced = Eigen::Matrix<double, kEnhanced, kEnhanced>::Zero();
  for (const ShellPoint& p : shell_points(reference, layers)) {
    const auto& c = layers[p.layer].stiffness;
    d += p.volume * p.strain_map.transpose() * c * p.strain_map;
    coupling += p.volume * p.enhanced_map.transpose() * c * p.strain_map;
    enhanced += p.volume * p.enhanced_map.transpose() * c * p.enhanced_map;
  }
  d -= coupling.transpose() * enhanced.ldlt().solve(coupling);
  return 0.5 * (d + d.transpose());
}

std::vector<ShellLayer> shell_layers(const TireFile& file, const Section& section) {
  std::vector<ShellLayer> layers;
  for (const Layer& layer : section.layers)
    layers.push_back({layer.thickness, layer.angle, stiffness(file.materials[layer.material], file.path)});
  return layers;
}

}  // namespace furrow::tire
