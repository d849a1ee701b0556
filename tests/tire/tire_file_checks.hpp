// What the tests of tires that are read from a file and pressed have in common.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tire/press/press.hpp"
#include "tire/tires.hpp"

namespace furrow::tire {

using ReadTire = std::unique_ptr<TireSpec>(const nlohmann::json& file, const TireOptions& options);

/// What a reader says against a file called tire.json; "no error" where it takes it.
inline std::string complaint_of(ReadTire& read, const nlohmann::json& file, TireOptions options) {
  try {
    options.file = "tire.json";
    read(file, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "no error";
}

inline TireOptions options_of(const std::filesystem::path& file, int around) {
  TireOptions o;
  o.file = file;
  o.elements_circumference = around;
  return o;
}

inline PressResults pressed(const TireOptions& tire, const PressOptions& options) {
  return read_tire(tire)->static_test()->press(options, {});
}

}  // namespace furrow::tire
