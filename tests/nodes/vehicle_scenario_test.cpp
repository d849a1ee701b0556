// Scenarios of vehicles: their tires, the keys and files that decide their results, and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "nodes/scenario/validate.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/files/data_files.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using nlohmann::json;
using testing::ScenarioFile;

json hmmwv() { return {{"rig", {{"type", "vehicle"}, {"vehicle", "hmmwv.json"}}}, {"terrain", {{"engine", "rigid"}}}}; }

using Settings = std::vector<std::pair<std::string, std::string>>;

scenario::Scenario load(const json& document, const Settings& settings = {}) {
  return ScenarioFile(document.dump()).load(settings);
}

std::string complaint(const json& document, const Settings& settings = {}) {
  return ScenarioFile(document.dump()).complaint(settings);
}

json vehicle_text(const char* name) { return json::parse(std::ifstream(data_folder() / "vehicle" / "data" / name)); }

/// A scenario in the folder of its vehicle's file, mine.json.
class OwnVehicle : public ScenarioFile {
 public:
  OwnVehicle(json scenario, const json& vehicle) : ScenarioFile(named(std::move(scenario))) { write(vehicle); }
  std::filesystem::path vehicle() const { return path().parent_path() / "mine.json"; }
  void write(const json& content) const { std::ofstream(vehicle()) << content.dump(); }

 private:
  static std::string named(json scenario) {
    scenario["rig"]["vehicle"] = "mine.json";
    return scenario.dump();
  }
};

void expect_complaint(const std::string& begin, const json& document, const Settings& settings = {}) {
  EXPECT_TRUE(complaint(document, settings).starts_with(begin)) << complaint(document, settings);
}

TEST(VehicleScenario, brings_the_tires_of_its_wheels) {
  const scenario::Scenario s = load(hmmwv());
  ASSERT_EQ(s.tires.size(), 4U);
  for (const auto& tire : s.tires) EXPECT_EQ(tire->options().file.filename(), "hmmwv_layered.json");
  EXPECT_FALSE(s.tires[3]->options().rigid);
  const rigs::RigDescription rig = scenario::describe_rig(s);
  EXPECT_EQ(rig.kind, "vehicle");
  ASSERT_EQ(rig.wheels.size(), 4U);
  EXPECT_NEAR(rig.wheels[0].lateral, 0.91, 0.01);
  EXPECT_NEAR(rig.wheels[0].from - rig.wheels[2].from, 3.302, 0.01);
  EXPECT_EQ(rig.wheels[1].start_key, "rig.start");
  EXPECT_TRUE(holds(scenario::validation_text(s), "vehicle HMMWV on 4 wheels, 19 bodies, parked"));
}

TEST(VehicleScenario, changes_the_tires_of_all_wheels_of_each_axle_or_of_each_wheel) {
  const auto rigid = [](const scenario::Scenario& s) {
    std::vector<bool> all;
    for (const auto& tire : s.tires) all.push_back(tire->options().rigid);
    return all;
  };
  using Flags = std::vector<bool>;
  EXPECT_EQ(rigid(load(hmmwv(), {{"tire.rigid", "true"}})), Flags({true, true, true, true}));
  json axles = hmmwv(), wheels = hmmwv();
  axles["tires"] = {json::object(), {{"rigid", true}, {"file", "toroidal.json"}}};
  EXPECT_EQ(rigid(load(axles)), Flags({false, false, true, true}));
  EXPECT_EQ(load(axles).tires[2]->options().file.filename(), "toroidal.json");
  wheels["tires"] = {nullptr, {{"rigid", true}}, nullptr, nullptr};
  EXPECT_EQ(rigid(load(wheels)), Flags({false, true, false, false}));
  const scenario::Scenario one = load(hmmwv(), {{"tires.2.pressure", "1e5"}, {"tires.0.rigid", "true"}});
  EXPECT_EQ(rigid(one), Flags({true, false, false, false}));
  EXPECT_EQ(one.tires[2]->options().pressure, (tire::PressureSchedule{{{0.0, 1e5}}}));
  json rover = hmmwv();
  rover["rig"]["vehicle"] = "rover.json";
  EXPECT_EQ(rigid(load(rover)), Flags(6, true));
}

