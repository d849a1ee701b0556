#include "vehicle/spec/read_vehicle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_text.hpp"
#include "vehicle/spec/spec_reader.hpp"
#include "vehicle/spec/spec_rules.hpp"
#include "vehicle/spec/suspension_abilities.hpp"

namespace furrow::vehicle {
namespace {

constexpr int kFormatVersion = 1;
constexpr std::size_t kMostAxles = 16;

/// The alternative of a variant that the key `type` names.
template <class Variant, std::size_t k = 0>
Variant read_type(JsonReader reader) {
  if constexpr (k < std::variant_size_v<Variant>) {
    using Option = std::variant_alternative_t<k, Variant>;
    if (reader.text("type") != Option::kType) return read_type<Variant, k + 1>(reader);
    return read_spec<Option>(reader);
  } else {
    std::vector<std::string> types;
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (types.emplace_back(std::variant_alternative_t<i, Variant>::kType), ...);
    }
    (std::make_index_sequence<std::variant_size_v<Variant>>{});
    reader.fail("type", "is '" + reader.text("type") + "', expected " + one_of(types));
  }
}

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

CornerSpec read_left(JsonReader& reader, const Vec3& origin) {
  CornerSpec corner;
  const auto suspension = read_type<SuspensionSpec>(reader.child("suspension"));
  check_side(reader, suspension, kLeft);
  corner.suspension = moved(suspension, origin);
  corner.wheel = read_spec<WheelSpec>(reader.child("wheel"));
  reader.skip("brake");
  if (reader.given("brake")) corner.brake = read_spec<BrakeSpec>(reader.child("brake"));
  return corner;
}

CornerSpec read_right(JsonReader& reader, const CornerSpec& left, const Vec3& origin) {
  CornerSpec corner = left;
  corner.suspension = std::visit([](const auto& s) -> SuspensionSpec { return mirrored(s); }, left.suspension);
  corner.wheel = mirrored(left.wheel);
  reader.skip("right");
  if (!reader.given("right")) return corner;
  JsonReader right = reader.child("right");
  for (const char* key : {"suspension", "wheel", "brake"}) right.skip(key);
  if (right.has("suspension")) {
    const auto suspension = read_type<SuspensionSpec>(right.child("suspension"));
    const bool whole = can(kHasHousing, left.suspension);
    if (whole || suspension.index() != left.suspension.index())
      right.fail("suspension.type", whole ? "is given for a rigid axle, expected that of the whole axle alone"
                                          : "is not the left side's, expected the same");
    check_side(right, suspension, kRight);
    corner.suspension = moved(suspension, origin);
  }
  if (right.has("wheel")) corner.wheel = read_spec<WheelSpec>(right.child("wheel"));
  if (right.has("brake")) {
    corner.brake.reset();
    if (right.given("brake")) corner.brake = read_spec<BrakeSpec>(right.child("brake"));
  }
  right.finish();
  return corner;
}

AxleSpec read_axle(JsonReader reader) {
  AxleSpec axle;
  detail::take(reader, "name", axle.name);
  detail::take(reader, "origin", axle.origin);
  axle.corners[kLeft] = read_left(reader, axle.origin);
  axle.corners[kRight] = read_right(reader, axle.corners[kLeft], axle.origin);
  reader.skip("steering");
  if (reader.given("steering")) {
    auto steering = read_type<SteeringSpec>(reader.child("steering"));
    // A Pitman arm's points are in axes of its own, its origin is in the vehicle's.
    axle.steering = std::holds_alternative<RackSpec>(steering) ? moved(steering, axle.origin) : steering;
    if (!can(kHasTieRods, axle.corners[kLeft].suspension))
      reader.fail("steering", fmt::format("is given for a suspension without tie rods, expected the type {}",
                                          fmt::join(kinds_that_can(kHasTieRods), " or ")));
  }
  reader.finish();
  return axle;
}

/// Results write a name as one word.
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

/// An axle whose wheels sit on the arms of another.
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
  detail::take(reader, "name", vehicle.name);
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

}  // namespace furrow::vehicle
