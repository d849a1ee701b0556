// What tests ask of a rig, whatever its kind.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/core/archive.hpp"
#include "protocol/core/error.hpp"
#include "rigs/rig.hpp"

namespace furrow::testing {

/// What a rig measures of a subject beside the report of every wheel, by the name of its column.
inline double measured(const rigs::Rig& rig, int subject, std::string_view column) {
  const rigs::Subject of = rig.subjects().at(subject);
  std::vector<double> values(of.columns.size());
  rig.measure(subject, values);
  return LineView{of.columns, values}[column];
}
inline double measured(const rigs::Rig& rig, std::string_view column) { return measured(rig, 0, column); }

inline std::map<std::string, Archive::Array> saved(const rigs::Rig& rig) {
  Archive archive;
  rig.save(archive);
  return archive.arrays();
}

/// The message with which the input is refused; empty where it is not.
inline std::string complaint(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "";
}

}  // namespace furrow::testing
