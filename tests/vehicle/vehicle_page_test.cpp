// Properties of a vehicle before it drives: counts, masses, posture, and vibrations on tires that do not deflect.
#include "vehicle/analysis/vehicle_page.hpp"
#include "tests/refusal.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/vehicle/shipped.hpp"
#include "vehicle/analysis/kinematics.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::StandingTire, vehicle::VehiclePage;

namespace {

std::vector<StandingTire> tires(int count, double mass, double radius, double stiffness) {
  StandingTire tire;
  tire.text = "a tire";
  tire.mass.mass = mass;
  tire.mass.inertia = 0.1 * mass * Mat3::Identity();
  tire.radius = radius;
  if (stiffness > 0.0) tire.points = {{0.0, 0.0}, {0.01, 0.01 * stiffness}, {0.03, 0.03 * stiffness}};
  return std::vector(count, tire);
}

}  // namespace

TEST(VehiclePage, of_the_hmmwv_has_its_counts_masses_and_stops) {
  const VehiclePage page = vehicle::vehicle_page(shipped("hmmwv.json"), tires(4, 25.0, 0.4673, 3.3e5));
  EXPECT_EQ(page.bodies, 19);
  EXPECT_EQ(page.rows, 100);
  EXPECT_EQ(page.freedoms, 14);
  EXPECT_EQ(page.shafts, 12);
  EXPECT_EQ(page.shaft_freedoms, 1);
  EXPECT_NEAR(page.mass, 2422.739, 1e-3);
  double sum = 0.0;
  for (const double load : page.trim.axle_loads) sum += load;
  EXPECT_NEAR(sum, (2422.739 + 100.0) * kStandardGravity, 0.02);
  EXPECT_NEAR(page.loaded_radii[0], 0.4673 - page.trim.wheels[0].load / 3.3e5, 1e-6);
  const nlohmann::ordered_json json = vehicle::page_json(page);
  EXPECT_EQ(json["wheels"][0]["spring"]["to_shortest_m"], page.trim.wheels[0].spring->to_shortest);
  EXPECT_EQ(json["modes"].size(), page.trim.modes.size());
  const std::string text = vehicle::page_text(page);
  for (const char* part :
       {"19, 100 rows, 14 degrees of freedom", "12, 1 more degree", "4 × a tire, 25.00 kg each", "front left, spring"})
    EXPECT_TRUE(holds(text, part)) << part << "\n" << text;
}

// c i²/(2 √(k m)): m by the spring's force at rest, k by kc, c of the file.
TEST(VehiclePage, damping_ratios_are_those_of_rates_ratios_and_the_mass_on_each_spring) {
  const vehicle::VehicleSpec spec = shipped("hmmwv.json");
  const VehiclePage page = vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5));
  ASSERT_EQ(page.damping_ratios.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const vehicle::WheelTrim& wheel = page.trim.wheels[k];
    const auto rows = vehicle::kinematics(spec, page.loaded_radii, {.travel = std::abs(wheel.travel), .points = 2});
    const auto at = std::find_if(rows.begin(), rows.end(), [&](const vehicle::KinematicsRow& row) {
      return row.motion == "parallel" && row.wheel == wheel.name && row.travel * wheel.travel > 0.0;
    });
    ASSERT_NE(at, rows.end());
    const auto& shock =
        std::get<vehicle::DoubleWishboneSpec>(spec.axles[k / 2].corners[k % 2].suspension).shock.value();
    ASSERT_GT(wheel.shock->to_shortest, 0.02);
    ASSERT_GT(wheel.shock->to_longest, 0.02);
    const double damping = 0.5 * (shock.compression + shock.rebound) * at->shock_ratio * at->shock_ratio;
    const double mass = wheel.spring->force * at->spring_ratio / kStandardGravity;
    EXPECT_NEAR(page.damping_ratios[k], damping / (2.0 * std::sqrt(at->wheel_rate * mass)), 2e-3) << wheel.name;
  }
}

