// The handling tire against its formula, Newton's equations and closed forms of its contact.
#include "tire/handling/handling_tire.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <tuple>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/core/mean_turn.hpp"
#include "tests/saved.hpp"
#include "tests/tire/handling/example_tire.hpp"
#include "tests/tire/tire_file_checks.hpp"
#include "tire/cylinder.hpp"
#include "tire/handling/handling_spec.hpp"
#include "tire/handling/tir_file.hpp"
#include "tire/outward.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kStep = 1e-4;  // s

HandlingTire make(const MagicFormula& formula = example_tire(), GroundHeights heights = {}) {
  TireShape shape = cylinder(96, formula.dimension.unloaded_radius, formula.dimension.width, 7);
  shape.mass = {10.0, Vec3(0.5, 0.9, 0.5).asDiagonal()};
  return HandlingTire(formula, shape, standard_gravity(), "a.tir", std::move(heights));
}

/// A rim that rolls along x, turned by `toe` about z and leaning by `camber`, its wheel's lowest point `depth` deep.
RimState rolling(double depth, double speed, double spin, double toe, double camber) {
  RimState rim;
  rim.orientation = Quat(Eigen::AngleAxisd(toe, Vec3::UnitZ())) * Quat(Eigen::AngleAxisd(camber, Vec3::UnitX()));
  rim.position = Vec3(0.0, 0.0, (0.35 - depth) * std::cos(camber));
  rim.velocity = Vec3(speed, 0.0, 0.0);
  rim.angular_velocity = rim.orientation * Vec3(0.0, spin, 0.0);
  return rim;
}

/// A rim that continues its motion, its tire, and the ground that applies the tire's stated forces.
class Rolling {
 public:
  Rolling(HandlingTire& tire, const RimState& start) : tire_(tire), rim_(start), trajectory_(start) {
    tire.place(start);
    tire.surface(before_);
  }
  void step() {
    const Vec3 from = rim_.position;
    const Quat turned = rim_.orientation;
    ASSERT_TRUE(tire_.state_contact(rim_, kStep).ok);
    trajectory_.extend(rim_, kStep);
    const NodalForces given = tire_.stated_contact()->forces;
    ASSERT_TRUE(tire_.advance(trajectory_, given, 1).ok);
    SurfaceState after;
    tire_.surface(after);
    for (std::size_t i = 0; i < given.vertex.size(); ++i)
      terrain_work += given.force[i].dot(after.position[given.vertex[i]] - before_.position[given.vertex[i]]);
    before_ = after;
    const Wrench on_rim = tire_.spindle_wrench();
    rim_ = trajectory_.end();
    rim_work -= on_rim.force.dot(rim_.position - from) + on_rim.moment.dot(mean_turn(turned, rim_.orientation));
  }
  void change(const RimState& rim) { rim_ = rim; }
  const RimState& rim() const { return rim_; }
  double terrain_work = 0.0, rim_work = 0.0;  // J

 private:
  HandlingTire& tire_;
  RimState rim_;
  RimTrajectory trajectory_;
  SurfaceState before_;
};

TEST(HandlingTire, steady_rolling_gives_the_formula_at_the_rims_slips) {
  for (const auto& [slip, toe, camber] :
       {std::tuple{0.0, 0.0, 0.0}, {0.05, 0.0, 0.0}, {-0.1, 0.05, 0.0}, {0.02, -0.1, 0.08}, {0.0, 0.02, -0.1}}) {
    const MagicFormula t = example_tire();
    HandlingTire tire = make();
    const double depth = 0.018, speed = 10.0;
    const double spin = (1.0 + slip) * speed * std::cos(toe) / rolling_radius(t, depth);
    Rolling run(tire, rolling(depth, speed, spin, toe, camber));
    for (int n = 0; n < 4000; ++n) run.step();  // 4 m, ten relaxation lengths
    const WheelAxes axes = wheel_axes(run.rim(), Vec3::UnitX(), 0.0);
    const HandlingForces f = evaluate(t, {.load = 2.2e5 * depth / std::cos(camber),
                                          .slip = slip,
                                          .slip_angle = -toe,
                                          .camber = axes.camber_angle,
                                          .speed = speed * std::cos(toe)});
    const Wrench spindle = tire.spindle_wrench();
    const Wrench found = axes.wrench(spindle.force - Vec3(0, 0, -9.81 * 10.0), spindle.moment, run.rim().position);
    const double scale = f.fz;
    EXPECT_NEAR(found.force.x(), f.fx, 2e-4 * scale);
    EXPECT_NEAR(found.force.y(), f.fy, 2e-4 * scale);
    EXPECT_NEAR(found.force.z(), f.fz, 1e-9 * scale);
    EXPECT_NEAR(found.moment.x(), f.mx, 1e-3 * scale * 0.35);
    EXPECT_NEAR(found.moment.y(), f.my, 1e-3 * scale * 0.35);
    EXPECT_NEAR(found.moment.z(), f.mz, 1e-3 * scale * 0.35);
  }
}

