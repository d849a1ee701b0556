#include "protocol/files/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>

#include "protocol/core/error.hpp"

namespace furrow {
namespace {

using nlohmann::json;

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (std::tolower(a[i - 1]) != std::tolower(b[j - 1]));
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

/// One line of a value, for messages.
std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() > 40 ? text.substr(0, 37) + "..." : text;
}

}  // namespace

json load_json(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw input_error(file.string(), "", "is a directory, expected a tire file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw input_error(file.string(), "", "cannot be read, expected a tire file in JSON");
  std::vector<std::set<std::string>> keys;
  std::string duplicate;
  const auto note_key = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key) {
      const auto name = parsed.get<std::string>();
      if (!keys.back().insert(name).second && duplicate.empty()) duplicate = name;
    }
    return true;
  };
  json document;
  try {
    document = json::parse(in, note_key);
  } catch (const json::exception& e) {
    const std::string what = e.what();  // begins with the library's own name of the error in brackets
    const std::size_t name = what.find("] ");
    throw input_error(file.string(), "",
                      "is not valid JSON: " + (name < what.size() ? what.substr(name + 2) : what));
  }
  if (!duplicate.empty()) throw input_error(file.string(), duplicate, "stands twice in the same object");
  if (!document.is_object()) throw input_error(file.string(), "", "expected a JSON object");
  return document;
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& valid) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 2);
  for (const auto& candidate : valid) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance <= least && (best.empty() || distance < least)) {
      best = candidate;
      least = distance;
    }
  }
  return best;
}

JsonReader::JsonReader(const json& object, std::string file, std::string path)
    : object_(object), file_(std::move(file)), path_(std::move(path)) {
  if (!object_.is_object()) throw input_error(file_, path_, "is " + shown(object_) + ", expected an object");
}

void JsonReader::fail(const std::string& key, const std::string& what) const {
  throw input_error(file_, full(key), what);
}

const json& JsonReader::at(const std::string& key) {
  used_.push_back(key);
  if (!object_.contains(key)) fail(key, "is missing");
  return object_.at(key);
}

JsonReader JsonReader::child(const std::string& key) { return JsonReader(at(key), file_, full(key)); }

const json& JsonReader::array(const std::string& key) {
  const json& value = at(key);
  if (!value.is_array()) fail(key, "is " + shown(value) + ", expected a list");
  return value;
}

std::string JsonReader::text(const std::string& key) {
  const json& value = at(key);
  if (!value.is_string()) fail(key, "is " + shown(value) + ", expected a text");
  return value.get<std::string>();
}

std::string JsonReader::text_or(const std::string& key, const std::string& otherwise) {
  skip(key);
  return has(key) ? text(key) : otherwise;
}

bool JsonReader::flag_or(const std::string& key, bool otherwise) {
  skip(key);
  if (!has(key)) return otherwise;
  const json& value = at(key);
  if (!value.is_boolean()) fail(key, "is " + shown(value) + ", expected true or false");
  return value.get<bool>();
}

int JsonReader::count(const std::string& key, int least) {
  const json& value = at(key);
  if (!value.is_number_integer() || value.get<double>() < least || value.get<double>() > 100000)
    fail(key, fmt::format("is {}, expected a whole number of at least {}", shown(value), least));
  return value.get<int>();
}

double JsonReader::number(const std::string& key) {
  const json& value = at(key);
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    fail(key, "is " + shown(value) + ", expected a finite number");
  return value.get<double>();
}

double JsonReader::positive(const std::string& key) {
  const double value = number(key);
  if (!(value > 0.0)) fail(key, fmt::format("is {}, expected a number above zero", value));
  return value;
}

double JsonReader::not_negative(const std::string& key) {
  const double value = number(key);
  if (!(value >= 0.0)) fail(key, fmt::format("is {}, expected a number of zero or above", value));
  return value;
}

double JsonReader::not_negative_or(const std::string& key, double otherwise) {
  skip(key);
  return has(key) ? not_negative(key) : otherwise;
}

std::vector<double> JsonReader::numbers(const std::string& key, int size) {
  const json& list = array(key);
  if (size >= 0 && static_cast<int>(list.size()) != size)
    fail(key, fmt::format("has {} values, expected {}", list.size(), size));
  std::vector<double> values;
  for (const json& value : list) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(key, "holds " + shown(value) + ", expected finite numbers");
    values.push_back(value.get<double>());
  }
  return values;
}

void JsonReader::finish() const {
  for (const auto& [key, value] : object_.items()) {
    if (std::find(used_.begin(), used_.end(), key) != used_.end()) continue;
    const std::string near = nearest_name(key, used_);
    fail(key, near.empty() ? "is unknown" : "is unknown, did you mean '" + near + "'?");
  }
}

}  // namespace furrow
