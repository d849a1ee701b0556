// Studies: their runs, and the settings of each.
#include "nodes/study/study.hpp"
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  try {
    const study::Study study = study::load_study(fuzz::input_file("study.json", data, size));
    for (const auto& run : study.runs) {
      study::settings_of(run);
      study::text_of(run);
    }
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
