#include "vehicle/driver/write_driver.hpp"

#include <nlohmann/json.hpp>

#include "vehicle/driver/driver.hpp"

namespace furrow::vehicle {
namespace {

using nlohmann::json;

json pairs(const DriverPoints& points) {
  json list = json::array();
  for (const auto& [first, second] : points) list.push_back({first, second});
  return list;
}

json gears(const DriverPoints& points) {
  json list = json::array();
  for (const auto& [time, gear] : points)
    list.push_back({time, gear == gear_request::automatic ? json("auto") : json(gear)});
  return list;
}

/// The numbers, texts and lists of a struct.
template <HasFields T>
void put_keys(const T& values, json& object) {
  visit_fields(values, [&](const auto& value, const Field& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::string>)
      object[field.name] = value;
    else if constexpr (std::is_same_v<Value, DriverPoints>)
      object[field.name] = pairs(value);
  });
}

/// Removes negative numbers, which stand for the vehicle's own values: in a file these keys are missing.
void remove_open(json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (object.contains(key) && object[key] < 0.0) object.erase(key);
}

json steering(const PathSteeringSpec& spec) {
  json object;
  put_keys(spec, object);
  std::visit(
      [&](const auto& law) {
        object["law"] = law.kName;
        put_keys(law, object);
      },
      spec.law);
  remove_open(object, {"lookahead_distance", "response_distance"});
  return object;
}

json path(const PathSpec& spec) {
  json object;
  put_keys(spec, object);
  std::visit(
      [&](const auto& shape) {
        object["kind"] = shape.kName;
        put_keys(shape, object);
      },
      spec.shape);
  object["steering"] = steering(spec.steering);
  return object;
}

}  // namespace

json driver_document(const DriverSpec& spec) {
  json document{{"format_version", 1}};
  json inputs = json::object();
  for (const auto& [key, points] : {std::pair{"throttle", &spec.inputs.throttle},
                                    {"brake", &spec.inputs.brake},
                                    {"steering", &spec.inputs.steering},
                                    {"lock", &spec.inputs.lock}})
    if (!points->empty()) inputs[key] = pairs(*points);
  if (!spec.inputs.gear.empty()) inputs["gear"] = gears(spec.inputs.gear);
  if (!inputs.empty()) document["inputs"] = inputs;
  if (spec.speed) {
    put_keys(*spec.speed, document["speed"]);
    remove_open(document["speed"], {"proportional", "integral"});
  }
  if (spec.path) document["path"] = path(*spec.path);
  return document;
}

}  // namespace furrow::vehicle
