#include "vehicle/spec/read_vehicle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <variant>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"
#include "vehicle/spec/part_keys.hpp"
#include "vehicle/spec/spec_reader.hpp"
#include "vehicle/spec/spec_rules.hpp"
#include "vehicle/spec/suspension_abilities.hpp"

namespace furrow::vehicle {
namespace {

constexpr int kFormatVersion = 1;
constexpr std::size_t kMostAxles = 16;

/// Keys of an axle's right side that differ from the left.
struct RightKeys {
  static constexpr SchemaName kSchema{"right",
                                      "Parts of the right side that are not the mirror image of the left side."};
  std::optional<SuspensionSpec> suspension;
  std::optional<WheelSpec> wheel;
  std::optional<BrakeSpec> brake;
};
void visit_fields(FieldsOf<RightKeys> auto& s, auto&& visit) {
  visit(s.suspension, key("suspension", "", "Suspension of the right side."));
  visit(s.wheel, key("wheel"));
  visit(s.brake, key("brake"));
}

struct AxleKeys {
  static constexpr SchemaName kSchema{"axle",
                                      "Two wheels. The left side is given; the right side is its mirror image."};
  std::string name;
  Vec3 origin = Vec3::Zero();  // m
  SuspensionSpec suspension;
  WheelSpec wheel;
  std::optional<BrakeSpec> brake;
  std::optional<SteeringSpec> steering;
  std::optional<RightKeys> right;
};
void visit_fields(FieldsOf<AxleKeys> auto& s, auto&& visit) {
  visit(s.name, needed("name", "", allowed::not_empty(), "Name of the axle, in messages and for the driveline."));
  visit(s.origin, needed("origin", "m", keys::kPoint,
                         "Origin from which the axle's points are measured, in the vehicle's frame."));
  visit(s.suspension, needed("suspension", "", "Suspension of the left side."));
  visit(s.wheel, needed("wheel"));
  visit(s.brake, key("brake"));
  visit(s.steering, key("steering", "", "Steering of the axle. Without this key it is not steered."));
  visit(s.right, key("right"));
}

void check_spec(const RightKeys&, const JsonReader&) {}
void check_spec(const AxleKeys&, const JsonReader&) {}

template <class Variant>
Variant moved(const Variant& part, const Vec3& by) {
  return std::visit([&](const auto& s) -> Variant { return shifted(s, by); }, part);
}

void check_side(const JsonReader& reader, const SuspensionSpec& suspension, int side) {
  const double y = spindle_of(suspension).center.y();
  if (!(y * outward(side) > 0.0))
    reader.fail("suspension.spindle.center",
                fmt::format("lies at y = {}, expected a point on the {}", number_text(y), kSideNames[side]));
}

/// The right side: the left side with the changes of `right`. @param reader of the axle
CornerSpec right_corner(const AxleKeys& axle, JsonReader reader) {
  CornerSpec corner;
  corner.suspension =
      std::visit([](const auto& s) -> SuspensionSpec { return mirrored(s); }, moved(axle.suspension, axle.origin));
  corner.wheel = mirrored(axle.wheel);
  corner.brake = axle.brake;
  if (!axle.right) return corner;
  const JsonReader right = reader.child("right");
  if (axle.right->suspension) {
    const bool whole = can(kHasHousing, axle.suspension);
    if (whole || axle.right->suspension->index() != axle.suspension.index())
      right.fail("suspension.type", whole ? "is given for a rigid axle, expected that of the whole axle alone"
                                          : "is not the left side's, expected the same");
    check_side(right, *axle.right->suspension, kRight);
    corner.suspension = moved(*axle.right->suspension, axle.origin);
  }
  if (axle.right->wheel) corner.wheel = *axle.right->wheel;
  if (right.has("brake")) corner.brake = axle.right->brake;  // null: none
  return corner;
}

AxleSpec read_axle(const JsonReader& reader) {
  const auto keys = read_spec<AxleKeys>(reader);
  check_side(reader, keys.suspension, kLeft);
  AxleSpec axle;
  axle.name = keys.name;
  axle.origin = keys.origin;
  axle.corners[kLeft] = {moved(keys.suspension, keys.origin), keys.wheel, keys.brake};
  axle.corners[kRight] = right_corner(keys, reader);
  if (!keys.steering) return axle;
  // A Pitman arm's points are in its own axes, its origin in the vehicle's frame.
  axle.steering =
      std::holds_alternative<RackSpec>(*keys.steering) ? moved(*keys.steering, keys.origin) : *keys.steering;
  if (!can(kHasTieRods, keys.suspension))
    reader.fail("steering", fmt::format("is given for a suspension without tie rods, expected the type {}",
                                        fmt::join(kinds_that_can(kHasTieRods), " or ")));
  return axle;
}

/// Checks that names also differ as one word, since results write them so.
void check_name(const VehicleSpec& vehicle, const std::string& name, const JsonReader& reader, const std::string& key) {
  const auto word = [](std::string text) {
    std::replace(text.begin(), text.end(), ' ', '_');
    return text;
  };
  if (name == "chassis") reader.fail(key, "'chassis' is taken, expected another name");
  for (const AxleSpec& axle : vehicle.axles)
    if (word(axle.name) == word(name))
      reader.fail(key, axle.name == name ? "'" + name + "' is taken, expected another name"
                                         : "'" + name + "' is '" + axle.name +
                                               "' where results write it as one word, expected another name");
}

/// Checks axles whose wheels are on the arms of another axle.
void check_hosts(const VehicleSpec& vehicle, const JsonReader& reader) {
  for (std::size_t k = 0; k < vehicle.axles.size(); ++k) {
    const auto* fixed = std::get_if<FixedSpec>(&vehicle.axles[k].corners[kLeft].suspension);
    if (fixed == nullptr || !fixed->on) continue;
    const int host = vehicle.axle(*fixed->on);
    if (host < 0 || !can(kHasArms, vehicle.axles[host].corners[kLeft].suspension))
      reader.fail(fmt::format("axles[{}].suspension.on", k),
                  "is '" + *fixed->on + "', expected the name of an axle with trailing arms");
  }
}

}  // namespace

VehicleSpec read_vehicle(const std::filesystem::path& file) {
  return read_vehicle(load_json(file, "a vehicle file in JSON"), file.string());
}

VehicleSpec read_vehicle(const nlohmann::json& document, const std::string& file) {
  refuse_other_kinds(document, FileKind::vehicle, file);
  JsonReader reader(document, file);
  reader.check_version(kFormatVersion, true);
  for (const char* key : {"source", "$schema"}) reader.skip(key);
  VehicleSpec vehicle;
  vehicle.file = file;
  detail::take(reader, needed("name"), vehicle.name);
  vehicle.chassis = read_spec<BodySpec>(reader.child("chassis"));
  const nlohmann::json& axles = reader.array("axles");
  if (axles.empty() || axles.size() > kMostAxles)
    reader.fail("axles", fmt::format("has {} entries, expected 1 to {} axles", axles.size(), kMostAxles));
  for (std::size_t i = 0; i < axles.size(); ++i) {
    AxleSpec axle = read_axle(JsonReader(axles[i], file, detail::entry_path("axles", i)));
    check_name(vehicle, axle.name, reader, fmt::format("axles[{}].name", i));
    vehicle.axles.push_back(std::move(axle));
  }
  check_hosts(vehicle, reader);
  reader.skip("driveline");
  if (reader.given("driveline")) {
    vehicle.driveline = read_spec<DrivelineSpec>(reader.child("driveline"));
    check_driveline(vehicle, reader.child("driveline"));
  }
  reader.finish();
  return vehicle;
}

nlohmann::ordered_json vehicle_schema() {
  using Json = nlohmann::ordered_json;
  SchemaWriter writer;
  Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Furrow vehicle file"}};
  root.update(
      object_schema("A vehicle. SI units, angles in degrees, engine speeds in rpm. Frame: x forward, y left, z up."));
  const auto add = [&](const Key& key, const char* type) { add_key(root, key, key_schema(key, type, nullptr)); };
  add(key("$schema", "", allowed::optional(), "Path of this schema, for editors."), "string");
  add(needed("format_version", "", allowed::shaped(R"({"const": 1})"), "Version of this layout."), "");
  add(needed("name", "", allowed::not_empty(), "Name for reports."), "string");
  add(key("source", "", allowed::optional(), "Where the numbers come from; [estimate] marks those without a source."),
      "string");
  add_key(root, needed("chassis"), writer.reference<BodySpec>());
  const Key axles = needed("axles", "", allowed::shaped(R"({"type": "array", "minItems": 1, "maxItems": 16})"),
                           "The axles from front to rear.");
  Json list = key_schema(axles, "", nullptr);
  list["items"] = writer.reference<AxleKeys>();
  add_key(root, axles, list);
  add_key(root, key("driveline"), writer.reference<DrivelineSpec>());
  // null removes the brake of the left side.
  Json& brake = writer.definitions["right"]["properties"]["brake"];
  brake = {{"oneOf", {brake, {{"type", "null"}}}}, {"description", "Brake of the right wheel. null: none."}};
  root["definitions"] = writer.definitions;
  return root;
}

}  // namespace furrow::vehicle