// The centre of mass is that at which the axle loads balance; a wheel command to the left turns the front wheels left.
TEST(VehiclePage, of_the_hmmwv_has_its_distances_speeds_and_sense_of_steering) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  const VehiclePage page = vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5));
  const auto& trim = page.trim;
  double moment = 0.0, load = 0.0;
  for (const auto& wheel : trim.wheels) moment += wheel.load * wheel.center.x(), load += wheel.load;
  EXPECT_NEAR(page.center_of_mass.x(), moment / load, 2e-3);
  EXPECT_NEAR(page.center_height, trim.height + page.center_of_mass.z(), 1e-3);
  const auto drawn = [&](int axle) { return vehicle::spindle_of(spec.axles[axle].corners[vehicle::kLeft].suspension); };
  EXPECT_NEAR(page.wheelbase, drawn(0).center.x() - drawn(1).center.x(), 1e-3);
  ASSERT_EQ(page.tracks.size(), 2U);
  EXPECT_NEAR(page.tracks[0], 1.82, 1e-2);
  EXPECT_NEAR(page.static_stability_factor, (page.tracks[0] + page.tracks[1]) / (4.0 * page.center_height), 1e-12);
  EXPECT_GT(page.full_steering[0], 0.3);
  EXPECT_EQ(page.full_steering[1], 0.0);
  EXPECT_TRUE(vehicle::steers_against(spec, page).empty());
  ASSERT_EQ(page.gear_speeds.size(), spec.driveline.gearbox->ratios.size());
  // At one speed of the engine, speeds are proportional to the ratios.
  for (std::size_t k = 1; k < page.gear_speeds.size(); ++k)
    EXPECT_NEAR(page.gear_speeds[k].speed / page.gear_speeds[0].speed,
                spec.driveline.gearbox->ratios[k] / spec.driveline.gearbox->ratios[0], 1e-12);
  for (const char* part : {"centre       of mass x ", "wheelbase    3.30", "static stability factor", "gear 1 ",
                           "full left turns the wheels of front "})
    EXPECT_TRUE(holds(vehicle::page_text(page), part)) << part << "\n" << vehicle::page_text(page);
  std::get<vehicle::PitmanArmSpec>(*spec.axles[0].steering).left_angle_deg *= -1.0;
  const auto odd = vehicle::steers_against(spec, vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5)));
  ASSERT_EQ(odd.size(), 1U);
  EXPECT_EQ(odd[0].first, "axles[0].steering.left_angle_deg");
}

// A rigid tire vibrates on the ground assumed under it: four times the stiffness doubles its frequency.
TEST(VehiclePage, on_tires_that_do_not_deflect_tells_only_vibrations_of_the_vehicle_s_own_springs) {
  const VehiclePage page = vehicle::vehicle_page(shipped("buggy.json"), tires(4, 10.0, 0.3, 0.0));
  std::vector<std::string> names;
  for (const vehicle::TrimMode& mode : page.trim.modes) {
    names.push_back(mode.name);
    EXPECT_LT(mode.frequency, 5.0) << mode.name;
  }
  EXPECT_EQ(page.trim.modes.size(), 3U);  // heave, pitch and roll of the chassis
  EXPECT_NEAR(page.loaded_radii[0], 0.3, 2e-3 * 0.3);
  for (const std::string& name : names) EXPECT_EQ(name.find("hop"), std::string::npos) << name;
}

// Each phase is reported as it begins, at any speed of the machine, and the call may stop each of them.
TEST(VehiclePage, tells_its_progress_from_the_beginning_of_each_phase_and_can_be_stopped_in_any) {
  const vehicle::VehicleSpec spec = shipped("hmmwv.json");
  std::vector<std::string> phases;
  const auto note = [&](const std::string& what, double share) {
    EXPECT_TRUE(share >= 0.0 && share <= 1.0) << what << " " << share;
    if (phases.empty() || phases.back() != what) {
      EXPECT_EQ(share, 0.0) << what;
      phases.push_back(what);
    }
  };
  vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5), note);
  EXPECT_EQ(phases, (std::vector<std::string>{"finding how it stands", "moving the steerings"}));
  struct Stopped {};
  for (const std::string& last : phases) {
    std::string stopped_in;
    const auto stop = [&](const std::string& what, double) {
      stopped_in = what;
      if (what == last) throw Stopped{};
    };
    EXPECT_THROW(vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5), stop), Stopped) << last;
    EXPECT_EQ(stopped_in, last);
  }
}

