// A vehicle as a rig: it stands in its trim, stays in place when braked, and accelerates according to its engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rigs/vehicle/vehicle_start.hpp"
#include "tests/rigs/vehicle_fixture.hpp"
#include "vehicle/driveline/torque_converter.hpp"

using namespace furrow;
using namespace furrow::testing;
using nlohmann::json;

namespace {

const json kFullThrottle = {{"inputs", {{"throttle", 1.0}}}};

std::vector<double> loads(const rigs::Rig& rig, const Track& track) {
  std::vector<double> all;
  for (int k = 0; k < rig.wheel_count(); ++k) all.push_back(track.wrench(rig.rim(k)).force.z());
  return all;
}

}  // namespace

TEST(VehicleRig, starts_in_the_trim_of_hard_ground_with_its_tires_at_their_heights) {
  rigs::VehicleRigPlan plan = vehicle_plan("hmmwv.json");
  plan.options.start = 3.0;
  plan.options.lateral = -0.4;
  plan.options.heading = 0.3;
  const Track track;
  const auto rig = track.rig(plan, 0.001);
  EXPECT_NEAR(of_vehicle(*rig, "x_m"), 3.0, 1e-12);
  EXPECT_NEAR(of_vehicle(*rig, "y_m"), -0.4, 1e-12);
  EXPECT_NEAR(of_vehicle(*rig, "yaw_rad"), 0.3, 1e-9);
  EXPECT_LT((rig->heading(0) - Vec3(std::cos(0.3), std::sin(0.3), 0.0)).norm(), 0.02);  // toe
  double total = 0.0;
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(rig->rim(k).position.z(), track.radius + 0.001, 2e-4) << k;
    EXPECT_GE(rig->rim(k).position.z(), track.radius + 0.001 - 1e-12) << k;
    EXPECT_EQ(rig->rim(k).velocity.norm(), 0.0);
    EXPECT_NEAR(measured(*rig, k, "suspension_travel_m"), 0.0, 2e-3) << k;  // drawn at rest
    EXPECT_NEAR(measured(*rig, k, "spring_force_N"), 0.0, 0.0);             // a mean over no time
    total += rig->report(k).load();
  }
  EXPECT_NEAR(total, (2422.739 + 4 * 4.8) * kStandardGravity, 0.1);
  EXPECT_NEAR(rig->report(0).load(), rig->report(1).load(), 5.0);
}

TEST(VehicleRig, parked_settles_to_the_loads_of_its_trim_and_stays) {
  for (const auto& [lowering, gap] : {std::pair{0.39, 0.001}, {0.0, 0.11}}) {
    const Track track;
    const auto rig = track.rig(vehicle_plan("hmmwv.json", nullptr, lowering), gap);
    double highest = 0.0;
    track.drive(*rig, 1.0, [&] {
      for (const double load : loads(*rig, track)) highest = std::max(highest, load);
    });
    EXPECT_LT(highest, lowering > 0.0 ? 12e3 : 30e3);  // 6 kN at rest
    EXPECT_GT(highest, lowering > 0.0 ? 5e3 : 9e3);
    track.drive(*rig, 3.0);
    const std::vector<double> now = loads(*rig, track);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(now[k], rig->report(k).load(), 5e-3 * now[k]) << k;
    const double x = of_vehicle(*rig, "x_m"), distance = of_vehicle(*rig, "distance_m");
    track.drive(*rig, 2.0);
    EXPECT_NEAR(of_vehicle(*rig, "x_m"), x, 1e-5) << "it creeps";
    EXPECT_LT(of_vehicle(*rig, "distance_m") - distance, 1e-4);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(rig->report(k).slip, 0.0);
    EXPECT_GT(of_vehicle(*rig, "engine_speed_rpm"), 573.0);  // it idles against the brakes
  }
}

