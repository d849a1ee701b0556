// What `furrow resume` reads before it starts ranks: the run's scenario, the manifest of the checkpoint with a checksum
// that fits, and the series up to its marks. The document: {"scenario": …, "settings": {"run.end": 2}, "manifest": …,
// "before": a patch to the completed scenario that the manifest holds, "failed": …, "lines": "0,1,…\n"}
#include <algorithm>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/output/table.hpp"
#include "nodes/output/wheel_row.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/json_mutator.hpp"

namespace {

using namespace furrow;

std::filesystem::path written(const std::string& name, const std::string& text) {
  return fuzz::input_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

/// The scenario as the run keeps it; null when it is none. Most inputs have the same.
fuzz::Json completed(const std::string& scenario) {
  static std::string known, result;
  if (scenario != known) {
    known = scenario, result = "null";
    try {
      result = scenario::load_scenario(written("run/scenario.json", scenario), {}).completed;
    } catch (const Error&) {
    }
  }
  return fuzz::Json::parse(result);
}

std::vector<std::pair<std::string, std::string>> settings_in(const fuzz::Json& document) {
  std::vector<std::pair<std::string, std::string>> settings;
  if (const auto found = document.find("settings"); found != document.end() && found->is_object())
    for (const auto& [key, value] : found->items()) settings.emplace_back(key, value.dump());
  return settings;
}

/// The manifest with the scenario, the part and the checksum that it should have, unless it says otherwise.
std::string signed_manifest(const fuzz::Json& document) {
  fuzz::Json manifest = document.value("manifest", fuzz::Json());
  if (!manifest.is_object()) return manifest.dump();
  if (!manifest.contains("scenario")) {
    manifest["scenario"] = completed(document.value("scenario", fuzz::Json()).dump());
    if (const auto patch = document.find("before"); patch != document.end()) manifest["scenario"].merge_patch(*patch);
  }
  if (!manifest.contains("parts")) {
    fuzz::Json part{{"file", "rig.h5"}};
    part["checksum"] = file_hash(fuzz::folder() / "run/checkpoints/000000000010/rig.h5");
    manifest["parts"] = fuzz::Json::array({part});
  }
  manifest.erase("checksum");
  manifest["checksum"] = text_hash(manifest.dump());
  return manifest.dump();
}

/// The lines as a series, from marks of the manifest with a checksum that fits.
void read_series(const checkpoint::CheckpointManifest& manifest, const std::string& lines) {
  output::Table table{"wheel0", columns_of<output::WheelRow>(), {}};
  std::string text;
  for (const Column& column : table.columns) text += (text.empty() ? "" : ",") + std::string(column.name);
  text += '\n' + lines;
  const auto file = written("run/timeseries.csv", text);
  for (checkpoint::SeriesMark mark : manifest.series) {
    mark.checksum = text_hash(text.substr(0, static_cast<std::size_t>(mark.bytes)));
    try {
      output::TableWriter(file, mark, table);
    } catch (const Error&) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Json document = fuzz::parsed(data, size);
  if (!document.is_object()) return 0;
  written("run/checkpoints/000000000010/rig.h5", "a part");
  try {
    const auto manifest = written("run/checkpoints/000000000010/manifest.json", signed_manifest(document));
    const auto run = written("run/scenario.json", document.value("scenario", fuzz::Json()).dump()).parent_path();
    written("run/summary_failed.json", document.value("failed", fuzz::Json()).dump());
    const fuzz::Json lines = document.value("lines", fuzz::Json());
    const checkpoint::CheckpointManifest read = checkpoint::read_checkpoint(manifest.parent_path());
    read.frames.index(read.step);
    if (lines.is_string()) read_series(read, lines.get<std::string>());
    checkpoint::plan_resume(run, settings_in(document));
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
