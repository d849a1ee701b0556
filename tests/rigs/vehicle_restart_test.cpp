// A vehicle that is restored continues bit for bit: in the air, during a shift, while its brakes hold, on a path.
#include <gtest/gtest.h>

#include "rigs/rut_trace.hpp"
#include "tests/rigs/vehicle_fixture.hpp"
#include "tests/saved.hpp"

using namespace furrow;
using namespace furrow::testing;
using nlohmann::json;

namespace {

struct Case {
  const char* name;
  json driver;
  double time = 0.0;        // of the save, s
  const char* column = "";  // of the vehicle, that shows this state
  double least = 0.0, most = 0.0;
};

}  // namespace

TEST(VehicleRestart, continues_bit_for_bit_in_the_air_in_a_shift_in_a_brake_hold_and_on_a_path) {
  const json shifts = {{"inputs", {{"throttle", 1.0}, {"gear", json::array({{0, 1}, {1, 2}})}}}};
  const json holds = {{"inputs",
                       {{"throttle", json::array({{0, 0.4}, {1, 0.4}, {1.01, 0}})},
                        {"brake", json::array({{0, 0}, {1.0, 0}, {1.1, 0.8}})}}}};
  const json path = {{"speed", {{"target", json::array({{0, 0}, {2, 6}})}}},
                     {"path", {{"kind", "circle"}, {"radius", 20.0}, {"lead_in", 1.0}}}};
  for (const Case& c :
       {Case{"air", shifts, 0.1, "distance_m", 0.0, 0.1}, Case{"shift", shifts, 1.2, "shifting", 1.0, 1.0},
        Case{"brake hold", holds, 3.0, "speed_m_s", -1e-2, 1e-2},
        Case{"path", path, 2.5, "path_distance_m", 1.5, 20.0}}) {
    SCOPED_TRACE(c.name);
    const Track track;
    const rigs::VehicleRigPlan plan = vehicle_plan("hmmwv.json", c.driver, c.time < 0.2 ? 0.0 : 0.39);
    const auto original = track.rig(plan, c.time < 0.2 ? 0.3 : 0.001);
    Track sinking = track;
    sinking.sinks = true;
    sinking.drive(*original, c.time, {}, 2);
    EXPECT_GE(of_vehicle(*original, c.column), c.least);
    EXPECT_LE(of_vehicle(*original, c.column), c.most);
    const Archive archive = saved(*original);
    const auto placed = track.rig(plan, 0.5), fresh = rigs::make_vehicle_rig(plan);
    track.add_tires(*fresh);
    placed->restore(archive);
    fresh->restore(archive);
    EXPECT_EQ(saved(*fresh).arrays(), saved(*original).arrays());
    for (rigs::Rig* rig : {original.get(), placed.get(), fresh.get()}) sinking.drive(*rig, 0.5, {}, 2);
    EXPECT_EQ(saved(*placed).arrays(), saved(*original).arrays());
    EXPECT_EQ(saved(*fresh).arrays(), saved(*original).arrays());
  }
}

TEST(VehicleRestart, refuses_the_state_of_other_tires) {
  Track track;
  const auto original = track.rig(vehicle_plan("hmmwv.json"));
  track.tire.mass = 10.0;
  const auto other = track.rig(vehicle_plan("hmmwv.json"));
  EXPECT_THROW(other->restore(saved(*original)), Error);
}

TEST(RutTrace, is_found_within_half_its_width_and_survives_a_round_trip) {
  rigs::RutTrace trace(0.02, 0.15);
  for (int i = 0; i <= 1000; ++i) trace.add(Vec3(1.0 + 1e-3 * i, 0.5, -0.02 - 1e-5 * i));
  EXPECT_NEAR(*trace.bottom(1.5, 0.6), -0.025, 2e-4);
  EXPECT_FALSE(trace.bottom(1.5, 0.7));
  EXPECT_FALSE(trace.bottom(2.3, 0.5));
  Archive archive;
  trace.save(archive, "rut");
  EXPECT_LT(archive.get<double>("rut/x").size(), 60u);
  rigs::RutTrace other(0.02, 0.15);
  other.restore(archive, "rut");
  EXPECT_EQ(other.bottom(1.7, 0.5), trace.bottom(1.7, 0.5));
}

TEST(RutTrace, a_wheel_that_follows_is_measured_against_the_rut_before_it) {
  Track track;
  const auto rig = track.rig(vehicle_plan("hmmwv.json", {{"inputs", {{"throttle", 0.5}}}}));
  // Every tire is 30 mm deep; the rear tires reach the front tires' rut after 3.3 m.
  const auto deep = [&] {
    for (int k = 0; k < 4; ++k) rig->observe(k, k < 2 ? -0.03 : -0.036, 0.0);
  };
  track.drive(*rig, 1.0, deep);
  EXPECT_NEAR(measured(*rig, 2, "sinkage_in_rut_m"), 0.036, 1e-12);
  track.drive(*rig, 3.0, deep);
  ASSERT_GT(of_vehicle(*rig, "x_m"), 4.0);
  deep();
  EXPECT_NEAR(measured(*rig, 0, "sinkage_in_rut_m"), 0.03, 1e-12);
  EXPECT_NEAR(measured(*rig, 2, "sinkage_in_rut_m"), 0.006, 1e-12);
}
