// Rigid ground: closed forms of its pressure and friction, weight balance, energy, momentum, exact continuation.
#include "terrain/rigid/rigid_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/constants.hpp"
#include "tests/refusal.hpp"
#include "tests/saved.hpp"
#include "tests/terrain/energy_residual.hpp"
#include "tests/terrain/ground_push.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

using testing::box;
using testing::Surface;
using testing::wheel;

const testing::Surface kBlock = testing::box({-0.1, -0.05, 0.0}, {0.1, 0.05, 0.1});

/// The push on a surface that has slid at constant velocity until the layer's shear is steady.
Push slide_steadily(Terrain& ground, SurfaceState state, double duration = 5e-3, int intervals = 500) {
  Push result;
  for (int i = 0; i < intervals; ++i) {
    result = push(ground, state, duration);
    for (std::size_t v = 0; v < state.position.size(); ++v) state.position[v] += duration * state.velocity[v];
  }
  return result;
}

TEST(RigidGround, presses_a_block_with_stiffness_times_depth_times_area) {
  GroundOptions options;
  const SurfaceState start = placed(kBlock, {3.0, 0.0, -4e-4}, Vec3::Zero());
  const auto ground = ground_under(kBlock, start, options);
  const Push one = push(*ground, start);
  EXPECT_NEAR(one.sums.force.z() / (options.ground_stiffness * 4e-4 * 0.02), 1.0, 1e-12);
  EXPECT_NEAR(one.sums.tangential.norm(), 0.0, 1e-12);
  EXPECT_NEAR(test::moment_about(Vec3::Zero(), one.forces, start).y() / (-3.0 * one.sums.force.z()), 1.0, 1e-12);
  EXPECT_NEAR(ground->gather_state().elastic_energy / (0.5 * options.ground_stiffness * 1.6e-7 * 0.02), 1.0, 1e-12);
  EXPECT_NEAR(ground->gather_state().floor_force, one.sums.force.z(), 1e-9);
}

TEST(RigidGround, presses_a_tilted_block_with_the_integral_of_its_depth) {
  GroundOptions options;
  // Bottom face tilted about y, its low edge 1 mm deep, its high edge above: a wedge of pressure of length L.
  const double tilt = 0.01, depth = 1e-3, length = depth / std::tan(tilt);
  const testing::Surface block = testing::box({0.0, -0.05, 0.0}, {0.2, 0.05, 0.1});
  const SurfaceState start = placed(block, {0.0, 0.0, -depth}, Vec3::Zero(), -tilt);
  const auto ground = ground_under(block, start, options);
  const Push one = push(*ground, start);
  const double expected = options.ground_stiffness * 0.1 * 0.5 * depth * length;
  EXPECT_NEAR(one.sums.force.z() / expected, 1.0,
              1e-3);  // the vertical back face adds its area: sin² tilt
  EXPECT_NEAR(-test::moment_about(Vec3::Zero(), one.forces, start).y() / one.sums.force.z() / (length / 3.0), 1.0,
              1e-3);
}

TEST(RigidGround, does_not_depend_on_how_a_flat_face_is_cut) {
  const testing::Surface coarse = testing::sheet(-0.1, -0.1, 0.2, 1, 1, [](double, double) { return 0.0; });
  const testing::Surface fine = testing::sheet(-0.1, -0.1, 0.02, 10, 10, [](double, double) { return 0.0; });
  const double tilt = 4e-3;
  const Vec3 velocity(0.3, 0.1, 0.0);
  const SurfaceState a = placed(coarse, {0.0, 0.0, -1e-4}, velocity, tilt);
  const SurfaceState b = placed(fine, {0.0, 0.0, -1e-4}, velocity, tilt);
  const auto coarse_ground = ground_under(coarse, a), fine_ground = ground_under(fine, b);
  const Push from_coarse = slide_steadily(*coarse_ground, a), from_fine = slide_steadily(*fine_ground, b);
  // Exact except for the rounding of velocities, which are differences of positions.
  EXPECT_LT((from_coarse.sums.force - from_fine.sums.force).norm() / from_fine.sums.force.norm(), 1e-10);
  const Vec3 of_coarse = test::moment_about(Vec3::Zero(), from_coarse.forces, a),
             of_fine = test::moment_about(Vec3::Zero(), from_fine.forces, b);
  EXPECT_LT((of_coarse - of_fine).norm() / of_fine.norm(), 1e-10);
}

