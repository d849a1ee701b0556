// Fuzzes tire files in our own and in the public layouts, with a scenario's changes: they are read, described,
// and meshed if that is quick. The document: {"file": a tire file, "pressure": …, "rigid": …, "around": …, "across": …}
#include <algorithm>

#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"
#include "tire/pressure_schedule.hpp"
#include "tire/tires.hpp"

namespace {

using namespace furrow;

constexpr int kQuick = 20000;  // vertices

/// The document's scenario keys that the scenario's schema accepts.
nlohmann::json section_of(const fuzz::Json& document, const std::string& file) {
  nlohmann::json section{{"file", file}};
  const auto take = [&](const char* from, const char* key, auto good) {
    if (const auto found = document.find(from); found != document.end() && good(*found))
      section[key] = nlohmann::json::parse(found->dump());
  };
  const auto number = [](const fuzz::Json& x) { return x.is_number() && std::abs(x.get<double>()) <= 1e8; };
  const auto within = [](int least, int most) {
    return [=](const fuzz::Json& x) { return x.is_number_integer() && x >= least && x <= most; };
  };
  take("pressure", "pressure", [&](const fuzz::Json& x) {
    if (number(x)) return x >= 0;
    return x.is_array() && !x.empty() && std::all_of(x.begin(), x.end(), [&](const fuzz::Json& knot) {
             return knot.is_array() && knot.size() == 2 && number(knot[0]) && number(knot[1]);
           });
  });
  take("rigid", "rigid", [](const fuzz::Json& x) { return x.is_boolean(); });
  take("around", "elements_circumference", within(8, 10000));
  take("across", "elements_width", within(6, 1000));
  return section;
}

void read(const nlohmann::json& section) {
  const auto spec = tire::read_tire(section, {"scenario.json", "tire"});
  const tire::PressureSchedule& pressure = spec->options().pressure;
  if (!pressure.empty())
    for (const double t : {-1.0, 0.0, 0.5, 1e9})
      if (!(std::abs(pressure.at(t)) <= (1.0 + 1e-12) * pressure.highest())) __builtin_trap();
  spec->unlikely_values();
  const tire::TireDescription description = spec->describe();
  if (description.vertices > kQuick) return;
  const tire::TireShape shape = spec->shape();
  if (static_cast<int>(shape.vertex.size()) != description.vertices) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Json document = fuzz::parsed(data, size);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (document.is_object() && document.contains("file")) text = document["file"].dump();
  if (!document.is_object()) document = fuzz::Json::object();
  try {
    const auto file = fuzz::input_file("tire.json", reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    read(section_of(document, file.string()));
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