// In the lowest gear: T = T_t/i is the turbine's torque on the wheels through the ratio i of wheel to turbine, T_t the
// converter's torque at the speeds of crank and wheels. It accelerates the mass and the parts that turn with the
// wheels:
//   T = m a r + J α,  r the radius under load.
TEST(VehicleRig, accelerates_as_engine_and_converter_say) {
  rigs::VehicleRigPlan plan = vehicle_plan("hmmwv.json", {{"inputs", {{"throttle", 0.4}, {"gear", 1}}}});
  const Track track;
  const auto rig = track.rig(plan);
  const auto spin = [&] {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += rig->report(k).spin / 4.0;
    return sum;
  };
  track.drive(*rig, 1.5);
  const double speed = of_vehicle(*rig, "speed_m_s"), before = spin();
  const vehicle::DrivelineSpec& line = plan.vehicle.driveline;
  const vehicle::ConverterOptions converter{{"capacity", line.converter->capacity},
                                            {"ratio", line.converter->torque_ratio}};
  const double ratio = 0.2 * 0.2;
  double torque = 0.0, acceleration = 0.0;
  constexpr int kSteps = 1000;
  track.drive(*rig, kSteps * track.step, [&] {
    const double crank = of_vehicle(*rig, "engine_speed_rpm") * std::numbers::pi / 30.0;
    torque += vehicle::converter_torque(converter, crank, spin() / ratio).turbine / ratio / kSteps;
    acceleration += of_vehicle(*rig, "acceleration_m_per_s2") / kSteps;
  });
  const double time = kSteps * track.step, radius = rig->rim(0).position.z();
  const double wheels = 4.0 * (0.07352 + 0.6243 + 0.78 + 0.4), boxes = 2.0 * 0.6,
               shafts = (2.0 * 0.5 + 0.6 + 0.5) / (0.2 * 0.2), turbine = 0.3 / (ratio * ratio);
  const double turning = (wheels + boxes + shafts + turbine) * (spin() - before) / time;
  const double mass = 2422.739 + 4.0 * 4.8;
  EXPECT_GT(acceleration, 1.0);
  EXPECT_NEAR((torque - turning) / radius, mass * acceleration, 0.01 * mass * acceleration);
  EXPECT_NEAR(acceleration, (of_vehicle(*rig, "speed_m_s") - speed) / time, 0.02 * acceleration);
  EXPECT_EQ(of_vehicle(*rig, "gear"), 1.0);
  EXPECT_NEAR(of_vehicle(*rig, "throttle"), 0.4, 1e-12);
  const double turbine_speed = of_vehicle(*rig, "turbine_speed_rpm") * std::numbers::pi / 30.0;
  EXPECT_NEAR(turbine_speed, spin() / ratio, 0.01 * turbine_speed);
}

TEST(VehicleRig, shifts_by_itself_and_holds_the_gear_that_its_driver_asks_for) {
  const Track track;
  const auto automatic = track.rig(vehicle_plan("hmmwv.json", kFullThrottle));
  double highest = 0.0, shifting = 0.0;
  track.drive(*automatic, 6.0, [&] {
    highest = std::max(highest, of_vehicle(*automatic, "gear"));
    shifting += track.step * of_vehicle(*automatic, "shifting");
  });
  EXPECT_GE(highest, 2.0);
  EXPECT_GT(shifting, 0.3);
  const auto held = track.rig(vehicle_plan(
      "hmmwv.json", {{"inputs", {{"throttle", 1.0}, {"gear", json::array({{0, 1}, {2, 2}, {4, "auto"}})}}}}));
  track.drive(*held, 1.9);
  EXPECT_EQ(of_vehicle(*held, "gear"), 1.0);
  track.drive(*held, 0.2);
  EXPECT_EQ(of_vehicle(*held, "gear"), 2.0);
  track.drive(*held, 1.5);
  EXPECT_EQ(of_vehicle(*held, "gear"), 2.0);
  EXPECT_EQ(held->live().text, "gear 2");
  EXPECT_NEAR(held->live().speed, of_vehicle(*held, "speed_m_s"), 0.0);
}

