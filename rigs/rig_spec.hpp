// What a scenario says of its rig, read, completed and able to describe and to make it. The ranks, the checks and the
// tools know rigs by this interface and by Rig alone; rigs.cpp lists the kinds.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rigs/rig.hpp"
#include "tire/rim_properties.hpp"

namespace furrow::rigs {

/// What a rig must know of a tire to say where its wheel goes.
struct WheelSize {
  double radius = 0.0;  // undeformed, m
  double width = 0.0;   // overall, m
};

/// What a rig may take from a tire where the scenario leaves it open.
struct MountedTire {
  double radius = 0.0;                                             // undeformed, m
  double mass = 0.0;                                               // kg
  tire::RimProperties rim;                                         // as its file says
  std::string file;                                                // for messages
  double width = 0.0;                                              // overall, m
  double hopeless_load = std::numeric_limits<double>::infinity();  // that it never carries, N
};

/// A file that the section names, whose content decides results.
struct RigFile {
  std::string key;  // of the section: "vehicle"
  std::filesystem::path path;
};

struct WheelDescription {
  std::string name;             // that a vehicle's file gives it: "front_left"; empty: it has none
  double lateral = 0.0;         // y of the mid-plane, m
  double from = 0.0, to = 0.0;  // x of the axle at start and end of the run, m
  double along = 0.0,
         across = 0.0;             // half of what the wheel takes of the bin along x and y as it turns and leans, m
  double toe_angle = 0.0;          // largest over the run, about +z, rad
  double camber_angle = 0.0;       // largest over the run, about the wheel's forward axis, rad
  std::optional<double> slip;      // that the rig imposes or aims at, -; none where it has no such thing
  double travel_sign = 1.0;        // +1 along +x, −1 along −x
  double carried_mass = 0.0;       // without the tire, kg
  double unsprung_mass = 0.0;      // of that, what no spring is between it and the tire, at least, kg
  double spin_inertia = 0.0;       // of what turns with the wheel, without the tire, at least, kg m²
  double speed = 0.0;              // of the axle at full speed, m/s
  double tread_speed = 0.0;        // of the tread against the axle at full speed, m/s
  double lowering_time = 0.0;      // until the motions begin, s; 0: they begin at once
  double lowering_speed = 0.0;     // at which the wheel is let down, m/s; 0: it falls
  bool stops_before_wall = false;  // the run ends where it comes near the wall ahead, before its planned end
  std::string start_key;           // of the scenario, says where the axle starts
  double start_offset = 0.0;       // of the axle ahead of what that key places, m
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
  /// Fills in what the scenario leaves to the tires: masses, loads, dampers. Comes first, with one tire per wheel.
  /// @throws Error(bad_input) naming the keys where neither of them says it
  virtual void mount(std::span<const MountedTire> /*tires*/) {}
  /// With one size per wheel, for a run of `duration`, s.
  virtual RigDescription describe(std::span<const WheelSize> tires, double duration) const = 0;
  virtual std::unique_ptr<Rig> make() const = 0;
  /// Keys, and what is allowed but odd about their values. @pre fill_starts
  virtual std::vector<std::pair<std::string, std::string>> unlikely_values() const { return {}; }

  /// Puts the axles for which the scenario names no start each its own of `margins` clear of the wall behind them, in a
  /// bin from x = 0 to `length`, m; at x = 0 where there is no bin.
  virtual void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                           std::span<const double> margins) = 0;
  /// A run ends before a wheel comes nearer to an end wall than this, m; 0: it does not, and motions that are imposed
  /// must keep clear of it. After mount().
  virtual double stop_before_wall() const { return 0.0; }
  virtual std::vector<RigFile> files() const { return {}; }
  /// On the rig and its tires, W, m/s²: tilted on a slope, whose surface is level in W.
  virtual Vec3 gravity() const { return standard_gravity(); }
  /// Writes what was filled in into the scenario's section.
  virtual void complete(nlohmann::json& section) const = 0;
};

}  // namespace furrow::rigs
