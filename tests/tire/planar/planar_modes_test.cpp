// Natural frequencies of the planar tire against closed forms of a thick ring, and against the whole mesh at once.
#include "tire/planar/planar_modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/tire/planar/planar_examples.hpp"

namespace furrow::tire {
namespace {

constexpr double kInner = 0.25, kOuter = 0.5;  // m

PlanarParams ring(int rings, int around, bool averaged = false) {
  PlanarParams p;
  p.size = {.radius = kOuter, .rim_radius = kInner, .rings = rings, .around = around};
  p.tire = {1100.0, 3e5, 0.3, 0.0};
  p.disc = kStiffDisc;
  p.options.averaged = averaged, p.options.width = 0.7;
  p.contact_stiffness = 1e6;
  return p;
}

/// The first k above 0 at which f changes its sign.
double first_root(const std::function<double(double)>& f) {
  double low = 0.05, step = 0.05;
  while (f(low) * f(low + step) > 0.0) low += step;
  for (double high = low + step; step > 1e-12; step *= 0.5) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

/// Inner edge held, outer edge free. Turning: u_θ = A J₁(kr) + B Y₁(kr), ω = k √(μ/ρ), with u = 0 inside and
/// τ ∝ u′ − u/r = 0 outside, x f₁′ − f₁ = −x f₂ [Achenbach 1973, Wave Propagation in Elastic Solids, § 6.10].
double turning(const PlanarMaterial& m) {
  const double k = first_root([](double wave) {
    const double a = wave * kInner, b = wave * kOuter;
    return std::cyl_bessel_j(1, a) * std::cyl_neumann(2, b) - std::cyl_neumann(1, a) * std::cyl_bessel_j(2, b);
  });
  return k * std::sqrt(planar_moduli(m, PlanarLaw::consistent).mu / m.density) / (2.0 * std::numbers::pi);
}

/// Breathing: u_r has the same form with ω = k √((λ + 2μ)/ρ), and (λ + 2μ) u′ + λ u/r = 0 outside.
double breathing(const PlanarMaterial& m) {
  const PlanarModuli moduli = planar_moduli(m, PlanarLaw::consistent);
  const double lambda = 2.0 * moduli.kappa, stiff = lambda + 2.0 * moduli.mu;
  const double k = first_root([&](double wave) {
    const double a = wave * kInner, b = wave * kOuter;
    const auto stress = [&](double f0, double f1) { return stiff * (f0 - f1 / b) + lambda * f1 / b; };
    return std::cyl_bessel_j(1, a) * stress(std::cyl_neumann(0, b), std::cyl_neumann(1, b)) -
           std::cyl_neumann(1, a) * stress(std::cyl_bessel_j(0, b), std::cyl_bessel_j(1, b));
  });
  return k * std::sqrt(stiff / m.density) / (2.0 * std::numbers::pi);
}

TEST(PlanarModes, turning_and_breathing_of_a_held_ring_converge_to_bessels_functions) {
  for (const bool averaged : {false, true}) {
    double before[2] = {1.0, 1.0};
    for (const int size : {1, 2, 4}) {
      const PlanarParams p = ring(4 * size, 24 * size, averaged);
      const ModesResults results = PlanarModes(p).modes({.orders = 0, .count = 4}, {});
      for (const bool radial : {false, true}) {
        const auto is_it = [&](const Mode& mode) {
          const auto& outer = mode.shape.back();
          return (std::abs(outer[2]) > std::abs(outer[0])) == radial;
        };
        const auto mode = std::ranges::find_if(results.modes, is_it);
        ASSERT_NE(mode, results.modes.end());
        const double off = std::abs(mode->frequency / (radial ? breathing(p.tire) : turning(p.tire)) - 1.0);
        EXPECT_LT(off, 0.35 * before[radial]) << size << (radial ? " breathing" : " turning");
        before[radial] = off;
      }
    }
    EXPECT_LT(std::max(before[0], before[1]), 3e-3) << averaged;
  }
}

TEST(PlanarModes, orders_together_have_the_frequencies_of_the_whole_mesh) {
  for (const bool averaged : {false, true}) {
    const PlanarParams p = ring(3, 12, averaged);
    const PlanarModes modes(p);
    std::vector<double> by_order;
    for (int order = -5; order <= 6; ++order) {
      const Eigen::VectorXd squares = lowest_squares(modes.stiffness(order), modes.mass(), modes.unknowns());
      by_order.insert(by_order.end(), squares.begin(), squares.end());
    }
    std::sort(by_order.begin(), by_order.end());
    const PlanarCarcass carcass(p);
    const Eigen::MatrixXd all = assembled(carcass.elements(), carcass.mesh().position);
    const int held = 2 * 12, free = static_cast<int>(all.rows()) - held;  // inner nodes come first
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(free, free);
    for (int u = 0; u < free; ++u) mass(u, u) = carcass.mass()[(u + held) / 2];
    const Eigen::VectorXd whole = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
                                      all.bottomRightCorner(free, free), mass, Eigen::EigenvaluesOnly)
                                      .eigenvalues();
    ASSERT_EQ(by_order.size(), static_cast<std::size_t>(free));
    for (int u = 0; u < free; ++u) EXPECT_NEAR(by_order[u], whole[u], 1e-9 * whole[u]) << u;
  }
}

TEST(PlanarModes, frequencies_go_with_the_root_of_modulus_over_density_and_not_with_the_width) {
  PlanarParams p = ring(4, 24);
  const ModesResults before = PlanarModes(p).modes({.orders = 3, .count = 2}, {});
  p.tire.young_modulus *= 4.0, p.tire.density *= 0.25, p.options.width *= 3.0;
  const ModesResults after = PlanarModes(p).modes({.orders = 3, .count = 2}, {});
  ASSERT_EQ(before.modes.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(after.modes[k].frequency, 4.0 * before.modes[k].frequency, 1e-9 * after.modes[k].frequency);
    EXPECT_EQ(before.modes[k].order, static_cast<int>(k / 2));
    EXPECT_EQ(before.modes[k].number, static_cast<int>(k % 2) + 1);
    double largest = 0.0;
    for (const auto& node : before.modes[k].shape)
      for (const auto& value : node) largest = std::max(largest, std::abs(value));
    EXPECT_NEAR(largest, 1.0, 1e-12);
    EXPECT_EQ(before.modes[k].shape.front(), (std::array<std::complex<double>, 3>{}));  // on the rim
  }
}

}  // namespace
}  // namespace furrow::tire