// The rear right wheel stands on ice. Without a lock it spins. With a lock both outputs turn equally, or the clutch
// between them slips and moves its torque from one to the other.
TEST(VehicleRig, locks_its_differentials_while_its_driver_says_so) {
  Track road, ice;
  ice.friction = 0.02;
  const auto drive = [&](double lock_torque, double& faster, double& torque) {
    rigs::VehicleRigPlan plan = vehicle_plan(
        "hmmwv.json", {{"inputs", {{"throttle", 0.3}, {"gear", 1}, {"lock", json::array({{0, 0}, {1.5, 1}})}}}});
    for (vehicle::DifferentialSpec& one : plan.vehicle.driveline.differentials) one.lock_torque.reset();
    plan.vehicle.driveline.differentials.back().lock_torque = lock_torque;
    const auto rig = road.rig(plan, 0.001);
    const auto run = [&](double duration, const std::function<void()>& after) {
      std::vector<Wrench> wrenches(4);
      for (int i = 0; i < std::lround(duration / road.step); ++i) {
        for (int k = 0; k < 4; ++k) wrenches[k] = (k == 3 ? ice : road).wrench(rig->rim(k));
        ASSERT_TRUE(rig->advance(wrenches, road.step, 1).ok);
        if (after) after();
      }
    };
    run(1.4, {});
    EXPECT_GT(rig->report(3).spin, 1.5 * rig->report(2).spin) << "open";
    EXPECT_EQ(of_vehicle(*rig, "lock"), 0.0);
    run(0.9, {});
    faster = torque = 0.0;
    run(0.2, [&] {
      faster += (rig->report(3).spin - rig->report(2).spin) / 400;
      torque += (rig->report(2).drive_torque - rig->report(3).drive_torque) / 400;
    });
    EXPECT_EQ(of_vehicle(*rig, "lock"), 1.0);
  };
  double faster = 0.0, torque = 0.0;
  drive(1e5, faster, torque);
  EXPECT_NEAR(faster, 0.0, 1e-3);
  EXPECT_GT(torque, 250.0);
  drive(100.0, faster, torque);
  EXPECT_GT(faster, 1.0);
  EXPECT_NEAR(torque, 2.0 * 100.0, 10.0);
}

// The brakes hold wheels that are locked together: the locks' creep determines each brake's share of the torque. A lock
// that is too weak slips and transmits its torque.
TEST(VehicleRig, locked_axles_turn_alike_when_they_are_braked_on_two_frictions_until_they_stand) {
  Track grip, ice;
  ice.friction = 0.2;
  for (const double lock_torque : {100.0, 2e3}) {
    rigs::VehicleRigPlan plan = vehicle_plan(
        "hmmwv.json", {{"inputs",
                        {{"gear", 0},
                         {"lock", json::array({{0, 0}, {0.3, 1}})},
                         {"brake", json::array({{0, 0}, {0.5, 0}, {0.6, 0.1}, {0.9, 0.1}, {1.0, 1.0}})}}}});
    plan.options.start_speed = 5.0;
    for (vehicle::DifferentialSpec& one : plan.vehicle.driveline.differentials) one.lock_torque = lock_torque;
    const auto rig = grip.rig(plan, 0.0);
    const rigs::RigAccounts start = rig->accounts();
    double apart = 0.0, across = 0.0;
    std::vector<Wrench> wrenches(4);
    for (int i = 0; i < std::lround(2.2 / grip.step); ++i) {
      for (int k = 0; k < 4; ++k) wrenches[k] = (k % 2 ? ice : grip).wrench(rig->rim(k));
      const Outcome outcome = rig->advance(wrenches, grip.step, 1);
      ASSERT_TRUE(outcome.ok) << outcome.message("rig") << " at " << i * grip.step << " s";
      if (const double time = i * grip.step; time < 0.7 || time > 0.9) continue;
      for (const int k : {0, 2}) {
        apart = std::max(apart, std::abs(rig->report(k).spin - rig->report(k + 1).spin));
        across = std::max(across, std::abs(rig->report(k).drive_torque - rig->report(k + 1).drive_torque));
      }
    }
    EXPECT_LT(std::abs(of_vehicle(*rig, "speed_m_s")), 0.05) << lock_torque;
    const bool slips = lock_torque == 100.0;
    EXPECT_EQ(apart < 1e-3, !slips) << apart << " rad/s, " << lock_torque;
    EXPECT_GT(across, 200.0 * 0.95) << lock_torque;
    EXPECT_EQ(across < 2.0 * 100.0 * 1.05, slips) << across << ' ' << lock_torque;
    const rigs::RigAccounts end = rig->accounts();
    EXPECT_LT(std::abs(energy_residual(start, end)), 1e-3 * start.stored()) << lock_torque;
    EXPECT_LT(momentum_residual(start, end).norm(), 1e-9 * end.gravity_impulse.norm()) << lock_torque;
  }
}

