// Fuzzes scenario files: their JSON, the schema's errors, defaults and warnings.
#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  static const scenario::Schema& schema = scenario::Schema::of_scenarios();
  try {
    const auto file = fuzz::input_file("scenario.json", data, size);
    nlohmann::json document = load_json(file, "a scenario");
    schema.normalize(document);
    if (!schema.problems(document).empty()) return 0;
    schema.fill_defaults(document);
    schema.normalize(document);
    schema.unusual(document);
    if (!schema.problems(document).empty()) __builtin_trap();  // defaults must not make mistakes
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
