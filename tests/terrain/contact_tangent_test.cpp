// Contact tangents of the terrains against differences of their forces.
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/rigid/rigid_ground.hpp"
#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

using testing::sheet;
using testing::Surface;

constexpr double kStep = 1e-5;  // of an interval, s

/// A square in the plane z = height, outside down. @param cells along each edge
testing::Surface plate(double size, double height, int cells = 1) {
  testing::Surface s =
      testing::sheet(-0.5 * size, -0.5 * size, size / cells, cells, cells, [=](double, double) { return height; });
  for (auto& triangle : s.mesh.triangles) std::swap(triangle[1], triangle[2]);
  return s;
}

SurfaceState moved(const testing::Surface& surface, const Vec3& shift) {
  return {surface.vertex, std::vector<Vec3>(surface.vertex.size(), shift / kStep)};
}

/// A surface at rest whose vertex (−1: all vertices) is then moved by `shift`, m.
struct Move {
  Vec3 shift = Vec3::Zero();
  int vertex = -1;

  SurfaceState of(const testing::Surface& surface) const {
    SurfaceState state = moved(surface, vertex < 0 ? shift : Vec3::Zero());
    if (vertex >= 0) state.velocity[vertex] = shift / kStep;
    return state;
  }
};

/// Sums of forces and of the tangents' predictions over the whole surface, whose vertices all move equally.
struct Answer {
  Vec3 force = Vec3::Zero();
  ContactTangent tangent;
};

Answer sum(const NodalForces& forces) {
  Answer a;
  EXPECT_EQ(forces.tangent.size(), forces.vertex.size());
  for (std::size_t k = 0; k < forces.tangent.size(); ++k) {
    a.force += forces.force[k];
    a.tangent.stiffness += forces.tangent[k].stiffness;
    a.tangent.damping += forces.tangent[k].damping;
  }
  return a;
}

/// Means of the motion of vertex 0, relative to its start.
std::pair<Vec3, Vec3> motion(const NodalForces& forces, const testing::Surface& surface) {
  return {forces.tangent[0].position - surface.vertex[forces.vertex[0]], forces.tangent[0].velocity};
}

/// Change of the force on a surface at rest when it is moved by `shift`, and the change predicted by the tangents at
/// rest.
template <class Push>
void expect_difference(const testing::Surface& surface, const Vec3& shift, double tolerance, Push push) {
  const NodalForces still = push(Vec3::Zero()), after = push(shift);
  ASSERT_FALSE(still.vertex.empty());
  const Answer a = sum(still), b = sum(after);
  const auto [x, v] = motion(after, surface);
  EXPECT_NEAR((v - shift / kStep).norm(), 0.0, 1e-5 * v.norm());
  const Vec3 expected = -a.tangent.stiffness * x - a.tangent.damping * v;
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_LE((b.force - a.force - expected).norm(), tolerance * expected.norm())
      << (b.force - a.force).transpose() << " N, expected " << expected.transpose() << " N";
}

constexpr int kSubsteps = 10;

struct Grain {
  std::string law;
  double friction = 100.0, rolling_friction = 0.0;  // -
  double density = 1e9;                             // kg/m³; of a heavy one dampers outweigh springs
};

/// A grain, 0.3 mm deep in a plate above it, that returns to its place after every substep.
NodalForces push_grain(const testing::Surface& surface, const Move& move, const Grain& grain) {
  terrain::dem::FewGrains few;
  few.options.law = grain.law;
  few.options.density = grain.density;
  few.options.friction = grain.friction;
  few.options.rolling_friction = grain.rolling_friction;
  few.options.friction_impulse_limit = false;
  few.options.step = kStep / kSubsteps;
  const terrain::dem::Quad place{0.3, 0.0, 0.3, few.options.radius};
  terrain::dem::GrainSolver solver = few.make({place});
  const ContactMaterial material = terrain::dem::grain_material(few.options);
  testing::Surface here = surface;
  for (Vec3& x : here.vertex) x += Vec3(0.3005, 2e-4, 0.3 + few.options.radius - 3e-4);  // off edges and vertices
  solver.surfaces().give_tangents(true);
  const SurfaceState target = move.of(here);
  solver.surfaces().attach(here.mesh, material, few.coefficients().floor, target);
  solver.surfaces().set_targets({&target, 1}, kStep);
  solver.surfaces().restrict_to({Vec3::Zero(), Vec3::Ones()});
  NodalForces forces;
  ContactSums sums;
  for (int s = 0; s < kSubsteps; ++s) {
    solver.surfaces().move_to(static_cast<double>(s) / kSubsteps);
    solver.step(few.options.step);
    solver.grains().position[0] = place;
    solver.grains().velocity[0] = solver.grains().spin[0] = {};
  }
  solver.surfaces().finish(kStep, {&forces, 1}, {&sums, 1});
  for (std::size_t k = 0; k < forces.vertex.size(); ++k)
    forces.tangent[k].position -= here.vertex[forces.vertex[k]] - surface.vertex[forces.vertex[k]];
  return forces;
}

