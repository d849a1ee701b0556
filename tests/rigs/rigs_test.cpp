// The table of rigs: readers of sections, and agreement of descriptions with the rigs made.
#include "rigs/rigs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/drawbar_spec.hpp"
#include "tests/refusal.hpp"

namespace furrow::rigs_test {
namespace {

using nlohmann::json;

const ReadContext kContext{"test.json", "rig"};
constexpr double kRadius = 0.5;    // m
constexpr double kWidth = 0.3;     // m
constexpr double kTireMass = 4.0;  // kg
constexpr double kGravity = 9.81;  // m/s²

rigs::MountedTire bare_tire() { return {kRadius, kTireMass, {}, "tire.json"}; }
/// A tire whose file states all properties of its rim.
rigs::MountedTire tire_on_rim() { return {kRadius, kTireMass, {15.0, 0.7, 0.4, 450.0}, "tire.json"}; }

/// The rig on equal tires.
std::unique_ptr<rigs::RigSpec> mounted_rig(const json& section, const rigs::MountedTire& tire = tire_on_rim()) {
  auto rig = rigs::read_rig(section, kContext);
  rig->mount(std::vector<rigs::MountedTire>(rig->wheel_count(), tire));
  return rig;
}

json completed(json section, const rigs::MountedTire& tire = tire_on_rim()) {
  mounted_rig(section, tire)->complete(section);
  return section;
}

std::string complaint(const json& section, const rigs::MountedTire& tire = tire_on_rim()) {
  return refusal(ExitCode::bad_input, [&] { mounted_rig(section, tire); });
}

rigs::WheelDescription only_wheel(const json& section, double duration = 2.0) {
  const std::vector<rigs::WheelSize> tires{{kRadius, kWidth}};
  return mounted_rig(section)->describe(tires, duration).wheels.at(0);
}

TEST(Rigs, a_section_without_a_type_is_a_drawbar_rig) {
  const auto rig = mounted_rig(json::object());
  EXPECT_EQ(rig->wheel_count(), 1U);
  EXPECT_EQ(rig->make()->kind(), "drawbar");
}

TEST(Rigs, an_unknown_type_lists_the_valid_ones) {
  std::vector<std::string> names;
  for (const rigs::RigKind& kind : rigs::rig_kinds()) names.emplace_back(kind.name);
  EXPECT_EQ(complaint({{"type", "sled"}}), "test.json: key 'rig.type': is 'sled', expected " + one_of(names));
}

TEST(Rigs, full_slip_at_an_imposed_speed_is_refused_with_its_key) {
  EXPECT_EQ(complaint({{"mode", "fixed_speed"}, {"wheels", {{{"slip", 0.1}}, {{"slip", 1.0}}}}}).substr(0, 40),
            "test.json: key 'rig.wheels.1.slip': is 1");
}

TEST(Rigs, keys_that_a_mode_does_not_use_are_warned_of) {
  const auto warnings = [](const json& section) {
    std::string all;
    for (const auto& [key, what] : rigs::read_rig(section, kContext)->unlikely_values()) all += key + " " + what + "\n";
    return all;
  };
  EXPECT_EQ(warnings({{"mode", "fixed_speed"}, {"slip", 0.1}, {"speed", 2.0}}), "");
  EXPECT_EQ(warnings({{"mode", "fixed_angular_speed"}, {"slip", 0.1}, {"angular_speed", 2.0}}), "");
  EXPECT_EQ(warnings({{"mode", "free_rolling"}, {"slip", 0.0}, {"speed", 2.0}}), "");
  EXPECT_TRUE(
      holds(warnings({{"mode", "fixed_speed"}, {"angular_speed", 2.0}}),
            "rig.angular_speed is 2 rad/s and is not used in mode fixed_speed, where the wheel turns at speed"));
  const std::string rolling = warnings({{"mode", "free_rolling"}, {"slip", 0.1}, {"angular_speed", 2.0}});
  EXPECT_TRUE(
      holds(rolling, "rig.slip is 0.1 and is not used in mode free_rolling, where the carriage moves at speed"));
  EXPECT_TRUE(holds(rolling, "rig.angular_speed is 2 rad/s and is not used in mode free_rolling"));
  EXPECT_TRUE(holds(warnings({{"mode", "free_rolling"}, {"wheels", {{{"lateral", 0.4}}, {{"slip", 0.2}}}}}),
                    "rig.wheels.1.slip is 0.2 and is not used"));
}

TEST(Rigs, entries_of_wheels_take_from_the_rig_what_they_leave_out) {
  const auto rig =
      mounted_rig({{"slip", 0.1},
                   {"carrier_mass", 100.0},
                   {"rim_mass", 10.0},
                   {"start", 3.0},
                   {"wheels", {{{"lateral", -0.4}}, {{"lateral", 0.4}, {"slip", 0.2}, {"start", nullptr}}}}});
  const std::vector<rigs::WheelSize> tires(2, {kRadius, kWidth});
  const rigs::RigDescription d = rig->describe(tires, 1.0);
  EXPECT_EQ(d.kind, rig->make()->kind());
  EXPECT_EQ(d.text, "2 drawbar rigs, fixed_angular_speed");
  EXPECT_EQ(rig->make()->wheel_count(), 2);
  EXPECT_EQ(d.wheels[0].slip, 0.1);
  EXPECT_EQ(d.wheels[1].slip, 0.2);
  EXPECT_EQ(d.wheels[0].lateral, -0.4);
  EXPECT_EQ(d.wheels[1].lateral, 0.4);
  EXPECT_EQ(d.wheels[1].from, 3.0);
  EXPECT_EQ(d.wheels[1].carried_mass, 110.0);
  EXPECT_EQ(d.wheels[1].start_key, "rig.wheels.1.start");
}

TEST(Rigs, a_wheel_that_rolls_freely_has_no_slip_of_its_rig) {
  EXPECT_EQ(only_wheel({{"slip", 0.2}}, 0.5).slip, 0.2);
  EXPECT_EQ(only_wheel({{"slip", 0.2}, {"mode", "free_rolling"}, {"speed", 2.0}}, 0.5).slip, std::nullopt);
}

TEST(Rigs, of_a_list_with_one_wheel_the_start_is_named_where_it_stands) {
  const std::vector<rigs::WheelSize> one(1, {kRadius, kWidth});
  const auto key = [&](const json& section) {
    return rigs::read_rig(section, kContext)->describe(one, 1.0).wheels[0].start_key;
  };
  EXPECT_EQ(key({{"wheels", {{{"start", -5.0}}}}}), "rig.wheels.0.start");
  EXPECT_EQ(key({{"start", -5.0}, {"wheels", {{{"lateral", 0.1}}}}}), "rig.start");
  EXPECT_EQ(key({{"start", -5.0}}), "rig.start");
  expect_refused(ExitCode::bad_input, {"key 'rig.wheels.0.slip'"}, [&] {
    rigs::read_rig({{"mode", "fixed_speed"}, {"wheels", {{{"slip", 1.0}}}}}, kContext);
  });
}

TEST(Rigs, description_is_that_of_the_made_rig) {
  const json section = {{"travel_sign", -1}, {"start", 4.0}, {"ramp", 0.2},        {"camber_angle", 0.1},
                        {"rim_mass", 20.0},  {"slip", 0.25}, {"carrier_mass", 300}};
  const rigs::WheelDescription d = only_wheel(section, 0.5);
  const auto rig = mounted_rig(section)->make();
  rig->add_tire_mass(0, {}, kRadius);
  const std::vector<double> height{1.0};
  rig->place(height);
  EXPECT_EQ(rig->rim(0).position.x(), d.from);
  EXPECT_EQ(rig->rim(0).position.y(), d.lateral);
  EXPECT_EQ(rig->heading(0).x(), d.travel_sign);
  EXPECT_EQ(rig->report(0).carried_mass, d.carried_mass);
  for (int n = 0; n < 1000; ++n) {
    const Wrench none;
    ASSERT_TRUE(rig->advance({&none, 1}, 5e-4, 1).ok);
  }
  EXPECT_NEAR(rig->rim(0).position.x(), d.to, 1e-3);  // first order in the step over the ramp
  EXPECT_NEAR(rig->report(0).slip, *d.slip, 1e-9);
}

/// A disc of radius R and width b, turned by δ and leaning by γ: R cos δ + h sin δ along, h cos δ + R sin δ across,
/// with h = b/2 cos γ + R sin γ.
TEST(Rigs, a_wheel_takes_the_room_of_a_disc_that_turns_and_leans) {
  const double toe = 0.3, camber = 0.2;
  const double h = 0.5 * kWidth * std::cos(camber) + kRadius * std::sin(camber);
  for (const double sign : {1.0, -1.0}) {
    const rigs::WheelDescription d = only_wheel({{"toe_angle", sign * toe}, {"camber_angle", sign * camber}});
    EXPECT_DOUBLE_EQ(d.along, kRadius * std::cos(toe) + h * std::sin(toe));
    EXPECT_DOUBLE_EQ(d.across, h * std::cos(toe) + kRadius * std::sin(toe));
    EXPECT_EQ(d.toe_angle, sign * toe);
    EXPECT_EQ(d.camber_angle, sign * camber);
  }
  // It is turned sideways later, but straight at first.
  EXPECT_EQ(only_wheel({{"toe_angle", 1.4}, {"toe_time", 1.0}}).along, kRadius);
}

TEST(Rigs, starts_are_filled_in_clear_of_the_wall_behind) {
  const std::vector<rigs::WheelSize> tires{{kRadius, kWidth}};
  const auto start = [&](const json& section, std::optional<double> length) {
    const auto rig = rigs::read_rig(section, kContext);
    rig->fill_starts(tires, 1.0, length, std::vector<double>{0.1});
    json completed = json::object();
    rig->complete(completed);
    EXPECT_EQ(completed["start"].get<double>(), rig->describe(tires, 1.0).wheels[0].from);
    return completed["start"].get<double>();
  };
  EXPECT_DOUBLE_EQ(start(json::object(), 9.0), 0.6);
  EXPECT_DOUBLE_EQ(start({{"travel_sign", -1}}, 9.0), 8.4);
  EXPECT_EQ(start({{"start", nullptr}}, std::nullopt), 0.0);
  EXPECT_EQ(start({{"start", 2.0}}, 9.0), 2.0);
}

TEST(Masses, the_carrier_follows_from_the_load) {
  EXPECT_NEAR(only_wheel({{"load", 1000.0}}).carried_mass, 1000.0 / kGravity - kTireMass, 1e-12);
  const auto rig = mounted_rig({{"load", 3000.0}, {"rim_mass", 2.0}})->make();
  rig->add_tire_mass(0, {kTireMass, Mat3::Zero()}, kRadius);
  const std::vector<double> height{1.0};
  rig->place(height);
  EXPECT_NEAR(rig->report(0).load(), 3000.0, 1e-9);
}

TEST(Masses, of_load_and_carrier_one_is_said) {
  EXPECT_EQ(complaint({{"wheels", {{{"lateral", 0.1}}, {{"load", 900.0}, {"carrier_mass", 5.0}}}}}),
            "test.json: key 'rig.wheels.1.load': is given beside 'rig.wheels.1.carrier_mass', expected one of "
            "the two");
  EXPECT_EQ(complaint({{"lowering_speed", 0.1}, {"touchdown_damping", 5.0}}),
            "test.json: key 'rig.lowering_speed': is given beside 'rig.touchdown_damping', expected one of the "
            "two");
}

TEST(Masses, a_load_below_the_weight_of_rim_and_tire_says_the_least) {
  const std::string told = complaint({{"load", 24.5}});
  EXPECT_TRUE(told.starts_with("test.json: key 'rig.load': is 24.5 N, expected above 186.39 N: ")) << told;
}

/// Regression: a laboratory's wheel got a car's masses without a message.
TEST(Masses, what_neither_scenario_nor_tire_file_says_is_asked_for_by_its_keys) {
  std::string told = complaint({{"slip", 0.1}}, bare_tire());
  EXPECT_TRUE(
      told.starts_with("test.json: key 'rig.load': is missing and so is rig.rim_mass, "
                       "rig.rim_spin_inertia, expected here"))
      << told;
  told = complaint({{"load", 60.0}, {"rim_mass", 0.1}}, bare_tire());
  EXPECT_TRUE(told.starts_with("test.json: key 'rig.rim_spin_inertia': is missing, expected here")) << told;
  const json given = completed({{"load", 60.0}, {"rim_mass", 0.1}, {"rim_spin_inertia", 1e-4}}, bare_tire());
  EXPECT_EQ(given["rim_diametral_inertia"], 0.5e-4);
}

TEST(Masses, the_tire_file_says_what_the_scenario_does_not) {
  const json given = completed({{"rim_mass", 12.0}});
  EXPECT_EQ(given["rim_mass"], 12.0);
  EXPECT_EQ(given["rim_spin_inertia"], 0.7);
  EXPECT_EQ(given["carrier_mass"], 450.0);
  EXPECT_EQ(completed(given), given);
  const json by_load = completed({{"load", 3000.0}});
  EXPECT_FALSE(by_load.contains("carrier_mass"));
  EXPECT_EQ(completed(by_load), by_load);
}

TEST(Masses, an_entry_of_wheels_has_its_own_load) {
  const auto rig = mounted_rig({{"carrier_mass", 100.0}, {"wheels", {{{"lateral", 0.4}}, {{"load", 2000.0}}}}});
  const std::vector<rigs::WheelSize> tires(2, {kRadius, kWidth});
  const rigs::RigDescription d = rig->describe(tires, 1.0);
  EXPECT_EQ(d.wheels[0].carried_mass, 115.0);
  EXPECT_NEAR(d.wheels[1].carried_mass, 2000.0 / kGravity - kTireMass, 1e-12);
}

/// Equal Froude number: v/√(g R) and t √(g/R) are the same for wheels of any size.
TEST(Touchdown, speed_and_time_of_lowering_go_with_the_wheels_size) {
  for (const double radius : {0.05, 0.5}) {
    rigs::MountedTire tire = tire_on_rim();
    tire.radius = radius;
    const json given = completed({{"load", 1000.0}}, tire);
    const double speed = 1000.0 / given["touchdown_damping"].get<double>(),
                 time = given["touchdown_time"].get<double>();
    EXPECT_NEAR(speed / std::sqrt(kGravity * radius), 0.18, 1e-12);
    EXPECT_NEAR(time * std::sqrt(kGravity / radius), 1.6, 1e-12);
  }
  const json slow = {{"lowering_speed", 0.01}, {"move_from", 0.7}};
  EXPECT_NEAR(only_wheel(slow).lowering_speed, 0.01, 1e-12);
  EXPECT_EQ(completed(slow)["touchdown_time"], 0.7);
}

TEST(Touchdown, a_wheel_that_moves_later_travels_less) {
  const json at_once = {{"mode", "fixed_speed"}, {"speed", 2.0}, {"ramp", 0.1}, {"start", 1.0}};
  json later = at_once;
  later["move_from"] = 0.5;
  EXPECT_NEAR(only_wheel(at_once).to - only_wheel(later).to, 2.0 * 0.5, 1e-12);
  later["move_from"] = 5.0;
  EXPECT_EQ(only_wheel(later).to, 1.0);
}

}  // namespace
}  // namespace furrow::rigs_test
