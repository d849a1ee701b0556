#include "tire/planar/planar_tangent.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::tire {
namespace {

using Vec2 = Eigen::Vector2d;

struct Shape {
  std::array<Vec2, 3> reference, deformed;  // ∇N, q
  double j = 1.0;
};

Shape shape_of(const PlanarElements& elements, const PlanarElements::Element& e, const PlanarField& x, int element) {
  Shape s;
  s.reference[1] = Vec2(e.inverse[0], e.inverse[1]);
  s.reference[2] = Vec2(e.inverse[2], e.inverse[3]);
  s.reference[0] = -(s.reference[1] + s.reference[2]);
  const auto f = elements.gradient(x, element);
  s.j = f[0] * f[3] - f[1] * f[2];
  Eigen::Matrix2d back;  // F⁻ᵀ
  back << f[3], -f[2], -f[1], f[0];
  for (int a = 0; a < 3; ++a) s.deformed[a] = back * s.reference[a] / s.j;
  return s;
}

PlanarMatrix tangent(const Shape& s, double scale, double mu, double alpha, double beta) {
  PlanarMatrix k;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      k.block<2, 2>(2 * a, 2 * b) = scale * (mu * s.reference[a].dot(s.reference[b]) * Eigen::Matrix2d::Identity() +
                                             alpha * s.deformed[b] * s.deformed[a].transpose() +
                                             beta * s.deformed[a] * s.deformed[b].transpose());
  return k;
}

double largest_eigenvalue(const PlanarMatrix& m) {
  return Eigen::SelfAdjointEigenSolver<PlanarMatrix>(m, Eigen::EigenvaluesOnly).eigenvalues()[5];
}

}  // namespace

PlanarMatrix element_tangent(const PlanarElements& elements, const PlanarField& x, int element, double pressure) {
  const PlanarElements::Element e = elements.element(element);
  const Shape s = shape_of(elements, e, x, element);
  const double scale = e.area * elements.options().width;
  if (elements.options().averaged) return tangent(s, scale, e.mu, e.mu - pressure * s.j, pressure * s.j);
  return tangent(s, scale, e.mu, e.mu - e.kappa * (s.j * s.j - 1.0), 2.0 * e.kappa * s.j * s.j);
}

Eigen::Matrix<double, 6, 1> volume_gradient(const PlanarElements& elements, const PlanarField& x, int element) {
  const PlanarElements::Element e = elements.element(element);
  const Shape s = shape_of(elements, e, x, element);
  Eigen::Matrix<double, 6, 1> g;
  for (int a = 0; a < 3; ++a) g.segment<2>(2 * a) = e.area * s.j * s.deformed[a];
  return g;
}

double step_limit(const PlanarElements& elements, const PlanarField& x) {
  double limit = std::numeric_limits<double>::infinity();
  for (int n = 0; n < elements.size(); ++n) {
    const PlanarElements::Element e = elements.element(n);
    const Shape s = shape_of(elements, e, x, n);
    const double per_mass = 3.0 / e.density;  // area and width cancel
    const double k =
        largest_eigenvalue(tangent(s, per_mass, e.mu, e.mu - e.kappa * (s.j * s.j - 1.0), 2.0 * e.kappa * s.j * s.j));
    double c = 0.0;
    if (e.viscosity > 0.0) {
      // D:D = ½ Σ [(u_a·u_b)(q_a·q_b) + (u_a·q_b)(q_a·u_b)]
      PlanarMatrix damping;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          damping.block<2, 2>(2 * a, 2 * b) = 0.5 * s.j * e.viscosity * per_mass *
                                              (s.deformed[a].dot(s.deformed[b]) * Eigen::Matrix2d::Identity() +
                                               s.deformed[b] * s.deformed[a].transpose());
      c = largest_eigenvalue(damping);
    }
    limit = std::min(limit, 4.0 / (c + std::sqrt(c * c + 4.0 * std::max(k, 0.0))));
  }
  return limit;
}

}  // namespace furrow::tire
