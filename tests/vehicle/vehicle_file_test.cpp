// Vehicle files: what is shipped follows the schema, and every mistake names file, key and what was expected.
#include <gtest/gtest.h>

#include "protocol/core/error.hpp"
#include "tests/vehicle/schema_check.hpp"
#include "tests/vehicle/shipped.hpp"
#include "vehicle/analysis/vehicle_page.hpp"
#include "vehicle/spec/read_vehicle.hpp"
#include "vehicle/spec/vehicle_magnitudes.hpp"

using namespace furrow;
using namespace furrow::testing;
using nlohmann::json;

namespace {

const std::vector<std::string> kShipped{"hmmwv.json", "hmmwv_tr.json", "buggy.json", "rover.json"};

std::string complaint(const json& document) {
  try {
    vehicle::read_vehicle(document, "car.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("car.json: ")) << what;
    return what.substr(10);
  }
  return "no error";
}

/// The complaint about a shipped file with one value changed; null takes the key away.
std::string changed(const std::string& file, const std::string& pointer, const json& value) {
  json document = shipped_text(file);
  const json::json_pointer at(pointer);
  if (!value.is_null()) {
    document[at] = value;
    return complaint(document);
  }
  document.at(at.parent_pointer()).erase(at.back());
  return complaint(document);
}

}  // namespace

TEST(VehicleFile, shipped_vehicles_follow_the_schema_and_are_read) {
  const json schema = shipped_text("vehicle.schema.json");
  for (const std::string& name : kShipped) {
    EXPECT_EQ(SchemaCheck(schema).complaint(shipped_text(name)), "") << name;
    EXPECT_NO_THROW(shipped(name)) << name;
    EXPECT_FALSE(shipped(name).name.empty());
  }
}

TEST(VehicleFile, the_right_side_is_the_mirror_image_unless_the_file_says_otherwise) {
  const vehicle::VehicleSpec car = shipped("hmmwv.json");
  const auto& left = std::get<vehicle::DoubleWishboneSpec>(car.axles[0].corners[0].suspension);
  const auto& right = std::get<vehicle::DoubleWishboneSpec>(car.axles[0].corners[1].suspension);
  EXPECT_EQ(left.upper_arm.upright, Vec3(1.688965 - 0.053, 0.716, 0.215));
  EXPECT_EQ(right.upper_arm.upright, Vec3(1.688965 - 0.053, -0.716, 0.215));
  json text = shipped_text("hmmwv.json");
  text["axles"][1]["right"]["wheel"] = text["axles"][1]["wheel"];
  text["axles"][1]["right"]["wheel"]["tire"] = "other.json";
  text["axles"][1]["right"]["brake"] = nullptr;
  const vehicle::VehicleSpec odd = vehicle::read_vehicle(text, "car.json");
  EXPECT_EQ(odd.axles[1].corners[0].wheel.tire, "hmmwv_layered.json");
  EXPECT_EQ(odd.axles[1].corners[1].wheel.tire, "other.json");
  EXPECT_FALSE(odd.axles[1].corners[1].brake.has_value());
  // Products of inertia change their sign where y is one of the two axes.
  vehicle::BodySpec body;
  body.inertia << 3, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 3;
  const Mat3 image = vehicle::mirrored(body).inertia;
  EXPECT_EQ(image(0, 1), -0.1);
  EXPECT_EQ(image(2, 1), -0.3);
  EXPECT_EQ(image(0, 2), 0.2);
}

TEST(VehicleFile, mistakes_in_bodies_and_suspensions_name_their_key) {
  const auto h = [](const char* pointer, const json& value) { return changed("hmmwv.json", pointer, value); };
  const std::string s = "/axles/0/suspension";
  EXPECT_EQ(h("/chassis/mass", -5), "key 'chassis.mass': is -5 kg, expected a number, above 0 up to 1e7 kg");
  EXPECT_EQ(h("/chassis/inertia", {1, 2}),
            "key 'chassis.inertia': has 2 values, expected 3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)");
  EXPECT_EQ(h("/chassis/inertia", {1, 2, 4}),
            "key 'chassis.inertia': has the principal moments 1, 2, 4, expected none larger than the sum of "
            "the other two");
  EXPECT_EQ(h("/chassis/inertia", {1, 1, 1, 2, 0, 0}),
            "key 'chassis.inertia': has the principal moment -1, expected positive ones");
  EXPECT_EQ(h("/chasis", json::object()), "key 'chasis': is unknown, expected 'chassis'?");
  EXPECT_EQ(h("/format_version", 2),
            "key 'format_version': is 2: the file is newer than this program, expected at most 1");
  EXPECT_EQ(h("/axles", json::array()), "key 'axles': has 0 entries, expected 1 to 16 axles");
  EXPECT_EQ(h("/axles/1/name", "front"), "key 'axles[1].name': 'front' is taken, expected another name");
  EXPECT_EQ(h("/axles/0/wheel", nullptr), "key 'axles[0].wheel': is missing, expected an object { }");
  EXPECT_EQ(h("/axles/0/wheel/tire", nullptr), "key 'axles[0].wheel.tire': is missing, expected a text");
  EXPECT_EQ(h("/axles/0/brake/torque", 0),
            "key 'axles[0].brake.torque': is 0 N m, expected a number, above 0 up to 1e8 N m");
  EXPECT_EQ(h((s + "/type").c_str(), "mcpherson"),
            "key 'axles[0].suspension.type': is 'mcpherson', expected 'double_wishbone', 'trailing_arm', "
            "'rigid_axle' or 'fixed'");
  EXPECT_EQ(h((s + "/spindle/center").c_str(), {0, -0.9, 0}),
            "key 'axles[0].suspension.spindle.center': lies at y = -0.9, expected a point on the left");
  EXPECT_EQ(h((s + "/upright/center_of_mass").c_str(), {0, 0.7}),
            "key 'axles[0].suspension.upright.center_of_mass': has 2 values, expected 3");
  EXPECT_EQ(h((s + "/lower_arm/chassis_back").c_str(), {0.223, 0.307, 0}),
            "key 'axles[0].suspension.lower_arm.chassis_back': is the point of "
            "axles[0].suspension.lower_arm.chassis_front, expected another one");
  EXPECT_EQ(h((s + "/lower_arm/upright").c_str(), {0, 0.307, 0}),
            "key 'axles[0].suspension.lower_arm.upright': lies on the hinge, expected a point beside it");
  EXPECT_EQ(h((s + "/tie_rod/outer").c_str(), {-0.250, 0.448, 0.054}),
            "key 'axles[0].suspension.tie_rod.outer': is the point of axles[0].suspension.tie_rod.inner, "
            "expected another one");
  EXPECT_EQ(h((s + "/spring/on").c_str(), "chassis"),
            "key 'axles[0].suspension.spring.on': is 'chassis', the body of its other end, expected 'lower_arm', "
            "'upper_arm' or 'upright'");
  EXPECT_EQ(h((s + "/spring/end").c_str(), {0.104, 0.510, 0.197}),
            "key 'axles[0].suspension.spring.end': is the point of axles[0].suspension.spring.chassis, expected "
            "another one");
  EXPECT_EQ(h((s + "/spring/free_length").c_str(), 0),
            "key 'axles[0].suspension.spring.free_length': is 0 m, expected a number, above 0 m");
  EXPECT_EQ(h((s + "/spring/force").c_str(), nullptr),
            "key 'axles[0].suspension.spring.force': is missing, expected a table of forces, or the key rate");
  EXPECT_EQ(h((s + "/spring/rate").c_str(), 1e5),
            "key 'axles[0].suspension.spring.force': is given beside rate, expected one of the two");
  EXPECT_EQ(h((s + "/spring/force/2/0").c_str(), 0.01),
            "key 'axles[0].suspension.spring.force[2]': begins with 0.01 after 0.02, expected a table that rises");
  EXPECT_EQ(h((s + "/spring/force/2/1").c_str(), 100),
            "key 'axles[0].suspension.spring.force[2]': ends with 100 after 3629.923, expected forces that rise");
  EXPECT_EQ(h((s + "/spring/force").c_str(), json::array({json::array({0, 0})})),
            "key 'axles[0].suspension.spring.force': has 1 points, expected at least two pairs [x, y]");
  EXPECT_EQ(h((s + "/spring/stop/longest").c_str(), 0.1),
            "key 'axles[0].suspension.spring.stop.longest': is 0.1, expected more than shortest, 0.15");
  EXPECT_EQ(h((s + "/shock/rebound").c_str(), -1),
            "key 'axles[0].suspension.shock.rebound': is -1 N s/m, expected a number, 0 to 1e8 N s/m");
  EXPECT_EQ(h((s + "/shock/outer/blend_length").c_str(), 0.2),
            "key 'axles[0].suspension.shock.outer.blend_length': is 0.2, expected at most longest - "
            "shortest, 0.095");
}

TEST(VehicleFile, mistakes_in_steering_links_and_hosts_name_their_key) {
  EXPECT_EQ(changed("hmmwv.json", "/axles/0/steering/type", "wire"),
            "key 'axles[0].steering.type': is 'wire', expected 'pitman_arm' or 'rack'");
  EXPECT_EQ(changed("hmmwv.json", "/axles/0/steering/left_angle_deg", 0),
            "key 'axles[0].steering.left_angle_deg': is 0, expected -90 to 90, not 0: the arm at full lock "
            "to the left");
  EXPECT_EQ(changed("buggy.json", "/axles/0/steering/left_travel", 0),
            "key 'axles[0].steering.left_travel': is 0, expected the travel at full lock to the left in m");
  EXPECT_EQ(changed("buggy.json", "/axles/1/steering", shipped_text("buggy.json")["axles"][0]["steering"]),
            "key 'axles[1].steering': is given for a suspension without tie rods, expected the type "
            "double_wishbone");
  EXPECT_EQ(changed("buggy.json", "/axles/1/suspension/links/1/mirrored", true),
            "key 'axles[1].suspension.links': has 5 rods (a mirrored one counts twice), expected 4: the axle rises "
            "and rolls");
  EXPECT_EQ(changed("rover.json", "/axles/0/suspension/pivot_outer", {-0.10, 0.10, 0.03}),
            "key 'axles[0].suspension.pivot_outer': is the point of axles[0].suspension.pivot_inner, expected "
            "another one");
  EXPECT_EQ(changed("rover.json", "/axles/2/suspension/on", "last"),
            "key 'axles[2].suspension.on': is 'last', expected the name of an axle with trailing arms");
}

TEST(VehicleFile, mistakes_in_the_driveline_name_their_key) {
  const auto h = [](const char* pointer, const json& value) { return changed("hmmwv.json", pointer, value); };
  EXPECT_EQ(h("/driveline/gears/1/ratio", 0),
            "key 'driveline.gears[1].ratio': is 0, expected another number: output over input");
  EXPECT_EQ(h("/driveline/gearbox/ratios/1", 0),
            "key 'driveline.gearbox.ratios[1]': is 0, expected a number above zero");
  EXPECT_EQ(h("/driveline/gearbox/reverse", 0.1),
            "key 'driveline.gearbox.reverse': is 0.1, expected a number, below 0");
  EXPECT_EQ(h("/driveline/gearbox/up_rpm", 1000),
            "key 'driveline.gearbox.up_rpm': is 1000, expected more than down_rpm, 1200");
  EXPECT_EQ(h("/driveline/engine/torque", nullptr), "key 'driveline.engine.torque': is missing, expected a list");
  EXPECT_EQ(h("/driveline/engine/torque/3/0", 850),
            "key 'driveline.engine.torque[3]': begins with 850 after 900, expected a table that rises");
  EXPECT_EQ(h("/driveline/engine/losses/3/1", 50),
            "key 'driveline.engine.losses[3]': drives the engine with 50 N m, expected a torque against its speed");
  EXPECT_EQ(h("/driveline/engine", nullptr), "key 'driveline.engine': is missing, expected an engine for the clutch");
  EXPECT_EQ(h("/driveline/converter/torque_ratio/3/1", 2),
            "key 'driveline.converter.torque_ratio[3]': gives 1.5 times the power that it takes, expected at "
            "most 1");
  EXPECT_EQ(h("/driveline/converter/capacity/5/0", 0.95),
            "key 'driveline.converter.capacity': does not run from speed ratio 0 to 1, expected both ends");
  EXPECT_EQ(h("/driveline/differentials/1/outputs", json::array({"front left"})),
            "key 'driveline.differentials[1].outputs': has 1 shafts, expected two");
  EXPECT_EQ(h("/driveline/differentials/1/share", 1.5),
            "key 'driveline.differentials[1].share': is 1.5, expected a number, above 0 and below 1");
  EXPECT_EQ(h("/driveline/shafts/2/inertia", 0),
            "key 'driveline.shafts[2].inertia': is 0 kg m², expected a number, above 0 up to 1e6 kg m²");
  EXPECT_EQ(h("/driveline/shafts/2/name", "crank"),
            "key 'driveline.shafts[2].name': 'crank' is given twice, expected another name");
  EXPECT_EQ(h("/driveline/shafts/2/carrier", "rear"),
            "key 'driveline.shafts[2].carrier': is 'rear', expected 'chassis' or the name of a rigid axle");
  EXPECT_EQ(h("/driveline/wheels/3/axle", "middle"),
            "key 'driveline.wheels[3].axle': is 'middle', expected one of the axles 'front' or 'rear'");
  EXPECT_EQ(h("/driveline/wheels/3/side", "left"),
            "key 'driveline.wheels[3]': drives the wheel 'rear left' again, expected one shaft per wheel");
  EXPECT_EQ(changed("buggy.json", "/driveline/wheels/1/shaft", "left"),
            "key 'driveline.wheels[1].shaft': 'left' drives two wheels, expected a shaft for each");
  EXPECT_EQ(changed("buggy.json", "/driveline/gears/0/in", "crankshaft"),
            "key 'driveline.gears[0].in': is 'crankshaft', expected one of the shafts 'crank', 'clutch', "
            "'propeller', "
            "'pinion', 'box', 'left' or 'right'");
  EXPECT_EQ(changed("buggy.json", "/driveline/gears/0/ratio", 2),
            "key 'driveline.gears[0].ratio': is 2 between shafts in 'chassis' and 'rear', expected 1: gears "
            "turn in one "
            "housing");
  EXPECT_EQ(changed("buggy.json", "/driveline/clutch/closed_rpm", 1000),
            "key 'driveline.clutch.closed_rpm': is 1000, expected more than open_rpm, 1500");
  EXPECT_EQ(changed("rover.json", "/driveline/motors/1/stall_torque", -1),
            "key 'driveline.motors[1].stall_torque': is -1 N m, expected a number, above 0 up to 1e8 N m");
  EXPECT_EQ(changed("rover.json", "/driveline/motors/1/axle", "front"),
            "key 'driveline.motors[1].axle': 'front' is driven already, expected one drive per wheel");
  EXPECT_EQ(changed("rover.json", "/driveline/motors", nullptr),
            "key 'driveline.skid_steer': is given without motors, expected a motor at each wheel");
}

// What is far beyond any vehicle is refused by the reader and by the schema, which editors use.
TEST(VehicleFile, magnitudes_beyond_any_vehicle_are_refused_as_the_schema_says) {
  const json keys = shipped_text("vehicle.schema.json");
  const SchemaCheck schema(keys);
  const std::string s = "/axles/0/suspension";
  const struct {
    const char* file;
    std::string pointer;
    json value;
    const char *expected, *of_schema;  // of_schema empty: a schema cannot say it
  } kTable[] = {
      {"hmmwv.json", "/chassis/mass", 1e9, "key 'chassis.mass': is 1e9 kg, expected a number, above 0 up to 1e7 kg",
       "/chassis/mass: is out of range"},
      {"hmmwv.json",
       "/chassis/inertia",
       {1e9, 1e9, 1e9},
       "key 'chassis.inertia': gives a body of 2086.52 kg a radius of gyration of 848 m, expected at most 100 m",
       ""},
      {"hmmwv.json",
       "/axles/0/wheel/inertia",
       {1e9, 1e9, 1e9},
       "key 'axles[0].wheel.inertia': gives a body of 18.8 kg a radius of gyration of 8.93e+03 m, expected at most "
       "100 m",
       ""},
      {"hmmwv.json", "/axles/1/brake/torque", 1e30,
       "key 'axles[1].brake.torque': is 1e30 N m, expected a number, above 0 up to 1e8 N m",
       "/axles/1/brake/torque: is out of range"},
      {"hmmwv.json", s + "/shock/compression", 1e9,
       "key 'axles[0].suspension.shock.compression': is 1e9 N s/m, expected a number, 0 to 1e8 N s/m", "definitions"},
      {"buggy.json", s + "/spring/rate", 1e13,
       "key 'axles[0].suspension.spring.rate': is 1e13 N/m, expected a number, above 0 up to 1e10 N/m", "definitions"},
      {"hmmwv.json", "/driveline/shafts/2/inertia", 1e9,
       "key 'driveline.shafts[2].inertia': is 1e9 kg m², expected a number, above 0 up to 1e6 kg m²",
       "/driveline/shafts/2/inertia: is out of range"},
      {"hmmwv.json", "/driveline/engine/idle_rpm", 9000,
       "key 'driveline.engine.idle_rpm': is 9000, expected at most 2700, the last speed of torque", ""},
      {"rover.json", "/driveline/skid_steer", 5, "key 'driveline.skid_steer': is 5, expected a number, 0 to 1",
       "/driveline/skid_steer: is out of range"},
      {"rover.json", "/driveline/skid_steer", -0.5, "key 'driveline.skid_steer': is -0.5, expected a number, 0 to 1",
       "/driveline/skid_steer: is out of range"},
      {"buggy.json", "/axles/0/steering/left_travel", 50,
       "key 'axles[0].steering.left_travel': is 50 m, expected a number, -10 to 10 m", "definitions"},
  };
  for (const auto& one : kTable) {
    json document = shipped_text(one.file);
    document[json::json_pointer(one.pointer)] = one.value;
    EXPECT_EQ(complaint(document), one.expected);
    const std::string said = schema.complaint(document);
    EXPECT_NE(said.find(one.of_schema), std::string::npos) << one.pointer << ": " << said;
    EXPECT_EQ(said.empty(), *one.of_schema == '\0') << one.pointer << ": " << said;
  }
}

TEST(VehicleFile, names_that_are_given_twice_are_refused) {
  const auto h = [](const char* pointer, const json& value) { return changed("hmmwv.json", pointer, value); };
  const json gears = shipped_text("hmmwv.json")["driveline"]["gears"];
  EXPECT_EQ(h("/driveline/gears/1/name", gears[0]["name"]), "key 'driveline.gears[1].name': '" +
                                                                gears[0]["name"].get<std::string>() +
                                                                "' is given twice, expected another name");
  const json boxes = shipped_text("hmmwv.json")["driveline"]["differentials"];
  EXPECT_EQ(h("/driveline/differentials/2/name", boxes[0]["name"]), "key 'driveline.differentials[2].name': '" +
                                                                        boxes[0]["name"].get<std::string>() +
                                                                        "' is given twice, expected another name");
  const json links = shipped_text("buggy.json")["axles"][1]["suspension"]["links"];
  EXPECT_EQ(changed("buggy.json", "/axles/1/suspension/links/1/name", links[0]["name"]),
            "key 'axles[1].suspension.links[1].name': '" + links[0]["name"].get<std::string>() +
                "' is given twice, expected another name");
  json text = shipped_text("rover.json");
  text["axles"][0]["name"] = "front pair", text["axles"][1]["name"] = "front_pair";
  EXPECT_EQ(complaint(text),
            "key 'axles[1].name': 'front_pair' is 'front pair' where results write it as one word, expected "
            "another name");
}

TEST(VehicleFile, an_unknown_key_of_the_right_side_is_told_with_all_that_there_are) {
  EXPECT_EQ(changed("hmmwv.json", "/axles/0/right", {{"tires", 1}}),
            "key 'axles[0].right.tires': is unknown, expected one of: suspension, wheel, brake");
  EXPECT_EQ(changed("hmmwv.json", "/axles/0/right", {{"wheels", 1}}),
            "key 'axles[0].right.wheels': is unknown, expected 'wheel'?");
}

// Magnitudes that some vehicle may have, but not this one: each with what it would do.
TEST(VehicleFile, parts_that_are_hardly_meant_are_named_with_what_they_would_do) {
  const std::string s = "/axles/0/suspension";
  const struct {
    const char* file;
    std::string pointer;
    json value;
    const char *key, *what;
  } kTable[] = {
      {"hmmwv.json", s + "/shock/compression", 1e6, "axles[0].suspension.shock.compression",
       "is 1e6 N s/m, which alone takes about 0.00242 s to bring the whole vehicle of 2423 kg to rest"},
      {"hmmwv.json", s + "/shock/rebound", 22.46, "axles[0].suspension.shock.rebound", "takes about 108 s"},
      {"hmmwv.json", s + "/spindle/toe_deg", 44.9, "axles[0].suspension.spindle.toe_deg",
       "is 44.9 degrees, usual is up to 10 in magnitude"},
      {"hmmwv.json", s + "/upright/inertia", {1e6, 1e6, 1e6}, "", ""},  // refused
      {"hmmwv.json",
       s + "/upright/inertia",
       {1656, 1934, 436.7},
       "axles[0].suspension.upright.inertia",
       "gives a part of 19.45 kg a radius of gyration of 10.2 m in a vehicle of "},
      {"hmmwv.json", "/axles/0/brake/torque", 4e6, "axles[0].brake.torque",
       "gives 4000000 N m: one wheel's brake would lift the whole vehicle of 2423 kg on a lever of 168 m"},
      {"hmmwv.json", "/axles/0/steering/left_angle_deg", -0.52, "axles[0].steering.left_angle_deg",
       "is -0.52, and is in degrees"},
      {"hmmwv.json", "/driveline/shafts/2/inertia", 5e4, "driveline.shafts[2].inertia",
       "is 50e3 kg m² in a vehicle of 2423 kg, usual is up to 242 kg m²"},
      {"rover.json", "/driveline/motors/0/stall_torque", 30, "driveline.motors[0].stall_torque",
       "gives 3000 N m: with its gear_ratio one motor would lift"},
      {"hmmwv.json", "/driveline/engine/torque", json::parse("[[0, -50], [2700, -50]]"), "driveline.engine.torque",
       "is -50.0 N m at the idle speed of 800 rpm, with the losses "},
  };
  for (const auto& one : kTable) {
    json document = shipped_text(one.file);
    document[json::json_pointer(one.pointer)] = one.value;
    if (*one.key == '\0') {
      EXPECT_NE(complaint(document).find("radius of gyration"), std::string::npos);
      continue;
    }
    const vehicle::VehicleSpec spec = vehicle::read_vehicle(document, "car.json");
    std::string said;
    int found = 0;
    for (const auto& [key, what] : vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec))) {
      if (key == one.key && what.find(one.what) != std::string::npos) ++found;
      said += key + ": " + what + "\n";
    }
    EXPECT_EQ(found, 1) << one.pointer << "\n" << said;
    EXPECT_EQ(said.find(".right."), std::string::npos) << "the mirrored side says it once:\n" << said;
  }
  // Of the right side alone.
  json document = shipped_text("hmmwv.json");
  document["axles"][0]["right"]["brake"]["torque"] = 4e6;
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(document, "car.json");
  const auto odd = vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec));
  ASSERT_EQ(odd.size(), 1U);
  EXPECT_EQ(odd[0].first, "axles[0].right.brake.torque");
}

