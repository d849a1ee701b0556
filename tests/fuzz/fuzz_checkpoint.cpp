// Checkpoints: the manifest as it comes, once more with a checksum that fits, and the series that it marks.
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/output/table.hpp"
#include "nodes/output/wheel_row.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;

void read(const std::uint8_t* data, std::size_t size) {
  try {
    const auto file = fuzz::input_file("000000000010/manifest.json", data, size);
    const checkpoint::CheckpointManifest manifest = checkpoint::read_checkpoint(file.parent_path());
    manifest.frames.index(manifest.step);
  } catch (const Error&) {
  }
}

/// The input as a series, from a mark that fits its bytes.
void read_series(const std::uint8_t* data, std::size_t size) {
  try {
    output::Table table{"wheel0", columns_of<output::WheelRow>(), {}};
    std::string text;
    for (const Column& column : table.columns) text += (text.empty() ? "" : ",") + std::string(column.name);
    text += '\n' + std::string(reinterpret_cast<const char*>(data), size);
    Hash hash;
    hash.add(text);
    const auto file =
        fuzz::input_file("timeseries.csv", reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    output::TableWriter(file, {static_cast<std::int64_t>(text.size()), 2, hash.hex(), "wheel0"}, table);
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read(data, size);
  read_series(data, size);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(data, data + size, nullptr, false);
  if (!json.is_object()) return 0;
  json.erase("checksum");
  try {
    Hash hash;
    hash.add(json.dump());
    json["checksum"] = hash.hex();
    const std::string text = json.dump();
    read(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  } catch (const nlohmann::json::exception&) {  // not UTF-8: cannot be signed
  }
  return 0;
}
