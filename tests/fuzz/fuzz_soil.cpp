// Soil files: the values of the section `terrain` that a scenario names by terrain.material.
#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  try {
    const auto file = fuzz::input_file("soil.json", data, size);
    scenario::read_soil_material(file);
    nlohmann::json document{{"terrain", {{"material", file.string()}, {"friction", 0.5}}}};
    scenario::apply_soil_material(document, file.parent_path() / "scenario.json", "dem");
    if (document["terrain"]["friction"] != 0.5) __builtin_trap();  // stated by the scenario itself
    scenario::override_soil_material(document, file.parent_path() / "scenario.json", "dem");
    scenario::override_soil_material(document, file.parent_path() / "scenario.json", "scm");
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
