// Common checks of tires that are read from a file and pressed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tire/press/press.hpp"
#include "tire/tires.hpp"

namespace furrow::tire {

using ReadTire = std::unique_ptr<TireSpec>(const nlohmann::json& file, const TireOptions& options);

/// A reader's error for a file called tire.json; "no error" if it accepts the file.
inline std::string complaint_of(ReadTire& read, const nlohmann::json& file, TireOptions options) {
  options.file = "tire.json";
  const std::string text = refusal(ExitCode::bad_input, [&] { read(file, options); });
  return text.empty() ? "no error" : text;
}

struct WrongValues {
  const char* pointer;  // "/disc/density"
  std::vector<nlohmann::json> values;
  const char* words = "";  // in the message
};

/// Checks that a good file is accepted, also without optional keys, and that wrong values and missing keys are refused
/// with their names.
inline void expect_keys_are_checked(ReadTire& read, const nlohmann::json& good, const std::vector<WrongValues>& wrong,
                                    const std::vector<const char*>& required,
                                    const std::vector<const char*>& optional) {
  const auto expect_refused = [&](const nlohmann::json& file, std::string key, const char* words) {
    std::replace(key.begin(), key.end(), '/', '.');
    const std::string said = complaint_of(read, file, {});
    EXPECT_TRUE(said.starts_with("tire.json: key '" + key)) << key << ": " << said;
    EXPECT_TRUE(holds(said, words)) << key;
  };
  EXPECT_EQ(complaint_of(read, good, {}), "no error");
  for (const auto& [pointer, values, words] : wrong)
    for (const nlohmann::json& value : values) {
      nlohmann::json file = good;
      file[nlohmann::json::json_pointer(pointer)] = value;
      expect_refused(file, pointer + 1, words);
    }
  for (const char* key : required) {
    nlohmann::json file = good;
    file.erase(key);
    expect_refused(file, key, "");
  }
  nlohmann::json file = good;
  for (const char* key : optional) file.erase(key);
  EXPECT_EQ(complaint_of(read, file, {}), "no error");
}

inline TireOptions options_of(const std::filesystem::path& file, int around) {
  TireOptions o;
  o.file = file;
  o.elements_circumference = around;
  return o;
}

/// Checks that unloading retraces loading, and that the footprint carries the load. @param retrace share of the largest
/// force
inline void expect_curve_and_footprint(const PressOptions& press, const PressResults& r, double retrace,
                                       double carried) {
  const auto points = static_cast<std::size_t>(press.points);
  ASSERT_EQ(r.loading.size(), points + 1);
  ASSERT_EQ(r.unloading.size(), points);
  EXPECT_EQ(r.loading.front().force, 0.0);
  for (std::size_t k = 0; k < points; ++k) {
    EXPECT_LT(r.loading[k].force, r.loading[k + 1].force);
    EXPECT_NEAR(r.unloading[k].force, r.loading[points - 1 - k].force, retrace * r.loading.back().force);
  }
  EXPECT_NEAR(r.at_load.force, press.load, 1e-3 * press.load);
  double force = 0.0;
  for (const PressSample& s : r.footprint) force += s.pressure * s.area;
  EXPECT_NEAR(force, r.at_load.force, carried * force);
  EXPECT_TRUE(press_json(press, r)["statically_stable"]);
}

inline PressResults pressed(const TireOptions& tire, const PressOptions& options) {
  return read_tire(tire)->static_test()->press(options, {});
}

}  // namespace furrow::tire