TEST(RigidGround, follows_the_regularised_friction_law) {
  for (double scale : {5.0, 50.0})
    for (double speed : {1e-4, 0.01, 0.1, 0.3, 3.0}) {
      GroundOptions options;
      options.friction = 0.7;
      options.friction_velocity_scale = scale;
      const Vec3 direction = Vec3(0.6, -0.8, 0.0);
      const SurfaceState start = placed(kBlock, {0.0, 0.0, -4e-4}, speed * direction);
      const auto ground = ground_under(kBlock, start, options, 0.9);  // the smaller coefficient rules
      const Push one = slide_steadily(*ground, start);
      const Vec3 expected = -0.7 * one.sums.normal.z() * std::tanh(scale * speed) * direction;
      EXPECT_LT((one.sums.tangential - expected).norm(), 1e-11 * one.sums.normal.norm()) << scale << ' ' << speed;
      EXPECT_LE(one.sums.tangential.norm(), 0.7 * one.sums.normal.norm() * (1.0 + 1e-14));
      EXPECT_LT(one.sums.transfer_force_residual, 1e-12);
      EXPECT_LT(one.sums.transfer_moment_residual, 1e-12);
    }
}

TEST(RigidGround, friction_of_the_pair_holds_as_it_stands) {
  GroundOptions options;
  options.friction = 0.7;
  const SurfaceState start = placed(kBlock, {0.0, 0.0, -4e-4}, {3.0, 0.0, 0.0});
  ContactMaterial tread = rubber(0.8);
  tread.pair_friction = 1.2;
  const auto ground = make_rigid_ground(options);
  ground->attach(kBlock.mesh, tread, start);
  const Push one = slide_steadily(*ground, start);
  EXPECT_NEAR(one.sums.tangential.norm(), 1.2 * one.sums.normal.norm(), 1e-6 * one.sums.normal.norm());
}

TEST(RigidGround, sticks_like_a_spring_before_it_slides) {
  // A block pushed sideways by less than μ N: κ A ξ holds it, and gives the work back.
  GroundOptions options;
  options.friction = 0.7;
  options.friction_velocity_scale = 1e6;
  options.ground_damping = 0.0;
  const SurfaceState start = placed(kBlock, {0.0, 0.0, -4e-4}, {1e-2, 0.0, 0.0});
  const auto ground = ground_under(kBlock, start, options);
  const double at_rest = ground->gather_state().elastic_energy;
  const Push one = push(*ground, start, 1e-2, 1000);  // 0.1 mm; it would slide from 1.1 mm on
  const double stiffness = options.ground_shear_stiffness * 0.02;
  EXPECT_NEAR(one.sums.tangential.x() / (-stiffness * 0.5e-4), 1.0, 2e-3);  // mean while it grows
  EXPECT_NEAR((ground->gather_state().elastic_energy - at_rest) / (0.5 * stiffness * 1e-8), 1.0, 2e-3);
  EXPECT_NEAR(ground->gather_state().energies.losses() / (0.5 * stiffness * 1e-8), 0.0, 2e-3);
}