TEST(VehicleScenario, completed_text_is_a_scenario_that_gives_the_same_digest_from_any_folder) {
  const json driver = {{"inputs", {{"gear", {{0, 1}, {1, "auto"}}}, {"lock", {{0, 1}, {2, 0}}}}},
                       {"speed", {{"target", 5}}},
                       {"path", {{"kind", "circle"}, {"radius", 30}, {"steering", {{"law", "stanley"}}}}}};
  json document = hmmwv();
  document["rig"]["driver"] = driver;
  const scenario::Scenario s = load(document, {{"tire.rigid", "true"}});
  const scenario::Scenario again = ScenarioFile(s.completed).load();
  EXPECT_EQ(again.completed, s.completed);
  EXPECT_EQ(again.digest, s.digest);
  EXPECT_EQ(json::parse(s.completed)["rig"]["driver"]["speed"]["target"], json::parse("[[0.0, 5.0]]"));
  EXPECT_NE(load(document, {{"tire.rigid", "true"}, {"rig.driver.speed.target", "6"}}).digest, s.digest);
  EXPECT_NE(load(document).digest, s.digest);
}

/// Files count by their contents. The completed scenario contains the driver's file, and the full name of the vehicle's
/// file.
TEST(VehicleScenario, files_beside_the_scenario_are_found_and_decide_the_results) {
  json document = hmmwv();
  document["rig"]["driver"] = "mine.csv";
  json car = vehicle_text("hmmwv.json");
  const OwnVehicle file(document, car);
  std::ofstream(file.path().parent_path() / "mine.csv") << "time_s,throttle\n0,0\n1,0.5\n";
  const scenario::Scenario s = file.load();
  const json completed = json::parse(s.completed);
  EXPECT_EQ(completed["rig"]["vehicle"], file.vehicle().string());
  EXPECT_EQ(completed["rig"]["driver"]["inputs"]["throttle"], json::parse("[[0.0, 0.0], [1.0, 0.5]]"));
  EXPECT_EQ(ScenarioFile(s.completed).load().digest, s.digest);
  car["chassis"]["mass"] = 2100.0;
  file.write(car);
  EXPECT_NE(file.load().digest, s.digest);
}

TEST(VehicleScenario, starts_clear_of_the_wall_and_says_when_the_bin_is_too_short) {
  json document = hmmwv();
  document["terrain"] = {{"radius", 0.03}, {"layers", 4}, {"length", 8.0}, {"width", 3.0}};
  document["rig"]["driver"] = {{"speed", {{"target", {{0, 0}, {1, 2}}}}}};
  document["run"] = {{"end", 1.5}};
  document["tire"] = {{"rigid", true}};
  const scenario::Scenario s = load(document);
  const std::vector<rigs::WheelDescription> wheels = scenario::describe_rig(s).wheels;
  EXPECT_EQ(wheels[0].name, "front_left");
  EXPECT_EQ(wheels[3].name, "rear_right");
  EXPECT_NEAR(wheels[2].from - wheels[2].along, 0.02, 1e-6);
  EXPECT_NEAR(wheels[0].to - wheels[0].from, 2.0, 1e-3);
  EXPECT_NEAR(json::parse(s.completed)["rig"]["start"].get<double>(), wheels[2].from + 1.653, 0.01);
  expect_complaint(": key 'terrain.length': is 5 m, but the axle travels from x = ", document,
                   {{"terrain.length", "5"}, {"rig.stop_before_wall", "0"}});
  const scenario::Scenario early = load(document, {{"terrain.length", "5"}});
  const rigs::WheelDescription foremost = scenario::describe_rig(early).wheels[0];
  EXPECT_TRUE(foremost.stops_before_wall);
  EXPECT_NEAR(5.0 - foremost.to - foremost.along, 0.4673, 1e-6);  // a tire's radius
  EXPECT_TRUE(std::any_of(early.warnings.begin(), early.warnings.end(), [](const std::string& warning) {
    return warning.find("'run.end': the run will end before 1.5 s, where a tire is 0.4673 m") != std::string::npos;
  }));
  expect_complaint(": key 'terrain.width': is 1.5 m, expected at ", document, {{"terrain.width", "1.5"}});
  // Places in messages are those of the key, the vehicle's origin, and not of a wheel.
  expect_complaint(": key 'rig.start': is 1 m, expected 2.120 to 5.884 m: the tire of rear_left with radius ", document,
                   {{"rig.start", "1"}});
  EXPECT_EQ(complaint(document, {{"terrain.length", "3"}}),
            ": key 'terrain.length': is 3 m, expected at least 4.28 m: from the first to the last tire the "
            "rig is 4.24 m "
            "long");
}