/// Seen after half a turn about z, a wheel that rolls backward rolls forward and leans the other way.
TEST(HandlingTire, rolling_backward_is_rolling_forward_seen_from_the_other_side) {
  for (const auto& [slip, toe, camber] : {std::tuple{0.3, 0.0, 0.0}, {-0.3, 0.02, 0.0}, {0.0, 0.05, 0.05}}) {
    const double depth = 0.018, speed = 5.0, spin = (1.0 + slip) * speed / rolling_radius(example_tire(), depth);
    HandlingTire ahead = make(), back = make();
    Rolling forward(ahead, rolling(depth, speed, spin, toe, -camber)),
        backward(back, rolling(depth, -speed, -spin, toe, camber));
    for (int n = 0; n < 4000; ++n) forward.step(), backward.step();
    const Wrench a = ahead.spindle_wrench(), b = back.spindle_wrench();
    const Mat3 half = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()).toRotationMatrix();
    EXPECT_LT((half * a.force - b.force).norm(), 1e-6 * a.force.norm()) << slip;
    EXPECT_LT((half * a.moment - b.moment).norm(), 1e-6 * a.force.norm()) << slip;
  }
}

TEST(HandlingTire, rolling_resistance_is_whole_from_a_hundredth_of_a_metre_per_second_on) {
  for (const double speed : {0.02, 0.2, 2.0}) {
    HandlingTire tire = make();
    const double depth = 0.018;
    Rolling run(tire, rolling(depth, speed, speed / rolling_radius(example_tire(), depth), 0.0, 0.0));
    for (int n = 0; n < 2000; ++n) run.step();
    const double whole = evaluate(example_tire(), {.load = 2.2e5 * depth, .speed = speed}).my;
    const WheelAxes axes = wheel_axes(run.rim(), Vec3::UnitX(), 0.0);
    const Wrench found = axes.wrench(tire.spindle_wrench().force - Vec3(0, 0, -9.81 * 10.0),
                                     tire.spindle_wrench().moment, run.rim().position);
    EXPECT_NEAR(found.moment.y(), whole, 0.05 * std::abs(whole)) << speed;
  }
}

TEST(HandlingTire, stated_forces_have_the_wrench_whatever_the_wheel_does) {
  HandlingTire tire = make();
  Rolling run(tire, rolling(0.01, 5.0, 16.0, 0.07, 0.15));
  for (int n = 0; n < 500; ++n) {
    run.step();
    const StatedContact& stated = *tire.stated_contact();
    Vec3 sum = Vec3::Zero();
    for (const Vec3& force : stated.forces.force) sum += force;
    EXPECT_TRUE(stated.given);
    EXPECT_TRUE(std::is_sorted(stated.forces.vertex.begin(), stated.forces.vertex.end()));
    EXPECT_NEAR(sum.z(), 2.2e5 * 0.01 / std::cos(0.15), 1e-6);
  }
}

