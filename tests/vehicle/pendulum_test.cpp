// Pendulum and double pendulum against the closed form (elliptic integral) and the equations of motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "protocol/core/constants.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

// Compound pendulum hinged at the origin about y: centre at a below it, angle from the vertical.
constexpr double kMass = 2.0, kArm = 0.7, kInertia = 0.3;  // kg, m, kg m²
const double kHingeInertia = kInertia + kMass * kArm * kArm;

Vec3 hanging(double arm, double angle) { return {-arm * std::sin(angle), 0.0, -arm * std::cos(angle)}; }

struct Pendulum {
  vehicle::System system;
  int body, joint;
  explicit Pendulum(double angle, const Vec3& gravity = standard_gravity()) : system(gravity) {
    body =
        system.add_body("bob", kMass, Vec3(0.2, kInertia, 0.25).asDiagonal(), bar_state(hanging(kArm, angle), angle));
    joint = system.add_joint(vehicle::JointKind::revolute, "hinge", vehicle::kGround, body, hinge(Vec3::Zero()));
    system.assemble(0.0);
  }
  double angle() const {
    const Vec3& x = system.body(body).state.position;
    return std::atan2(-x.x(), -x.z());
  }
};

// [Landau & Lifshitz, Mechanics, §11]: T = 4 √(I/(m g a)) K(sin θ₀/2)
double quarter_period(double amplitude) {
  return std::sqrt(kHingeInertia / (kMass * kStandardGravity * kArm)) * std::comp_ellint_1(std::sin(0.5 * amplitude));
}

double angle_after_quarter(int steps) {
  Pendulum pendulum(2.0);
  const double h = quarter_period(2.0) / steps;
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(pendulum.system.step(h).ok);
  return pendulum.angle();
}

}  // namespace

