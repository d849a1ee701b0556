// Checks the recipe of CONTRIBUTING.md for parts of vehicles, with a kind of suspension.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/files/key_schema.hpp"
#include "tests/dummies/sliding_pillar.hpp"
#include "vehicle/spec/spec_reader.hpp"
#include "vehicle/spec/spec_rules.hpp"

namespace furrow::vehicle {
namespace {

using nlohmann::json;

constexpr double kRate = 2e4, kMass = 25.0;  // N/m; of upright, spindle and rim, kg

/// As the key `suspension` of an axle in a vehicle's file, without its type.
json pillar() {
  const json body = {{"mass", 10.0}, {"center_of_mass", {0, 0.7, 0}}, {"inertia", {1, 1, 1}}};
  const json spindle = {{"center", {0, 0.7, 0}}, {"mass", 5.0}, {"inertia", {0.1, 0.1, 0.1}}};
  return {{"spindle", spindle},
          {"upright", body},
          {"bottom", {0, 0.6, -0.2}},
          {"top", {0, 0.6, 0.3}},
          {"spring", {{"chassis", {0, 0.6, 0.5}}, {"end", {0, 0.6, 0.1}}, {"free_length", 0.4}, {"rate", kRate}}}};
}

SlidingPillarSpec read(const json& text) {
  return read_spec<SlidingPillarSpec>(JsonReader(text, "car.json", "axles[0].suspension"));
}

TEST(SlidingPillar, is_refused_by_file_key_and_value) {
  const auto complaint = [](const char* key, const json& value) {
    json text = pillar();
    text[key] = value;
    try {
      read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string key = "car.json: key 'axles[0].suspension.";
  EXPECT_EQ(complaint("top", {0, 0.6, -0.2}),
            key + "top': is the point of axles[0].suspension.bottom, expected another one");
  EXPECT_TRUE(complaint("upright", 3).starts_with(key + "upright': is 3, expected")) << complaint("upright", 3);
  EXPECT_TRUE(complaint("botom", 3).starts_with(key + "botom': is unknown, expected 'bottom'?"));
  json spring = pillar()["spring"];
  spring["rate"] = -1;
  EXPECT_TRUE(complaint("spring", spring).starts_with(key + "spring.rate': is -1 N/m, expected"))
      << complaint("spring", spring);
  EXPECT_EQ(complaint("shock", nullptr), "accepted");
}

TEST(SlidingPillar, right_side_is_the_mirror_image_and_points_move_with_the_axle) {
  const SlidingPillarSpec left = read(pillar()), right = mirrored(left), behind = shifted(left, Vec3(-2, 0, 0.1));
  EXPECT_EQ(right.bottom, Vec3(0, -0.6, -0.2));
  EXPECT_EQ(right.spring->end, Vec3(0, -0.6, 0.1));
  EXPECT_EQ(behind.spindle.center, Vec3(-2, 0.7, 0.1));
}

/// z = −(m g/k) (1 − cos √(k/m) t) from the free length, the chassis being held.
TEST(SlidingPillar, wheel_swings_on_its_spring_along_the_pillar) {
  const SlidingPillarSpec left = read(pillar()), right = mirrored(left);
  AxleSpec axle;
  axle.name = "front";
  for (CornerSpec& corner : axle.corners) corner.wheel.mass = 10.0;
  System system;
  const int chassis = system.add_body("chassis", 100.0, Mat3::Identity(), {});
  add_joint(system, JointKind::fixed, "floor", kGround, chassis, Vec3::Zero());
  AxleBuild build{system, axle, chassis, chassis, nullptr, {}};
  for (const int side : {kLeft, kRight}) {
    build.wheels[side].side = side;
    build.wheels[side].name = kSideNames[side];
    build.wheels[side].corner = &axle.corners[side];
  }
  add_suspension(build, Sides<SlidingPillarSpec>{&left, &right});
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  const double h = 1e-4, omega = std::sqrt(kRate / kMass);
  for (int i = 1; i <= 2000; ++i) {
    ASSERT_TRUE(system.step(h).ok);
    const double expected = -kMass * kStandardGravity / kRate * (1.0 - std::cos(omega * i * h));
    for (const Wheel& wheel : build.wheels) {
      const Vec3 moved = system.body(wheel.spindle).state.position - Vec3(0, outward(wheel.side) * 0.7, 0);
      ASSERT_NEAR(moved.z(), expected, 1e-6) << i;
      ASSERT_NEAR(moved.head<2>().norm(), 0.0, 1e-12) << i;
    }
  }
}

TEST(SlidingPillar, definition_in_the_schema_follows_from_the_list_of_fields) {
  SchemaWriter writer;
  EXPECT_EQ(writer.reference<SlidingPillarSpec>()["$ref"], "#/definitions/sliding_pillar");
  const json definition = writer.definitions["sliding_pillar"], &properties = definition["properties"];
  EXPECT_EQ(properties["type"]["const"], "sliding_pillar");
  EXPECT_EQ(properties["top"]["unit"], "m");
  EXPECT_EQ(properties["spring"]["$ref"], "#/definitions/spring");
  std::set<std::string> keys, fields{"type"};
  for (const auto& [key, value] : properties.items()) keys.insert(key);
  const SlidingPillarSpec spec{};
  visit_fields(spec, [&](const auto&, const Field& field) { fields.insert(field.name); });
  EXPECT_EQ(keys, fields);
  EXPECT_EQ(definition["required"], json::array({"type", "spindle", "upright", "bottom", "top"}));
}

}  // namespace
}  // namespace furrow::vehicle
