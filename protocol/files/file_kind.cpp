#include "protocol/files/file_kind.hpp"

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/printable.hpp"

namespace furrow {
namespace {

struct Words {
  FileKind kind;
  const char* name;
  const char* use;
};

constexpr Words kWords[] = {
    {FileKind::scenario, "scenario", "'furrow run' takes scenarios"},
    {FileKind::study, "study", "'furrow sweep' takes studies"},
    {FileKind::calibration, "calibration", "'furrow calibrate' takes calibrations"},
    {FileKind::tire, "tire", "the key tire.file of a scenario takes tires"},
    {FileKind::soil, "soil", "the key terrain.material of a scenario takes soils"},
    {FileKind::vehicle, "vehicle", "the key rig.vehicle of a scenario takes vehicles"},
};

constexpr const char* kChronoTires[] = {"ANCFTire", "ReissnerTire", "RigidTire"};  // those that Furrow reads

constexpr std::string_view kOfSoils[] = {"format_version", "description", "terrain", "measured"};

const Words& words_of(FileKind kind) {
  return *std::find_if(std::begin(kWords), std::end(kWords), [&](const Words& one) { return one.kind == kind; });
}

/// Whether the document can be a soil, or a scenario with nothing but its terrain.
template <class Json>
bool reads_as_soil(const Json& document) {
  if (!document.is_object() || !document.contains("terrain")) return false;
  for (const auto& [key, value] : document.items())
    if (std::find(std::begin(kOfSoils), std::end(kOfSoils), key) == std::end(kOfSoils)) return false;
  return true;
}

template <class Json>
std::string text_at(const Json& document, const char* key) {
  return document.contains(key) && document[key].is_string() ? document[key].template get<std::string>()
                                                             : std::string();
}

/// A file of Project Chrono that Furrow does not read: "a Vehicle (WheeledVehicle)"; empty for any other file. Chrono's
/// keys begin with capitals and ours do not.
template <class Json>
std::string part_of_chrono(const Json& document) {
  if (!document.is_object() || document.contains("format_version")) return {};
  const std::string type = text_at(document, "Type"), name = text_at(document, "Template");
  if (!name.empty() && (type.empty() || type == "Tire") &&
      std::find(std::begin(kChronoTires), std::end(kChronoTires), name) != std::end(kChronoTires))
    return {};
  if (!type.empty() || !name.empty())
    return (type == "Engine" ? "an " : "a ") + (type.empty() ? "file" : type) + (name.empty() ? "" : " (" + name + ")");
  for (const char* ours : {"rig", "tire", "terrain", "run", "scenario", "chassis", "template", "model"})
    if (document.contains(ours)) return {};
  for (const auto& [key, value] : document.items())
    if (!key.empty() && key.front() >= 'A' && key.front() <= 'Z') return "a file with the key '" + key + "'";
  return {};
}

const char* instead_of_chrono(FileKind expected) {
  if (expected == FileKind::tire)
    return "of its tires the templates ANCFTire, ReissnerTire and RigidTire are read, and the tire property file "
           "(.tir) that a Pac02Tire names";
  if (expected == FileKind::vehicle) return "vehicle/data/hmmwv.json is Chrono's HMMWV as a vehicle file";
  return "its vehicles, suspensions, engines and terrains are not read";
}

}  // namespace

template <class Json>
std::optional<FileKind> kind_of_file(const Json& document) {
  if (!document.is_object()) return {};
  const auto has = [&](const char* key) { return document.contains(key); };
  if (has("calibrate")) return FileKind::calibration;
  if (has("scenario") && !has("terrain") && !has("tire")) return FileKind::study;
  if (has("chassis") && has("axles")) return FileKind::vehicle;
  if (!part_of_chrono(document).empty()) return {};
  if (has("template") || has("Template") || (has("model") && has("contact")) || has("tir")) return FileKind::tire;
  if (reads_as_soil(document) && !document["terrain"].empty()) return FileKind::soil;
  if (has("rig") || has("terrain") || has("tire") || has("tires")) return FileKind::scenario;
  return {};
}

template <class Json>
void refuse_other_kinds(const Json& document, FileKind expected, const std::string& file) {
  const Words& wanted = words_of(expected);
  if (const std::string part = part_of_chrono(document); !part.empty())
    throw input_error(file, "", "is {} of Project Chrono, expected a {}: {}", printable(part), wanted.name,
                      instead_of_chrono(expected));
  const std::optional<FileKind> kind = kind_of_file(document);
  if (!kind || *kind == expected) return;
  const bool could_be =
      expected == FileKind::soil || (expected == FileKind::scenario && !document.contains("measured"));
  if (could_be && reads_as_soil(document)) return;
  const Words& is = words_of(*kind);
  throw input_error(file, "", "is a {}, expected a {} ({})", is.name, wanted.name, is.use);
}

template std::optional<FileKind> kind_of_file(const nlohmann::json&);
template std::optional<FileKind> kind_of_file(const nlohmann::ordered_json&);
template void refuse_other_kinds(const nlohmann::json&, FileKind, const std::string&);
template void refuse_other_kinds(const nlohmann::ordered_json&, FileKind, const std::string&);

}  // namespace furrow
