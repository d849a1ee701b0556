#include "vehicle/spec/spec_reader.hpp"

#include <fmt/format.h>

#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"

namespace furrow::vehicle::detail {
namespace {

constexpr double kMostCoordinate = 100.0;  // m: twice the longest vehicles

}  // namespace

void take(JsonReader& reader, const Key& key, double& value) {
  value = reader.number(key.name);
  if (const std::string what = mistake(key, value); !what.empty()) reader.fail(key.name, what);
}

void take(JsonReader& reader, const Key& key, bool& value) { value = reader.flag(key.name); }

void take(JsonReader& reader, const Key& key, std::string& value) {
  value = reader.text(key.name);
  if (value.empty()) reader.fail(key.name, "is empty, expected a name");
  if (const std::string what = mistake(key, value); !what.empty()) reader.fail(key.name, what);
}

void take(JsonReader& reader, const Key& key, Vec3& value) {
  const std::vector<double> v = reader.numbers(key.name, 3);
  value = Vec3(v[0], v[1], v[2]);
  if (const double most = value.cwiseAbs().maxCoeff(); most > kMostCoordinate)
    reader.fail(key.name, fmt::format("has {} among its coordinates, expected at most {} in magnitude: points are in m",
                                      number_text(most), number_text(kMostCoordinate)));
}

void take(JsonReader& reader, const Key& key, Mat3& value) {
  const std::vector<double> v = reader.numbers(key.name);
  if (v.size() != 3 && v.size() != 6)
    reader.fail(key.name,
                fmt::format("has {} values, expected 3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)", v.size()));
  value = Vec3(v[0], v[1], v[2]).asDiagonal();
  if (v.size() == 3) return;
  value(0, 1) = value(1, 0) = v[3];
  value(0, 2) = value(2, 0) = v[4];
  value(1, 2) = value(2, 1) = v[5];
}

void take(JsonReader& reader, const Key& key, Points& value) {
  const nlohmann::json& list = reader.array(key.name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const nlohmann::json& point = list[i];
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      reader.fail(entry_path(key.name, i), "is " + value_text(point) + ", expected a pair of numbers [x, y]");
    const double x = point[0].get<double>();
    if (!value.empty() && !(x > value.back().first))
      reader.fail(entry_path(key.name, i), fmt::format("begins with {} after {}, expected a table that rises",
                                                       number_text(x), number_text(value.back().first)));
    value.emplace_back(x, point[1].get<double>());
  }
  if (value.size() < 2)
    reader.fail(key.name, fmt::format("has {} points, expected at least two pairs [x, y]", value.size()));
}

void take(JsonReader& reader, const Key& key, std::vector<double>& value) { value = reader.numbers(key.name); }

void take(JsonReader& reader, const Key& key, std::vector<std::string>& value) {
  for (const nlohmann::json& entry : reader.array(key.name)) {
    if (!entry.is_string()) reader.fail(key.name, "holds " + value_text(entry) + ", expected names");
    value.push_back(entry.get<std::string>());
  }
}

std::string entry_path(const std::string& list, std::size_t index) { return fmt::format("{}[{}]", list, index); }

void refuse_type(JsonReader& reader, const std::vector<std::string>& types) {
  reader.fail("type", "is '" + reader.text("type") + "', expected " + one_of(types));
}

}  // namespace furrow::vehicle::detail