TEST(VehicleScenario, wrong_combinations_are_refused_by_key) {
  const auto with = [](const char* pointer, const json& value) {
    json document = hmmwv();
    document[json::json_pointer(pointer)] = value;
    return document;
  };
  json none = hmmwv();
  none["rig"].erase("vehicle");
  none["tire"] = {{"file", "hmmwv_layered.json"}};
  EXPECT_EQ(complaint(none), ": key 'rig.vehicle': is missing, expected the name of a vehicle's file: hmmwv.json");
  expect_complaint(": key 'rig.vehicle': 'nowhere.json' does not exist, expected a file at one of: ",
                   with("/rig/vehicle", "nowhere.json"));
  EXPECT_EQ(complaint(with("/tires", json::array({json::object()}))),
            ": key 'tires': has 1 entries, expected 4, one per wheel, or 2, one per axle");
  EXPECT_EQ(complaint(with("/rig/slip", 0.5)),
            ": key 'rig.slip': is a key of type 'drawbar', but rig.type is 'vehicle', expected keys of that "
            "type alone");
  expect_complaint(": key 'rig.driver.inputs.throttle': ", with("/rig/driver", {{"inputs", {{"throttle", 2}}}}));
  EXPECT_EQ(complaint(with("/rig/driver", {{"inputs", {{"gear", {{0, 1}, {2, 4}}}}}})),
            ": key 'rig.driver': asks for gear 4 at 2 s, expected at most 3: the vehicle HMMWV has no more");
  json rover = with("/rig/driver", {{"inputs", {{"gear", 2}}}});
  rover["rig"]["vehicle"] = "rover.json";
  EXPECT_EQ(complaint(rover),
            ": key 'rig.driver': asks for gear 2 at 0 s, expected at most 1: the vehicle Rover has no gearbox");
  rover["rig"]["driver"] = {{"inputs", {{"brake", {{0, 0}, {1, 0.5}}}}}};
  EXPECT_EQ(complaint(rover),
            ": key 'rig.driver': gives brake 0.5 at 1 s, expected a driver that does not: the vehicle Rover "
            "has no brakes");
  EXPECT_EQ(complaint(vehicle_text("hmmwv.json")),
            ": is a vehicle, expected a scenario (the key rig.vehicle of a scenario takes vehicles)");
  json foreign = hmmwv();
  foreign["rig"] = {{"type", "drawbar"}, {"vehicle", "hmmwv.json"}};
  foreign["tire"] = {{"file", "hmmwv_layered.json"}};
  EXPECT_EQ(complaint(foreign),
            ": key 'rig.vehicle': is a key of type 'vehicle', but rig.type is 'drawbar', expected "
            "keys of that type alone");
}

TEST(VehicleScenario, locks_need_a_differential_that_has_one) {
  json document = hmmwv(), open = vehicle_text("hmmwv.json");
  document["rig"]["driver"] = {{"inputs", {{"lock", {{0, 0}, {1, 1}}}}}};
  EXPECT_EQ(complaint(document), "");
  for (json& differential : open["driveline"]["differentials"]) differential.erase("lock_torque");
  EXPECT_EQ(OwnVehicle(document, open).complaint(),
            ": key 'rig.driver': gives lock, expected a driver that does not: the vehicle HMMWV has no differential "
            "with a lock_torque");
}

// In gear -1, motors turn backward without a gearbox; a gearbox needs a reverse gear.
TEST(VehicleScenario, gear_minus_one_needs_motors_or_a_reverse_gear) {
  json document = hmmwv();
  document["rig"]["driver"] = {{"inputs", {{"gear", -1}}}};
  document["rig"]["vehicle"] = "rover.json";
  EXPECT_EQ(complaint(document), "");
  document["rig"]["vehicle"] = "buggy.json";
  EXPECT_EQ(complaint(document), "");
  json forward = vehicle_text("buggy.json");
  forward["driveline"]["gearbox"].erase("reverse");
  EXPECT_EQ(OwnVehicle(document, forward).complaint(),
            ": key 'rig.driver': asks for gear -1 at 0 s, expected 0 to 4 or 'auto': the vehicle Buggy has no reverse "
            "gear");
  json pushed = vehicle_text("rover.json");
  pushed.erase("driveline");
  EXPECT_EQ(OwnVehicle(document, pushed).complaint(),
            ": key 'rig.driver': asks for gear -1 at 0 s, expected 0 to 1 or 'auto': the vehicle Rover has neither a "
            "gearbox nor motors, which turn backward in it");
}