TEST(RigidGround, shears_what_it_touches_from_then_on) {
  // A sheet rolls out along x with the speed c while it drifts sideways with v: contact at x has been sheared by v (t −
  // x/c), so F = ½ κ_t W c v t² with its centre at x = c t/3, on any mesh.
  GroundOptions options;
  options.ground_damping = 0.0;
  options.friction_velocity_scale = 1e6;
  options.friction = 10.0;
  const double slope = 0.01, c = 4.0, v = 0.02, width = 0.06, dt = 1e-5;
  for (const double cell : {0.03, 0.01}) {
    const int across = static_cast<int>(std::lround(width / cell));
    const testing::Surface tread =
        testing::sheet(0.0, 0.0, cell, 4 * across, across, [&](double x, double) { return slope * x; });
    SurfaceState state = placed(tread, Vec3::Zero(), {0.0, v, -slope * c});
    const auto ground = ground_under(tread, state, options, 10.0);
    Push one;
    const int steps = 3000;
    for (int i = 0; i < steps; ++i) {
      one = push(*ground, state, dt);
      for (std::size_t k = 0; k < state.position.size(); ++k) state.position[k] += dt * state.velocity[k];
    }
    const double t = steps * dt;
    EXPECT_NEAR(one.sums.tangential.y() / (-0.5 * options.ground_shear_stiffness * width * c * v * t * t), 1.0, 1e-3);
    double moment = 0.0;
    for (std::size_t k = 0; k < one.forces.vertex.size(); ++k)
      moment += one.forces.force[k].y() * state.position[one.forces.vertex[k]].x();
    EXPECT_NEAR(moment / one.sums.tangential.y() / (c * t / 3.0), 1.0, 1e-3) << cell;
  }
}

TEST(RigidGround, does_not_let_a_light_vertex_chatter) {
  // A tread vertex of 2 g under 50 N is driven along by 5 N through its spring of 1e5 N/m; forces come one step late.
  // The bare law, a dashpot of c μ N = 1750 N s/m, would throw it back and forth by (c μ N h/m) v.
  for (double scale : {5.0, 50.0}) {
    GroundOptions options;
    options.friction = 0.7;
    options.friction_velocity_scale = scale;
    const testing::Surface patch = testing::box({-0.01, -0.025, 0.0}, {0.01, 0.025, 0.01});
    const double mass = 2e-3, h = 4e-5, drive = 1e5, speed = 0.02;
    Vec3 position(0.0, 0.0, -50.0 / (options.ground_stiffness * 1e-3)), velocity = Vec3::Zero();
    double pulled = 0.0, force = 0.0, last = 0.0, swing = 0.0, mean = 0.0;
    const auto ground = ground_under(patch, placed(patch, position, velocity), options);
    for (int i = 0; i < 20000; ++i) {
      const Push one = push(*ground, placed(patch, position, velocity), h);
      pulled += h * speed;
      const double damping = 0.5 * std::sqrt(drive * mass) * (speed - velocity.x());
      velocity.x() += h / mass * (drive * (pulled - position.x()) + damping + force);
      position.x() += h * velocity.x();
      force = one.sums.force.x();
      if (i >= 10000) {
        swing = std::max(swing, std::abs(velocity.x() - last));
        mean += force / 10000.0;
      }
      last = velocity.x();
    }
    EXPECT_LT(swing, 1e-4 * speed) << scale;
    EXPECT_NEAR(mean / (-0.7 * 50.0 * std::tanh(scale * speed)), 1.0, 1e-6) << scale;
  }
}

TEST(RigidGround, gives_no_tractive_effort_without_friction) {
  for (double friction : {0.0, 0.5}) {
    const testing::Surface round = testing::wheel(0.4673, 0.2, 60, 4);
    const SurfaceState start = placed(round, {0.0, 0.0, 0.4673 - 1e-3}, {2.0, 0.0, 0.0}, 0.02, 8.56);
    const auto ground = ground_under(round, start, {}, friction);
    const Push first = push(*ground, start, 4e-4, 40);
    SurfaceState later = start;
    for (std::size_t v = 0; v < later.position.size(); ++v) later.position[v] += 4e-4 * start.velocity[v];
    const Push one = push(*ground, later, 1e-6);
    EXPECT_GT(first.sums.normal.z(), 1000.0);
    EXPECT_EQ(first.sums.normal.x(), 0.0);
    if (friction == 0.0) {
      EXPECT_EQ(one.sums.tangential.norm(), 0.0);
    } else {
      EXPECT_NEAR(one.sums.tangential.x(), friction * one.sums.normal.z(), 1e-3 * one.sums.normal.z());
    }
  }
}

