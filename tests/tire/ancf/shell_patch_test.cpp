// Patch tests on a distorted mesh and a cantilever; references: the exact states themselves, plate and beam
// theory.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <vector>

#include "shell_patch.hpp"

namespace furrow::test {
namespace {

constexpr double kYoung = 2.0e7, kPoisson = 0.3, kThickness = 0.05;  // Pa, –, m

std::vector<int> range(int first, int last) {
  std::vector<int> list;
  for (int n = first; n < last; ++n) list.push_back(n);
  return list;
}

/// Equilibrium with the prescribed coordinates as in `q`.
Vector solve(const ShellPatch& patch, const Supports& supports, const Vector& q) {
  StaticPath path(patch, supports, Vector::Zero(patch.coordinates()));
  path.prescribe([&](double share, Vector& target) {
    for (int c = 0; c < patch.coordinates(); ++c)
      if (supports.fixed(c)) target[c] = patch.reference()[c] + share * (q[c] - patch.reference()[c]);
  });
  EXPECT_TRUE(path.go_to(1.0));
  return path.q();
}

TEST(ShellPatch, membrane_state_of_constant_plane_stress_is_exact) {
  const ShellPatch patch(distorted_mesh(), {isotropic_layer(kThickness, kYoung, kPoisson)});
  Mat3 f;
  f << 1.04, 0.03, 0, -0.02, 0.98, 0, 0, 0, 1;
  const Mat3 e = 0.5 * (f.transpose() * f - Mat3::Identity());
  const double e33 = -kPoisson / (1 - kPoisson) * (e(0, 0) + e(1, 1));  // S₃₃ = 0
  f(2, 2) = std::sqrt(1 + 2 * e33);
  Vector exact = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n)
    for (const int s : {0, 3}) exact.segment<3>(6 * n + s) = f * patch.reference().segment<3>(6 * n + s);
  const Vector q = solve(patch, Supports(8).fix(range(0, 4), "xyz"), exact);
  EXPECT_LT((q - exact).norm(), 1e-11);
  const double plane = kYoung / (1 - kPoisson * kPoisson);
  const double density = 0.5 * plane *
                         (e(0, 0) * e(0, 0) + e(1, 1) * e(1, 1) + 2 * kPoisson * e(0, 0) * e(1, 1) +
                          2 * (1 - kPoisson) * e(0, 1) * e(0, 1));
  EXPECT_NEAR(patch.energy(q), density * 2.0 * kThickness, 1e-10 * density);
}

TEST(ShellPatch, thickness_state_keeps_the_full_stiffness_c33) {
  const ShellPatch patch(distorted_mesh(), {isotropic_layer(kThickness, kYoung, kPoisson)});
  Vector exact = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) exact[6 * n + 5] = 1.02;  // directors held, as by a uniform squeeze
  const Vector q = solve(patch, Supports(8).fix(range(0, 4), "xyzabc").fix(range(4, 8), "abc"), exact);
  EXPECT_LT((q - exact).norm(), 1e-11);
  const double e33 = 0.5 * (1.02 * 1.02 - 1), c33 = kYoung * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson));
  EXPECT_NEAR(patch.energy(q), 0.5 * c33 * e33 * e33 * 2.0 * kThickness, 1e-9 * patch.energy(q));
}

TEST(ShellPatch, bending_state_of_constant_moment_matches_kirchhoff_plate_energy) {
  const ShellPatch patch(distorted_mesh(), {isotropic_layer(kThickness, kYoung, kPoisson)});
  const double kxx = 1e-5, kyy = -0.6e-5, kxy = 0.4e-5;  // w = ½ (kxx x² + kyy y²) + kxy x y
  Vector exact = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) {
    const double x = exact[6 * n], y = exact[6 * n + 1];
    exact[6 * n + 2] = 0.5 * (kxx * x * x + kyy * y * y) + kxy * x * y;
    exact[6 * n + 3] = -(kxx * x + kxy * y);
    exact[6 * n + 4] = -(kyy * y + kxy * x);
  }
  const Vector q = solve(patch, Supports(8).fix(range(0, 4), "xyzabc"), exact);
  EXPECT_LT((q - exact).norm(), 1e-9);  // second-order terms of the large-rotation strain
  const double d = kYoung * std::pow(kThickness, 3) / (12 * (1 - kPoisson * kPoisson));
  const double theory =
      0.5 * d * (kxx * kxx + kyy * kyy + 2 * kPoisson * kxx * kyy + 2 * (1 - kPoisson) * kxy * kxy) * 2.0;
  EXPECT_NEAR(patch.energy(q), theory, 1e-5 * theory);
}

TEST(ShellPatch, rigid_motion_by_a_large_rotation_has_no_energy) {
  const ShellPatch patch(distorted_mesh(), {isotropic_layer(kThickness, kYoung, kPoisson)});
  const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Vector q = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) {
    q.segment<3>(6 * n) = turn * q.segment<3>(6 * n) + Vec3(7, -3, 2);
    q.segment<3>(6 * n + 3) = turn * q.segment<3>(6 * n + 3);
  }
  EXPECT_LT(patch.energy(q), 1e-20 * kYoung);
}

/// Length 1 m, width 0.1 m, along x. The clamp leaves thickness and width free.
double cantilever_tip(int elements, double height, double force) {
  const ShellPatch strip(plate_mesh(elements, 1, 1.0, 0.1), {isotropic_layer(height, kYoung, 0.3)});
  Vector load = Vector::Zero(strip.coordinates());
  load[6 * (2 * elements) + 2] = load[6 * (2 * elements + 1) + 2] = 0.5 * force;
  StaticPath path(strip, Supports(strip.nodes()).fix({0}, "xyzab").fix({1}, "xzab"), load);
  EXPECT_TRUE(path.go_to(1.0));
  return path.q()[6 * 2 * elements + 2];
}

TEST(ShellPatch, cantilever_tip_matches_beam_theory_for_thick_and_thin_strips) {
  for (const double height : {0.05, 0.005}) {
    const double inertia = 0.1 * std::pow(height, 3) / 12, force = 1e-5 * kYoung * inertia;
    const double shear = force / (kYoung / 2.6 * 0.1 * height);  // δ = F L³/(3 E I) + F L/(G A), no shear correction
    const double theory = force / (3 * kYoung * inertia) + shear;
    const double tip = cantilever_tip(20, height, force);
    EXPECT_NEAR(tip, theory, 0.01 * theory) << "height " << height;
  }
}

}  // namespace
}  // namespace furrow::test
