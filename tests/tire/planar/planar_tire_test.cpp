// The planar tire with the interface of tires: momentum, energy, comparison with the static test, exact continuation.
#include "tire/planar/planar_tire.hpp"
#include "tests/refusal.hpp"
#include "tire/planar/planar_spec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "protocol/core/error.hpp"
#include "tests/tire/extruded_ride.hpp"
#include "tests/tire/planar/planar_examples.hpp"
#include "tests/tire/planar/planar_motion.hpp"
#include "tire/outward.hpp"
#include "tire/planar/planar_carcass.hpp"
#include "tire/planar/planar_static.hpp"
#include "tire/planar/rubbing_contact.hpp"
#include "tire/planar/tread_contact.hpp"
#include "tire/tires.hpp"

namespace furrow::tire::planar_tire_test {
namespace {

using nlohmann::json;

constexpr double kStep = 1e-4;  // s

TireOptions options(int around = 36) {
  TireOptions o;
  o.file = TIRE_DATA "/aligator_planar.json";
  o.elements_circumference = around;
  return o;
}

PlanarFile file(int around = 36) {
  const std::string path = TIRE_DATA "/aligator_planar.json";
  PlanarFile f = read_planar_file(json::parse(std::ifstream(path)), path);
  f.params.size.rings = f.params.size.rings * around / f.params.size.around;
  f.params.size.around = around;
  return f;
}

TEST(PlanarTire, momentum_changes_by_ground_gravity_and_spindle_to_round_off) {
  EXPECT_LT(Ride(options(), kStep).worst_force, 1e-11);
  EXPECT_LT(Ride(options(), kStep, 0.1).worst_force, 1e-11);  // with a slip angle
}

TEST(PlanarTire, the_account_of_energy_closes) {
  const Ride ride(options(), kStep);
  EXPECT_GT(ride.last.elastic_energy, 0.5);
  EXPECT_GT(ride.last.dissipation, 0.1);
  EXPECT_LT(std::abs(ride.residual), 2e-3 * ride.work) << ride.work;
  EXPECT_LT(std::abs(ride.residual), 0.03 * ride.last.dissipation) << ride.last.dissipation;
  const Ride turned(options(), kStep, 0.1);
  EXPECT_NEAR(turned.residual / turned.work, 0.0, 2e-3);
}

TEST(PlanarTire, a_free_wheel_that_spins_keeps_its_angular_momentum_and_needs_no_wrench) {
  PlanarFile f = file();
  f.params.tire.viscosity = 5e3;
  TireShape shape = read_tire(options())->shape();
  const auto tire = make_planar_tire(f, shape, Vec3::Zero());
  RimState rim;
  rim.angular_velocity = Vec3(0.0, 4.0, 0.0);
  RimTrajectory motion(rim);
  tire->place(rim);
  for (int k = 0; k < 3000; ++k) {
    motion.extend(rim, kStep);
    ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
    rim.orientation = motion.end().orientation;
  }
  // After growth by centrifugal forces it moves rigidly, without force, moment or loss.
  const Wrench w = tire->spindle_wrench();
  EXPECT_LT(w.force.norm(), 1e-6);
  EXPECT_LT(w.moment.norm(), 0.02);
}

TEST(PlanarTire, pressed_slowly_it_comes_to_the_static_test) {
  PlanarFile f = file(36);
  f.params.tire.viscosity = 2e3;
  f.params.disc.young_modulus = 1e11;  // of the static test, as hard as a rim
  f.params.friction = 0.0;
  PlanarStatic peer(f.params, PlanarGround::plate(f.params.size.radius));
  const double deflection = 0.03;
  ASSERT_TRUE(peer.move_to({0.0, f.params.size.radius - deflection}).converged);
  PlanarCarcass carcass(f.params);
  RubbingContact contact(carcass.mesh(), PlanarGround::plate(f.params.size.radius),
                         {f.params.contact_stiffness * f.params.options.width, 0.0});
  carcass.place(0.0, 0.0, {});
  const double h = 0.5 * carcass.step_limit(), down = 0.2, speed = deflection / down;
  PlaneSums sums;
  PlanarField load(carcass.mesh().position.size());
  double force = 0.0;
  const int lowering = static_cast<int>(down / h), steps = 3 * lowering;
  for (int k = 0; k < steps; ++k) {
    PlanarState state{carcass.position(), carcass.velocity()};
    const double height = f.params.size.radius - deflection * std::min(1.0, double(k) / lowering);
    for (double& z : state.x.z) z += height;
    for (std::size_t n = 0; n < load.size(); ++n) load.x[n] = load.z[n] = 0.0;
    contact.load(state, carcass.mass(), h, load);
    force = contact.force_z();
    ASSERT_TRUE(carcass.step(h, {{0.0, k < lowering ? -speed : 0.0}, 0.0}, load, {}, sums).ok);
  }
  EXPECT_NEAR(force / peer.force(), 1.0, 1e-3);
}

TEST(PlanarTire, a_restored_tire_continues_bit_for_bit) { expect_exact_continuation(options(), kStep); }

TEST(PlanarTire, its_surface_is_the_shape_that_it_was_described_with) {
  for (const int around : {24, 37})
    for (const bool rigid : {false, true}) expect_described_shape(options(around), rigid);
}

TEST(PlanarTire, what_cannot_go_on_says_so) {
  // Fifty tons on one node push it to the rim, or turn its triangles inside out.
  expect_limits_are_told(options(), kStep, {{36, 37}, std::vector<Vec3>(2, Vec3(0.0, 0.0, 2.5e5))}, "try");
}

constexpr PlanarIntegrator kIntegrators[] = {PlanarIntegrator::semi_implicit_euler, PlanarIntegrator::runge_kutta_4};

/// A tire with the penalty contact.
PlanarFile penalty(PlanarIntegrator integrator, PlanarDisc disc, int around = 36) {
  PlanarFile f = file(around);
  f.params.contact = PlanarContactOf::penalty;
  f.params.integrator = integrator;
  f.params.disc_in_run = disc;
  return f;
}

std::unique_ptr<Tire> made(const PlanarFile& f, const GroundProfilePoints& ground = {},
                           const Vec3& gravity = standard_gravity()) {
  TireShape shape = read_tire(options(f.params.size.around))->shape();
  shape.mass = planar_mass(f.params);
  return make_planar_tire(f, shape, gravity, ground);
}

/// Sum of the stated forces.
Vec3 stated(const Tire& tire) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : tire.stated_contact()->forces.force) sum += force;
  return sum;
}

