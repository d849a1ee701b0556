#include "tire/planar/planar_modes.hpp"

#include <cmath>
#include <complex>

#include "protocol/core/assert.hpp"
#include "tire/planar/planar_tangent.hpp"
#include "tire/planar/planar_tire.hpp"

namespace furrow::tire {
namespace {

using Complex = std::complex<double>;
// Displacements x, z of a node in its unknowns.
using Tie = Eigen::Matrix2cd;

/// u = e^{i n θ} (û_t e_t + û_r e_r), θ from the top forwards, e_t = (cos θ, −sin θ), e_r = (sin θ, cos θ).
Tie tie(const PlanarField& p, int node, int order) {
  const double radius = std::hypot(p.x[node], p.z[node]), s = p.x[node] / radius, c = p.z[node] / radius;
  Tie t;
  t << c, s, -s, c;
  return t * std::polar(1.0, order * std::atan2(s, c));
}

}  // namespace

PlanarModes::PlanarModes(const PlanarParams& params)
    : carcass_(params), around_(params.size.around), rings_(params.size.rings), total_(planar_mass(params)) {
  FURROW_ASSERT(carcass_.mesh().nodes() == around_ * (rings_ + 1), carcass_.mesh().nodes(), around_, rings_);
}

/// Nodes are ordered ring by ring, from the inside outwards. Unknowns of ring k begin at 2 (k − 1); ring 0 is held.
Eigen::MatrixXcd PlanarModes::stiffness(int order) const {
  const PlanarElements& elements = carcass_.elements();
  const PlanarField& p = carcass_.mesh().position;
  Eigen::MatrixXcd k = Eigen::MatrixXcd::Zero(unknowns(), unknowns());
  const auto place = [&](int node) { return 2 * (node / around_ - 1); };
  const std::vector<double> pressure = elements.volumetric(p);
  for (int e = 0; e < elements.size(); ++e) {
    const auto node = elements.element(e).node;
    const PlanarMatrix m = element_tangent(elements, p, e, pressure[e]);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        if (place(node[a]) < 0 || place(node[b]) < 0) continue;
        k.block<2, 2>(place(node[a]), place(node[b])) +=
            tie(p, node[a], order).adjoint() * m.block<2, 2>(2 * a, 2 * b).cast<Complex>() * tie(p, node[b], order);
      }
  }
  for (const PlanarElements::Patch& patch : elements.patches()) {  // b A_p U'' g gᵀ of the undeformed tire, U'' = 2 κ
    Eigen::VectorXcd g = Eigen::VectorXcd::Zero(unknowns());
    for (const int e : patch.elements) {
      const auto part = volume_gradient(elements, p, e);
      const auto node = elements.element(e).node;
      for (int a = 0; a < 3; ++a)
        if (place(node[a]) >= 0)
          g.segment<2>(place(node[a])) +=
              tie(p, node[a], order).adjoint() * part.segment<2>(2 * a).cast<Complex>() / (3.0 * patch.area);
    }
    k += elements.options().width * patch.area * 2.0 * patch.kappa * g * g.adjoint();
  }
  return k / static_cast<double>(around_);
}

Eigen::MatrixXcd PlanarModes::mass() const {
  Eigen::MatrixXcd m = Eigen::MatrixXcd::Zero(unknowns(), unknowns());
  for (int ring = 1; ring <= rings_; ++ring)  // all nodes of a ring are equal
    for (int x = 0; x < 2; ++x) m(2 * (ring - 1) + x, 2 * (ring - 1) + x) = carcass_.mass()[ring * around_];
  return m;
}

ModesResults PlanarModes::modes(const ModesOptions& options, const ProgressCall& progress) const {
  ModesResults results;
  results.mass = total_;
  results.around = around_;
  const PlanarField& p = carcass_.mesh().position;
  for (int ring = 0; ring <= rings_; ++ring) {
    results.section.push_back({0.0, std::hypot(p.x[ring * around_], p.z[ring * around_])});
    if (ring > 0) results.lines.push_back({ring - 1, ring});
  }
  for (int order = 0; order <= options.orders; ++order) {
    if (progress) progress("solving", static_cast<double>(order) / (options.orders + 1));
    const LowestModes lowest = lowest_modes(stiffness(order), mass(), options.count);
    for (int k = 0; k < options.count; ++k)
      results.modes.push_back(mode_of(lowest, order, k, rings_ + 1, [&](const auto& vector, int ring) {
        std::array<Complex, 3> node{};  // of the rim: none
        if (ring > 0) node[0] = vector[2 * (ring - 1)], node[2] = vector[2 * (ring - 1) + 1];
        return node;
      }));
  }
  return results;
}

}  // namespace furrow::tire
