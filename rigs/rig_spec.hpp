// The rig section of a scenario, read and completed; it describes the rig and makes it. Ranks, checks and tools use
// rigs only through this interface and Rig; rigs.cpp lists the kinds.
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

struct WheelSize {
  double radius = 0.0;  // undeformed, m
  double width = 0.0;   // overall, m
  double beyond = 0.0;  // that grousers reach beyond the radius, m
};

/// Values that a rig may take from a tire if the scenario leaves them open.
struct MountedTire {
  double radius = 0.0;                                             // undeformed, m
  double mass = 0.0;                                               // kg
  tire::RimProperties rim;                                         // from its file
  std::string file;                                                // for messages
  double width = 0.0;                                              // overall, m
  double hopeless_load = std::numeric_limits<double>::infinity();  // that the tire can never carry, N
};

/// A file that the section names and whose content affects the results.
struct RigFile {
  std::string key;  // of the section: "vehicle"
  std::filesystem::path path;
};

struct WheelDescription {
  std::string name;             // from the vehicle's file: "front_left"; may be empty
  double lateral = 0.0;         // y of the mid-plane, m
  double from = 0.0, to = 0.0;  // x of the axle at start and end of the run, m
  double along = 0.0,
         across = 0.0;             // half of the space that the turning, leaning wheel takes along x and y, m
  double toe_angle = 0.0;          // largest over the run, about +z, rad
  double camber_angle = 0.0;       // largest over the run, about the wheel's forward axis, rad
  std::optional<double> slip;      // that the rig imposes or aims at, -; none if the rig has no such slip
  double travel_sign = 1.0;        // +1 along +x, −1 along −x
  double carried_mass = 0.0;       // without the tire, kg
  double unsprung_mass = 0.0;      // part of it without a spring above the tire, at least, kg
  double spin_inertia = 0.0;       // of the parts that turn with the wheel, without the tire, at least, kg m²
  double speed = 0.0;              // of the axle at full speed, m/s
  double tread_speed = 0.0;        // of the tread against the axle at full speed, m/s
  double lowering_time = 0.0;      // until the motions begin, s; 0: they begin at once
  double lowering_speed = 0.0;     // at which the wheel is lowered, m/s; 0: it falls
  bool stops_before_wall = false;  // the run ends early if the wheel comes near the wall ahead
  std::string start_key;           // of the scenario, sets where the axle starts
  double start_offset = 0.0;       // of the axle ahead of the place that this key sets, m
};

struct RigDescription {
  std::string kind;              // as in results: "drawbar"
  std::string text;              // for users: "1 drawbar rig, fixed_speed"
  double speeds_up_until = 0.0;  // imposed motions are steady from then on, s
  std::string speeds_up_key;     // key of the scenario that sets this time
  std::vector<WheelDescription> wheels;
};

class RigSpec {
 public:
  virtual ~RigSpec() = default;

  virtual std::size_t wheel_count() const = 0;
  /// Fills in what the scenario leaves to the tires: masses, loads, dampers. Call it first, with one tire per wheel.
  /// @throws Error(bad_input) naming the keys if neither scenario nor tire gives a value
  virtual void mount(std::span<const MountedTire> /*tires*/) {}
  /// Describes the rig, given one size per wheel, for a run of `duration`, s.
  virtual RigDescription describe(std::span<const WheelSize> tires, double duration) const = 0;
  virtual std::unique_ptr<Rig> make() const = 0;
  /// Keys with allowed but unlikely values, and what is unlikely about them. @pre fill_starts
  virtual std::vector<std::pair<std::string, std::string>> unlikely_values() const { return {}; }

  /// Places the axles whose start the scenario leaves open: wheel k clears the wall behind it by at least `margins[k]`,
  /// m. The bin extends from x = 0 to `length`, m; without a bin the axles start at x = 0.
  virtual void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                           std::span<const double> margins) = 0;
  /// Distance of a wheel from an end wall at which the run ends, m; 0: it does not end there, and imposed motions must
  /// keep clear of the wall. Call it after mount().
  virtual double stop_before_wall() const { return 0.0; }
  virtual std::vector<RigFile> files() const { return {}; }
  /// Acceleration of rig and tires, W, m/s²: tilted on a slope, whose surface is level in W.
  virtual Vec3 gravity() const { return standard_gravity(); }
  /// Writes the filled-in values into the scenario's section.
  virtual void complete(nlohmann::json& section) const = 0;
};

}  // namespace furrow::rigs