/// The same mesh as free nodes (planar_motion.hpp), of which those on the rim are held, meets a curb.
TEST(PlanarTire, with_the_penalty_contact_it_moves_as_the_mesh_of_the_source_to_round_off) {
  const GroundProfilePoints ground{{0.2, 0.0}, {0.2, 0.02}};
  const double speed = 2.0, fall = -0.1, gravity = 9.81;
  for (const PlanarIntegrator integrator : kIntegrators)
    for (const PlanarDisc disc : {PlanarDisc::rigid, PlanarDisc::elastic}) {
      const PlanarFile f = penalty(integrator, disc);
      const PlanarCarcass carcass(f.params);
      const PlanarMesh& mesh = carcass.mesh();
      const double h = 0.3 * carcass.step_limit(), height = f.params.size.radius - 1e-3;
      PlanarState start{mesh.position, PlanarField(mesh.position.size())};
      for (std::size_t n = 0; n < start.x.size(); ++n)
        start.x.z[n] += height, start.v.x[n] = speed, start.v.z[n] = fall;
      PlanarMotion peer(carcass.elements(), start, integrator);
      for (const int n : carcass.held()) peer.hold(n, true, true);
      RubbingContact contact(mesh, endless_ground(ground),
                             {f.params.contact_stiffness * f.params.options.width, f.params.friction});
      peer.set_loads([&](const PlanarState& state, double step, PlanarField& force) {
        for (std::size_t n = 0; n < force.size(); ++n) force.z[n] -= peer.mass()[n] * gravity;
        contact.load(state, peer.mass(), step, force);
      });
      const auto tire = made(f, ground, Vec3(0.0, 0.0, -gravity));
      RimState rim;
      rim.position = Vec3(0.0, 0.0, height), rim.velocity = Vec3(speed, 0.0, fall);
      RimTrajectory motion(rim);
      tire->place(rim);
      double most = 0.0, off = 0.0;
      SurfaceState surface;
      const int steps = static_cast<int>(0.12 / h);
      for (int k = 0; k < steps; ++k) {
        motion.extend(rim, h);
        ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
        ASSERT_TRUE(peer.step(h));
        rim.position += h * rim.velocity;
        most = std::max(most, stated(*tire).norm());
        tire->surface(surface);
        for (std::size_t j = 0; j < carcass.tread().size(); ++j) {
          const int n = carcass.tread()[j];
          off = std::max(off, (surface.position[2 * j] -
                               Vec3(peer.state().x.x[n], f.params.options.width / 2, peer.state().x.z[n]))
                                  .norm());
        }
      }
      EXPECT_EQ(tire->figures().of("explicit_steps"), steps);
      EXPECT_GT(most, 5e3);
      EXPECT_LT(off, 1e-10);
    }
}