TEST(VehicleFile, a_clutch_beside_the_converter_is_named) {
  json document = shipped_text("hmmwv.json");
  const json converter = document["driveline"]["converter"];
  document["driveline"]["clutch"] = {
      {"in", converter["in"]}, {"out", converter["out"]}, {"torque", 500}, {"open_rpm", 1500}, {"closed_rpm", 2000}};
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(document, "car.json");
  const auto odd = vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec));
  ASSERT_EQ(odd.size(), 1U);
  EXPECT_EQ(odd[0].first, "driveline.clutch");
  EXPECT_NE(odd[0].second.find("from closed_rpm, 2000 rpm, on it bridges the converter"), std::string::npos)
      << odd[0].second;
}

TEST(VehicleFile, gears_and_drives_that_are_hardly_meant_are_named) {
  const auto odd_key = [](const auto& change) {
    vehicle::VehicleSpec spec = shipped("hmmwv.json");
    change(spec.driveline);
    const auto odd = vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec));
    return odd.size() == 1 ? odd.front().first : std::to_string(odd.size()) + " keys";
  };
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) {
              line.gearbox->ratios = {0.8, 0.4, 0.2};
            }),
            "driveline.gearbox.ratios");
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) { line.gearbox->shift_time = 400.0; }),
            "driveline.gearbox.shift_time");
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) { line.gears[1].ratio *= -1.0; }), "driveline.gears");
}

