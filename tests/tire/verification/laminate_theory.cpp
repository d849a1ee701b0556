#include "tests/tire/verification/laminate_theory.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace furrow::test {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Stiffness in laminate axes, order 11, 22, 12, 33, 13, 23 (engineering shears).
Mat6 turned(const tire::ShellLayer& layer) {
  const double c = std::cos(layer.angle), s = std::sin(layer.angle);
  Mat6 t = Mat6::Zero();  // strains of the material axes from those of the laminate
  t.topLeftCorner<3, 3>() << c * c, s * s, c * s, s * s, c * c, -c * s, -2 * c * s, 2 * c * s, c * c - s * s;
  t(3, 3) = 1;
  t.bottomRightCorner<2, 2>() << c, s, -s, c;
  return t.transpose() * layer.stiffness * t;
}

/// Calls `visit` with each layer's stiffness and ∫ dz, ∫ z dz, ∫ z² dz.
template <class Visit>
void for_layers(const std::vector<tire::ShellLayer>& layers, Visit visit) {
  double z = 0.0;
  for (const tire::ShellLayer& layer : layers) z -= 0.5 * layer.thickness;
  for (const tire::ShellLayer& layer : layers) {
    const double top = z + layer.thickness;
    visit(turned(layer), top - z, (top * top - z * z) / 2, (top * top * top - z * z * z) / 3);
    z = top;
  }
}

}  // namespace

Abd plane_stress_abd(const std::vector<tire::ShellLayer>& layers) {
  Abd abd = Abd::Zero();
  for_layers(layers, [&](const Mat6& c, double i0, double i1, double i2) {
    const Mat3 q = c.topLeftCorner<3, 3>() - c.block<3, 1>(0, 3) * c.block<1, 3>(3, 0) / c(3, 3);
    abd.topLeftCorner<3, 3>() += i0 * q;
    abd.topRightCorner<3, 3>() += i1 * q;
    abd.bottomLeftCorner<3, 3>() += i1 * q;
    abd.bottomRightCorner<3, 3>() += i2 * q;
  });
  return abd;
}

Abd linear_thickness_abd(const std::vector<tire::ShellLayer>& layers) {
  Eigen::Matrix<double, 8, 8> all = Eigen::Matrix<double, 8, 8>::Zero();  // ε⁰, a; κ, b
  for_layers(layers, [&](const Mat6& c, double i0, double i1, double i2) {
    const Eigen::Matrix4d d = c.topLeftCorner<4, 4>();
    all.topLeftCorner<4, 4>() += i0 * d;
    all.topRightCorner<4, 4>() += i1 * d;
    all.bottomLeftCorner<4, 4>() += i1 * d;
    all.bottomRightCorner<4, 4>() += i2 * d;
  });
  const Eigen::Matrix<int, 6, 1> kept(0, 1, 2, 4, 5, 6);
  const Eigen::Matrix<int, 2, 1> gone(3, 7);
  const Eigen::Matrix<double, 6, 2> mixed = all(kept, gone);
  const Eigen::Matrix2d thickness = all(gone, gone);
  return all(kept, kept) - mixed * thickness.inverse() * mixed.transpose();
}

std::pair<double, double> shear_stiffness(const std::vector<tire::ShellLayer>& layers) {
  double s13 = 0.0, s23 = 0.0;
  for_layers(layers, [&](const Mat6& c, double i0, double, double) { s13 += i0 * c(4, 4), s23 += i0 * c(5, 5); });
  return {s13, s23};
}

double navier_deflection(const Abd& abd, std::pair<double, double> shear, double factor, double side, double q) {
  const double k = std::numbers::pi / side, s13 = factor * shear.first, s23 = factor * shear.second;
  const auto entry = [&](int row, int column) { return abd(row, column) * k * k; };
  Eigen::Matrix<double, 5, 5> m;  // of u, v, w, ψ₁, ψ₂
  const auto block = [&](int i, int j) {
    const double d11 = entry(i, j) + entry(i + 2, j + 2), d12 = entry(i, j + 1) + entry(i + 2, j + 2),
                 d22 = entry(i + 1, j + 1) + entry(i + 2, j + 2);
    Eigen::Matrix2d b;
    b << d11, d12, d12, d22;
    return b;
  };
  m.setZero();
  m.block<2, 2>(0, 0) = block(0, 0);
  m.block<2, 2>(0, 3) = block(0, 3);
  m.block<2, 2>(3, 0) = block(0, 3);
  m.block<2, 2>(3, 3) = block(3, 3) + Eigen::Vector2d(s13, s23).asDiagonal().toDenseMatrix();
  m(2, 2) = (s13 + s23) * k * k;
  m(2, 3) = m(3, 2) = s13 * k;
  m(2, 4) = m(4, 2) = s23 * k;
  Eigen::Matrix<double, 5, 1> load = Eigen::Matrix<double, 5, 1>::Zero();
  load[2] = q;
  return m.ldlt().solve(load)[2];
}

}  // namespace furrow::test
