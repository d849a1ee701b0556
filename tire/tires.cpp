#include "tire/tires.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/ancf/shell_spec.hpp"
#include "tire/handling/handling_spec.hpp"
#include "tire/planar/planar_file.hpp"
#include "tire/planar/planar_spec.hpp"
#include "tire/rigid/rigid_spec.hpp"
#include "tire/rim_properties.hpp"
#include "tire/ring/ring_spec.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

/// Schema definition of a model's files, with the keys that all models share.
template <HasFields File>
nlohmann::ordered_json add_keys_of(SchemaWriter& writer, std::string_view model, bool is_default) {
  nlohmann::ordered_json file = object_schema(File::kSchema.description);
  const auto add = [&](const Key& key, const char* type) { add_key(file, key, key_schema(key, type, nullptr)); };
  add(key("$schema", "", allowed::optional(), "Path of this schema, for editors."), "string");
  add(needed("format_version", "", allowed::shaped(R"({"const": 1})"), "Version of this layout."), "");
  nlohmann::ordered_json name{{"const", model}, {"description", "Model that the file describes."}};
  if (is_default) name["default"] = model;
  add_key(file, is_default ? key("model") : needed("model"), name);
  add(key("name", "", allowed::optional(), "Name for reports."), "string");
  add(key("source", "", allowed::optional(), "Where the data come from."), "string");
  add_key(file, key("rim"), writer.reference<RimProperties>());
  writer.add_keys<File>(file);
  return file;
}

constexpr auto kModels = std::to_array<TireModel>({
    {"shell", read_shell, add_keys_of<TireFile>},
    {"ring", read_ring, add_keys_of<RingFile>},
    {"planar", read_planar, add_keys_of<PlanarFile>},
    {"handling", read_handling, add_keys_of<HandlingFile>},
});
// Model names reserved for later.
constexpr std::array<std::string_view, 1> kLater{"wheel"};

const TireModel& model_of(const json& document, const std::string& file) {
  JsonReader reader(document, file);
  if (!reader.has("model")) return kModels.front();
  const std::string name = reader.text("model");
  std::vector<std::string> valid;
  for (const TireModel& model : kModels) {
    if (model.name == name) return model;
    valid.emplace_back(model.name);
  }
  const bool later = std::find(kLater.begin(), kLater.end(), name) != kLater.end();
  reader.fail("model", fmt::format("is '{}', {}expected {}", name,
                                   later ? "which is not available in this version, " : "", one_of(valid)));
}

/// The block `rim` of any model's file.
RimProperties rim_of(const json& document, const std::string& file) {
  RimProperties rim;
  if (!document.contains("rim")) return rim;
  JsonReader whole(document, file);
  JsonReader reader = whole.child("rim");
  read_keys(reader, rim);
  reader.finish();
  return rim;
}

/// Checks the rules of a schedule that a schema cannot express.
void check(const PressureSchedule& schedule, const std::string& key, const std::string& file) {
  for (std::size_t k = 0; k < schedule.knots.size(); ++k) {
    const PressureSchedule::Knot& knot = schedule.knots[k];
    const std::string here = fmt::format("{}.{}", key, k);
    if (knot.pressure < 0.0)
      throw input_error(file, here + ".1", fmt::format("is {} Pa, expected 0 or more", number_text(knot.pressure)));
    if (k > 0 && !(knot.time > schedule.knots[k - 1].time))
      throw input_error(file, here + ".0",
                        fmt::format("is {} s, expected a time after that of the entry before, {} s",
                                    number_text(knot.time), number_text(schedule.knots[k - 1].time)));
  }
}