TEST(VehicleRig, drives_backwards_in_reverse_and_not_at_all_in_neutral) {
  const Track track;
  const auto back = track.rig(vehicle_plan("hmmwv.json", {{"inputs", {{"throttle", 0.3}, {"gear", -1}}}}));
  track.drive(*back, 2.0);
  EXPECT_LT(of_vehicle(*back, "speed_m_s"), -0.3);
  EXPECT_EQ(of_vehicle(*back, "gear"), -1.0);
  const auto neutral = track.rig(vehicle_plan("hmmwv.json", {{"inputs", {{"throttle", 0.3}, {"gear", 0}}}}));
  track.drive(*neutral, 2.0);
  EXPECT_LT(std::abs(of_vehicle(*neutral, "speed_m_s")), 0.02);
  EXPECT_EQ(of_vehicle(*neutral, "gear"), 0.0);
}

TEST(VehicleRig, steers_to_the_left_and_measures_its_turn) {
  const Track track;
  const auto rig =
      track.rig(vehicle_plan("hmmwv.json", {{"inputs", {{"steering", json::array({{0, 0}, {1, 0}, {1.5, 0.5}})}}},
                                            {"speed", {{"target", 3.0}}}}));
  track.drive(*rig, 5.0);
  EXPECT_GT(of_vehicle(*rig, "yaw_rad"), 0.3);
  EXPECT_GT(of_vehicle(*rig, "y_m"), 0.3);
  EXPECT_GT(measured(*rig, 0, "wheel_steer_rad"), 0.1);
  EXPECT_NEAR(measured(*rig, 2, "wheel_steer_rad"), 0.0, 0.02);
  EXPECT_GT(rig->heading(0).y(), rig->heading(2).y());
  EXPECT_GT(of_vehicle(*rig, "lateral_acceleration_m_per_s2"), 0.3);
  // It leans outward, to the right, and its outer wheels carry more.
  EXPECT_GT(of_vehicle(*rig, "roll_rad"), 0.001);
  EXPECT_GT(track.wrench(rig->rim(1)).force.z(), track.wrench(rig->rim(0)).force.z());
  EXPECT_NEAR(of_vehicle(*rig, "speed_m_s"), 3.0, 0.4);
  EXPECT_EQ(of_vehicle(*rig, "target_speed_m_per_s"), 3.0);
}

TEST(VehicleRig, a_braked_wheel_slips_and_the_vehicle_stops) {
  Track track;
  const auto rig = track.rig(vehicle_plan("hmmwv.json", {{"inputs",
                                                          {{"throttle", json::array({{0, 0.6}, {3, 0.6}, {3.01, 0}})},
                                                           {"brake", json::array({{0, 0}, {3, 0}, {3.1, 0.3}})}}}}));
  track.drive(*rig, 3.0);
  const double speed = of_vehicle(*rig, "speed_m_s"), slip = rig->report(0).slip;
  EXPECT_GT(speed, 3.0);
  track.drive(*rig, 0.3);
  EXPECT_LT(measured(*rig, 0, "brake_torque_Nm"), -1000.0);
  EXPECT_LT(rig->report(0).slip, slip - 0.02);  // relative to the undeformed radius, it is not zero in rolling
  track.drive(*rig, 4.0);
  EXPECT_LT(std::abs(of_vehicle(*rig, "speed_m_s")), 0.02);
  EXPECT_GT(of_vehicle(*rig, "brake_heat_J"), 0.3 * 2441.9 * speed * speed / 2.0);
}