/// Down and up on the spring and damper of the file, at rest: K ρ̇² is lost, the rest comes back.
TEST(HandlingTire, bounce_loses_what_the_damper_takes) {
  MagicFormula curved = example_tire();
  curved.load_curve = {{0.0, 0.0}, {0.01, 1500.0}, {0.02, 4000.0}, {0.022, 5000.0}};
  for (const MagicFormula& t : {example_tire(), curved}) {
    HandlingTire tire = make(t);
    RimState rim;
    const double amplitude = 0.01, frequency = 20.0, mean = 0.35 - 0.015;
    const auto at = [&](double time) {
      rim.position.z() = mean + amplitude * std::cos(frequency * time);
      rim.velocity.z() = -amplitude * frequency * std::sin(frequency * time);
      return rim;
    };
    Rolling run(tire, at(0.0));
    const int steps = static_cast<int>(std::lround(2.0 * std::numbers::pi / frequency / kStep));
    for (int n = 0; n < steps; ++n) {
      run.step();
      run.change(at((n + 1) * kStep));
    }
    const double expected = 0.5 * 150.0 * amplitude * amplitude * frequency * frequency * steps * kStep;
    EXPECT_NEAR(tire.diagnostics().dissipation, expected, 0.02 * expected);
    EXPECT_NEAR(tire.diagnostics().elastic_energy, t.load_curve.empty() ? 0.5 * 2.2e5 * 0.005 * 0.005 : 1.875, 0.01);
  }
}

/// rim work + terrain work = Δ(kinetic + elastic + potential) + dissipation + numerical, up to the rule's error.
TEST(HandlingTire, accounts_close_while_it_rolls_and_slides) {
  for (const double slip : {0.0, 0.1, -0.3}) {
    HandlingTire tire = make();
    const double speed = 8.0, depth = 0.016;
    Rolling run(tire, rolling(depth, speed, (1.0 + slip) * speed / rolling_radius(example_tire(), depth), 0.05, 0.03));
    for (int n = 0; n < 1000; ++n) run.step();
    const TireDiagnostics before = tire.diagnostics();
    const double rim = run.rim_work, ground = run.terrain_work;
    for (int n = 0; n < 4000; ++n) run.step();
    const TireDiagnostics after = tire.diagnostics();
    const double left = run.rim_work - rim + run.terrain_work - ground - (after.stored() - before.stored()) -
                        (after.losses() - before.losses());
    const double turned_over = std::abs(run.terrain_work - ground) + after.dissipation - before.dissipation;
    EXPECT_LT(std::abs(left), 2e-3 * std::max(turned_over, 50.0)) << slip;
    EXPECT_LE(run.terrain_work, 0.0) << "the ground takes";
  }
}

RimState turned(const Quat& turn, RimState rim) {
  rim.position = turn * rim.position;
  rim.orientation = turn * rim.orientation;
  rim.velocity = turn * rim.velocity;
  rim.angular_velocity = turn * rim.angular_velocity;
  return rim;
}

/// Waves along x, m.
GroundHeights waves(double amplitude, double length) {
  return [=](double x, double) { return amplitude * std::sin(2.0 * std::numbers::pi * x / length); };
}

/// About the rim's centre, without the tire's own weight.
Wrench stated_wrench(HandlingTire& tire, const RimState& rim) {
  SurfaceState surface;
  tire.surface_on(rim, surface);
  Wrench sum;
  const NodalForces& stated = tire.stated_contact()->forces;
  for (std::size_t i = 0; i < stated.vertex.size(); ++i) {
    sum.force += stated.force[i];
    sum.moment += (surface.position[stated.vertex[i]] - rim.position).cross(stated.force[i]);
  }
  return sum;
}

TEST(HandlingTire, a_slope_gives_the_forces_of_level_ground_turned_with_it) {
  for (const auto& [sx, sy] : {std::pair{0.0, 0.3}, {0.3, 0.0}, {-0.25, 0.15}}) {
    const Vec3 normal = Vec3(-sx, -sy, 1.0).normalized();
    const Quat turn = Quat::FromTwoVectors(Vec3::UnitZ(), normal);
    HandlingTire on_level = make(),
                 on_slope = make(example_tire(), [=](double x, double y) { return sx * x + sy * y; });
    const RimState start = rolling(0.018, 8.0, 24.0, 0.05, -0.1);
    Rolling level(on_level, start), slope(on_slope, turned(turn, start));
    for (int n = 0; n < 300; ++n) {
      level.step(), slope.step();
      const Wrench a = stated_wrench(on_level, level.rim()), b = stated_wrench(on_slope, slope.rim());
      ASSERT_LT((turn * a.force - b.force).norm(), 1e-8 * a.force.norm()) << n;
      ASSERT_LT((turn * a.moment - b.moment).norm(), 1e-8 * a.force.norm()) << n;
    }
    const StatedContact& stated = *on_slope.stated_contact();
    for (std::size_t i = 0; i < stated.friction.size(); ++i) {
      const double force = stated.forces.force[i].norm();
      EXPECT_NEAR(stated.friction[i].dot(normal), 0.0, 1e-12 * force);
      EXPECT_LT((stated.forces.force[i] - stated.friction[i]).cross(normal).norm(), 1e-12 * force);
    }
    EXPECT_NEAR(on_slope.diagnostics().elastic_energy, on_level.diagnostics().elastic_energy, 1e-6);
  }
}