void check_grousers(const TireOptions& o, const TireDescription& tire, const ReadContext& context) {
  const auto refuse = [&](const char* key, const std::string& what) {
    throw input_error(context.file, context.key(key), what);
  };
  const bool height = o.grouser_height > 0.0, thickness = o.grouser_thickness > 0.0;
  if (o.grousers == 0) {
    if (height || thickness)
      refuse(height ? "grouser_height" : "grouser_thickness", "is given, expected the number of 'grousers' as well");
    return;
  }
  if (std::ranges::find(tire.takes, "grousers") == tire.takes.end())
    refuse("grousers", fmt::format("is {}, expected 0 for a tire that is not rigid (tire.rigid)", o.grousers));
  if (!height || !thickness)
    refuse(height ? "grouser_thickness" : "grouser_height", "is not given, expected above 0 m for grousers");
  if (o.grouser_height >= tire.radius)
    refuse("grouser_height", fmt::format("is {} m, expected less than the radius of {} m",
                                         number_text(o.grouser_height), number_text(tire.radius)));
  if (const double pitch = 2.0 * std::numbers::pi * tire.radius / o.grousers; o.grouser_thickness >= pitch)
    refuse("grouser_thickness", fmt::format("is {} m, expected less than the pitch of {} grousers, {:.4g} m",
                                            number_text(o.grouser_thickness), o.grousers, pitch));
}

}  // namespace

std::span<const TireModel> tire_models() { return kModels; }

std::unique_ptr<TireSpec> read_tire(const TireOptions& options) {
  const json document =
      is_tir(options.file) ? tire_file_of_tir(options.file) : load_json(options.file, "a tire file in JSON");
  refuse_other_kinds(document, FileKind::tire, options.file.string());
  const bool wheel = document.contains("Template") && document["Template"] == kRigidWheel;
  std::unique_ptr<TireSpec> spec =
      wheel ? read_rigid_wheel(document, options) : model_of(document, options.file.string()).read(document, options);
  if (options.rigid) spec = make_rigid(std::move(spec));
  spec->set_rim(rim_of(document, options.file.string()));
  return spec;
}

std::shared_ptr<const TireSpec> read_tire(const json& section, const ReadContext& context) {
  TireOptions options;
  read_fields(section, options);
  options.file = find_file(options.file.string(), context.key("file"), context.file);
  check(options.pressure, context.key("pressure"), context.file);
  std::shared_ptr<const TireSpec> spec = read_tire(options);
  check_grousers(options, spec->describe(), context);
  if (!options.contact_tangent) return spec;
  if (const TireDescription tire = spec->describe(); !tire.takes_tangents)
    throw input_error(
        context.file, context.key("contact_tangent"),
        fmt::format("is true, expected false for a {}{}", tire.name, tire.name.ends_with("tire") ? "" : " tire"));
  return spec;
}

std::unique_ptr<Tire> make_tire(const TireOptions& options) { return read_tire(options)->make(); }

nlohmann::ordered_json tire_schema() {
  SchemaWriter writer;
  nlohmann::ordered_json root = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                                 {"title", "Furrow tire file"},
                                 {"description", "Keys of a tire file: one definition for each model. SI units."}};
  writer.definitions["one_or_three"] = nlohmann::ordered_json::parse(R"({
    "anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}]})");
  writer.definitions["section"] = nlohmann::ordered_json::parse(R"({
    "type": "object", "additionalProperties": false, "required": ["elements_per_side", "layers"],
    "properties": {
      "elements_per_side": {"type": "integer", "minimum": 1, "maximum": 500,
                            "description": "Elements across this band on each side."},
      "layers": {"type": "array", "minItems": 1, "description": "Layers of the band, from the inside outwards.",
        "items": {"type": "object", "additionalProperties": false, "required": ["thickness", "angle_deg", "material"],
          "properties": {
            "thickness": {"type": "number", "exclusiveMinimum": 0, "unit": "m",
                          "description": "Thickness of the layer."},
            "angle_deg": {"type": "number", "unit": "deg",
                          "description": "Fibre direction from the circumferential direction towards +y (left)."},
            "material": {"type": "string", "description": "One of the names under materials."}}}}}})");
  for (const TireModel& model : kModels) {
    const std::string name(model.name);
    root["oneOf"].push_back({{"$ref", "#/definitions/" + name}});
    nlohmann::ordered_json file = model.schema(writer, name, &model == kModels.begin());
    writer.definitions[name] = std::move(file);
  }
  root["definitions"] = writer.definitions;
  return root;
}

}  // namespace furrow::tire
