// Fuzzes vehicle files and driver files with their tables of points. The document: {"vehicle": …, "driver": …, "csv": a
// text}
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"
#include "vehicle/driver/read_driver.hpp"
#include "vehicle/parts/vehicle.hpp"
#include "vehicle/spec/read_vehicle.hpp"

namespace {

using namespace furrow;

std::filesystem::path written(const std::string& name, const std::string& text) {
  return fuzz::input_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

template <class Work>
void one_message(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Json document = fuzz::parsed(data, size);
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (!document.is_object()) document = fuzz::Json::object();
  const auto part = [&](const char* key) {
    if (!document.contains(key)) return text;
    const fuzz::Json& found = document[key];
    return found.is_string() ? found.get<std::string>()
                             : found.dump(-1, ' ', false, fuzz::Json::error_handler_t::replace);
  };
  one_message([&] {
    const vehicle::VehicleSpec spec = vehicle::read_vehicle(written("vehicle.json", part("vehicle")));
    const vehicle::Vehicle car(spec);
    if (car.wheel_count() != 2 * static_cast<int>(spec.axles.size())) __builtin_trap();
  });
  one_message([&] {
    written("points.csv", part("csv"));
    vehicle::read_driver(written("driver.json", part("driver")));
  });
  return 0;
}
