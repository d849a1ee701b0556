// Vehicle files: shipped files follow the schema, and every error names file, key and expected value.
#include <gtest/gtest.h>

#include <regex>

#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/vehicle/schema_check.hpp"
#include "tests/vehicle/shipped.hpp"
#include "vehicle/analysis/vehicle_page.hpp"
#include "vehicle/spec/part_magnitudes.hpp"
#include "vehicle/spec/read_vehicle.hpp"
#include "vehicle/spec/vehicle_magnitudes.hpp"

using namespace furrow;
using namespace furrow::testing;
using nlohmann::json;

namespace {

const std::vector<std::string> kShipped{"hmmwv.json", "hmmwv_tr.json", "buggy.json", "rover.json"};

std::string complaint(const json& document) {
  return without_file(refusal(ExitCode::bad_input, [&] { vehicle::read_vehicle(document, "car.json"); }), "car.json");
}

/// The error for a shipped file with one value changed; null removes the key.
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

/// One changed value of a shipped file and its error; null removes the key.
struct Mistake {
  const char* file;
  std::string pointer;
  json value;
  const char* said;
  std::string key = "";  // in the message; empty: the pointer's key
};

/// "/axles/0/wheel" as "axles[0].wheel".
std::string key_of(const std::string& pointer) {
  return std::regex_replace(std::regex_replace(pointer.substr(1), std::regex("/(\\d+)"), "[$1]"), std::regex("/"), ".");
}

void expect_mistakes(const std::vector<Mistake>& mistakes) {
  for (const Mistake& m : mistakes) {
    const std::string told = changed(m.file, m.pointer, m.value);
    EXPECT_TRUE(told.starts_with("key '" + (m.key.empty() ? key_of(m.pointer) : m.key) + "': " + m.said)) << told;
  }
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
  // Products of inertia change their sign if y is one of the two axes.
  vehicle::BodySpec body;
  body.inertia << 3, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 3;
  const Mat3 image = vehicle::mirrored(body).inertia;
  EXPECT_EQ(image(0, 1), -0.1);
  EXPECT_EQ(image(2, 1), -0.3);
  EXPECT_EQ(image(0, 2), 0.2);
}

TEST(VehicleFile, mistakes_in_bodies_and_suspensions_name_their_key) {
  const std::string s = "/axles/0/suspension";
  expect_mistakes({
      {"hmmwv.json", "/chassis/mass", -5, "is -5 kg, expected a number, above 0 up to 1e7 kg"},
      {"hmmwv.json", "/chassis/inertia", {1, 2}, "has 2 values, expected 3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)"},
      {"hmmwv.json",
       "/chassis/inertia",
       {1, 2, 4},
       "has the principal moments 1, 2, 4, expected none larger than the sum of the other two"},
      {"hmmwv.json", "/chassis/inertia", {1, 1, 1, 2, 0, 0}, "has the principal moment -1, expected positive ones"},
      {"hmmwv.json", "/chasis", json::object(), "is unknown, expected 'chassis'?"},
      {"hmmwv.json", "/format_version", 2, "is 2: the file is newer than this program, expected at most 1"},
      {"hmmwv.json", "/axles", json::array(), "has 0 entries, expected 1 to 16 axles"},
      {"hmmwv.json", "/axles/1/name", "front", "'front' is taken, expected another name"},
      {"hmmwv.json", "/axles/0/wheel", nullptr, "is missing, expected an object { }"},
      {"hmmwv.json", "/axles/0/wheel/tire", nullptr, "is missing, expected a text"},
      {"hmmwv.json", "/axles/0/brake/torque", 0, "is 0 N m, expected a number, above 0 up to 1e8 N m"},
      {"hmmwv.json", s + "/type", "mcpherson",
       "is 'mcpherson', expected 'double_wishbone', 'trailing_arm', 'rigid_axle' or 'fixed'"},
      {"hmmwv.json", s + "/spindle/center", {0, -0.9, 0}, "lies at y = -0.9, expected a point on the left"},
      {"hmmwv.json", s + "/upright/center_of_mass", {0, 0.7}, "has 2 values, expected 3"},
      {"hmmwv.json",
       s + "/lower_arm/chassis_back",
       {0.223, 0.307, 0},
       "is the point of axles[0].suspension.lower_arm.chassis_front"},
      {"hmmwv.json", s + "/lower_arm/upright", {0, 0.307, 0}, "lies on the hinge, expected a point beside it"},
      {"hmmwv.json", s + "/tie_rod/outer", {-0.250, 0.448, 0.054}, "is the point of axles[0].suspension.tie_rod.inner"},
      {"hmmwv.json", s + "/spring/on", "chassis",
       "is 'chassis', the body of its other end, expected 'lower_arm', 'upper_arm' or 'upright'"},
      {"hmmwv.json", s + "/spring/end", {0.104, 0.510, 0.197}, "is the point of axles[0].suspension.spring.chassis"},
      {"hmmwv.json", s + "/spring/free_length", 0, "is 0 m, expected a number, above 0 m"},
      {"hmmwv.json", s + "/spring/force", nullptr, "is missing, expected a table of forces, or the key rate"},
      {"hmmwv.json", s + "/spring/rate", 1e5, "is given beside rate", "axles[0].suspension.spring.force"},
      {"hmmwv.json", s + "/spring/force/2/0", 0.01, "begins with 0.01 after 0.02, expected a table that rises",
       "axles[0].suspension.spring.force[2]"},
      {"hmmwv.json", s + "/spring/force/2/1", 100, "ends with 100 after 3629.923, expected forces that rise",
       "axles[0].suspension.spring.force[2]"},
      {"hmmwv.json", s + "/spring/force", json::array({json::array({0, 0})}), "has 1 points"},
      {"hmmwv.json", s + "/spring/stop/longest", 0.1, "is 0.1, expected more than shortest, 0.15"},
      {"hmmwv.json", s + "/shock/rebound", -1, "is -1 N s/m, expected a number, 0 to 1e8 N s/m"},
      {"hmmwv.json", s + "/shock/outer/blend_length", 0.2, "is 0.2, expected at most longest - shortest, 0.095"},
  });
}

TEST(VehicleFile, mistakes_in_steering_links_and_hosts_name_their_key) {
  expect_mistakes({
      {"hmmwv.json", "/axles/0/steering/type", "wire", "is 'wire', expected 'pitman_arm' or 'rack'"},
      {"hmmwv.json", "/axles/0/steering/left_angle_deg", 0, "is 0, expected -90 to 90, not 0"},
      {"buggy.json", "/axles/0/steering/left_travel", 0, "is 0, expected the travel at full lock to the left in m"},
      {"buggy.json", "/axles/1/steering", shipped_text("buggy.json")["axles"][0]["steering"],
       "is given for a suspension without tie rods"},
      {"buggy.json", "/axles/1/suspension/links/1/mirrored", true,
       "has 5 rods (a mirrored one counts twice), expected 4", "axles[1].suspension.links"},
      {"rover.json",
       "/axles/0/suspension/pivot_outer",
       {-0.10, 0.10, 0.03},
       "is the point of axles[0].suspension.pivot_inner"},
      {"rover.json", "/axles/2/suspension/on", "last", "is 'last', expected the name of an axle with trailing arms"},
  });
}

TEST(VehicleFile, mistakes_in_the_driveline_name_their_key) {
  expect_mistakes({
      {"hmmwv.json", "/driveline/gears/1/ratio", 0, "is 0, expected another number: output over input"},
      {"hmmwv.json", "/driveline/gearbox/ratios/1", 0, "is 0, expected a number above zero"},
      {"hmmwv.json", "/driveline/gearbox/reverse", 0.1, "is 0.1, expected a number, below 0"},
      {"hmmwv.json", "/driveline/gearbox/up_rpm", 1000, "is 1000, expected more than down_rpm, 1200"},
      {"hmmwv.json", "/driveline/engine/torque", nullptr, "is missing, expected a list"},
      {"hmmwv.json", "/driveline/engine/torque/3/0", 850, "begins with 850 after 900, expected a table that rises",
       "driveline.engine.torque[3]"},
      {"hmmwv.json", "/driveline/engine/losses/3/1", 50,
       "drives the engine with 50 N m, expected a torque against its speed", "driveline.engine.losses[3]"},
      {"hmmwv.json", "/driveline/engine", nullptr, "is missing, expected an engine for the clutch"},
      {"hmmwv.json", "/driveline/converter/torque_ratio/3/1", 2,
       "gives 1.5 times the power that it takes, expected at most 1", "driveline.converter.torque_ratio[3]"},
      {"hmmwv.json", "/driveline/converter/capacity/5/0", 0.95, "does not run from speed ratio 0 to 1",
       "driveline.converter.capacity"},
      {"hmmwv.json", "/driveline/differentials/1/outputs", json::array({"front left"}), "has 1 shafts, expected two"},
      {"hmmwv.json", "/driveline/differentials/1/share", 1.5, "is 1.5, expected a number, above 0 and below 1"},
      {"hmmwv.json", "/driveline/shafts/2/inertia", 0, "is 0 kg m², expected a number, above 0 up to 1e6 kg m²"},
      {"hmmwv.json", "/driveline/shafts/2/name", "crank", "'crank' is given twice, expected another name"},
      {"hmmwv.json", "/driveline/shafts/2/carrier", "rear", "is 'rear'"},
      {"hmmwv.json", "/driveline/wheels/3/axle", "middle", "is 'middle', expected one of the axles 'front' or 'rear'"},
      {"hmmwv.json", "/driveline/wheels/3/side", "left",
       "drives the wheel 'rear left' again, expected one shaft per wheel", "driveline.wheels[3]"},
      {"buggy.json", "/driveline/wheels/1/shaft", "left", "'left' drives two wheels, expected a shaft for each"},
      {"buggy.json", "/driveline/gears/0/in", "crankshaft", "is 'crankshaft'"},
      {"buggy.json", "/driveline/gears/0/ratio", 2, "is 2 between shafts in 'chassis' and 'rear'"},
      {"buggy.json", "/driveline/clutch/closed_rpm", 1000, "is 1000, expected more than open_rpm, 1500"},
      {"rover.json", "/driveline/motors/1/stall_torque", -1, "is -1 N m, expected a number, above 0 up to 1e8 N m"},
      {"rover.json", "/driveline/motors/1/axle", "front", "'front' is driven already, expected one drive per wheel"},
      {"rover.json", "/driveline/motors", nullptr, "is given without motors", "driveline.skid_steer"},
  });
}

// Values far beyond any vehicle are refused by the reader and by the schema, which editors use.
TEST(VehicleFile, magnitudes_beyond_any_vehicle_are_refused_as_the_schema_says) {
  const json keys = shipped_text("vehicle.schema.json");
  const SchemaCheck schema(keys);
  const std::string s = "/axles/0/suspension";
  const struct {
    const char* file;
    std::string pointer;
    json value;
    const char *expected, *of_schema;  // of_schema empty: a schema cannot express it
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
    EXPECT_TRUE(holds(said, one.of_schema)) << one.pointer << ": " << said;
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

// Magnitudes that some vehicle may have, but not this one, each with its effect.
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
      {"hmmwv.json", s + "/spring/free_length", 340, "axles[0].suspension.spring.free_length",
       "is 340 m, but the spring is drawn 0."},
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
      {"hmmwv.json", "/axles/0/brake/torque", 4, "axles[0].brake.torque",
       "is 4 N m on a vehicle of 2423 kg, usual is 47.5 N m or more"},
      {"hmmwv.json", "/axles/0/brake/torque", 32e3, "axles[0].brake.torque", "on a lever of 1.35 m"},
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
      EXPECT_TRUE(holds(complaint(document), "radius of gyration"));
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
  // On the right side alone.
  json document = shipped_text("hmmwv.json");
  document["axles"][0]["right"]["brake"]["torque"] = 4e6;
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(document, "car.json");
  const auto odd = vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec));
  ASSERT_EQ(odd.size(), 1U);
  EXPECT_EQ(odd[0].first, "axles[0].right.brake.torque");
}