/// Pressed and at rest: the stated forces are Σ c h of the surface, and those of the static test.
TEST(PlanarTire, at_rest_the_penalty_contact_carries_its_load) {
  for (const PlanarIntegrator integrator : kIntegrators)
    for (const PlanarDisc disc : {PlanarDisc::rigid, PlanarDisc::elastic}) {
      PlanarFile f = penalty(integrator, disc, 24);
      f.params.tire.viscosity = f.params.disc.viscosity = 2e3;
      f.params.disc.young_modulus = disc == PlanarDisc::rigid ? 1e11 : 1e8;
      f.params.friction = 0.0;
      const double radius = f.params.size.radius, deflection = 0.03, step = 2e-4, down = 0.1;
      PlanarStatic peer(f.params, PlanarGround::plate(radius));
      ASSERT_TRUE(peer.move_to({0.0, radius - deflection}).converged);
      if (disc == PlanarDisc::rigid) f.params.disc.young_modulus = 1e8;
      const auto tire = made(f, {{3.0, 0.25}, {4.0, 0.25}}, Vec3::Zero());  // level at another height
      RimState rim;
      rim.position = Vec3(1.0, 0.0, 0.25 + radius);
      RimTrajectory motion(rim);
      tire->place(rim);
      const int lowering = static_cast<int>(down / step);
      for (int k = 0; k < 3 * lowering; ++k) {
        rim.velocity.z() = k < lowering ? -deflection / down : 0.0;
        motion.extend(rim, step);
        ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
        rim.position += step * rim.velocity;
      }
      SurfaceState surface;
      tire->surface(surface);
      double depths = 0.0, squares = 0.0;
      for (int v = 0; v < tire->mesh().vertex_count - 2; v += 2) {
        const double depth = std::max(0.0, 0.25 - surface.position[v].z());
        depths += depth, squares += depth * depth;
      }
      const double c = f.params.contact_stiffness * f.params.options.width, load = stated(*tire).z();
      EXPECT_NEAR(load, c * depths, 1e-5 * load);
      EXPECT_NEAR(tire->stated_contact()->energy, 0.5 * c * squares, 1e-9);
      // The static test holds the disc's middle node, a run the ring around it as well.
      EXPECT_NEAR(load / peer.force(), 1.0, disc == PlanarDisc::rigid ? 2e-3 : 5e-3);
      EXPECT_NEAR(tire->spindle_wrench().force.z(), load, 1e-4 * load);
      EXPECT_NEAR(tire->spindle_wrench().moment.norm(), 0.0, 1e-3 * load * radius);
    }
}

/// Largest change of a tire's energy, with the contact's, that rings on the ground under a rim at rest, of its start.
double energy_gain(PlanarIntegrator integrator, double share) {
  PlanarFile f = penalty(integrator, PlanarDisc::elastic, 24);
  f.params.tire.viscosity = f.params.disc.viscosity = 0.0;
  f.params.friction = 0.0;
  f.params.contact_stiffness = 1e6;
  f.params.step_share = share;
  const auto tire = made(f);
  RimState rim;
  rim.position.z() = f.params.size.radius - 0.02;
  RimTrajectory motion(rim);
  tire->place(rim);
  const double c = f.params.contact_stiffness * f.params.options.width, step = 1e-4;
  SurfaceState surface;
  tire->surface(surface);
  double first = tire->diagnostics().stored(), most = 0.0, scale = 0.0;
  for (int v = 0; v < tire->mesh().vertex_count - 2; v += 2) {
    const double depth = std::max(0.0, -surface.position[v].z());
    scale += 0.5 * c * depth * depth;
  }
  first += scale;
  for (int k = 0; k < 300; ++k) {
    motion.extend(rim, step);
    EXPECT_TRUE(tire->advance(motion, {}, 1).ok);
    most = std::max(most, std::abs(tire->diagnostics().stored() + tire->stated_contact()->energy - first));
  }
  return most / scale;
}

TEST(PlanarTire, it_bounces_without_loss_to_the_order_of_its_integrator) {
  for (const PlanarIntegrator integrator : kIntegrators) {
    const bool euler = integrator == PlanarIntegrator::semi_implicit_euler;
    const double coarse = energy_gain(integrator, 0.4), fine = energy_gain(integrator, 0.1);
    EXPECT_LT(coarse, euler ? 0.02 : 1e-3);
    // Nodes that meet the ground within a step make the method of fourth order one of second.
    EXPECT_LT(fine, coarse / (euler ? 3.0 : 10.0)) << euler;
  }
}

