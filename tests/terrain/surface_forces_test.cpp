// Contact forces on vertices transmit force, moment and work to round-off.
#include "terrain/surface/surface_forces.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

struct Loaded {
  testing::Surface start = testing::wheel(0.4673, 0.2, 60, 6);
  std::vector<Vec3> end;
  std::mt19937 random{41};
  std::uniform_real_distribution<double> any{-1.0, 1.0};

  Loaded() {
    for (Vec3& x : start.vertex) x += Vec3(7.0, 0.1, 0.6);
    end = start.vertex;
    for (Vec3& x : end) x += Vec3(1.6e-4, 1e-6 * any(random), -2e-5);
  }
  std::vector<SurfaceContactForce> contacts(const SurfaceCollider& surface, int count) {
    std::vector<SurfaceContactForce> result(count);
    for (auto& one : result) {
      one.triangle = static_cast<int>(random() % surface.mesh().triangles.size());
      const double a = 0.5 + 0.5 * any(random), b = (1.0 - a) * (0.5 + 0.5 * any(random));
      one.weight = {a, b, 1.0 - a - b};
      for (int k = 0; k < 3; ++k)
        one.point += one.weight[k] * surface.positions()[surface.mesh().triangles[one.triangle][k]];
      one.normal = 10.0 * Vec3(any(random), any(random), any(random));
      one.tangential = 5.0 * Vec3(any(random), any(random), any(random));
    }
    return result;
  }
};

TEST(NodalForceSum, hands_over_force_and_moment_to_round_off) {
  Loaded loaded;
  SurfaceCollider surface(loaded.start.mesh, 6e-3);
  surface.set_motion(loaded.start.vertex, loaded.end, 4e-5);
  NodalForceSum sum(loaded.start.mesh.vertex_count);
  const auto contacts = loaded.contacts(surface, 500);
  sum.add_substep(contacts, surface, 4e-5);
  NodalForces forces;
  ContactSums sums;
  sum.finish(4e-5, forces, sums);

  Vec3 force = Vec3::Zero(), moment = Vec3::Zero(), nodal_force = Vec3::Zero(), nodal_moment = Vec3::Zero();
  double scale = 0.0, moment_scale = 0.0, work = 0.0;
  for (const auto& c : contacts) {
    const Vec3 f = c.normal + c.tangential;
    force += f;
    moment += c.point.cross(f);
    scale += f.norm();
    moment_scale += c.point.cross(f).norm();
  }
  for (std::size_t i = 0; i < forces.vertex.size(); ++i) {
    nodal_force += forces.force[i];
    nodal_moment += surface.positions()[forces.vertex[i]].cross(forces.force[i]);
    work += forces.force[i].dot(loaded.end[forces.vertex[i]] - loaded.start.vertex[forces.vertex[i]]);
    if (i > 0) {
      EXPECT_LT(forces.vertex[i - 1], forces.vertex[i]);
    }
  }
  EXPECT_LT((nodal_force - force).norm() / scale, 1e-14);
  EXPECT_LT((nodal_moment - moment).norm() / moment_scale, 1e-14);
  EXPECT_LT((sums.force - force).norm() / scale, 1e-14);
  EXPECT_LT(sums.transfer_force_residual, 1e-14);
  EXPECT_LT(sums.transfer_moment_residual, 1e-13);
  EXPECT_NEAR(sums.work, work, 1e-12 * scale);
  EXPECT_EQ(sums.contacts, 500);
  EXPECT_EQ(sums.force, sums.normal + sums.tangential);
}

TEST(NodalForceSum, averages_impulses_over_substeps_and_starts_again) {
  Loaded loaded;
  SurfaceCollider surface(loaded.start.mesh, 6e-3);
  surface.set_motion(loaded.start.vertex, loaded.end, 1e-4);
  NodalForceSum sum(loaded.start.mesh.vertex_count);
  Vec3 impulse = Vec3::Zero();
  for (int s = 1; s <= 4; ++s) {
    surface.move_to(s / 4.0);
    const auto contacts = loaded.contacts(surface, 10 * s);
    for (const auto& c : contacts) impulse += 2.5e-5 * (c.normal + c.tangential);
    sum.add_substep(contacts, surface, 2.5e-5);
  }
  EXPECT_LT((sum.impulse() - impulse).norm(), 1e-15);
  NodalForces forces;
  ContactSums sums;
  sum.finish(1e-4, forces, sums);
  Vec3 total = Vec3::Zero();
  for (const Vec3& f : forces.force) total += f;
  EXPECT_LT((total * 1e-4 - impulse).norm(), 1e-15);
  EXPECT_LT((sums.force * 1e-4 - impulse).norm(), 1e-15);
  EXPECT_EQ(sums.contacts, 40);

  sum.finish(1e-4, forces, sums);
  EXPECT_TRUE(forces.vertex.empty());
  EXPECT_EQ(sums.force.norm(), 0.0);
  EXPECT_EQ(sums.work, 0.0);
}

}  // namespace
}  // namespace furrow::terrain
