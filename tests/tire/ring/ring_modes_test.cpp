// Natural frequencies of the flexible ring against the continuous ring in closed form, and against the whole ring at
// once.
#include "tire/ring/ring_modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "tests/tire/ring/ring_examples.hpp"

namespace furrow::tire {
namespace {

using std::numbers::pi;

RingMotion motion() { return {.rim_radius = 0.21, .mass = 20.0, .spin_inertia = 2.2, .damping = 0.0}; }

/// Both frequencies of u = U cos nθ, v = V sin nθ per radian [belt of ring_mechanics.hpp (2), continuous], Hz.
std::array<double, 2> closed_form(const RingParams& p, int n) {
  const double n2 = n * n, m = belt_mass(motion(), p.radius) / (2.0 * pi);
  double uu = p.bending * n2 * n2 + p.shear * n2 + p.sidewall_1 + p.tension_share * p.pressure * p.width * (n2 - 1.0);
  if (n == 0) {  // air: p_abs (R T)² 2π/V₀ per radian
    const double volume = p.air_share * pi * p.radius * p.radius * p.width;
    uu += (p.pressure + p.ambient) * std::pow(p.radius * p.width, 2) * 2.0 * pi / volume;
  }
  const double vv = p.bending * n2 + p.shear * n2 * n2 + p.tangential, uv = n * n2 * (p.bending + p.shear);
  const double middle = 0.5 * (uu + vv), apart = std::hypot(0.5 * (uu - vv), uv);
  return {std::sqrt((middle - apart) / m) / (2.0 * pi), std::sqrt((middle + apart) / m) / (2.0 * pi)};
}

TEST(RingModes, frequencies_converge_to_those_of_the_continuous_ring) {
  for (const double tension : {0.0, 0.6}) {
    double before = 1.0;
    for (const int segments : {60, 120, 240, 480}) {
      RingParams p = with_tension(linear_ring(segments), tension);
      p.pressure = tension > 0.0 ? 4e5 : 0.0;
      const ModesResults r = RingModes(p, motion(), {}).modes({.orders = 8, .count = 2}, {});
      double worst = 0.0;
      for (const Mode& mode : r.modes)
        worst = std::max(worst, std::abs(mode.frequency / closed_form(p, mode.order)[mode.number - 1] - 1.0));
      EXPECT_LT(worst, 0.27 * before) << segments;
      before = worst;
    }
    EXPECT_LT(before, 1e-3);
  }
  // Orders 0 and 1, for which the differences are exact.
  const RingParams p = linear_ring(16);
  const ModesResults r = RingModes(p, motion(), {}).modes({.orders = 1, .count = 2}, {});
  for (const Mode& mode : r.modes)
    EXPECT_NEAR(mode.frequency, closed_form(p, mode.order)[mode.number - 1], 1e-9 * mode.frequency);
}

TEST(RingModes, orders_together_have_the_frequencies_of_the_whole_ring) {
  constexpr int kSegments = 17;
  const RingParams p = truck_ring(kSegments);
  const RingModes modes(p, motion(), {});
  std::vector<double> by_order, whole;
  for (int order = -kSegments / 2; order <= kSegments / 2; ++order) {
    const Eigen::VectorXd squares = lowest_squares(modes.stiffness(order), Eigen::MatrixXcd::Identity(2, 2), 2);
    by_order.insert(by_order.end(), squares.begin(), squares.end());
  }
  std::sort(by_order.begin(), by_order.end());
  RingMechanics ring(p);
  Eigen::MatrixXd stiffness(2 * kSegments, 2 * kSegments);  // by differences of the gradient, an independent check
  const double size = 1e-6;
  for (int c = 0; c < 2 * kSegments; ++c) {
    RingField q = ring.zero(), up = q, down = q;
    double& one = c % 2 ? q.v[c / 2] : q.u[c / 2];
    one = size, ring.gradient(q, up);
    one = -size, ring.gradient(q, down);
    for (int r = 0; r < 2 * kSegments; ++r)
      stiffness(r, c) = (r % 2 ? up.v[r / 2] - down.v[r / 2] : up.u[r / 2] - down.u[r / 2]) / (2.0 * size);
  }
  const Eigen::VectorXd squares = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues();
  ASSERT_EQ(by_order.size(), static_cast<std::size_t>(squares.size()));
  for (int k = 0; k < squares.size(); ++k) EXPECT_NEAR(by_order[k], squares[k], 1e-6 * squares[k]) << k;
}

TEST(RingModes, shapes_are_those_of_the_belt_on_a_rim_that_does_not_move) {
  RingParams p = truck_ring(48);
  p.shear = 4e8;
  const ModesResults r = RingModes(p, motion(), {5.0, Mat3::Identity()}).modes({.orders = 4, .count = 2}, {});
  ASSERT_EQ(r.modes.size(), 10U);
  EXPECT_EQ(r.around, 48);
  EXPECT_EQ(*r.pressure, p.pressure);
  EXPECT_EQ(r.mass.mass, 5.0);
  for (const Mode& mode : r.modes) {
    ASSERT_EQ(mode.shape.size(), 2U);
    EXPECT_EQ(mode.shape[0], (std::array<std::complex<double>, 3>{}));
    EXPECT_NEAR(std::max(std::abs(mode.shape[1][0]), std::abs(mode.shape[1][2])), 1.0, 1e-12);
  }
  // In order 1 a stiff belt shifts without deformation. Upwards this is radial cos θ and tangential −sin θ, θ from the
  // top forwards.
  const auto& shift = r.modes[2].shape[1];
  EXPECT_NEAR(std::abs(shift[0]) / std::abs(shift[2]), 1.0, 0.01);
  EXPECT_NEAR(std::arg(shift[0] / shift[2]), 0.5 * pi, 1e-9);
}

}  // namespace
}  // namespace furrow::tire
