// Fuzzes `furrow validate` with scenarios of valid keys and odd values. Most values have the type and range of the
// schema, or are just beyond: values that the schema refuses do not reach the code after it.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/validate.hpp"
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;
using nlohmann::json;
using Settings = std::vector<std::pair<std::string, std::string>>;

const scenario::Schema& schema() {
  static const scenario::Schema& loaded = scenario::Schema::of_scenarios();
  return loaded;
}

const std::vector<std::string>& keys() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names = schema().keys();
    for (const char* section : {"tires.0", "tires.1", "rig.wheels.0", "rig.wheels.1"})
      for (const std::string& name : schema().keys(section))
        names.push_back(name.starts_with(section) ? name : std::string(section) + "." + name);
    return names;
  }();
  return all;
}

std::string text(FuzzedDataProvider& in) {
  static constexpr const char* kTexts[] = {"",
                                           "auto",
                                           "mindlin",
                                           "hertz_tanh",
                                           "rigid",
                                           "periodic",
                                           "lattice",
                                           "free_rolling",
                                           "hmmwv_layered.json",
                                           "toroidal.json",
                                           "passenger_205_55r16.json",
                                           "loose_sand.json",
                                           "cohesive_sand.json",
                                           "first_look.json",
                                           "/",
                                           "\n",
                                           "ü"};
  return in.PickValueInArray(kTexts);
}

json odd(FuzzedDataProvider& in) {
  static constexpr double kOdd[] = {0,    1,    -1,   0.5,   2,  1e-9, 1e9, 1e308,        -1e308, 5e-324,
                                    1e-4, 4e-5, 1e15, 0.999, 10, 64,   6,   2147483648.0, 9.1e15, 1e5};
  switch (in.ConsumeIntegralInRange(0, 5)) {
    case 0:
      return in.ConsumeIntegral<std::int64_t>();
    case 1:
      return text(in);
    case 2:
      return in.ConsumeBool();
    case 3:
      return in.ConsumeBool() ? json() : json::array();
    default:
      return in.PickValueInArray(kOdd);
  }
}

double number(FuzzedDataProvider& in, const json& node) {
  const auto bound = [&](const char* inside, const char* outside, double otherwise) {
    return node.value(inside, node.value(outside, otherwise));
  };
  const double low = bound("minimum", "exclusiveMinimum", -1e6),
               high = std::max(low, bound("maximum", "exclusiveMaximum", 1e6));
  switch (in.ConsumeIntegralInRange(0, 7)) {
    case 0:
      return low;
    case 1:
      return high;
    case 2:
      return std::nextafter(in.ConsumeBool() ? low : high, in.ConsumeBool() ? 1e300 : -1e300);
    case 3:
      return in.ConsumeFloatingPointInRange(low, high);
    case 4:  // of any magnitude
      return std::clamp(std::pow(10.0, in.ConsumeFloatingPointInRange(-12.0, 9.0)), low, high);
    default:
      if (const json usual = node.value("usual", json()); usual.is_array() && usual.size() == 2)
        return in.ConsumeFloatingPointInRange(usual[0].get<double>(), usual[1].get<double>());
      if (const json standard = node.value("default", json()); standard.is_number())
        return standard.get<double>() * in.ConsumeFloatingPointInRange(0.2, 5.0);
      return std::clamp(in.ConsumeFloatingPointInRange(0.0, 2.0), low, high);
  }
}

/// A value of a type that the schema allows.
json fitting(FuzzedDataProvider& in, const std::string& key, int depth = 0) {
  const json* node = schema().find(key);
  if (!node || depth > 3) return odd(in);
  if (node->contains("enum"))
    return (*node)["enum"][in.ConsumeIntegralInRange<std::size_t>(0, (*node)["enum"].size() - 1)];
  json types = node->value("type", json("number"));
  if (types.is_string()) types = json::array({types});
  const std::string type = types[in.ConsumeIntegralInRange<std::size_t>(0, types.size() - 1)];
  if (type == "number") return number(in, *node);
  if (type == "integer") return static_cast<std::int64_t>(std::clamp(number(in, *node), -9e15, 9e15));
  if (type == "boolean") return in.ConsumeBool();
  if (type == "string") return text(in);
  if (type != "array") return nullptr;
  json list = json::array();
  const std::size_t least = std::min<std::size_t>(node->value("minItems", 0), 8);
  for (std::size_t k = least + in.ConsumeIntegralInRange<std::size_t>(0, 3); k > 0; --k)
    list.push_back(fitting(in, key + ".0", depth + 1));
  if (in.ConsumeBool()) std::sort(list.begin(), list.end());
  return list;
}

json start(FuzzedDataProvider& in) {
  const json bed{{"radius", 0.03}, {"length", 8.0}}, tire{{"file", "toroidal.json"}, {"rigid", true}};
  switch (in.ConsumeIntegralInRange(0, 4)) {
    case 0:
      return {{"tire", tire}, {"terrain", {{"engine", "rigid"}}}};
    case 1:
      return {
          {"tires", {tire, tire}}, {"terrain", bed}, {"rig", {{"wheels", {{{"lateral", -0.5}}, {{"lateral", 0.5}}}}}}};
    case 2:
      return {{"tire", tire}, {"terrain", {{"radius", 0.03}, {"length", 8.0}, {"material", "loose_sand.json"}}}};
    default:
      return {{"tire", {{"file", "toroidal.json"}}}, {"terrain", bed}};
  }
}

std::filesystem::path written(const char* name, const std::string& text) {
  return fuzz::input_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void check(const std::filesystem::path& file, const Settings& settings) {
  const scenario::Scenario s = scenario::load_scenario(file, settings);
  if (scenario::validation_text(s).empty()) __builtin_trap();
  scenario::validation_report(s).dump();
  if (scenario::load_scenario(written("again.json", s.completed), {}).digest != s.digest)
    __builtin_trap();  // completing a completed scenario must not change it
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  json document = start(in);
  Settings settings;
  for (int k = 0; k < 12 && in.remaining_bytes() > 2; ++k) {
    const std::string key = keys()[in.ConsumeIntegralInRange<std::size_t>(0, keys().size() - 1)];
    const json value = in.ConsumeIntegralInRange(0, 5) == 0 ? odd(in) : fitting(in, key);
    if (in.ConsumeBool()) {
      settings.emplace_back(key, value.dump());
      continue;
    }
    std::string pointer = "/" + key;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    try {
      document[json::json_pointer(pointer)] = value;
    } catch (const json::exception&) {  // below a value that is not a section
    }
  }
  try {
    check(written("scenario.json", document.dump()), settings);
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
