// Studies, soil files, and the results that later commands read back: summary.json, scenario.json and soil.json.
#include <fuzzer/FuzzedDataProvider.h>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "nodes/study/study.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/soil_estimate.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;

template <class F>
void attempt(F&& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

std::filesystem::path written(const char* name, const std::string& text) {
  return fuzz::input_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      attempt([&] {
        const study::Study study = study::load_study(written("study.json", text));
        for (const auto& run : study.runs) study::settings_of(run);
      });
      break;
    case 1:
      attempt([&] { scenario::read_soil_material(written("soil.json", text)); });
      break;
    case 2:
      attempt([&] {
        const auto summary = checkpoint::read_summary(written("run/summary.json", text).parent_path());
        for (const char* path : {"drawbar_pull_N.mean", "segments", "wheels.0.slip", "0", ""})
          checkpoint::value_at(summary, path);
      });
      break;
    default:
      attempt([&] {
        const std::size_t half = text.find('\n');
        const std::string rest = half == std::string::npos ? text : text.substr(half + 1);
        const auto run = written("run/summary.json", text.substr(0, half)).parent_path();
        written("run/scenario.json", "{}");
        terrain::soil::write_soil_estimate(run, written("soil.json", rest));
      });
  }
  return 0;
}