// The rig has the tires' inertia: in the air, everything falls together.
TEST(VehicleRig, falls_freely_with_its_tires_masses) {
  const Track track;
  const auto rig = track.rig(vehicle_plan("hmmwv.json", nullptr, 0.0), 2.0);
  const double z = of_vehicle(*rig, "z_m");
  const rigs::RigAccounts start = rig->accounts();
  track.drive(*rig, 0.4);
  const rigs::RigAccounts end = rig->accounts();
  EXPECT_NEAR(end.momentum.z() - start.momentum.z(), -(2422.739 + 4 * 4.8) * kStandardGravity * 0.4, 1e-2);
  EXPECT_NEAR(of_vehicle(*rig, "z_m") - z, -0.5 * kStandardGravity * 0.16, 0.08);  // the wheels spring out
  EXPECT_EQ(end.tire_impulse.norm(), 0.0);
}

TEST(VehicleRig, rover_drives_on_its_motors_on_six_rigid_wheels) {
  Track track;
  track.radius = 0.058;
  track.stiffness = 2e4;
  track.damping = 50.0;
  track.slip_scale = 100.0;
  track.tire = {0.0, Mat3::Zero()};
  rigs::VehicleRigPlan plan = vehicle_plan("rover.json", {{"inputs", {{"throttle", 0.5}}}}, 0.13);
  plan.options.touchdown_time = 0.12;
  plan.tire_width = 0.05;
  const auto rig = track.rig(plan, 0.0005);
  ASSERT_EQ(rig->wheel_count(), 6);
  double weight = 0.0;
  for (int k = 0; k < 6; ++k) weight += rig->report(k).load();
  EXPECT_NEAR(weight, 6 * 24.5, 2.0);
  track.drive(*rig, 2.0);
  // Without load half of the no-load speed: 6000 rpm / 100 × ½ on 58 mm.
  const double free = 0.5 * 6000.0 * std::numbers::pi / 30.0 / 100.0 * 0.058;
  EXPECT_NEAR(of_vehicle(*rig, "speed_m_s"), free, 0.03 * free);  // on 2 % less than 58 mm
  EXPECT_EQ(rig->live().text, "");
  EXPECT_GT(of_vehicle(*rig, "drive_work_J"), 0.0);
}

// The engine's work goes into the vehicle's motion, the losses of driveline, brakes and shocks, and the tires.
TEST(VehicleRig, accounts_of_energy_and_momentum_close) {
  const json driver = {{"inputs",
                        {{"throttle", json::array({{0, 0}, {0.5, 1}, {4, 1}, {4.01, 0}})},
                         {"brake", json::array({{0, 0}, {4.5, 0}, {4.6, 0.4}})},
                         {"steering", json::array({{0, 0}, {2, 0}, {3, 0.3}})}}}};
  const auto residuals = [&](double step) {
    Track track;
    track.step = step;
    const auto rig = track.rig(vehicle_plan("hmmwv.json", driver), 0.01);
    const rigs::RigAccounts a = rig->accounts();
    EXPECT_EQ(first_missing(a), nullptr);
    track.drive(*rig, 5.5);
    const rigs::RigAccounts b = rig->accounts();
    EXPECT_LT(momentum_residual(a, b).norm(), 1e-9 * b.gravity_impulse.norm());
    EXPECT_GT(of_vehicle(*rig, "shift_heat_J"), 10.0);
    EXPECT_GT(b.drive_work, 1e5);
    return energy_residual(a, b) / b.drive_work;
  };
  const double coarse = residuals(2e-3), fine = residuals(1e-3);
  EXPECT_LT(std::abs(fine), 1e-3);
  EXPECT_LT(std::abs(fine), 0.6 * std::abs(coarse) + 1e-6) << coarse;
}