TEST(RigidGround, mirrors_what_is_mirrored) {
  const testing::Surface round = testing::wheel(0.4673, 0.2, 60, 4);
  Push there, back;
  for (int sign : {1, -1}) {
    const auto ground = make_rigid_ground({});
    const SurfaceState start =
        placed(round, {0.0, 0.0, 0.4673 - 1e-3}, {sign * 3.0, 0.0, 0.0}, sign * 0.013, sign * 8.56);
    ground->attach(round.mesh, rubber(), start);
    (sign > 0 ? there : back) = push(*ground, start, 4e-4, 10);
  }
  EXPECT_NEAR(there.sums.force.x(), -back.sums.force.x(), 1e-9 * there.sums.force.norm());
  EXPECT_NEAR(there.sums.force.z(), back.sums.force.z(), 1e-9 * there.sums.force.norm());
}

TEST(RigidGround, never_pulls) {
  GroundOptions options;
  options.ground_damping = 1e7;
  const SurfaceState start = placed(kBlock, {0.0, 0.0, -4e-4}, {0.0, 0.0, 1.0});
  const auto ground = ground_under(kBlock, start, options);
  const Push one = push(*ground, start);
  EXPECT_EQ(one.sums.force.norm(), 0.0);
  EXPECT_TRUE(one.forces.vertex.empty());
}

TEST(RigidGround, evens_out_the_facets_of_a_rolling_wheel) {
  // 60 facets: a vertex stands 0.64 mm farther out than a facet's middle; rigid contact would lift the wheel by that.
  const testing::Surface round = testing::wheel(0.4673, 0.2, 60, 4);
  auto load = [&](double height, double turn) {
    const SurfaceState start = placed(round, {0.0, 0.0, height}, Vec3::Zero(), turn);
    return push(*ground_under(round, start), start).sums.force.z();
  };
  double lowest = 1e9, highest = 0.0;
  for (int i = 0; i <= 30; ++i) {
    double lo = 0.4640, hi = 0.4673;  // bisection for the height that carries 4609 N
    for (int k = 0; k < 40; ++k) {
      const double height = 0.5 * (lo + hi);
      (load(height, 2.0 * M_PI / 60 * i / 30.0) > 4609.0 ? lo : hi) = height;
    }
    lowest = std::min(lowest, lo);
    highest = std::max(highest, lo);
  }
  EXPECT_LT(highest - lowest, 2e-4);
  EXPECT_LT(0.4673 - lowest, 2e-3);
  RecordProperty("ripple_um", static_cast<int>(1e6 * (highest - lowest)));
  RecordProperty("depth_um", static_cast<int>(1e6 * (0.4673 - lowest)));
}

/// A block of mass m that falls on the ground, stepped as a partner of the co-simulation: the force of an interval
/// acts on it during the next.
struct Faller {
  testing::Surface surface = kBlock;
  double mass = 50.0;             // kg
  double load = 0.0;              // on top of its weight, N
  Vec3 position{0.0, 0.0, 2e-3};  // m
  Vec3 velocity = Vec3::Zero();   // m/s
  Vec3 force = Vec3::Zero();      // N
  SurfaceState state() const { return placed(surface, position, velocity); }
  void advance(Terrain& ground, double h) {
    const SurfaceState before = state();
    NodalForces forces;
    ContactSums sums;
    ASSERT_TRUE(ground.advance({&before, 1}, h, 2, {&forces, 1}, {&sums, 1}).ok);
    velocity += h * (force / mass - Vec3(0.0, 0.0, kStandardGravity + load / mass));
    position += h * velocity;
    force = Vec3::Zero();
    for (const Vec3& f : forces.force) force += f;
  }
};