TEST(ContactTangent, of_a_grain_is_the_difference_of_its_force) {
  const testing::Surface surface = plate(0.1, 0.0);
  for (const char* law : {"mindlin", "hertz_tanh"})
    for (const Vec3& shift : {Vec3(0, 0, -1e-10), Vec3(0, 0, 1e-10), Vec3(1e-10, 2e-10, -1e-10)})
      expect_difference(surface, shift, 1e-3, [&](const Vec3& d) { return push_grain(surface, {d}, {law}); });
}

TEST(ContactTangent, of_a_grain_without_friction_is_normal_to_the_surface) {
  const testing::Surface surface = plate(0.1, 0.0);
  const Answer a = sum(push_grain(surface, {}, {"mindlin", 0.0}));
  EXPECT_GT(a.tangent.stiffness(2, 2), 1e4);
  EXPECT_EQ(a.tangent.stiffness.leftCols<2>().norm(), 0.0);
  EXPECT_EQ(a.tangent.damping.leftCols<2>().norm(), 0.0);
  expect_difference(surface, Vec3(0, 0, -1e-10), 1e-3, [&](const Vec3& d) {
    return push_grain(surface, {d}, {"mindlin", 0.0});
  });
}

/// A light grain that resists rolling.
Grain rough(const char* law) { return {law, 100.0, 0.3, 2500.0}; }

/// Compares the part of rolling friction in the force on a single moving vertex with its part in the tangent, times the
/// motion. The hit is the same with and without rolling friction.
void expect_couple_difference(const testing::Surface& surface, const char* law, int vertex, const Vec3& shift) {
  Grain smooth = rough(law);
  smooth.rolling_friction = 0.0;
  Vec3 force = Vec3::Zero(), expected = Vec3::Zero();
  const auto add = [&](const Grain& grain, double sign) {
    const NodalForces forces = push_grain(surface, {shift, vertex}, grain);
    for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
      if (forces.vertex[k] != vertex) continue;
      const ContactTangent& t = forces.tangent[k];
      // Within a substep the law stretches its spring before it takes the force.
      const Vec3 stretch = t.position - surface.vertex[vertex] + kStep / kSubsteps * t.velocity;
      force += sign * forces.force[k];
      expected -= sign * (t.stiffness * stretch + t.damping * t.velocity);
    }
  };
  add(rough(law), 1.0), add(smooth, -1.0);
  EXPECT_GT(expected.norm(), 0.0) << law << ' ' << vertex;
  EXPECT_LE((force - expected).norm(), 1e-4 * expected.norm())
      << law << ' ' << vertex << ": " << force.transpose() << " N, expected " << expected.transpose() << " N";
}

TEST(ContactTangent, of_the_rolling_couple_is_the_difference_of_its_forces) {
  const Vec3 shift(2e-10, 1e-10, 3e-10);
  // The couple acts on the vertices of a large facet, and on more than one facet's vertices if facets are smaller than
  // the grain.
  for (const auto& [cells, least] : {std::pair{1, 3U}, {50, 20U}})
    for (const char* law : {"mindlin", "hertz_tanh"}) {
      const testing::Surface surface = plate(0.1, 0.0, cells);
      const int middle = cells / 2 * (cells + 2);
      const std::vector<int> patch = push_grain(surface, {shift, middle}, rough(law)).vertex;
      EXPECT_GE(patch.size(), least);
      for (const int vertex : patch) expect_couple_difference(surface, law, vertex, shift);
    }
}

/// A plate that was at rest 0.4 mm deep in hard ground.
NodalForces push_ground(const testing::Surface& surface, const Vec3& shift) {
  GroundOptions options;
  options.contact_tangents = true;
  const auto ground = make_rigid_ground(options);
  ContactMaterial material;
  material.friction = 0.8;
  const SurfaceState target = moved(surface, shift);
  ground->attach(surface.mesh, material, target);
  NodalForces forces;
  ContactSums sums;
  EXPECT_TRUE(ground->advance({&target, 1}, kStep, 10, {&forces, 1}, {&sums, 1}).ok);
  return forces;
}

TEST(ContactTangent, of_rigid_ground_is_the_difference_of_its_force) {
  const testing::Surface surface = plate(0.1, -4e-4);
  for (const Vec3& shift : {Vec3(0, 0, -1e-9), Vec3(0, 0, 1e-9), Vec3(1e-9, 2e-9, -1e-9)})
    expect_difference(surface, shift, 0.02, [&](const Vec3& d) { return push_ground(surface, d); });
}

TEST(ContactTangent, is_not_sent_unless_wanted) {
  GroundOptions options;
  const auto ground = make_rigid_ground(options);
  const testing::Surface surface = plate(0.1, -4e-4);
  const SurfaceState target = moved(surface, Vec3::Zero());
  ground->attach(surface.mesh, {}, target);
  NodalForces forces;
  ContactSums sums;
  ASSERT_TRUE(ground->advance({&target, 1}, kStep, 1, {&forces, 1}, {&sums, 1}).ok);
  EXPECT_FALSE(forces.vertex.empty());
  EXPECT_TRUE(forces.tangent.empty());
}

}  // namespace
}  // namespace furrow::terrain