TEST(VehicleFile, a_gearbox_whose_mark_the_engine_does_not_reach_is_unlikely) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  const double mass = vehicle::mass_without_tires(spec);
  EXPECT_TRUE(vehicle::unlikely_values(spec, mass).empty());
  // Between 2,500 and 2,700 rpm the torque falls from 558 − 80 to −400 − 84 N m: it is zero at 2,599 rpm.
  spec.driveline.gearbox->up_rpm = 2598;
  EXPECT_TRUE(vehicle::unlikely_values(spec, mass).empty());
  spec.driveline.gearbox->up_rpm = 2600;
  const auto odd = vehicle::unlikely_values(spec, mass);
  ASSERT_EQ(odd.size(), 1U);
  EXPECT_EQ(odd[0].first, "driveline.gearbox.up_rpm");
  EXPECT_EQ(odd[0].second, "is 2600, above the 2599 rpm to which the engine drives it: it will never shift up");
  spec.driveline.engine->torque.back().second = 500;  // an engine without a highest speed
  EXPECT_TRUE(vehicle::unlikely_values(spec, mass).empty());
}

TEST(VehicleFile, loops_of_gears_and_trains_that_reach_no_wheel_are_refused) {
  json text = shipped_text("hmmwv.json");
  text["driveline"]["shafts"].push_back({{"name", "pump"}, {"inertia", 0.1}, {"axis", {1, 0, 0}}});
  EXPECT_EQ(complaint(text),
            "key 'driveline.shafts[12].name': 'pump' reaches no wheel, expected a train of gears to one");
  text = shipped_text("hmmwv.json");
  text["driveline"]["gears"].push_back({{"name", "bypass"}, {"in", "front box"}, {"out", "front drive"}, {"ratio", 5}});
  EXPECT_EQ(complaint(text),
            "key 'driveline.gears[3]': 'bypass' closes a loop of gears, expected a train without loops");
}
