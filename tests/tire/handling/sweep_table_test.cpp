// Tables of sweeps on hard ground, and their files in the layout of TYDEX.
#include "tire/handling/sweep_table.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "protocol/core/error.hpp"
#include "tests/tire/handling/example_tire.hpp"
#include "tire/handling/tydex.hpp"

namespace furrow::tire::handling {
namespace {

constexpr const char* kHead =
    "state,rig.mode,iso_w.force_N.0,iso_w.force_N.1,iso_w.force_N.2,iso_w.moment_Nm.0,iso_w.moment_Nm.1,"
    "iso_w.moment_Nm.2,iso_w.slip_angle_rad,iso_w.camber_angle_rad,iso_w.loaded_radius_m,effective_rolling_radius_m,"
    "problem\n";

std::filesystem::path written(const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "sweep_table.csv";
  std::ofstream(file) << text;
  return file;
}

std::string complaint(const std::string& text) {
  return refusal(ExitCode::bad_input, [&] { read_sweep_table(written(text)); });
}

const std::string kRows =
    "done,free_rolling,-50,0,2000,0,-10,0,0,0,0.344,0.347,\n"
    "done,fixed_speed,1500,0,3000,0,-10,0,0,0,0.342,0.3415,\n"
    "failed,fixed_speed,,,,,,,,,,,\"it, said \"\"no\"\"\"\n"
    "done,free_rolling,-60,900,4000,1,-20,-9,-0.02,0,0.34,0.345,\n"
    "done,free_rolling,-60,0,4000,0,-20,0,0,0,0.34,0.345,\n";

TEST(SweepTable, slip_counts_from_free_rolling_at_the_load) {
  const auto points = read_sweep_table(written("# commit: 1\n" + std::string(kHead) + kRows));
  ASSERT_EQ(points.size(), 4u);
  EXPECT_NEAR(points[1].state.slip, 0.346 / 0.3415 - 1.0, 1e-15) << "between 0.347 at 2000 N and 0.345 at 4000 N";
  EXPECT_EQ(points[1].forces.fx, 1500.0);
  EXPECT_NEAR(points[2].state.slip, 0.0, 1e-15);
  EXPECT_EQ(points[2].state.slip_angle, -0.02);
  EXPECT_TRUE(points[3].rolls_freely);
  EXPECT_FALSE(points[2].rolls_freely);
}

TEST(SweepTable, wrong_tables_are_refused_by_line) {
  std::string head = kHead, rows = kRows;
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_TRUE(
      holds(complaint(changed(head, "iso_w.force_N.1", "x") + rows), "line 1': has no column 'iso_w.force_N.1'"));
  EXPECT_TRUE(holds(complaint(changed(head, "rig.mode", "x") + rows), "has no column 'rig.mode'"));
  EXPECT_TRUE(holds(complaint(head + changed(rows, "1500", "nan")), "line 3': iso_w.force_N.0 is 'nan'"));
  EXPECT_TRUE(holds(complaint(head + changed(rows, "3000", "-3000")), "line 3': has a load"));
  EXPECT_TRUE(holds(complaint(head + changed(rows, "0.3415", "1e-300")),
                    "line 3': has a load of 3000 N and a rolling radius of 1e-300 m"));
  EXPECT_TRUE(holds(complaint(head + changed(rows, "3000", "1e300")), "line 3': has a load of 1e+300 N"));
  EXPECT_TRUE(holds(complaint(head + changed(rows, "1500,", "")), "line 3': has 12 values, expected 13"));
  EXPECT_TRUE(
      holds(complaint(head + "done,fixed_speed,1500,0,3000,0,-10,0,0,0,0.342,0.3415,\n"), "expected one at each load"));
  EXPECT_TRUE(holds(complaint(head), "expected one at each load"));
}

/// Names are in columns 1 to 10, units in 41 to 50; a line has one number for each channel [TYDEX 1.3].
TEST(Tydex, has_the_layout_of_its_release) {
  const auto points = read_sweep_table(written(std::string(kHead) + kRows));
  std::istringstream lines(tydex_text("lumped", example_tire(), points, {"fitted for slip -0.1 to 0.1"}));
  std::string line, section;
  int channels = 0, data = 0;
  while (std::getline(lines, line)) {
    if (line.starts_with("**")) {
      section = line;
      continue;
    }
    if (section == "**HEADER" && line.starts_with("RELEASE")) {
      EXPECT_EQ(line.substr(50), "1.3");
    }
    if (section == "**MEASURCHANNELS") {
      ++channels;
      EXPECT_GE(line.size(), 71u);
      if (line.starts_with("FYW")) {
        EXPECT_EQ(line.substr(40, 1), "N");
      }
    }
    if (section == "**MEASURDATA") {
      ++data;
      std::istringstream numbers(line);
      double value = 0.0;
      int count = 0;
      while (numbers >> value) ++count;
      EXPECT_EQ(count, channels);
    }
  }
  EXPECT_EQ(section, "**END");
  EXPECT_EQ(data, 4);
  EXPECT_EQ(channels, 11);
}

}  // namespace
}  // namespace furrow::tire::handling
