// What a scenario says of its rig, read, completed and able to describe and to make it. The ranks, the checks and the
// tools know rigs by this interface and by Rig alone; rigs.cpp lists the kinds.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rigs/rig.hpp"

namespace furrow::rigs {

/// What a rig must know of a tire to say where its wheel goes.
struct WheelSize {
  double radius = 0.0;  // undeformed, m
  double width = 0.0;   // overall, m
};

struct WheelDescription {
  double lateral = 0.0;         // y of the mid-plane, m
  double from = 0.0, to = 0.0;  // x of the axle at start and end of the run, m
  double along = 0.0,
         across = 0.0;     // half of what the wheel takes of the bin along x and y as it turns and leans, m
  double toe_angle = 0.0;  // largest over the run, about +z, rad
  double camber_angle = 0.0;   // largest over the run, about the wheel's forward axis, rad
  std::optional<double> slip;  // that the rig imposes or aims at, -; none where it has no such thing
  double travel_sign = 1.0;    // +1 along +x, −1 along −x
  double carried_mass = 0.0;   // without the tire, kg
  std::string start_key;       // of the scenario, says where the axle starts
};

struct RigDescription {
  std::string kind;              // as results name it: "drawbar"
  std::string text;              // for people: "1 drawbar rig, fixed_speed"
  double speeds_up_until = 0.0;  // imposed motions are steady from then on, s
  std::string speeds_up_key;     // of the scenario, says so
  std::vector<WheelDescription> wheels;
};

class RigSpec {
 public:
  virtual ~RigSpec() = default;

  virtual std::size_t wheel_count() const = 0;
  /// With one size per wheel, for a run of `duration`, s.
  virtual RigDescription describe(std::span<const WheelSize> tires, double duration) const = 0;
  virtual std::unique_ptr<Rig> make() const = 0;

  /// Puts the axles for which the scenario names no start `margin` clear of the wall behind them, in a bin from x = 0
  /// to `length`, m; at x = 0 where there is no bin.
  virtual void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                           double margin) = 0;
  /// Writes what was filled in into the scenario's section.
  virtual void complete(nlohmann::json& section) const = 0;
};

}  // namespace furrow::rigs
