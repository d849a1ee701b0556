// A vehicle as its file describes it: read, checked, mirrored, in the vehicle's frame (x forward, y left, z up).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vehicle/spec/driveline_spec.hpp"
#include "vehicle/spec/steering_spec.hpp"
#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

enum Side { kLeft = 0, kRight = 1 };
inline constexpr std::array<const char*, 2> kSideNames{"left", "right"};
/// +1 on the left, −1 on the right: along y, outward.
inline double outward(int side) { return side == kLeft ? 1.0 : -1.0; }

/// One side of an axle.
struct CornerSpec {
  SuspensionSpec suspension;
  WheelSpec wheel;
  std::optional<BrakeSpec> brake;
};

struct AxleSpec {
  std::string name;
  Vec3 origin = Vec3::Zero();  // m
  std::array<CornerSpec, 2> corners;
  std::optional<SteeringSpec> steering;
};

struct VehicleSpec {
  std::string file;  // for messages
  std::string name;
  BodySpec chassis;
  std::vector<AxleSpec> axles;
  DrivelineSpec driveline;

  /// Index of an axle, or −1.
  int axle(const std::string& wanted) const {
    for (std::size_t k = 0; k < axles.size(); ++k)
      if (axles[k].name == wanted) return static_cast<int>(k);
    return -1;
  }
};

inline const SpindleSpec& spindle_of(const SuspensionSpec& suspension) {
  return std::visit([](const auto& s) -> const SpindleSpec& { return s.spindle; }, suspension);
}

/// Calls `call` with every Vec3 and Mat3 of a struct, in structs within it as well.
template <class T, class Call>
void for_each_vector(T& value, const Call& call) {
  if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, Mat3>)
    call(value);
  else if constexpr (HasFields<T>)
    visit_fields(value, [&](auto& field, const Field&) { for_each_vector(field, call); });
  else if constexpr (std::is_same_v<T, std::vector<LinkSpec>>)
    for (LinkSpec& link : value) for_each_vector(link, call);
  else if constexpr (requires { value.has_value(); })
    if (value) for_each_vector(*value, call);
}

/// The mirror image at the other side of the vehicle: y changes its sign.
template <class T>
T mirrored(T value) {
  struct Mirror {
    void operator()(Vec3& point) const { point.y() = -point.y(); }
    void operator()(Mat3& inertia) const {
      for (const int k : {0, 2}) inertia(1, k) = inertia(k, 1) = -inertia(k, 1);
    }
  };
  for_each_vector(value, Mirror{});
  return value;
}

/// A copy with all points moved by `by`, m.
template <class T>
T shifted(T value, const Vec3& by) {
  struct Shift {
    Vec3 by;
    void operator()(Vec3& point) const { point += by; }
    void operator()(Mat3&) const {}
  };
  for_each_vector(value, Shift{by});
  return value;
}

}  // namespace furrow::vehicle