TEST(RigidGround, brings_a_dropped_block_to_rest_with_its_weight_balanced) {
  GroundOptions options;
  options.ground_damping = 1e6;
  Faller block;
  const auto ground = ground_under(block.surface, block.state(), options);
  const double h = 4e-5;
  for (int i = 0; i < 20000; ++i) block.advance(*ground, h);
  const double weight = block.mass * kStandardGravity;
  EXPECT_NEAR(block.force.z() / weight, 1.0, 1e-6);
  EXPECT_NEAR(-block.position.z() / (weight / (options.ground_stiffness * 0.02)), 1.0, 1e-6);
  EXPECT_LT(block.velocity.norm(), 1e-8);
  // ∫ F dt − W T = Δp = 0, and the drop's energy has been dissipated.
  const TerrainState state = ground->gather_state();
  const double received = -state.momenta.surface_impulse.z();
  EXPECT_NEAR(received / (weight * 20000 * h), 1.0, 1e-4);  // one interval of force is still in flight
  const double released = weight * (2e-3 - block.position.z());
  EXPECT_NEAR((state.energies.losses() + state.elastic_energy) / released, 1.0,
              0.02);  // coupling lag: k h²/m = 3e-4
  EXPECT_EQ(state.momenta.wall_impulse, -state.momenta.surface_impulse);
}

TEST(RigidGround, damps_bouncing_as_a_linear_oscillator_would) {
  GroundOptions options;
  options.ground_damping = 2e5;
  Faller block;
  block.position.z() = -0.5 * block.mass * kStandardGravity / (options.ground_stiffness * 0.02);
  const auto ground = ground_under(block.surface, block.state(), options);
  const double omega = std::sqrt(options.ground_stiffness * 0.02 / block.mass);
  const double zeta = 0.5 * options.ground_damping * omega / options.ground_stiffness;
  const double h = 1e-6, rest = -block.mass * kStandardGravity / (options.ground_stiffness * 0.02);
  const int period = static_cast<int>(2.0 * M_PI / (omega * std::sqrt(1.0 - zeta * zeta)) / h);
  for (int i = 0; i < period; ++i) block.advance(*ground, h);
  const double expected = (-0.5 - -1.0) * -rest * std::exp(-2.0 * M_PI * zeta / std::sqrt(1.0 - zeta * zeta));
  EXPECT_NEAR((block.position.z() - rest) / expected, 1.0, 0.02);  // lag of h: 1.5 k h²… per cycle
}

TEST(RigidGround, holds_a_light_vertex_at_the_usual_step) {
  // A tread vertex of 2.8 g that carries 10 cm² at 240 kPa, without any damping of its own: the force that comes one
  // interval late acts as −k H, and the ground's damping must exceed this. (Larger steps rely on the tire's damping.)
  for (double h : {1e-5, 2e-5, 4e-5}) {
    Faller vertex;
    vertex.surface = testing::box({-0.01, -0.025, 0.0}, {0.01, 0.025, 0.01});
    vertex.mass = 2.8e-3;
    vertex.load = 240.0;
    vertex.position.z() = -5e-4;
    const auto ground = ground_under(vertex.surface, vertex.state());
    for (int i = 0; i < 2000; ++i) vertex.advance(*ground, h);
    EXPECT_NEAR(vertex.position.z(), -(240.0 + vertex.mass * kStandardGravity) / 4e5, 1e-9) << h;
  }
}

TEST(RigidGround, work_of_its_spring_is_its_elastic_energy) {
  GroundOptions options;
  options.ground_damping = 0.0;
  options.friction = 0.0;
  const auto ground = ground_under(kBlock, testing::at_rest(kBlock), options);
  double work = 0.0;
  for (int i = 0; i < 10; ++i)
    work += push(*ground, placed(kBlock, {0.0, 0.0, -1e-4 * i}, {0.0, 0.0, -0.1}), 1e-3, 3).sums.work;
  const TerrainState state = ground->gather_state();
  EXPECT_NEAR(-work / state.elastic_energy, 1.0, 1e-12);
  EXPECT_NEAR(state.energies.losses() / state.elastic_energy, 0.0, 1e-12);
}