/// F = C_z ρ + K_z ρ̇ with ρ = depth + A sinc(k a) sin k x of an axle held level, k²A R « 1: heights are means over 2a.
TEST(HandlingTire, an_axle_held_level_over_long_waves_has_the_load_of_their_height) {
  const MagicFormula t = example_tire();
  const double amplitude = 2e-3, length = 4.0, speed = 10.0, depth = 0.015, k = 2.0 * std::numbers::pi / length;
  HandlingTire tire = make(t, waves(amplitude, length));
  Rolling run(tire, rolling(depth, speed, speed / rolling_radius(t, depth), 0.0, 0.0));
  const double a = 0.5 * contact_length(t), seen = amplitude * std::sin(k * a) / (k * a);
  EXPECT_NEAR(contact_length(t), 2.0 * std::sqrt(2.0 * 0.35 * spring_deflection(t, t.vertical.fnomin)), 0.02 * 2.0 * a);
  double off = 0.0;
  for (int n = 0; n < 4000; ++n) {
    const double x = run.rim().position.x() + 0.5 * kStep * speed;
    run.step();
    const double load = 2.2e5 * (depth + seen * std::sin(k * x)) + 150.0 * seen * k * speed * std::cos(k * x);
    off = std::max(off, std::abs(stated_wrench(tire, run.rim()).force.z() - load));
  }
  EXPECT_LT(off, 5e-3 * 2.2e5 * amplitude);
}

/// The spring's force does the work that it stores, n·v = −ρ̇: also over waves of a few contact lengths.
TEST(HandlingTire, waves_make_no_energy_of_the_spring) {
  const MagicFormula t = example_tire();
  for (const double length : {0.6, 1.0, 3.0}) {
    const double amplitude = 0.02 * length * length, slope = amplitude * 2.0 * std::numbers::pi / length;
    const RoadPlane road([=](double x, double y) { return waves(amplitude, length)(x + 0.3 * y, y); },
                         0.5 * contact_length(t), 0.5 * t.dimension.width);
    for (double x = 0.0; x < length; x += 0.07 * length) {
      RimState rim = rolling(0.01, 1.0, 3.0, 0.1, 0.05), before = rim, after = rim;
      rim.position.x() = x;
      rim.velocity = Vec3(1.0, 0.2, 0.0);
      before = after = rim;
      before.position -= 1e-6 * rim.velocity;
      after.position += 1e-6 * rim.velocity;
      const double change = contact_motion(t, after, road).deflection - contact_motion(t, before, road).deflection;
      EXPECT_NEAR(contact_motion(t, rim, road).rate, change / 2e-6, 0.01 * slope) << length << " m, x " << x;
    }
  }
}

TEST(HandlingTire, accounts_close_over_waves) {
  HandlingTire tire = make(example_tire(), waves(5e-3, 2.0));
  const double speed = 8.0, depth = 0.016;
  Rolling run(tire, rolling(depth, speed, 1.05 * speed / rolling_radius(example_tire(), depth), 0.02, 0.0));
  for (int n = 0; n < 2500; ++n) run.step();
  const TireDiagnostics before = tire.diagnostics();
  const double rim = run.rim_work, ground = run.terrain_work;
  for (int n = 0; n < 2500; ++n) run.step();  // once over a wave
  const TireDiagnostics after = tire.diagnostics();
  const double left = run.rim_work - rim + run.terrain_work - ground - (after.stored() - before.stored()) -
                      (after.losses() - before.losses());
  EXPECT_LT(std::abs(left), 2e-3 * std::abs(run.terrain_work - ground));
}

