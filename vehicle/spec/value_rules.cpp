#include "vehicle/spec/value_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::vehicle {
namespace {

void expect(bool ok, const JsonReader& reader, const std::string& key, double value, const std::string& expected) {
  if (!ok) reader.fail(key, "is " + number_text(value) + ", expected " + expected);
}

}  // namespace

void check_positive(const JsonReader& reader, const std::string& key, double value, double most) {
  expect(value > 0.0 && value <= most, reader, key, value,
         "a number above zero" + (std::isinf(most) ? "" : " and at most " + number_text(most)));
}

void check_not_negative(const JsonReader& reader, const std::string& key, double value, double most) {
  expect(value >= 0.0 && value <= most, reader, key, value,
         std::isinf(most) ? "a number of zero or above" : "a number from 0 to " + number_text(most));
}

void check_within(const JsonReader& reader, const std::string& key, double value, double least, double most) {
  expect(value >= least && value <= most, reader, key, value,
         fmt::format("a number from {} to {}", number_text(least), number_text(most)));
}

void check_known(const JsonReader& reader, const std::string& key, const std::string& text,
                 const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), text) == known.end())
    reader.fail(key, "'" + text + "' " + unknown_text(nearest_words(text, known), known));
}

}  // namespace furrow::vehicle
