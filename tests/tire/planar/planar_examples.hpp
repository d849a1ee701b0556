// Planar meshes for tests.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "tire/planar/planar_elements.hpp"
#include "tire/planar/planar_tangent.hpp"

namespace furrow::tire {

inline constexpr PlanarMaterial kRubber{1100.0, 3e5, 0.45, 0.0}, kStiffDisc{900.0, 5e6, 0.3, 0.0};

/// A wheel of 0.5 m with a disc of 0.25 m.
inline PlanarMesh small_wheel(int around = 24, int rings = 4) {
  return planar_wheel({.radius = 0.5, .rim_radius = 0.25, .rings = rings, .around = around});
}

inline PlanarElements wheel_elements(const PlanarMesh& mesh, const PlanarOptions& options = {},
                                     double viscosity = 0.0) {
  PlanarMaterial disc = kStiffDisc, rubber = kRubber;
  disc.viscosity = rubber.viscosity = viscosity;
  return PlanarElements(mesh, std::array{disc, rubber}, options);
}

inline PlanarField random_planar(std::size_t nodes, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-size, size);
  PlanarField f(nodes);
  for (std::size_t n = 0; n < nodes; ++n) f.x[n] = any(random), f.z[n] = any(random);
  return f;
}

inline PlanarField along(const PlanarField& a, const PlanarField& b, double share) {  // a + share × b
  PlanarField out = a;
  for (std::size_t n = 0; n < a.size(); ++n) out.x[n] += share * b.x[n], out.z[n] += share * b.z[n];
  return out;
}

inline double dot(const PlanarField& a, const PlanarField& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += a.x[n] * b.x[n] + a.z[n] * b.z[n];
  return sum;
}

inline double largest(const PlanarField& a) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max({most, std::abs(a.x[n]), std::abs(a.z[n])});
  return most;
}

/// x → A x + shift
inline PlanarField mapped(const PlanarField& p, const Eigen::Matrix2d& a, double shift_x = 0.0, double shift_z = 0.0) {
  PlanarField out = p;
  for (std::size_t n = 0; n < p.size(); ++n) {
    out.x[n] = a(0, 0) * p.x[n] + a(0, 1) * p.z[n] + shift_x;
    out.z[n] = a(1, 0) * p.x[n] + a(1, 1) * p.z[n] + shift_z;
  }
  return out;
}

/// ∂²Π/∂x² of all nodes: unknowns x, z of node 0, of node 1, …
inline Eigen::MatrixXd assembled(const PlanarElements& elements, const PlanarField& x) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(2 * elements.nodes(), 2 * elements.nodes());
  const std::vector<double> pressure = elements.volumetric(x);
  for (int e = 0; e < elements.size(); ++e) {
    const auto node = elements.element(e).node;
    const PlanarMatrix m = element_tangent(elements, x, e, pressure[e]);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) k.block<2, 2>(2 * node[a], 2 * node[b]) += m.block<2, 2>(2 * a, 2 * b);
  }
  for (const PlanarElements::Patch& patch : elements.patches()) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(2 * elements.nodes());
    double volume = 0.0;
    for (const int e : patch.elements) {
      const auto part = volume_gradient(elements, x, e);
      const auto f = elements.gradient(x, e);
      volume += elements.element(e).area * (f[0] * f[3] - f[1] * f[2]);
      for (int a = 0; a < 3; ++a)
        g.segment<2>(2 * elements.element(e).node[a]) += part.segment<2>(2 * a) / (3.0 * patch.area);
    }
    const double j = volume / (3.0 * patch.area);
    k += elements.options().width * patch.area * patch.kappa * (1.0 + 1.0 / (j * j)) * g * g.transpose();
  }
  return k;
}

}  // namespace furrow::tire