TEST(VehicleScenario, keys_of_the_vehicle_s_file_are_not_set_but_told_how_to_change) {
  for (const char* key : {"vehicle.chassis.mass", "rig.vehicle.chassis.mass", "chassis.mass"})
    EXPECT_EQ(complaint(hmmwv(), {{key, "2500"}}),
              std::string(": key '") + key +
                  "': is a key of 'hmmwv.json', which --set does not reach, expected a copy of that file with another "
                  "'chassis.mass', and --set rig.vehicle=COPY");
  EXPECT_EQ(complaint(hmmwv(), {{"rig.vehicle", "\"hmmwv_tr.json\""}}), "");
}

TEST(VehicleScenario, a_vehicle_that_no_tire_of_its_size_carries_is_refused_by_the_key_of_its_mass) {
  json heavy = vehicle_text("hmmwv.json");
  heavy["chassis"]["mass"] = 1e6;
  heavy["chassis"]["inertia"] = {5e5, 1.4e6, 1.7e6};
  const std::string told = OwnVehicle(hmmwv(), heavy).complaint();
  EXPECT_TRUE(holds(told,
                    "key 'chassis.mass': is 1e6 kg: on 4 wheels each tire would carry 2.45e+06 N, and no tire of "
                    "the size of 'hmmwv_layered.json' carries "));
  // Rigid wheels carry anything.
  for (json& axle : heavy["axles"]) axle["wheel"]["rigid"] = true;
  EXPECT_EQ(OwnVehicle(hmmwv(), heavy).complaint().find("no tire of the size"), std::string::npos);
}

TEST(VehicleScenario, springs_that_rest_in_their_stops_are_warned_of) {
  json car = vehicle_text("hmmwv.json");
  car["axles"][1]["suspension"]["spring"]["stop"]["shortest"] = 0.325;  // it rests at 0.306 m
  car["axles"][1]["suspension"]["spring"]["stop"]["longest"] = 0.4;
  const std::vector<std::string> warnings = OwnVehicle(hmmwv(), car).load().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(holds(warnings[0], "whose key 'axles[1].suspension.spring.stop' holds the wheel 'rear left' at rest"));
}

TEST(VehicleScenario, what_binds_the_answer_names_its_wheels) {
  const scenario::Scenario s = scenario::load_scenario(data_folder() / "rigs" / "four_wheels.json",
                                                       {{"terrain.radius", "0.03"}, {"terrain.layers", "4"}});
  const auto bounds = scenario::validation_report(s)["bound_by"];
  ASSERT_FALSE(bounds.empty());
  const std::string text = scenario::validation_text(s);
  for (const auto& bound : bounds) {
    EXPECT_FALSE(bound["wheels"].empty()) << bound.dump();
    for (const auto& wheel : bound["wheels"])
      EXPECT_TRUE(bound["wheels"].size() == s.tires.size() || text.find(wheel.get<std::string>()) != std::string::npos);
  }
  EXPECT_TRUE(holds(text, "\nbound by     " + bounds[0]["key"].get<std::string>() + " ("));
}

TEST(VehicleScenario, a_parked_vehicle_without_brakes_is_warned_of) {
  json rover = hmmwv();
  rover["rig"]["vehicle"] = "rover.json";
  const ScenarioFile file(rover.dump());
  const std::vector<std::string> warnings = file.load().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(
      warnings[0].ends_with("key 'rig.driver': is missing, and so the brakes hold the vehicle, but Rover has "
                            "no brakes: it may roll"))
      << warnings[0];
  rover["rig"]["driver"] = {{"inputs", {{"throttle", 0.5}}}};
  EXPECT_TRUE(load(rover).warnings.empty());
  EXPECT_TRUE(load(hmmwv()).warnings.empty()) << "it has brakes";
}

TEST(VehicleScenario, wheels_of_one_vehicle_in_each_other_are_its_file_s_fault) {
  json rover = vehicle_text("rover.json");
  rover["axles"][0]["origin"] = {0.10, 0.0, 0.0};
  EXPECT_EQ(OwnVehicle(hmmwv(), rover).complaint(),
            ": key 'rig.vehicle': has the wheel middle_left in the way of front_left, expected 0.12 m "
            "between their axles "
            "or 0.05 m between their mid-planes");
}

