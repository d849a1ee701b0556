// The pre-integrated stiffness against layer-wise quadrature with tensors, on a curved laminated element.
#include "tire/ancf/shell_matrices.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tire/shell_mesh.hpp"

namespace furrow::tire {
namespace {

using Tensor = Mat3;

/// The bead element of the layered tire next to the sidewall, on a coarse mesh: strongly curved.
struct Fixture {
  TireFile file = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  ElementNodes x;
  std::vector<ShellLayer> layers;
  explicit Fixture(int j) {
    file.elements_circumference = 16;
    set_elements_width(file, 12);
    const ShellMesh mesh = make_shell_mesh(file);
    const Mat3 next = mesh.turn(1);
    const Vec3 r[4] = {mesh.position[j], next * mesh.position[j], next * mesh.position[j + 1], mesh.position[j + 1]};
    const Vec3 d[4] = {mesh.director[j], next * mesh.director[j], next * mesh.director[j + 1], mesh.director[j + 1]};
    for (int n = 0; n < 4; ++n) x.row(2 * n) = r[n], x.row(2 * n + 1) = d[n];
    layers = shell_layers(file, file.section(j));
  }
};

Mat3 base(const ElementNodes& q, double xi, double eta, double z) {
  const double sx[4] = {-1, 1, 1, -1}, se[4] = {-1, -1, 1, 1};
  Mat3 g = Mat3::Zero();
  for (int n = 0; n < 4; ++n) {
    const Vec3 p = (q.row(2 * n) + z * q.row(2 * n + 1)).transpose(), d = q.row(2 * n + 1).transpose();
    g.col(0) += 0.25 * sx[n] * (1 + se[n] * eta) * p;
    g.col(1) += 0.25 * se[n] * (1 + sx[n] * xi) * p;
    g.col(2) += 0.25 * (1 + sx[n] * xi) * (1 + se[n] * eta) * d;
  }
  return g;
}

Tensor plain_strain(const ElementNodes& q, const ElementNodes& x, double xi, double eta, double z) {
  const Mat3 now = base(q, xi, eta, z), was = base(x, xi, eta, z);
  return 0.5 * (now.transpose() * now - was.transpose() * was);
}

/// Covariant strain with the assumed transverse parts.
Tensor strain(const ElementNodes& q, const ElementNodes& x, double xi, double eta, double z) {
  Tensor e = plain_strain(q, x, xi, eta, z);
  e(0, 2) = 0.5 * (1 - eta) * plain_strain(q, x, 0, -1, z)(0, 2) + 0.5 * (1 + eta) * plain_strain(q, x, 0, 1, z)(0, 2);
  e(1, 2) = 0.5 * (1 - xi) * plain_strain(q, x, -1, 0, z)(1, 2) + 0.5 * (1 + xi) * plain_strain(q, x, 1, 0, z)(1, 2);
  const double sx[4] = {-1, 1, 1, -1}, se[4] = {-1, -1, 1, 1};
  e(2, 2) = 0.0;
  for (int n = 0; n < 4; ++n)
    e(2, 2) += 0.25 * (1 + sx[n] * xi) * (1 + se[n] * eta) * plain_strain(q, x, sx[n], se[n], 0)(2, 2);
  e(2, 0) = e(0, 2);
  e(2, 1) = e(1, 2);
  return e;
}

Eigen::Matrix<double, 6, 1> components(const Tensor& e) {
  Eigen::Matrix<double, 6, 1> v;
  v << e(0, 0), e(1, 1), 2 * e(0, 1), e(2, 2), 2 * e(0, 2), 2 * e(1, 2);
  return v;
}

/// Energy layer by layer; the enhanced parameters are found by minimising it.
double layerwise_energy(const ElementNodes& q, const Fixture& f) {
  const double a = std::sqrt(0.6), points[3] = {-a, 0, a}, weights[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9},
               g = 1 / std::sqrt(3.0);
  double total = 0.0, energy = 0.0;
  for (const ShellLayer& layer : f.layers) total += layer.thickness;
  const Mat3 g0 = base(f.x, 0, 0, 0), to_cartesian = g0.inverse();  // E_cart = G⁻ᵀ E G⁻¹
  Eigen::Matrix<double, 8, 8> k = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b = Eigen::Matrix<double, 8, 1>::Zero();
  for (const double xi : {-g, g})
    for (const double eta : {-g, g}) {
      double bottom = -0.5 * total;
      for (const ShellLayer& layer : f.layers) {
        for (int c = 0; c < 3; ++c) {
          const double z = bottom + 0.5 * layer.thickness * (1 + points[c]);
          const Mat3 base_here = base(f.x, xi, eta, z);
          const double j = base_here.determinant(), volume = 0.5 * layer.thickness * weights[c] * j;
          const Vec3 t1 = base_here.col(0).normalized(), n = base_here.col(0).cross(base_here.col(1)).normalized();
          const Vec3 t2 = n.cross(t1);
          Mat3 axes;
          axes << (std::cos(layer.angle) * t1 + std::sin(layer.angle) * t2).transpose(),
              (std::cos(layer.angle) * t2 - std::sin(layer.angle) * t1).transpose(), n.transpose();
          const Mat3 inverse = base_here.inverse();
          const auto local =
              components(axes * inverse.transpose() * strain(q, f.x, xi, eta, z) * inverse * axes.transpose());
          Eigen::Matrix<double, 6, 8> enhanced;
          const double zeta = 2 * z / total;
          for (int mode = 0; mode < 8; ++mode) {
            Tensor m = Tensor::Zero();
            if (mode == 0) m(0, 0) = xi;
            if (mode == 1) m(1, 1) = eta;
            if (mode == 2) m(0, 1) = m(1, 0) = 0.5 * xi;
            if (mode == 3) m(0, 1) = m(1, 0) = 0.5 * eta;
            if (mode == 4) m(2, 2) = zeta;
            if (mode == 5) m(2, 2) = zeta * xi;
            if (mode == 6) m(2, 2) = zeta * eta;
            if (mode == 7) m(2, 2) = zeta * xi * eta;
            const Tensor cartesian = g0.determinant() / j * to_cartesian.transpose() * m * to_cartesian;
            enhanced.col(mode) = components(axes * cartesian * axes.transpose());
          }
          energy += 0.5 * volume * local.dot(layer.stiffness * local);
          k += volume * enhanced.transpose() * layer.stiffness * enhanced;
          b += volume * enhanced.transpose() * layer.stiffness * local;
        }
        bottom += layer.thickness;
      }
    }
  return energy - 0.5 * b.dot(k.ldlt().solve(b));
}

TEST(ShellMatrices, preintegrated_energy_equals_layerwise_quadrature_on_curved_elements) {
  for (const int j : {0, 2, 4, 5}) {
    const Fixture f(j);
    const StrainMatrix d = shell_stiffness(f.x, f.layers);
    std::srand(1);
    for (int sample = 0; sample < 5; ++sample) {
      const ElementNodes q = f.x + 1e-2 * ElementNodes::Random();
      const StrainVector e = raw_strains(q) - raw_strains(f.x);
      const double reference = layerwise_energy(q, f);
      EXPECT_NEAR(0.5 * e.dot(d * e), reference, 1e-12 * reference) << "width element " << j;
    }
  }
}

TEST(ShellMatrices, enhanced_strains_have_zero_mean_over_the_element) {
  const Fixture f(3);
  Eigen::Matrix<double, 6, kEnhanced> mean = Eigen::Matrix<double, 6, kEnhanced>::Zero();
  double volume = 0.0;
  std::vector<ShellLayer> straight = f.layers;
  for (ShellLayer& layer : straight) layer.angle = 0.0;
  const Mat3 g0 = base(f.x, 0, 0, 0);
  for (const ShellPoint& p : shell_points(f.x, straight)) {
    mean += p.volume * p.enhanced_map;
    volume += p.volume;
  }
  // Exact in fixed axes; material axes turn by half a pitch over the element, so the error is a few per cent.
  EXPECT_LT(mean.norm() / volume, 0.05 / (g0.col(0).squaredNorm()));
}

TEST(ShellMatrices, stiffness_is_positive_semidefinite_with_rigid_motions_in_its_kernel) {
  const Fixture f(1);
  const StrainMatrix d = shell_stiffness(f.x, f.layers);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(d)};
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-10 * eigen.eigenvalues().maxCoeff());
}

}  // namespace
}  // namespace furrow::tire