/// Rides over a curb on a rim that accelerates, turns and shifts sideways.
TEST(PlanarTire, with_its_own_contact_momentum_and_energy_close) {
  for (const PlanarIntegrator integrator : kIntegrators)
    for (const double toe : {0.0, 0.1}) {
      const PlanarFile f = penalty(integrator, PlanarDisc::elastic);
      const auto tire = made(f, {{0.6, 0.0}, {0.6, 0.01}});
      const double lift = f.params.size.radius - rim_at(0.0).position.z();
      const auto rim = [&](double t) {
        RimState state = rim_at(t, toe);
        state.position.z() += lift;
        return state;
      };
      RimTrajectory motion(rim(0.0));
      tire->place(rim(0.0));
      const TireDiagnostics first = tire->diagnostics();
      SurfaceState before, after;
      double worst = 0.0, rim_work = 0.0, ground_work = 0.0, turnover = 0.0;
      for (int k = 0; k < 1000; ++k) {
        motion.extend(rim(k * kStep), kStep);
        tire->surface(before);
        const Vec3 momentum = tire->diagnostics().momentum;
        ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
        tire->surface(after);
        const Vec3 spindle = tire->spindle_wrench().force, ground = stated(*tire);
        const Vec3 impulse = kStep * (tire->mass_properties().mass * tire->gravity() - spindle + ground);
        worst = std::max(worst, (tire->diagnostics().momentum - momentum - impulse).norm() /
                                    (kStep * (spindle.norm() + ground.norm())));
        ground_work += test::surface_work(tire->stated_contact()->forces, before, after);
        const double work = test::rim_work(*tire, motion);
        rim_work += work, turnover += std::abs(work);
      }
      const TireDiagnostics last = tire->diagnostics();
      const double residual = rim_work + ground_work - (last.stored() - first.stored()) - last.losses();
      EXPECT_LT(worst, 1e-11);
      EXPECT_LT(std::abs(residual), 2e-3 * turnover) << static_cast<int>(integrator) << " " << toe;
      EXPECT_GT(last.dissipation, 0.1);
      EXPECT_LT(ground_work, 0.0);
    }
}

TEST(PlanarTire, a_steered_wheel_slides_sideways_with_the_friction_of_its_load) {
  const PlanarFile f = penalty(PlanarIntegrator::semi_implicit_euler, PlanarDisc::rigid);
  for (const double toe : {0.1, -0.1, 3.0}) {  // the last drives backwards through the profile
    const auto tire = made(f, {{-50.0, 0.0}, {50.0, 0.0}});
    const Quat turn(Eigen::AngleAxisd(toe, Vec3::UnitZ()));
    RimState rim;
    rim.position = Vec3(0.0, 0.0, f.params.size.radius - 0.02);
    rim.velocity = turn * Vec3(0.0, 3.0, 0.0);  // sideways alone
    rim.orientation = turn;
    RimTrajectory motion(rim);
    tire->place(rim);
    for (int k = 0; k < 500; ++k) {
      motion.extend(rim, kStep);
      ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
      rim.position += kStep * rim.velocity;
    }
    const Vec3 force = stated(*tire);
    EXPECT_NEAR(force.dot(turn * Vec3::UnitY()), -f.params.friction * force.z(), 0.02 * force.z()) << toe;
  }
}

TEST(PlanarTire, with_its_own_contact_it_continues_bit_for_bit) {
  PlanarFile f = penalty(PlanarIntegrator::runge_kutta_4, PlanarDisc::elastic);
  const auto one = made(f), other = made(f);
  RimState rim;
  rim.position.z() = f.params.size.radius - 0.01;
  RimTrajectory motion(rim);
  one->place(rim);
  const auto go = [&](Tire& tire, RimTrajectory& way, int steps) {
    for (int k = 0; k < steps; ++k) {
      way.extend(rim, kStep);
      ASSERT_TRUE(tire.advance(way, {}, 2).ok);
    }
  };
  go(*one, motion, 200);
  other->restore(testing::saved(*one));
  RimTrajectory copy = motion;
  go(*one, motion, 300);
  go(*other, copy, 300);
  EXPECT_EQ(one->stated_contact()->forces.force, other->stated_contact()->forces.force);
  EXPECT_EQ(one->stated_contact()->energy, other->stated_contact()->energy);
  EXPECT_EQ(one->spindle_wrench().force, other->spindle_wrench().force);
}

TEST(PlanarTire, an_elastic_disc_counts_with_the_tire) {
  const PlanarFile f = penalty(PlanarIntegrator::semi_implicit_euler, PlanarDisc::elastic, 72);
  const PlanarFile rigid = penalty(PlanarIntegrator::semi_implicit_euler, PlanarDisc::rigid, 72);
  const double disc = 740.0 * std::numbers::pi * 0.254 * 0.254,
               more = planar_mass(f.params).mass - planar_mass(rigid.params).mass;
  EXPECT_NEAR(more, disc, 0.01 * disc);
}

}  // namespace
}  // namespace furrow::tire::planar_tire_test