/// A driver must not use parts that the vehicle lacks: they would be ignored.
TEST(VehicleScenario, pedals_and_steering_without_effect_are_refused) {
  const auto complains = [&](const json& car, const char* input) {
    json with = hmmwv();
    with["rig"]["driver"] = {{"inputs", {{input, {{0, 0}, {2, 1}}}}}};
    return OwnVehicle(with, car).complaint();
  };
  json pushed = vehicle_text("hmmwv.json"), straight = pushed;
  pushed.erase("driveline");
  straight["axles"][0].erase("steering");
  EXPECT_EQ(complains(pushed, "throttle"),
            ": key 'rig.driver': gives throttle 1 at 2 s, expected a driver that does not: the vehicle HMMWV "
            "has neither "
            "engine nor motors");
  EXPECT_EQ(complains(straight, "steering"),
            ": key 'rig.driver': gives steering 1 at 2 s, expected a driver that does not: the vehicle HMMWV "
            "has no "
            "steering");
}

TEST(VehicleScenario, times_of_a_driver_in_milliseconds_are_warned_of) {
  json document = hmmwv();
  document["rig"]["driver"] = {{"inputs", {{"throttle", {{0, 0}, {5000, 1}}}}}};
  const scenario::Scenario s = load(document, {{"tire.rigid", "true"}});
  EXPECT_TRUE(std::ranges::any_of(s.warnings, [](const std::string& text) {
    return text.find("key 'rig.driver': its key 'inputs.throttle': 5000 s is unusually large") != std::string::npos;
  }));
}

/// Such paths are followed as well as possible, which is rarely intended.
TEST(VehicleScenario, paths_that_the_vehicle_cannot_follow_are_warned_of) {
  const auto warning = [](const json& path) {
    json document = hmmwv();
    document["rig"]["driver"] = {{"speed", {{"target", 3}}}, {"path", path}};
    const scenario::Scenario s = load(document, {{"tire.rigid", "true"}});
    std::string texts;
    for (const std::string& text : s.warnings)
      if (const std::size_t at = text.find("key 'rig.driver': "); at != std::string::npos) texts += text.substr(at);
    return texts;
  };
  const auto waypoints = [](const json& points) { return json{{"kind", "waypoints"}, {"points", points}}; };
  EXPECT_EQ(warning({{"kind", "straight"}, {"length", 30}}), "");
  EXPECT_EQ(warning({{"kind", "circle"}, {"radius", 8}}), "");
  EXPECT_EQ(warning({{"kind", "circle"}, {"radius", 3}}),
            "key 'rig.driver': has a path that bends with a radius of 3.00 m, the vehicle HMMWV turns with "
            "6.63 m at least");
  EXPECT_EQ(warning(waypoints({{-10, 0}, {-20, 0}})),
            "key 'rig.driver': has a path that leads backward where the vehicle starts: drivers drive "
            "forward and turn "
            "round");
  EXPECT_EQ(warning(waypoints({{0, 50}, {100, 50}})),
            "key 'rig.driver': has a path that comes no nearer than 50.0 m to where the rear axle starts, x "
            "= -1.65 m, y = "
            "0.00 m");
}

/// Errors of the vehicle's own file are reported with its name.
TEST(VehicleScenario, faults_of_the_vehicle_s_file_are_told_with_its_name) {
  const OwnVehicle file(hmmwv(), {});
  const auto complains = [&](const char* pointer, const json& value) {
    json changed = vehicle_text("hmmwv.json");
    changed[json::json_pointer(pointer)] = value;
    file.write(changed);
    return file.complaint({}, file.vehicle());
  };
  EXPECT_TRUE(complains("/axles/0/wheel/tire", "none.json")
                  .starts_with(": key 'axles[0].wheel.tire': 'none.json' does not exist, expected a file at one of: "));
  EXPECT_EQ(complains("/driveline/gearbox/ratios/0", 0.0),
            ": key 'driveline.gearbox.ratios[0]': is 0, expected a number above zero");
  // It cannot stand if all wheels are in front of its centre of mass.
  const std::string falls = complains("/chassis/center_of_mass/0", -9.0);
  EXPECT_TRUE(holds(falls, "key 'rig.vehicle': is " + file.vehicle().string() + ", which cannot be used: "));
}

}  // namespace
}  // namespace furrow
