// Vehicles that start at speed, follow paths, and lift wheels.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/rigs/vehicle_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;
using nlohmann::json;

namespace {

/// Tires whose side force at 12 m/s grows by 7 times the load per rad, as the reference tire's does.
Track road() {
  Track track;
  track.slip_scale = 0.65;
  return track;
}

double figure(const rigs::Rig& rig, std::string_view name) {
  for (const auto& [key, value] : rig.findings().figures)
    if (key == name) return value;
  ADD_FAILURE() << name;
  return NAN;
}

rigs::VehicleRigPlan lane_change(const json& steering, double speed) {
  const json driver = {
      {"speed", {{"target", speed}}},
      {"path",
       {{"kind", "double_lane_change"}, {"x", -1.65}, {"lead_in", 20}, {"lead_out", 20}, {"steering", steering}}}};
  rigs::VehicleRigPlan plan = vehicle_plan("hmmwv.json", driver);
  plan.options.start_speed = speed;
  return plan;
}

}  // namespace

TEST(StartAtSpeed, wheels_roll_and_the_driveline_turns_with_them) {
  for (const auto& [speed, gear] : {std::pair{3.0, 1.0}, {8.0, 2.0}, {15.0, 3.0}}) {
    rigs::VehicleRigPlan plan = vehicle_plan("hmmwv.json", {{"speed", {{"target", speed}}}});
    plan.options.start_speed = speed;
    plan.options.heading = 0.4;
    const Track track = road();
    const auto rig = track.rig(plan, 0.001);
    EXPECT_NEAR(rig->rim(0).velocity.x(), speed * std::cos(0.4), 1e-9);
    EXPECT_NEAR(rig->rim(3).velocity.y(), speed * std::sin(0.4), 1e-9);
    track.drive(*rig, 0.5, [&] {
      for (int k = 0; k < 4; ++k) ASSERT_LT(std::abs(rig->report(k).slip), 0.06);
      ASSERT_NEAR(of_vehicle(*rig, "speed_m_s"), speed, 0.5);
    });
    EXPECT_EQ(of_vehicle(*rig, "gear"), gear);
    EXPECT_EQ(figure(*rig, "gear_changes"), 0.0);
    EXPECT_GT(of_vehicle(*rig, "engine_speed_rpm"), 793.0);
  }
}

TEST(StartAtSpeed, a_rover_with_motors_rolls_in_any_order_of_wheels) {
  rigs::VehicleRigPlan plan = vehicle_plan("rover.json", {{"inputs", {{"throttle", 0.5}}}}, 0.0);
  plan.options.start_speed = 0.2;
  Track track;
  track.radius = 0.058, track.stiffness = 2e4, track.damping = 40.0, track.slip_scale = 5.0;
  track.tire = {};
  const auto rig = track.rig(plan);
  for (int k = 0; k < rig->wheel_count(); ++k) EXPECT_NEAR(rig->rim(k).angular_velocity.y(), 0.2 / 0.058, 1e-6) << k;
}

// Margins are the space beside the vehicle in lanes of 1.1 to 1.3 of its width plus 25 cm.
TEST(LaneChange, preview_stays_in_its_lanes_where_pure_pursuit_leaves_them) {
  const auto drive = [](const json& steering) {
    const Track track = road();
    auto rig = track.rig(lane_change(steering, 12.0), 0.001);
    track.drive(*rig, 12.0);
    return rig;
  };
  const auto preview = drive({{"law", "preview"}}), pursuit = drive({{"law", "pure_pursuit"}});
  EXPECT_GT(figure(*preview, "lane_margin_least_m"), 0.1);
  EXPECT_LT(std::abs(figure(*preview, "path_error_largest_m")), 0.2);
  EXPECT_LT(figure(*preview, "path_error_rms_m"), 0.1);
  EXPECT_EQ(figure(*preview, "gear_changes"), 0.0);
  EXPECT_TRUE(preview->findings().events.empty());
  EXPECT_LT(figure(*pursuit, "lane_margin_least_m"), -0.1);
}

// With the higher centre of mass it leans until wheels on the inner side carry no load; the event is kept after a
// restart.
TEST(WheelLift, is_noticed_and_kept) {
  const json driver = {{"inputs", {{"steering", json::array({{0, 0}, {0.5, 0}, {0.8, 1}})}, {"gear", 2}}}};
  rigs::VehicleRigPlan plan = vehicle_plan("hmmwv_tr.json", driver);
  plan.options.start_speed = 14.0;
  Track track = road();
  track.friction = 2.0;
  const auto rig = track.rig(plan, 0.001);
  track.drive(*rig, 0.5);
  EXPECT_TRUE(rig->findings().events.empty());
  double roll = 0.0;
  for (int i = 0; i < 40 && roll < 0.5; ++i) {
    track.drive(*rig, 0.05);
    roll = std::abs(of_vehicle(*rig, "roll_rad"));
  }
  const rigs::RigFindings found = rig->findings();
  ASSERT_FALSE(found.events.empty());
  EXPECT_EQ(found.events.front().what, "wheel_lift");
  EXPECT_EQ(found.events.front().wheel % 2, 0);  // on the left, the inner side
  EXPECT_GT(found.events.front().from, 0.5);
  Archive state, findings;
  rig->save(state);
  rig->save_findings(findings);
  const auto other = rigs::make_vehicle_rig(plan);
  track.add_tires(*other);
  other->restore(state);
  other->restore_findings(findings);
  const rigs::RigFindings again = other->findings();
  ASSERT_EQ(again.events.size(), found.events.size());
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    EXPECT_EQ(again.events[i].wheel, found.events[i].wheel);
    EXPECT_EQ(again.events[i].from, found.events[i].from);
  }
  EXPECT_EQ(again.figures, found.figures);
}
