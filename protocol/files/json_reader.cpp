#include "protocol/files/json_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"

namespace furrow {
namespace {

constexpr std::size_t kMaxName = 4096;  // bytes of a text that names something

}  // namespace

template <class Json>
BasicJsonReader<Json>::BasicJsonReader(const Json& object, std::string file, std::string path)
    : object_(object), file_(std::move(file)), path_(std::move(path)) {
  if (!object_.is_object()) fail("", "is " + value_text(object_) + ", expected an object { }");
}

template <class Json>
const Json& BasicJsonReader<Json>::at(const std::string& key, bool (Json::*is)() const noexcept,
                                      const std::string& expected) {
  skip(key);
  if (!has(key)) fail(key, "is missing, expected " + expected);
  const Json& value = object_.at(key);
  if (!(value.*is)()) fail(key, "is " + value_text(value) + ", expected " + expected);
  return value;
}

template <class Json>
BasicJsonReader<Json> BasicJsonReader<Json>::child(const std::string& key) {
  return BasicJsonReader(at(key, &Json::is_object, "an object { }"), file_, full(key));
}

template <class Json>
Json BasicJsonReader<Json>::object_or_empty(const std::string& key) {
  skip(key);
  return given(key) ? at(key, &Json::is_object, "an object { } of keys and values") : Json::object();
}

template <class Json>
const Json& BasicJsonReader<Json>::array(const std::string& key) {
  return at(key, &Json::is_array, "a list");
}

template <class Json>
std::string BasicJsonReader<Json>::text(const std::string& key) {
  const std::string text = at(key, &Json::is_string, "a text").template get<std::string>();
  if (text.size() > kMaxName || printable(text) != text)
    fail(key, "is '{}', expected one line of at most {} bytes", excerpt(text), kMaxName);
  return text;
}

template <class Json>
std::string BasicJsonReader<Json>::text_or(const std::string& key, const std::string& otherwise) {
  skip(key);
  return has(key) ? text(key) : otherwise;
}

template <class Json>
bool BasicJsonReader<Json>::flag(const std::string& key) {
  return at(key, &Json::is_boolean, "true or false").template get<bool>();
}

template <class Json>
bool BasicJsonReader<Json>::flag_or(const std::string& key, bool otherwise) {
  skip(key);
  return has(key) ? flag(key) : otherwise;
}

template <class Json>
int BasicJsonReader<Json>::count(const std::string& key, int least, int most) {
  const std::string expected = fmt::format("a whole number from {} to {}", least, most);
  const Json& value = at(key, &Json::is_number_integer, expected);
  const auto number = value.template get<double>();
  if (number < least || number > most) fail(key, "is " + value_text(value) + ", expected " + expected);
  return value.template get<int>();
}

template <class Json>
double BasicJsonReader<Json>::number(const std::string& key) {
  return at(key, &Json::is_number, "a number").template get<double>();
}

template <class Json>
double BasicJsonReader<Json>::positive(const std::string& key) {
  const double value = number(key);
  if (!(value > 0.0)) fail(key, "is " + number_text(value) + ", expected a number above zero");
  return value;
}

template <class Json>
double BasicJsonReader<Json>::not_negative(const std::string& key) {
  const double value = number(key);
  if (!(value >= 0.0)) fail(key, "is " + number_text(value) + ", expected a number of zero or above");
  return value;
}

template <class Json>
double BasicJsonReader<Json>::not_negative_or(const std::string& key, double otherwise) {
  skip(key);
  return has(key) ? not_negative(key) : otherwise;
}

template <class Json>
std::vector<double> BasicJsonReader<Json>::numbers(const std::string& key, int size) {
  const Json& list = array(key);
  if (size >= 0 && static_cast<int>(list.size()) != size) fail(key, "has {} values, expected {}", list.size(), size);
  std::vector<double> values;
  for (const Json& value : list) {
    if (!value.is_number()) fail(key, "holds " + value_text(value) + ", expected numbers");
    values.push_back(value.template get<double>());
  }
  return values;
}

template <class Json>
void BasicJsonReader<Json>::check_version(int newest, bool required) {
  constexpr const char* kKey = "format_version";
  skip(kKey);
  if (!required && !given(kKey)) return;
  const std::string expected = newest == 1 ? "1" : fmt::format("1 to {}", newest);
  const Json& value = at(kKey, &Json::is_number_integer, expected);
  if (value.template get<double>() > newest)
    fail(kKey, "is {}: the file is newer than this program, expected at most {}", value_text(value), newest);
  if (value.template get<double>() < 1.0) fail(kKey, "is " + value_text(value) + ", expected " + expected);
}

template <class Json>
void BasicJsonReader<Json>::skip(const std::string& key) {
  if (std::find(used_.begin(), used_.end(), key) == used_.end()) used_.push_back(key);
}

template <class Json>
void BasicJsonReader<Json>::allow_only(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : object_.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(key, unknown_text(nearest_words(key, known), known));
}

template class BasicJsonReader<nlohmann::json>;
template class BasicJsonReader<nlohmann::ordered_json>;

}  // namespace furrow
