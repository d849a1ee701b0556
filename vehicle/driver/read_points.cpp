#include "vehicle/driver/read_points.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::vehicle {
namespace {

using nlohmann::json;

constexpr double kLargest = 1e6;  // of times and places, s and m

/// The fault of the last point, if it has one.
std::optional<std::string> fault_of_last(const DriverPoints& points, const PointRule& rule) {
  const auto [x, y] = points.back();
  const bool time = std::string(rule.first) == "time_s";
  if (std::abs(x) > kLargest)
    return fmt::format("{} is {}, expected at most {}", rule.first, number_text(x), number_text(kLargest));
  if (time && points.size() > 1 && !(x > points[points.size() - 2].first))
    return fmt::format("{} is {} after {}, expected times that rise", rule.first, number_text(x),
                       number_text(points[points.size() - 2].first));
  const bool is_word = rule.word && y == rule.meaning;
  if (!is_word && (!(y >= rule.least && y <= rule.most) || (rule.whole && y != std::round(y))))
    return fmt::format("{} is {}, expected {}", rule.second, number_text(y), rule.expected);
  return std::nullopt;
}

double second_value(const json& value, const PointRule& rule, const JsonReader& reader, const std::string& key) {
  if (rule.word && value == rule.word) return rule.meaning;
  // The value of a word must not be written as a number.
  if (!value.is_number() || (rule.word && value.get<double>() == rule.meaning))
    reader.fail(key, fmt::format("{} is {}, expected {}", rule.second, value_text(value), rule.expected));
  return value.get<double>();
}

DriverPoints read_list(const JsonReader& reader, const std::string& key, const json& list, const PointRule& rule) {
  DriverPoints points;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string entry = fmt::format("{}[{}]", key, i);
    const json& pair = list[i];
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number())
      reader.fail(entry, fmt::format("is {}, expected [{}, {}]", value_text(pair), rule.first, rule.second));
    points.emplace_back(pair[0].get<double>(), second_value(pair[1], rule, reader, entry));
    if (const auto fault = fault_of_last(points, rule)) reader.fail(entry, *fault);
  }
  if (points.empty()) reader.fail(key, "is [], expected at least one point");
  return points;
}

}  // namespace

DriverPoints read_points(JsonReader& reader, const std::string& key, const PointRule& rule) {
  reader.skip(key);
  const bool time = std::string(rule.first) == "time_s";
  const std::string forms = fmt::format("a list of [{}, {}], the name of a CSV file{}", rule.first, rule.second,
                                        time ? std::string(" or ") + rule.expected : "");
  if (!reader.has(key)) reader.fail(key, "is missing, expected " + forms);
  const json& value = reader.object().at(key);
  if (value.is_array()) return read_list(reader, key, value, rule);
  if (value.is_string() && !(rule.word && value == rule.word)) {
    if (const auto text = reader.text(key); text.find('.') == std::string::npos)
      reader.fail(key, "is " + value_text(value) + ", expected " + forms);
    const auto file = find_file(reader.text(key), reader.full(key), reader.file());
    return read_points(CsvFile(file, fmt::format("a CSV file with the columns {} and {}", rule.first, rule.second),
                               {rule.first, rule.second}),
                       rule);
  }
  if (!time || !(value.is_number() || value.is_string()))
    reader.fail(key, "is " + value_text(value) + ", expected " + forms);
  const DriverPoints points = {{0.0, second_value(value, rule, reader, key)}};
  if (const auto fault = fault_of_last(points, rule)) reader.fail(key, *fault);
  return points;
}

DriverPoints read_points(const CsvFile& file, const PointRule& rule) {
  DriverPoints points;
  for (std::size_t row = 0; row < file.row_count(); ++row) {
    const bool is_word = rule.word && file.text(row, rule.second) == rule.word;
    const double second = is_word ? rule.meaning : file.number(row, rule.second);
    if (!is_word && rule.word && second == rule.meaning)
      throw file.wrong(row, fmt::format("{} is {}, expected {}", rule.second, number_text(second), rule.expected));
    points.emplace_back(file.number(row, rule.first), second);
    if (const auto fault = fault_of_last(points, rule)) throw file.wrong(row, *fault);
  }
  return points;
}

}  // namespace furrow::vehicle