TEST(VehicleFile, a_chassis_whose_centre_of_mass_lies_below_the_ground_is_refused) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  const std::vector<double> radii(4, 0.4673);
  vehicle::check_height(spec, radii);
  spec.chassis.center_of_mass.z() = -0.7;
  expect_refused(ExitCode::bad_input,
                 {"key 'chassis.center_of_mass': has z = -0.7 m, expected a place above the ground"},
                 [&] { vehicle::check_height(spec, radii); });
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
  EXPECT_TRUE(holds(odd[0].second, "from closed_rpm, 2000 rpm, on it bridges the converter"));
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
  // Final drives given as input over output.
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) {
              for (vehicle::GearSpec& gear : line.gears) gear.ratio = 1.0 / gear.ratio;
            }),
            "driveline.gears");
  // Without a converter; the mark in rad/s.
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) {
              line.gearbox->in = line.engine->shaft;
              line.gearbox->up_rpm = 200, line.gearbox->down_rpm = 60;
            }),
            "driveline.gearbox.up_rpm");
  // 2400 rpm in one gear are 2400 × ratio / next ratio in the next one.
  EXPECT_EQ(odd_key([](vehicle::DrivelineSpec& line) { line.gearbox->down_rpm = 0.99 * line.gearbox->up_rpm; }),
            "driveline.gearbox.down_rpm");
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
