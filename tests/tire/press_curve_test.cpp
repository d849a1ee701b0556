// Press curves: they agree with the static test, are kept and read again; a rigid tire has none.
#include "tire/press/press_curve.hpp"
#include "tests/refusal.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/temporary_folder.hpp"
#include "tire/press/press.hpp"
#include "tire/tires.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

class PressCurveTest : public ::testing::Test {
 protected:
  std::unique_ptr<tire::TireSpec> coarse(double pressure = 0.0) const {
    tire::TireOptions options;
    options.file = TIRE_DATA "/hmmwv_lumped.json";
    options.elements_circumference = 24;
    options.elements_width = 6;
    if (pressure > 0.0) options.pressure.knots = {{0.0, pressure}};
    return tire::read_tire(options);
  }
  std::vector<std::filesystem::path> kept() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "furrow" / "press"))
      files.push_back(entry.path());
    return files;
  }
  OwnCache folder_;
};

TEST_F(PressCurveTest, is_that_of_the_static_test_and_is_kept) {
  const auto spec = coarse();
  const auto curve = tire::press_curve(*spec, 3000.0, {});
  ASSERT_TRUE(curve.has_value());
  EXPECT_GE(curve->points.back().second, 3000.0);
  EXPECT_EQ(curve->points.front(), std::pair(0.0, 0.0));
  tire::PressOptions options;
  options.deflection = curve->points.back().first;
  options.points = static_cast<int>(curve->points.size()) - 1;
  const tire::PressResults pressed = spec->static_test()->press(options, {});
  EXPECT_EQ(curve->radius, spec->describe().radius + pressed.inflation_growth.value_or(0.0));
  for (std::size_t k = 1; k < curve->points.size(); ++k)
    EXPECT_NEAR(curve->points[k].second, pressed.loading[k].force, 1e-4 * pressed.loading[k].force);
  int pressings = 0;
  const auto again = tire::press_curve(*spec, 3000.0, [&](const std::string&, double) { ++pressings; });
  EXPECT_EQ(pressings, 0);
  EXPECT_EQ(again->points, curve->points);
  EXPECT_EQ(again->radius, curve->radius);
}

TEST_F(PressCurveTest, is_made_anew_where_the_file_is_damaged_or_the_pressure_another) {
  const auto curve = tire::press_curve(*coarse(), 1000.0, {});
  ASSERT_EQ(kept().size(), 1U);
  const std::filesystem::path file = kept().front();
  for (const char* text :
       {"", "{}", "[1]", R"({"radius_m": [0.4], "deflection_m": [0, 1, 2, 3, 4], "force_N": [0, 2, 1, 3, 4]})",
        R"({"radius_m": [0.4], "deflection_m": [0, 1, 2, 3, 4], "force_N": [0, 1, 2, 3, "x"]})",
        R"({"radius_m": [0.4], "deflection_m": [0, 1, 2, 3, 4], "force_N": [0, 1, 2, 3, 4]})",
        R"({"checksum": 1, "radius_m": [0.4], "deflection_m": [0, 1, 2, 3, 4], "force_N": [0, 1, 2, 3, 4]})"}) {
    write_whole_file(file, text);
    EXPECT_EQ(tire::press_curve(*coarse(), 1000.0, {})->points, curve->points) << text;
  }
  EXPECT_NE(tire::press_curve(*coarse(100e3), 1000.0, {})->points, curve->points);
  EXPECT_EQ(kept().size(), 2U);
}

TEST_F(PressCurveTest, of_a_rigid_tire_there_is_none) {
  tire::TireOptions options;
  options.file = TIRE_DATA "/rigid_drum.json";
  options.rigid = true;
  EXPECT_FALSE(tire::press_curve(*tire::read_tire(options), 100.0, {}).has_value());
}

TEST_F(PressCurveTest, a_load_that_the_tire_does_not_carry_is_told) {
  expect_refused(ExitCode::physics, {"hmmwv_lumped.json"}, [&] { tire::press_curve(*coarse(1e3), 1e9, {}); });
}

}  // namespace
