// Scenarios with valid keys and odd values, through all that `furrow validate` does.
#include <fuzzer/FuzzedDataProvider.h>

#include <nlohmann/json.hpp>

#include "nodes/scenario/explain.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/validate.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;
using nlohmann::json;

const std::vector<std::string>& keys() {
  static const std::vector<std::string> all = [] {
    const scenario::Schema schema = scenario::Schema::load();
    std::vector<std::string> names = schema.keys();
    for (const char* section : {"tires.0", "rig.wheels.0", "rig.wheels.1"})
      for (const std::string& name : schema.keys(section)) names.push_back(name);
    return names;
  }();
  return all;
}

json value_for(FuzzedDataProvider& in, const std::string& key, int depth = 0) {
  static constexpr double kOdd[] = {
      0,     1,     -1,   0.5,   2,  1e-9, 1e9, 1e308, -1e308, 5e-324, 1e-4, 4e-5, 0.03,         0.006,
      100.0, 1000., 1e15, 0.999, 10, 64,   6,   0.467, 1e5,    2e5,    9999, 1e6,  2147483648.0, 9.1e15};
  static constexpr const char* kTexts[] = {"",
                                           "auto",
                                           "mindlin",
                                           "coulomb",
                                           "rigid",
                                           "dem",
                                           "periodic",
                                           "walls",
                                           "lattice",
                                           "poisson",
                                           "fixed_speed",
                                           "free_rolling",
                                           "normal",
                                           "double",
                                           "hmmwv_layered.json",
                                           "toroidal.json",
                                           "passenger_205_55r16.json",
                                           "loose_sand.json",
                                           "cohesive_sand.json",
                                           "first_look.json",
                                           "/",
                                           "\n",
                                           "ü"};
  switch (in.ConsumeIntegralInRange(0, 9)) {
    case 0:
    case 1:
    case 2:
      return in.PickValueInArray(kOdd);
    case 3:
      return in.ConsumeFloatingPointInRange(-10.0, 10.0);
    case 4:
      return in.ConsumeIntegral<std::int64_t>();
    case 5:
      return in.PickValueInArray(kTexts);
    case 6:
      return in.ConsumeBool();
    case 7:
      return nullptr;
    case 8: {
      if (depth > 3) return json::array();
      json list = json::array();
      for (int k = in.ConsumeIntegralInRange(0, 5); k > 0; --k) list.push_back(value_for(in, key, depth + 1));
      return list;
    }
    default: {
      const json* node = nullptr;
      static const scenario::Schema schema = scenario::Schema::load();
      node = schema.find(key);
      if (node && node->contains("enum"))
        return (*node)["enum"][in.ConsumeIntegralInRange<std::size_t>(0, (*node)["enum"].size() - 1)];
      for (const char* bound : {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "default"})
        if (node && node->contains(bound) && in.ConsumeBool()) return (*node)[bound];
      return 1;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  json document{{"tire", {{"file", "toroidal.json"}}}, {"terrain", {{"radius", 0.03}, {"length", 3.0}}}};
  std::vector<std::pair<std::string, std::string>> settings;
  while (in.remaining_bytes() > 2 && settings.size() < 12) {
    const std::string key = keys()[in.ConsumeIntegralInRange<std::size_t>(0, keys().size() - 1)];
    const json value = value_for(in, key);
    if (in.ConsumeBool()) {
      settings.emplace_back(key, value.dump());
      continue;
    }
    std::string pointer = "/" + key;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    try {
      document[json::json_pointer(pointer)] = value;
    } catch (const json::exception&) {  // below something that is no section
    }
  }
  const std::string text = document.dump();
  try {
    const auto file =
        fuzz::input_file("scenario.json", reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const scenario::Scenario s = scenario::load_scenario(file, settings);
    scenario::validation_text(s);
    scenario::validation_report(s).dump();
    if (scenario::load_scenario(
            fuzz::input_file("again.json", reinterpret_cast<const std::uint8_t*>(s.completed.data()),
                             s.completed.size()),
            {})
            .digest != s.digest)
      __builtin_trap();  // a completed scenario is that scenario
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
