// Strain of the contact surface against closed forms.
#include "tire/surface_strain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::tire {
namespace {

const SurfaceMesh kSquare{4, {{0, 1, 2}, {0, 2, 3}}};
const std::vector<Vec3> kFlat{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

std::vector<float> strain_under(const Mat3& gradient) {
  std::vector<Vec3> moved;
  for (const Vec3& x : kFlat) moved.push_back(gradient * x + Vec3(3, -2, 1));
  return surface_strain(kSquare, kFlat, moved);
}

TEST(SurfaceStrain, a_rigid_motion_strains_nothing) {
  for (const float e : strain_under(Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()).toRotationMatrix()))
    EXPECT_NEAR(e, 0.0, 1e-7);
}

TEST(SurfaceStrain, a_stretch_in_two_directions_gives_the_larger_one) {
  const Mat3 turn = Eigen::AngleAxisd(0.4, Vec3(1, 0, 1).normalized()).toRotationMatrix();
  for (const float e : strain_under(turn * Vec3(0.9, 1.2, 1.0).asDiagonal())) EXPECT_NEAR(e, 0.5 * (1.44 - 1), 1e-6);
}

TEST(SurfaceStrain, simple_shear_has_the_closed_form) {
  const double s = 0.3;
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = s;
  const double expected = 0.25 * s * s + 0.5 * s * std::sqrt(1.0 + 0.25 * s * s);  // of ½ [0 s; s s²]
  for (const float e : strain_under(shear)) EXPECT_NEAR(e, expected, 1e-6);
}

TEST(SurfaceStrain, a_vertex_takes_the_mean_by_undeformed_area) {
  const SurfaceMesh mesh{4, {{0, 1, 2}, {0, 3, 1}}};
  const std::vector<Vec3> before{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, -1, 0}};
  std::vector<Vec3> after = before;
  after[2].y() = 2.4;  // the first triangle, of twice the area, stretches to λ = 1.2
  const std::vector<float> strain = surface_strain(mesh, before, after);
  EXPECT_NEAR(strain[2], 0.22, 1e-6);
  EXPECT_NEAR(strain[3], 0.0, 1e-7);
  EXPECT_NEAR(strain[0], 0.22 * 2.0 / 3.0, 1e-6);
}

}  // namespace
}  // namespace furrow::tire
