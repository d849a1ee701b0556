// Patch tests on a distorted mesh and a cantilever; references: the exact states themselves, plate and beam
// theory.
#include <gtest/gtest.h>

#include <cmath>

#include "flat_patch.hpp"

namespace furrow::test {
namespace {

constexpr double kYoung = 2.0e7, kPoisson = 0.3, kThickness = 0.05;  // Pa, –, m

std::vector<int> coordinates(int first_node, int last_node, int first, int last) {
  std::vector<int> list;
  for (int n = first_node; n < last_node; ++n)
    for (int c = first; c < last; ++c) list.push_back(6 * n + c);
  return list;
}

TEST(ShellPatch, membrane_state_of_constant_plane_stress_is_exact) {
  const FlatPatch patch = FlatPatch::distorted({isotropic_layer(kThickness, kYoung, kPoisson)});
  Mat3 f;
  f << 1.04, 0.03, 0, -0.02, 0.98, 0, 0, 0, 1;
  const Mat3 e = 0.5 * (f.transpose() * f - Mat3::Identity());
  const double e33 = -kPoisson / (1 - kPoisson) * (e(0, 0) + e(1, 1));  // S₃₃ = 0
  f(2, 2) = std::sqrt(1 + 2 * e33);
  Eigen::VectorXd exact = patch.reference(), q = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n)
    for (const int s : {0, 3}) exact.segment<3>(6 * n + s) = f * patch.reference().segment<3>(6 * n + s);
  for (int n = 0; n < 4; ++n) q.segment<3>(6 * n) = exact.segment<3>(6 * n);
  auto free = coordinates(4, 8, 0, 6);
  for (const int c : coordinates(0, 4, 3, 6)) free.push_back(c);
  patch.solve(q, free, Eigen::VectorXd::Zero(q.size()));
  EXPECT_LT((q - exact).norm(), 1e-11);
  const double plane = kYoung / (1 - kPoisson * kPoisson);
  const double density = 0.5 * plane *
                         (e(0, 0) * e(0, 0) + e(1, 1) * e(1, 1) + 2 * kPoisson * e(0, 0) * e(1, 1) +
                          2 * (1 - kPoisson) * e(0, 1) * e(0, 1));
  EXPECT_NEAR(patch.energy(q), density * 2.0 * kThickness, 1e-10 * density);
}

TEST(ShellPatch, thickness_state_keeps_the_full_stiffness_c33) {
  const FlatPatch patch = FlatPatch::distorted({isotropic_layer(kThickness, kYoung, kPoisson)});
  Eigen::VectorXd exact = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) exact[6 * n + 5] = 1.02;  // directors held, as by a uniform squeeze
  Eigen::VectorXd q = exact;
  q[6 * 4] += 0.01, q[6 * 6 + 1] -= 0.02;
  patch.solve(q, coordinates(4, 8, 0, 3), Eigen::VectorXd::Zero(q.size()));
  EXPECT_LT((q - exact).norm(), 1e-11);
  const double e33 = 0.5 * (1.02 * 1.02 - 1),
               c33 = kYoung * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson));
  EXPECT_NEAR(patch.energy(q), 0.5 * c33 * e33 * e33 * 2.0 * kThickness, 1e-9 * patch.energy(q));
}

TEST(ShellPatch, bending_state_of_constant_moment_matches_kirchhoff_plate_energy) {
  const FlatPatch patch = FlatPatch::distorted({isotropic_layer(kThickness, kYoung, kPoisson)});
  const double kxx = 1e-5, kyy = -0.6e-5, kxy = 0.4e-5;  // w = ½ (kxx x² + kyy y²) + kxy x y
  Eigen::VectorXd exact = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) {
    const double x = exact[6 * n], y = exact[6 * n + 1];
    exact[6 * n + 2] = 0.5 * (kxx * x * x + kyy * y * y) + kxy * x * y;
    exact[6 * n + 3] = -(kxx * x + kxy * y);
    exact[6 * n + 4] = -(kyy * y + kxy * x);
  }
  Eigen::VectorXd q = exact;
  for (const int c : coordinates(4, 8, 0, 6)) q[c] = patch.reference()[c];
  patch.solve(q, coordinates(4, 8, 0, 6), Eigen::VectorXd::Zero(q.size()));
  EXPECT_LT((q - exact).norm(), 1e-9);  // second-order terms of the large-rotation strain
  const double d = kYoung * std::pow(kThickness, 3) / (12 * (1 - kPoisson * kPoisson));
  const double theory =
      0.5 * d * (kxx * kxx + kyy * kyy + 2 * kPoisson * kxx * kyy + 2 * (1 - kPoisson) * kxy * kxy) * 2.0;
  EXPECT_NEAR(patch.energy(q), theory, 1e-5 * theory);
}

TEST(ShellPatch, rigid_motion_by_a_large_rotation_has_no_energy) {
  const FlatPatch patch = FlatPatch::distorted({isotropic_layer(kThickness, kYoung, kPoisson)});
  const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Eigen::VectorXd q = patch.reference();
  for (int n = 0; n < patch.nodes(); ++n) {
    q.segment<3>(6 * n) = turn * q.segment<3>(6 * n) + Vec3(7, -3, 2);
    q.segment<3>(6 * n + 3) = turn * q.segment<3>(6 * n + 3);
  }
  EXPECT_LT(patch.energy(q), 1e-20 * kYoung);
}

/// Length 1 m, width 0.1 m, along x.
double cantilever_tip(int elements, double height, double force) {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 4>> quads;
  for (int i = 0; i <= elements; ++i)
    for (int j = 0; j < 2; ++j) nodes.push_back({static_cast<double>(i) / elements, 0.1 * j, 0});
  for (int i = 0; i < elements; ++i) quads.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  const FlatPatch strip(nodes, quads, {isotropic_layer(height, kYoung, 0.3)});
  Eigen::VectorXd q = strip.reference(), load = Eigen::VectorXd::Zero(q.size());
  load[6 * (2 * elements) + 2] = load[6 * (2 * elements + 1) + 2] = 0.5 * force;
  std::vector<int> free = coordinates(2, strip.nodes(), 0, 6);
  for (int n = 0; n < 2; ++n) free.insert(free.end(), {6 * n + 5});  // the clamp lets the thickness breathe
  if (strip.nodes() > 1) free.push_back(6 + 1);                      // and the width
  strip.solve(q, free, load);
  return q[6 * 2 * elements + 2];
}

TEST(ShellPatch, cantilever_tip_matches_beam_theory_for_thick_and_thin_strips) {
  for (const double height : {0.05, 0.005}) {
    const double inertia = 0.1 * std::pow(height, 3) / 12, force = 1e-5 * kYoung * inertia;
    const double shear =
        force / (kYoung / 2.6 * 0.1 * height);  // δ = F L³/(3 E I) + F L/(G A), no shear correction
    const double theory = force / (3 * kYoung * inertia) + shear;
    const double tip = cantilever_tip(20, height, force);
    EXPECT_NEAR(tip, theory, 0.01 * theory) << "height " << height;
  }
}

}  // namespace
}  // namespace furrow::test
