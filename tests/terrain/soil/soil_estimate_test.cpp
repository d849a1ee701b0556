// Soil theory compared with a run: the values in summary.json and soil.json are checked.
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "terrain/soil/bekker_wong.hpp"
#include "terrain/soil/soil_estimate.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow::terrain::soil {
namespace {

using Json = nlohmann::json;

class SoilEstimate : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.path() / "scenario.json") << "{}";
    summary_ = {{"format_version", 1},
                {"tire_radius_m", 0.47},
                {"tread_width_m", 0.25},
                {"vertical_load_N", 4600.0},
                {"slip", 0.3}};
    soil_ = {{"format_version", 1},        {"k_c", 1e3},        {"k_phi", 1e6}, {"n", 1.0}, {"cohesion_Pa", 100.0},
             {"friction_angle_deg", 30.0}, {"janosi_K_m", 0.01}};
  }

  /// The printed text, or the error.
  std::string told(const Json& summary, const Json& soil) {
    std::ofstream(folder_.path() / "summary.json") << summary;
    std::ofstream(folder_.path() / "soil.json") << soil;
    try {
      return write_soil_estimate(folder_.path(), folder_.path() / "soil.json");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return error.what();
    }
  }

  testing::TemporaryFolder folder_;
  Json summary_, soil_;
};

TEST_F(SoilEstimate, tells_the_pull_with_the_error_that_the_parameters_give_it) {
  soil_["standard_error"] = {{"k_phi", 1e5}, {"n", 0.1}, {"k_c", nullptr}};
  EXPECT_TRUE(holds(told(summary_, soil_), "drawbar pull"));
  EXPECT_TRUE(holds(told(summary_, soil_), "±"));
  EXPECT_EQ(told({{"format_version", 1}, {"wheels", {summary_}}}, soil_), told(summary_, soil_));
}

TEST_F(SoilEstimate, values_of_other_kinds_are_named) {
  const auto with = [](Json document, const char* key, const Json& value) {
    document[key] = value;
    return document;
  };
  const auto expect = [&](const std::string& text, const char* words) { EXPECT_TRUE(holds(text, words)); };
  expect(told(with(summary_, "wheels", 3), soil_), "summary.json: key 'wheels': is 3, expected a list");
  expect(told(with(summary_, "wheels", {3}), soil_), "summary.json: key 'wheels.0': is 3, expected an object");
  expect(told(summary_, with(soil_, "quick", "no")), "soil.json: key 'quick': is 'no', expected true or false");
  expect(told(summary_, with(soil_, "standard_error", 3)), "soil.json: key 'standard_error': is 3, expected");
  for (const Json& value : {Json("x"), Json(-1.0)})
    expect(told(summary_, with(soil_, "standard_error", {{"n", value}})), "key 'standard_error.n': is ");
}

TEST_F(SoilEstimate, numbers_that_overflow_carry_no_wheel) {
  soil_["k_phi"] = 1e308;
  soil_["standard_error"] = {{"k_phi", 1e308}, {"cohesion_Pa", 1e308}};
  EXPECT_NE(told(summary_, soil_), "");
  summary_["tire_radius_m"] = 1e200;
  EXPECT_TRUE(holds(told(summary_, soil_), "does not carry"));
}

}  // namespace
}  // namespace furrow::terrain::soil
