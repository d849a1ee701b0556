// The planar tire with the interface of tires: momentum, energy, comparison with the static test, exact continuation.
#include "tire/planar/planar_tire.hpp"
#include "tests/refusal.hpp"
#include "tire/planar/planar_spec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tests/tire/extruded_ride.hpp"
#include "tests/tire/planar/planar_examples.hpp"
#include "tests/tire/planar/rubbing_contact.hpp"
#include "tire/outward.hpp"
#include "tire/planar/planar_carcass.hpp"
#include "tire/planar/planar_static.hpp"
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

TEST(PlanarTire, runs_refuse_another_integrator_by_name) {
  PlanarFile f = file();
  json text = json::parse(std::ifstream(f.path));
  text["integrator"] = "runge_kutta_4";
  const auto spec = read_planar(text, options());
  EXPECT_TRUE(holds(spec->describe().static_only, "expected 'semi_implicit_euler'"));
  expect_refused(ExitCode::bad_input, {"key 'integrator': is 'runge_kutta_4'"}, [&] { spec->make(); });
}

}  // namespace
}  // namespace furrow::tire::planar_tire_test
