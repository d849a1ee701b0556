// The table of rigs: what reads a section, and that descriptions are true of the rigs that are made.
#include "rigs/rigs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "protocol/core/error.hpp"
#include "rigs/drawbar_spec.hpp"

using namespace furrow;
using nlohmann::json;

namespace {

const ReadContext kContext{"test.json", "rig"};
constexpr double kRadius = 0.5;  // m
constexpr double kWidth = 0.3;   // m

std::string complaint(const json& section) {
  try {
    rigs::read_rig(section, kContext);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "no error";
}

rigs::WheelDescription only_wheel(const json& section, double duration = 2.0) {
  const std::vector<rigs::WheelSize> tires{{kRadius, kWidth}};
  return rigs::read_rig(section, kContext)->describe(tires, duration).wheels.at(0);
}

}  // namespace

TEST(Rigs, a_section_without_a_type_is_a_drawbar_rig) {
  const auto rig = rigs::read_rig(json::object(), kContext);
  EXPECT_EQ(rig->wheel_count(), 1U);
  EXPECT_EQ(rig->make()->kind(), "drawbar");
}

TEST(Rigs, an_unknown_type_lists_the_valid_ones) {
  EXPECT_EQ(complaint({{"type", "sled"}}), "test.json: key 'rig.type': is 'sled', expected drawbar");
}

TEST(Rigs, full_slip_at_an_imposed_speed_is_refused_with_its_key) {
  EXPECT_EQ(complaint({{"mode", "fixed_speed"}, {"slip", 1.0}}).substr(0, 55),
            "test.json: key 'rig.slip': is 1, expected below 1 in mo");
  EXPECT_EQ(
      complaint({{"mode", "fixed_speed"}, {"wheels", {{{"slip", 0.1}}, {{"slip", 1.0}}}}}).substr(0, 40),
      "test.json: key 'rig.wheels.1.slip': is 1");
}

TEST(Rigs, entries_of_wheels_take_from_the_rig_what_they_leave_out) {
  const auto rig = rigs::read_rig(
      {{"slip", 0.1},
       {"carrier_mass", 100.0},
       {"rim_mass", 10.0},
       {"start", 3.0},
       {"wheels", {{{"lateral", -0.4}}, {{"lateral", 0.4}, {"slip", 0.2}, {"start", nullptr}}}}},
      kContext);
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

TEST(Rigs, of_a_list_with_one_wheel_the_start_is_named_where_it_stands) {
  const std::vector<rigs::WheelSize> one(1, {kRadius, kWidth});
  const auto key = [&](const json& section) {
    return rigs::read_rig(section, kContext)->describe(one, 1.0).wheels[0].start_key;
  };
  EXPECT_EQ(key({{"wheels", {{{"start", -5.0}}}}}), "rig.wheels.0.start");
  EXPECT_EQ(key({{"start", -5.0}, {"wheels", {{{"lateral", 0.1}}}}}), "rig.start");
  EXPECT_EQ(key({{"start", -5.0}}), "rig.start");
  try {
    rigs::read_rig({{"mode", "fixed_speed"}, {"wheels", {{{"slip", 1.0}}}}}, kContext);
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("key 'rig.wheels.0.slip'"), std::string::npos) << error.what();
  }
}

TEST(Rigs, description_is_that_of_the_made_rig) {
  const json section = {{"travel_sign", -1}, {"start", 4.0}, {"ramp", 0.2},        {"camber_angle", 0.1},
                        {"rim_mass", 20.0},  {"slip", 0.25}, {"carrier_mass", 300}};
  const rigs::WheelDescription d = only_wheel(section, 0.5);
  const auto rig = rigs::read_rig(section, kContext)->make();
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
  // Turned sideways later, it still stands straight at first.
  EXPECT_EQ(only_wheel({{"toe_angle", 1.4}, {"toe_time", 1.0}}).along, kRadius);
}

TEST(Rigs, starts_are_filled_in_clear_of_the_wall_behind) {
  const std::vector<rigs::WheelSize> tires{{kRadius, kWidth}};
  const auto start = [&](const json& section, std::optional<double> length) {
    const auto rig = rigs::read_rig(section, kContext);
    rig->fill_starts(tires, 1.0, length, 0.1);
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
