// The surface of a wheel with grousers, against the volume and the reach of its plates.
#include "tire/rigid/grousers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tire/cylinder.hpp"
#include "tire/outward.hpp"
#include "tire/reach.hpp"
#include "tire/rigid/rigid_tire.hpp"

namespace furrow::tire {
namespace {

constexpr double kRadius = 0.058, kWidth = 0.05, kHeight = 0.005, kThickness = 0.002;

TireShape wheel(int grousers) {
  TireShape shape = cylinder(72, kRadius, kWidth, 7);
  if (grousers > 0) add_grousers(shape, grousers, kHeight, kThickness);
  return shape;
}

/// Of the cones from the axle's middle to the triangles, m³.
double volume(const TireShape& shape) {
  double sum = 0.0;
  for (const auto& [a, b, c] : shape.mesh.triangles)
    sum += shape.vertex[a].dot(shape.vertex[b].cross(shape.vertex[c])) / 6.0;
  return sum;
}

TEST(Grousers, each_plate_has_its_volume_and_the_cone_beneath_its_open_base) {
  const TireShape smooth = wheel(0), with = wheel(24);
  const double plate = 2.0 * kHeight * kThickness * kWidth, cone = (kRadius - kHeight) * kThickness * kWidth / 3.0;
  EXPECT_NEAR(volume(with) - volume(smooth), 24 * (plate + cone), 1e-12 * volume(smooth));
  EXPECT_NO_THROW(require_outward(with.mesh, with.vertex, Vec3::Zero(), "wheel"));
  EXPECT_EQ(with.mesh.vertex_count, static_cast<int>(with.vertex.size()));
  EXPECT_EQ(with.mesh.vertex_count, smooth.mesh.vertex_count + 24 * kGrouserVertices);
}

TEST(Grousers, tips_are_the_reach_of_the_wheel_and_the_discs_stay_last) {
  RigidTire tire(wheel(5));
  EXPECT_NEAR(inflated_reach(tire, 0.0), std::hypot(kRadius + kHeight, 0.5 * kThickness), 1e-15);
  EXPECT_EQ(tire.radius(), kRadius);
  EXPECT_EQ(tire.tread_vertices(), 72 * 7);
  EXPECT_EQ(RigidTire(wheel(0)).tread_vertices(), 72 * 7 + 2);
  SurfaceState surface;
  tire.surface(surface);
  EXPECT_EQ(surface.position.back(), Vec3(0.0, -0.5 * kWidth, 0.0));
  EXPECT_EQ(surface.position[surface.position.size() - 2], Vec3(0.0, 0.5 * kWidth, 0.0));
}

TEST(Grousers, plates_follow_a_crowned_tread) {
  TireShape shape = cylinder(72, kRadius, kWidth, 5);
  for (Vec3& x : shape.vertex) {
    const double share = 1.0 - 0.2 * std::pow(x.y() / kWidth, 2);
    x = Vec3(share * x.x(), x.y(), share * x.z());
  }
  const TireShape smooth = shape;
  add_grousers(shape, 3, kHeight, kThickness);
  for (int k = 0; k < 3 * kGrouserVertices; ++k) {
    const Vec3 at = shape.vertex[smooth.vertex.size() - 2 + k];
    const double tread = kRadius * (1.0 - 0.2 * std::pow(at.y() / kWidth, 2));
    EXPECT_NEAR(std::abs(std::hypot(at.x(), at.z()) - tread), kHeight, 1e-5) << at.transpose();
  }
}

}  // namespace
}  // namespace furrow::tire