TEST(RigidGround, books_each_loss_where_it_belongs) {
  // Steady sliding under a constant depth: μ N tanh(c v) v t is lost by sliding, nothing else happens.
  GroundOptions options;
  options.friction = 0.5;
  const double speed = 0.2, load = options.ground_stiffness * 4e-4 * 0.02;
  SurfaceState state = placed(kBlock, {0.0, 0.0, -4e-4}, {speed, 0.0, 0.0});
  const auto ground = ground_under(kBlock, state, options);
  const TerrainEnergies start = ground->gather_state().energies;
  slide_steadily(*ground, state, 1e-4, 2000);
  const TerrainEnergies begin = ground->gather_state().energies;
  for (Vec3& x : state.position) x += Vec3(2000 * 1e-4 * speed, 0.0, 0.0);
  slide_steadily(*ground, state, 1e-4, 1000);
  const TerrainEnergies end = ground->gather_state().energies;
  const double friction = 0.5 * load * std::tanh(options.friction_velocity_scale * speed);
  EXPECT_NEAR((end.sliding_loss - begin.sliding_loss) / (friction * speed * 0.1), 1.0, 1e-9);
  EXPECT_NEAR(end.tangential_damping_loss, begin.tangential_damping_loss, 1e-9 * end.sliding_loss);
  EXPECT_EQ(end.normal_damping_loss, 0.0);
  EXPECT_NEAR(end.elastic_normal, 0.5 * options.ground_stiffness * 0.02 * 1.6e-7, 1e-12);
  EXPECT_NEAR(end.elastic_tangential, 0.5 * friction * friction / (options.ground_shear_stiffness * 0.02), 1e-9);
  EXPECT_LT(std::abs(residual(start, end)), 2e-3 * end.losses());
  // When it is lifted off, the layer releases its shear.
  for (Vec3& x : state.position) x += Vec3(1000 * 1e-4 * speed, 0.0, 0.0);
  for (Vec3& v : state.velocity) v = Vec3(0.0, 0.0, 1.0);
  push(*ground, state, 1e-3, 100);
  const TerrainEnergies lifted = ground->gather_state().energies;
  EXPECT_EQ(lifted.elastic_normal + lifted.elastic_tangential, 0.0);
  EXPECT_GT(lifted.normal_damping_loss, 0.0);
  EXPECT_LT(std::abs(residual(end, lifted)), 0.02 * end.elastic_normal);
}

TEST(RigidGround, accounts_of_its_shear_close_at_any_step) {
  // A block that begins to slide at constant depth: all work goes into shear and friction.
  GroundOptions options;
  options.ground_shear_stiffness = 1.6e7;
  options.ground_damping = 1e4;
  options.friction_velocity_scale = 50.0;
  for (const double h : {1e-3, 1e-4}) {
    const SurfaceState state = placed(kBlock, {0.0, 0.0, -4e-4}, Vec3(0.3, -0.2, 0.0));
    const auto ground = ground_under(kBlock, state, options);
    const TerrainEnergies begin = ground->gather_state().energies;
    slide_steadily(*ground, state, h, static_cast<int>(std::lround(0.03 / h)));
    const TerrainEnergies end = ground->gather_state().energies;
    EXPECT_GT(end.tangential_damping_loss, 0.01 * end.losses());
    EXPECT_LT(std::abs(residual(begin, end)), 1e-10 * end.losses()) << h;
  }
}

TEST(RigidGround, residual_of_a_rolling_wheel_shrinks_with_the_step) {
  // A wheel that rolls at slip 0.1 and bounces; its accounts against the work of its surface.
  const testing::Surface round = testing::wheel(0.4673, 0.2, 60, 4);
  double share[3];
  for (const int k : {0, 1, 2}) {
    GroundOptions options;
    options.ground_damping = 1e6;
    const double h = 4e-5 / (1 << k), spin = 8.56, speed = 0.9 * spin * 0.4673;
    const auto at = [&](double t) {
      const double z = 0.4673 - 4e-4 + 6e-4 * std::cos(300.0 * t), v_z = -6e-4 * 300.0 * std::sin(300.0 * t);
      return placed(round, {speed * t, 0.0, z}, {speed, 0.0, v_z}, spin * t, spin);
    };
    const auto ground = ground_under(round, at(0.0), options);
    const TerrainEnergies begin = ground->gather_state().energies;
    const int steps = 2500 * (1 << k);
    for (int i = 0; i < steps; ++i) push(*ground, at(h * i), h);
    const TerrainEnergies end = ground->gather_state().energies;
    share[k] = residual(begin, end) / end.losses();
    EXPECT_GT(end.sliding_loss, 0.0);
    EXPECT_GT(end.normal_damping_loss, 0.0);
    TerrainEnergies wrong = end;
    wrong.sliding_loss *= 1.1;
    EXPECT_GT(std::abs(residual(begin, wrong)), 0.03 * end.losses());
  }
  EXPECT_LT(std::abs(share[0]), 1e-3);
  EXPECT_LT(std::abs(share[1]), 0.65 * std::abs(share[0]));
  EXPECT_LT(std::abs(share[2]), 0.4 * std::abs(share[0]));
}