/// At rest the patch is a spring: F = K/σ × the way of the rim; it does not creep.
TEST(HandlingTire, standing_wheel_holds_its_place) {
  const MagicFormula t = symmetric_tire();
  HandlingTire tire = make(t);
  const double depth = 0.018, load = 2.2e5 * depth;
  RimState rim = rolling(depth, 0.0, 0.0, 0.0, 0.0);
  Rolling run(tire, rim);
  const double speed = 1e-3, way = 2e-4;  // m/s, m
  rim.velocity.y() = speed;
  run.change(rim);
  const int steps = static_cast<int>(std::lround(way / speed / kStep));
  for (int n = 0; n < steps; ++n) {
    run.step();
    rim.position.y() += kStep * speed;
    run.change(rim);
  }
  rim.velocity.y() = 0.0;
  run.change(rim);
  for (int n = 0; n < 20; ++n) run.step();
  const HandlingForces still = evaluate(t, {.load = load});
  const double spring = -still.cornering_stiffness / relaxation_lengths(t, load, 0.0).lateral;
  const double held = tire.spindle_wrench().force.y();
  EXPECT_NEAR(held, -spring * way, 1e-2 * spring * way);
  for (int n = 0; n < 20000; ++n) run.step();
  EXPECT_NEAR(tire.spindle_wrench().force.y(), held, 1e-9 * std::abs(held)) << "2 s later";
}

/// A spinning wheel does not wind up its patch: when it turns back, it holds at once.
TEST(HandlingTire, spinning_on_the_spot_stays_within_the_range_of_slip) {
  HandlingTire tire = make();
  Rolling run(tire, rolling(0.018, 0.0, 30.0, 0.0, 0.0));
  for (int n = 0; n < 3000; ++n) run.step();
  const double sigma = relaxation_lengths(example_tire(), 2.2e5 * 0.018, 0.0).longitudinal;
  EXPECT_NEAR(tire.figures().of("patch_along_m"), 1.2 * sigma, 1e-12);
  EXPECT_NEAR(tire.spindle_wrench().force.x(), evaluate(example_tire(), {.load = 2.2e5 * 0.018, .slip = 1.2}).fx, 1.0);
}

/// F = F_end (1 − exp(−s/σ)) after a step of the slip angle, for small angles.
TEST(HandlingTire, side_force_builds_up_over_the_relaxation_length) {
  const MagicFormula t = symmetric_tire();
  HandlingTire tire = make(t);
  const double depth = 0.018, speed = 5.0, toe = 2e-3;
  Rolling run(tire, rolling(depth, speed, speed / rolling_radius(t, depth), 0.0, 0.0));
  for (int n = 0; n < 1000; ++n) run.step();
  RimState turned = rolling(depth, speed, speed / rolling_radius(t, depth), toe, 0.0);
  turned.position = run.rim().position;
  run.change(turned);
  const double sigma = relaxation_lengths(t, 2.2e5 * depth, 0.0).lateral;
  const HandlingForces end = evaluate(t, {.load = 2.2e5 * depth, .slip_angle = -toe});
  const int steps = static_cast<int>(std::lround(sigma / speed / kStep));
  for (int n = 0; n < steps; ++n) run.step();
  EXPECT_NEAR(tire.spindle_wrench().force.y(), (1.0 - std::exp(-1.0)) * end.fy, 0.01 * std::abs(end.fy));
}

TEST(HandlingTire, restored_tire_continues_bit_for_bit) {
  HandlingTire tire = make();
  Rolling run(tire, rolling(0.018, 10.0, 30.0, 0.05, 0.02));
  for (int n = 0; n < 100; ++n) run.step();
  HandlingTire other = make();
  other.place(RimState());
  other.restore(testing::saved(tire));
  RimTrajectory one(run.rim());
  one.extend(run.rim(), kStep);
  ASSERT_TRUE(tire.state_contact(run.rim(), kStep).ok);
  ASSERT_TRUE(other.state_contact(run.rim(), kStep).ok);
  const StatedContact &a = *tire.stated_contact(), &b = *other.stated_contact();
  EXPECT_EQ(a.forces.vertex, b.forces.vertex);
  EXPECT_EQ(a.forces.force, b.forces.force);
  ASSERT_TRUE(tire.advance(one, a.forces, 1).ok);
  ASSERT_TRUE(other.advance(one, b.forces, 1).ok);
  Hash first, second;
  tire.add_state(first);
  other.add_state(second);
  EXPECT_EQ(first.hex(), second.hex());
  EXPECT_EQ(tire.diagnostics().dissipation, other.diagnostics().dissipation);
}

