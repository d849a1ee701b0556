#include "protocol/files/file_kind.hpp"

#include <filesystem>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using nlohmann::json;

TEST(FileKind, every_file_that_comes_with_the_program_is_what_its_folder_says) {
  const auto kinds_in = [](const char* folder) {
    std::map<FileKind, int> found;
    for (const auto& entry : std::filesystem::directory_iterator(data_folder() / folder)) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() != ".json" || path.stem().extension() == ".schema") continue;
      const auto kind = kind_of_file(load_json(path, "a file"));
      EXPECT_TRUE(kind.has_value()) << path;
      if (kind) ++found[*kind];
    }
    return found;
  };
  const auto rigs = kinds_in("rigs");
  EXPECT_EQ(rigs.size(), 3u);
  EXPECT_GT(rigs.at(FileKind::scenario), 15);
  EXPECT_GE(rigs.at(FileKind::study), 5);
  EXPECT_GE(rigs.at(FileKind::calibration), 5);
  EXPECT_EQ(kinds_in("tire/data").size(), 1u);
  EXPECT_EQ(kinds_in("terrain/data").size(), 1u);
  EXPECT_EQ(kinds_in("vehicle/data").size(), 1u);
}

TEST(FileKind, only_what_is_certainly_of_another_kind_is_refused) {
  const auto refused = [](const json& document, FileKind expected) -> std::string {
    return refusal(ExitCode::bad_input, [&] { refuse_other_kinds(document, expected, "x.json"); });
  };
  const json soil = json::parse(R"({"format_version": 1, "terrain": {"friction": 0.5}})");
  EXPECT_EQ(refused(soil, FileKind::tire),
            "x.json: is a soil, expected a tire (the key terrain.material of a scenario takes soils)");
  EXPECT_EQ(refused(soil, FileKind::soil), "");
  EXPECT_EQ(refused(soil, FileKind::scenario), "");  // a scenario with all other keys at their defaults
  const json measured = json::parse(R"({"terrain": {"friction": 0.5}, "measured": {}})");
  EXPECT_EQ(refused(measured, FileKind::scenario),
            "x.json: is a soil, expected a scenario (the key terrain.material of a scenario takes soils)");
  EXPECT_EQ(refused(measured, FileKind::soil), "");
  EXPECT_EQ(refused(json::parse(R"({"terrain": {}})"), FileKind::study),
            "x.json: is a scenario, expected a study ('furrow run' takes scenarios)");
  EXPECT_EQ(refused(json::parse(R"({"terrain": {}})"), FileKind::soil), "");
  EXPECT_EQ(refused(json::object(), FileKind::vehicle), "");
  EXPECT_EQ(refused(json::array(), FileKind::vehicle), "");
  EXPECT_EQ(refused(json::parse(R"({"format_version": 1})"), FileKind::tire), "");
}

TEST(FileKind, files_of_project_chrono_are_named_for_what_they_are) {
  const auto refused = [](const char* text, FileKind expected) -> std::string {
    const json document = json::parse(text);
    return refusal(ExitCode::bad_input, [&] { refuse_other_kinds(document, expected, "x.json"); });
  };
  const char* const vehicle = R"({"Name": "HMMWV", "Type": "Vehicle", "Template": "WheeledVehicle"})";
  EXPECT_EQ(refused(vehicle, FileKind::scenario),
            "x.json: is a Vehicle (WheeledVehicle) of Project Chrono, expected a scenario: its vehicles, suspensions, "
            "engines and terrains are not read");
  EXPECT_EQ(refused(vehicle, FileKind::vehicle),
            "x.json: is a Vehicle (WheeledVehicle) of Project Chrono, expected a vehicle: vehicle/data/hmmwv.json is "
            "Chrono's HMMWV as a vehicle file");
  EXPECT_EQ(refused(R"({"Type": "Suspension", "Template": "DoubleWishbone"})", FileKind::tire),
            "x.json: is a Suspension (DoubleWishbone) of Project Chrono, expected a tire: of its tires the templates "
            "ANCFTire, ReissnerTire and RigidTire are read, and the tire property file (.tir) that a Pac02Tire names");
  EXPECT_TRUE(holds(refused(R"({"Type": "Engine", "Template": "EngineSimple"})", FileKind::tire),
                    "is an Engine (EngineSimple) of Project Chrono"));
  EXPECT_TRUE(holds(refused(R"({"Granular material": {"Density": 2000}})", FileKind::scenario),
                    "is a file with the key 'Granular material' of Project Chrono"));
  const char* const ancf = R"({"Name": "x", "Type": "Tire", "Template": "ANCFTire"})";
  EXPECT_EQ(refused(ancf, FileKind::tire), "");
  EXPECT_EQ(refused(ancf, FileKind::vehicle),
            "x.json: is a tire, expected a vehicle (the key tire.file of a scenario takes tires)");
}

}  // namespace
}  // namespace furrow