// Vehicles of many axles take long: their shares rise.
TEST(VehiclePage, of_many_axles_tells_shares_that_do_not_fall) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  spec.driveline = {};
  const vehicle::AxleSpec axle = spec.axles[1];
  for (int k = 0; k < 6; ++k) {
    spec.axles.push_back(axle);
    spec.axles.back().name = "axle " + std::to_string(k);
    for (vehicle::CornerSpec& corner : spec.axles.back().corners)
      corner.suspension = std::visit(
          [&](const auto& s) -> vehicle::SuspensionSpec { return vehicle::shifted(s, Vec3(-1.2 * (k + 1), 0, 0)); },
          corner.suspension);
  }
  spec.chassis.mass *= 4.0;
  spec.chassis.inertia *= 4.0;
  spec.chassis.inertia.diagonal() += 2e4 * Vec3(0, 1, 1);
  spec.chassis.center_of_mass.x() -= 4.0;
  std::string phase;
  double share = 0.0;
  const auto note = [&](const std::string& what, double done) {
    EXPECT_TRUE(done >= 0.0 && done <= 1.0) << what << " " << done;
    EXPECT_TRUE(what != phase || done >= share) << what << " " << done << " after " << share;
    phase = what, share = done;
  };
  vehicle::vehicle_page(spec, tires(16, 25.0, 0.4673, 3.3e5), note);
  EXPECT_EQ(phase, "moving the steerings");
}

TEST(VehiclePage, springs_that_rest_in_their_stops_are_named_with_how_far) {
  const auto stops = [](const vehicle::VehicleSpec& spec) {
    const VehiclePage page = vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5));
    return vehicle::stops_at_rest(spec, page.trim);
  };
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  EXPECT_TRUE(stops(spec).empty()) << stops(spec)[0].second;
  const double length = vehicle::vehicle_page(spec, tires(4, 25.0, 0.4673, 3.3e5)).trim.wheels[2].spring->length;
  for (vehicle::CornerSpec& corner : spec.axles[1].corners) {
    vehicle::StopSpec& stop = *std::get<vehicle::DoubleWishboneSpec>(corner.suspension).spring->stop;
    stop.shortest = length + 0.02;
    stop.longest = stop.shortest + 0.1;
  }
  const auto found = stops(spec);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].first, "axles[1].suspension.spring.stop");
  EXPECT_TRUE(holds(found[0].second, "holds the wheel 'rear left' at rest: its spring is "));
  EXPECT_TRUE(holds(found[0].second, " mm beyond shortest, and pushes with "));
}

TEST(VehiclePage, of_a_vehicle_that_cannot_stand_is_an_error_of_its_file) {
  const auto complaint = [](const vehicle::VehicleSpec& spec) {
    return refusal(ExitCode::bad_input, [&] { vehicle::vehicle_page(spec, tires(4, 10.0, 0.3, 2e5)); });
  };
  vehicle::VehicleSpec spec = shipped("buggy.json"), fallen = spec;
  for (vehicle::CornerSpec& corner : spec.axles[0].corners)
    std::get<vehicle::DoubleWishboneSpec>(corner.suspension).spring.reset();
  EXPECT_TRUE(complaint(spec).starts_with(spec.file + ": vehicle 'Buggy'")) << complaint(spec);
  // Without its springs the rigid axle finds an equilibrium with the chassis on the ground.
  for (vehicle::CornerSpec& corner : fallen.axles[1].corners)
    std::get<vehicle::RigidAxleSpec>(corner.suspension).spring.reset();
  EXPECT_TRUE(holds(complaint(fallen), "key 'axles[1].suspension': lets the wheel 'rear left' stand 0.4"));
}