TEST(RigidGround, carries_several_surfaces_each_with_its_own_force) {
  const auto ground = make_rigid_ground({});
  std::vector<SurfaceState> state;
  for (int k = 0; k < 4; ++k) {
    state.push_back(placed(kBlock, {1.0 * k, 0.0, -1e-4 * (k + 1)}, Vec3::Zero()));
    ground->attach(kBlock.mesh, rubber(), state.back());
  }
  std::vector<NodalForces> forces(4);
  std::vector<ContactSums> sums(4);
  ASSERT_TRUE(ground->advance(state, 4e-5, 1, forces, sums).ok);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(sums[k].force.z() / (4e8 * 1e-4 * (k + 1) * 0.02), 1.0, 1e-12);
}

TEST(RigidGround, continues_a_saved_state_bit_for_bit) {
  const testing::Surface round = testing::wheel(0.4673, 0.2, 60, 4);
  auto at = [&](int i) { return placed(round, {1.2e-4 * i, 0.0, 0.4673 - 8e-4}, {3.0, 0.0, -0.01}, 3.4e-4 * i, 8.56); };
  const auto ground = ground_under(round, at(0));
  for (int i = 0; i < 5; ++i) push(*ground, at(i), 4e-5, 2);
  const auto again = make_rigid_ground({});
  again->restore(testing::saved(*ground));
  EXPECT_EQ(again->gather_state().energies.losses(), ground->gather_state().energies.losses());
  for (int i = 5; i < 10; ++i) {
    const Push a = push(*ground, at(i), 4e-5, 2), b = push(*again, at(i), 4e-5, 2);
    ASSERT_EQ(a.forces.vertex, b.forces.vertex);
    ASSERT_EQ(a.forces.force, b.forces.force);
    ASSERT_EQ(a.sums.work, b.sums.work);
    ASSERT_EQ(ground->gather_state().floor_force, again->gather_state().floor_force);
    ASSERT_EQ(ground->gather_state().energies.losses(), again->gather_state().energies.losses());
    ASSERT_EQ(ground->gather_state().energies.stored(), again->gather_state().energies.stored());
  }
}

TEST(RigidGround, refuses_bad_options_and_surfaces) {
  GroundOptions options;
  options.ground_stiffness = -1.0;
  EXPECT_THROW(make_rigid_ground(options), Error);
  options = {};
  options.friction = std::nan("");
  EXPECT_THROW(make_rigid_ground(options), Error);
  const auto ground = make_rigid_ground({});
  EXPECT_THROW(ground->attach(kBlock.mesh, rubber(), placed(kBlock, {0.0, 0.0, -0.02}, Vec3::Zero())), Error);
  ground->attach(kBlock.mesh, rubber(), testing::at_rest(kBlock));
  SurfaceState broken = testing::at_rest(kBlock);
  broken.position[3].x() = std::nan("");
  NodalForces forces;
  ContactSums sums;
  const Outcome status = ground->advance({&broken, 1}, 4e-5, 1, {&forces, 1}, {&sums, 1});
  EXPECT_FALSE(status.ok);
  EXPECT_TRUE(holds(status.detail, "vertex 3")) << status.message("terrain");
}

}  // namespace
}  // namespace furrow::terrain
