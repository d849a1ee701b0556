// What later commands read back of a run: summary.json for resume, sweep and report, with the run's scenario.json and
// the soil.json of `furrow soil`. The document: {"summary": …, "scenario": …, "soil": …, "path": "drawbar_pull_N.mean"}
#include "nodes/checkpoint/run_summary.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/soil_estimate.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"

namespace {

using namespace furrow;

std::filesystem::path written(const std::string& name, const std::string& text) {
  return fuzz::input_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::string text_of(const fuzz::Json& document, const char* key) {
  return document.contains(key) ? document[key].dump() : "";
}

void look_up(const std::filesystem::path& run, const fuzz::Json& path) {
  const auto summary = checkpoint::read_summary(run);
  checkpoint::read_failed_summary(run);
  for (const char* usual : {"drawbar_pull_N.mean", "segments.0.to_step", "wheels.0.slip", "", "."})
    checkpoint::value_at(summary, usual);
  if (path.is_string()) checkpoint::value_at(summary, path.get<std::string>());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Json document = fuzz::parsed(data, size);
  if (!document.is_object()) return 0;
  const auto run = written("run/summary.json", text_of(document, "summary")).parent_path();
  written("run/summary_failed.json", text_of(document, "summary"));
  written("run/scenario.json", text_of(document, "scenario"));
  look_up(run, document.value("path", fuzz::Json()));
  try {
    if (terrain::soil::write_soil_estimate(run, written("soil.json", text_of(document, "soil"))).empty())
      __builtin_trap();
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