TEST(HandlingTire, in_the_air_it_states_no_force_and_is_round) {
  HandlingTire tire = make();
  RimState rim;
  rim.position.z() = 0.4;
  Rolling run(tire, rim);
  run.step();
  const StatedContact& stated = *tire.stated_contact();
  EXPECT_TRUE(stated.given);
  EXPECT_TRUE(stated.forces.force.empty());
  SurfaceState surface;
  tire.surface(surface);
  EXPECT_NO_THROW(require_outward(tire.mesh(), surface.position, rim.position, "a.tir"));
}

TEST(HandlingTire, stops_at_its_rim) {
  HandlingTire tire = make();
  RimState rim;
  rim.position.z() = 0.19;
  tire.place(rim);
  EXPECT_FALSE(tire.state_contact(rim, kStep).ok);
}

// ---- its files

nlohmann::json file_of(const std::filesystem::path& tir) {
  return {{"format_version", 1}, {"model", "handling"}, {"tir", tir.string()}};
}

std::filesystem::path written(MagicFormula formula) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "handling_test.tir";
  std::ofstream(file) << tir_text(formula, {});
  return file;
}

TEST(HandlingFile, takes_mass_from_either_file) {
  MagicFormula t = example_tire();
  nlohmann::json file = file_of(written(t));
  EXPECT_EQ(read_handling_file(file, "tire.json").mass, 10.0);
  file["mass"] = 37.0;
  EXPECT_EQ(read_handling_file(file, "tire.json").mass, 37.0);
  EXPECT_EQ(read_handling_file(file, "tire.json").spin_inertia, 0.9);
  t.inertia = {};
  file = file_of(written(t));
  const auto in_json = read_handling(file, {});
  EXPECT_TRUE(holds(in_json->describe().static_only, "key 'mass' in "));
  expect_refused(ExitCode::bad_input, {"key 'mass': is missing"}, [&] { in_json->make(); });
  TireOptions options;
  options.file = written(t);
  const auto in_tir = read_tire(options);
  EXPECT_TRUE(holds(in_tir->describe().static_only, "key '[INERTIA] MASS' in "));
  expect_refused(ExitCode::bad_input, {"key '[INERTIA] MASS': is missing"}, [&] { in_tir->make(); });
  options.rigid = true;
  expect_refused(ExitCode::bad_input, {"key '[INERTIA] MASS': is missing"}, [&] { read_tire(options); });
}

TEST(HandlingFile, is_pressed_without_mass_and_inertia) {
  MagicFormula t = example_tire();
  const auto force = [&] {
    TireOptions options;
    options.file = written(t);
    PressOptions press;
    press.deflection = 0.01;
    return read_tire(options)->static_test()->press(press, {}).loading.back().force;
  };
  const double with = force();
  t.inertia = {};
  EXPECT_EQ(force(), with);
}

TEST(HandlingFile, a_tir_file_is_a_tire) {
  TireOptions options;
  options.file = written(example_tire());
  const auto spec = read_tire(options);
  const TireDescription d = spec->describe();
  EXPECT_EQ(d.kind, "handling");
  EXPECT_FALSE(d.own_contact.empty());
  const auto tire = spec->make();
  EXPECT_EQ(d.vertices, tire->mesh().vertex_count);
  EXPECT_EQ(d.radius, tire->radius());
  EXPECT_TRUE(spec->files().empty());
  options.rigid = true;
  EXPECT_TRUE(read_tire(options)->describe().own_contact.empty());
}