TEST(Pendulum, quarter_period_matches_elliptic_integral_with_second_order) {
  const double coarse = angle_after_quarter(100), fine = angle_after_quarter(200);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

TEST(Pendulum, hangs_at_rest_along_a_tilted_gravity) {
  const double tilt = 0.3;  // towards −x, where the bob hangs at this angle
  Pendulum pendulum(tilt, kStandardGravity * hanging(1.0, tilt));
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(pendulum.system.step(1e-3).ok);
  EXPECT_NEAR(pendulum.angle(), tilt, 1e-9);
}

TEST(Pendulum, energy_stays_bounded_over_many_swings) {
  Pendulum pendulum(2.0);
  const double start = pendulum.system.gravity_energy(), h = quarter_period(2.0) / 200;
  double largest = 0.0, late = 0.0;
  for (int i = 0; i < 40000; ++i) {
    EXPECT_TRUE(pendulum.system.step(h).ok);
    const double error = std::abs(pendulum.system.kinetic_energy() + pendulum.system.gravity_energy() - start);
    largest = std::max(largest, error);
    if (i >= 39200) late = std::max(late, error);
  }
  EXPECT_LT(largest, 1e-4 * kMass * kStandardGravity * kArm);
  EXPECT_LT(late, 1.01 * largest);
  EXPECT_LT(pendulum.system.max_violation(), 1e-12);
}

TEST(Pendulum, hinge_carries_weight_and_centripetal_force_at_the_bottom) {
  Pendulum pendulum(1.2);
  const int steps = 2000;
  const double h = quarter_period(1.2) / steps;
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(pendulum.system.step(h).ok);
  const double omega_sq = 2.0 * kMass * kStandardGravity * kArm * (1.0 - std::cos(1.2)) / kHingeInertia;
  const vehicle::Reaction& reaction = pendulum.system.reaction(pendulum.joint);
  EXPECT_NEAR(reaction.force.norm(), kMass * (kStandardGravity + kArm * omega_sq), 1e-4 * kMass * kStandardGravity);
  EXPECT_LT(reaction.moment.norm(), 1e-9);
}

TEST(Pendulum, reaction_times_step_is_the_change_of_momentum) {
  Pendulum pendulum(1.2);
  const double h = 0.01;
  for (int i = 0; i < 50; ++i) {
    const Vec3 before = pendulum.system.momentum();
    EXPECT_TRUE(pendulum.system.step(h).ok);
    const Vec3 change = (pendulum.system.momentum() - before) / h;
    const Mat3 axes = pendulum.system.joint(pendulum.joint).frame_a.axes;
    const Vec3 sum = axes * pendulum.system.reaction(pendulum.joint).force - Vec3(0, 0, kMass * kStandardGravity);
    EXPECT_LT((sum - change).norm(), 1e-12 * kMass * kStandardGravity * 10) << i;
  }
}

namespace {

// Double pendulum of two bars (mass m, length l, centre at l/2), angles from the vertical; Lagrange's
// equations.
constexpr double kBarMass = 1.5, kBarLength = 0.8;
constexpr double kBarInertia = kBarMass * kBarLength * kBarLength / 12.0;

using Angles = std::array<double, 4>;  // θ₁, θ₂, θ₁', θ₂'

Angles rates(const Angles& q) {
  const double a = 0.5 * kBarLength, m = kBarMass, l = kBarLength, g = kStandardGravity;
  const double c = std::cos(q[0] - q[1]), s = std::sin(q[0] - q[1]);
  const double M11 = kBarInertia + m * a * a + m * l * l, M22 = kBarInertia + m * a * a, M12 = m * l * a * c;
  const double r1 = -m * l * a * s * q[3] * q[3] - (m * a + m * l) * g * std::sin(q[0]);
  const double r2 = m * l * a * s * q[2] * q[2] - m * a * g * std::sin(q[1]);
  const double det = M11 * M22 - M12 * M12;
  return {q[2], q[3], (M22 * r1 - M12 * r2) / det, (M11 * r2 - M12 * r1) / det};
}

Angles runge_kutta(Angles q, double end, int steps) {
  const double h = end / steps;
  const auto plus = [](const Angles& x, double f, const Angles& d) {
    return Angles{x[0] + f * d[0], x[1] + f * d[1], x[2] + f * d[2], x[3] + f * d[3]};
  };
  for (int i = 0; i < steps; ++i) {
    const Angles k1 = rates(q), k2 = rates(plus(q, h / 2, k1)), k3 = rates(plus(q, h / 2, k2)),
                 k4 = rates(plus(q, h, k3));
    for (int j = 0; j < 4; ++j) q[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return q;
}

Angles double_pendulum(double first, double second, double end, int steps) {
  vehicle::System system;
  const Mat3 inertia = Vec3(kBarInertia, kBarInertia, 0.01).asDiagonal();
  const Vec3 knee = hanging(kBarLength, first);
  const int upper = system.add_body("upper", kBarMass, inertia, bar_state(hanging(0.5 * kBarLength, first), first));
  const int lower =
      system.add_body("lower", kBarMass, inertia, bar_state(knee + hanging(0.5 * kBarLength, second), second));
  system.add_joint(vehicle::JointKind::revolute, "shoulder", vehicle::kGround, upper, hinge(Vec3::Zero()));
  system.add_joint(vehicle::JointKind::revolute, "knee", upper, lower, hinge(knee));
  system.assemble(0.0);
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(end / steps).ok);
  const auto angle = [&](int body) {
    const Vec3 z = system.body(body).R.col(2);
    return std::atan2(z.x(), z.z());
  };
  return {angle(upper), angle(lower), system.body(upper).state.angular_velocity.y(),
          system.body(lower).state.angular_velocity.y()};
}

double worst_difference(const Angles& a, const Angles& b) {
  double worst = 0.0;
  for (int j = 0; j < 4; ++j) worst = std::max(worst, std::abs(a[j] - b[j]));
  return worst;
}

}  // namespace

TEST(DoublePendulum, follows_lagrange_equations_with_second_order) {
  const Angles reference = runge_kutta({1.0, -0.4, 0.0, 0.0}, 1.5, 20000);
  const double coarse = worst_difference(double_pendulum(1.0, -0.4, 1.5, 1000), reference);
  const double fine = worst_difference(double_pendulum(1.0, -0.4, 1.5, 2000), reference);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}