/// Linear spring: its stiffness is C_z (1 + PFZ1 dp_i).
TEST(HandlingFile, takes_the_scenarios_pressure_where_its_coefficients_have_one) {
  MagicFormula t = example_tire();
  t.vertical.pfz1 = 0.8;
  TireOptions options;
  options.pressure.knots = {{0.0, 250e3}};
  options.file = written(t);
  EXPECT_EQ(idle_keys(*read_tire(options)), std::vector<std::string>{"pressure"});
  t.conditions = {.inflpres = 220e3, .nompres = 200e3};
  options.file = written(t);
  EXPECT_TRUE(idle_keys(*read_tire(options)).empty());
  EXPECT_NEAR(read_tire(options)->describe().vertical_stiffness, 2.2e5 * (1.0 + 0.8 * 0.25), 1e-6);
  MagicFormula without = t;
  without.vertical.pfz1 = 0.0;
  options.file = written(without);
  EXPECT_EQ(idle_keys(*read_tire(options)), std::vector<std::string>{"pressure"}) << "no coefficient has an effect";
  options.file = written(t);
  options.pressure.knots.push_back({1.0, 200e3});
  expect_refused(ExitCode::bad_input, {"key 'tire.pressure'", "one pressure"}, [&] { read_tire(options); });
}

/// Impossible numbers of a file, and parts of it that are not used, are reported with their names.
TEST(HandlingFile, unlikely_values_are_told_by_section_and_key) {
  const auto told = [](const MagicFormula& formula) {
    TireOptions options;
    options.file = written(formula);
    std::string all;
    for (const auto& [key, what] : read_tire(options)->unlikely_values()) all += key + " " + what + "\n";
    return all;
  };
  EXPECT_EQ(told(example_tire()), "");
  MagicFormula t = example_tire();
  t.longitudinal.rbx1 = 0.0;
  EXPECT_TRUE(holds(told(t), "[LONGITUDINAL_COEFFICIENTS] RBX1 of ")) << told(t);
  t.lateral.rcy1 = 0.0;
  EXPECT_TRUE(holds(told(t), "[LATERAL_COEFFICIENTS] RBY1 of ")) << told(t);
  EXPECT_TRUE(holds(told(t), "a friction ellipse is used"));
  t = example_tire();
  t.lateral.pty2 = 0.0;
  EXPECT_TRUE(holds(told(t), "[LATERAL_COEFFICIENTS] PTY1, PTY2 of ")) << told(t);
  t = example_tire();
  t.scaling.lmuy = 95.0;
  EXPECT_TRUE(holds(told(t), "[SCALING_COEFFICIENTS] LMUY of ")) << told(t);
  t = example_tire();
  t.vertical.fnomin = 400.0;
  EXPECT_TRUE(holds(told(t), "[VERTICAL] FNOMIN of ")) << told(t);
  t.load = {20.0, 390.0};
  EXPECT_TRUE(holds(told(t), "[VERTICAL_FORCE_RANGE] FZMIN, FZMAX of ")) << told(t);
  t = example_tire();
  t.slip.most = 0.0;
  EXPECT_TRUE(holds(told(t), "[LONG_SLIP_RANGE] KPUMAX of ")) << told(t);
  t = example_tire();
  t.lateral.pdy1 = 105.0;  // per cent; LMUY is 0.95
  EXPECT_TRUE(holds(told(t), "makes a grip of 99.75 under FNOMIN")) << told(t);
}

TEST(HandlingFile, wrong_files_are_refused_by_key) {
  const nlohmann::json good = file_of(written(example_tire()));
  const auto said = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json file = good;
    file[key] = value;
    return complaint_of(read_handling, file, {});
  };
  EXPECT_EQ(complaint_of(read_handling, good, {}), "no error");
  EXPECT_TRUE(holds(said("mass", -1), "key 'mass'"));
  EXPECT_TRUE(holds(said("mas", 1), "key 'mas'"));
  EXPECT_TRUE(holds(said("tir", "nowhere.tir"), "nowhere.tir"));
  EXPECT_TRUE(holds(said("tir", 3), "key 'tir'"));
  EXPECT_TRUE(holds(said("format_version", 7), "key 'format_version'"));
}

TEST(HandlingFile, is_pressed_along_its_stiffness_on_a_plate_alone) {
  TireOptions options;
  options.file = written(example_tire());
  PressOptions press;
  press.load = 2000.0;
  const PressResults results = pressed(options, press);
  EXPECT_NEAR(results.at_load.deflection, 2000.0 / 2.2e5, 1e-3 * 0.01);
  press.obstacle.height = 0.05;
  press.obstacle.width = 0.05;
  EXPECT_THROW(pressed(options, press), Error);
  press.obstacle.height = 0.0;
  press.deflection = 0.16;
  EXPECT_THROW(pressed(options, press), Error);
}

}  // namespace
}  // namespace furrow::tire::handling
