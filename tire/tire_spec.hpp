// A scenario's description of a tire, read and completed. It describes its model and makes it. Ranks, checks and tools
// use tires only through this interface and Tire; tires.cpp lists the models.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/ground_heights.hpp"
#include "protocol/core/key.hpp"
#include "tire/pressure_schedule.hpp"
#include "tire/rim_properties.hpp"
#include "tire/tire.hpp"

namespace furrow::tire {

/// The section `tire` of a scenario. Every field is the key `tire.<name>`; null stands for the default.
struct TireOptions {
  static constexpr SchemaName kSchema{"tire", "The tire, and what the scenario changes of its file."};
  std::filesystem::path file;        // resolved
  PressureSchedule pressure;         // gauge, Pa; empty: the file's, constant
  double friction = -1.0;            // contact friction; negative: the file's
  double rolling_friction = -1.0;    // of grains on the tread; negative: as among grains
  int elements_circumference = 0;    // 0: the file's
  int elements_width = 0;            // 0: the file's; split over the sections in the file's proportions
  double structural_damping = -1.0;  // s; negative: the file's
  bool rigid = false;                // same surface, no deformation
  int grousers = 0;                  // of a rigid tire
  double grouser_height = -1.0;      // m; negative: not given
  double grouser_thickness = -1.0;   // m; negative: not given
  bool contact_tangent = false;      // contact forces follow the tire's motion within the step
  int substeps = 1;                  // of the tire in one communication step

  /// Sets the contact properties that the scenario states.
  void apply_to(ContactMaterial& contact) const {
    if (friction >= 0.0) contact.friction = contact.pair_friction = friction;
    contact.rolling_friction = rolling_friction;
  }
};

void visit_fields(FieldsOf<TireOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.file, key("file", "", not_empty().required(),
                    "Tire file, relative to the scenario, then to the folders rigs/ and tire/data/."));
  visit(s.pressure,
        key("pressure", "Pa",
            from(0, 1e8)
                .usual(5e3, 2e6)
                .shaped(
                    R"({"type": ["number", "array"], "minItems": 1, "maxItems": 10000, "entries": "[t, p] in s and Pa",
                      "items": {"type": "array", "minItems": 2, "maxItems": 2,
                                "items": {"type": "number", "minimum": -1e8, "maximum": 1e8}}})")
                .or_null(),
            "Inflation pressure above the atmosphere. A list of [t, p] in s and Pa makes it a function of time: "
            "straight between the entries, constant before the first and after the last. Rigid tires ignore it. null: "
            "as in the tire file."));
  visit(s.friction,
        key("friction", "-", from(0, 10).or_null(),
            "Coulomb coefficient of the tread; on grains and hard ground it holds as it stands. null: as in "
            "the tire file, or terrain.friction where that is less."));
  visit(s.rolling_friction,
        key("rolling_friction", "-", from(0, 10).or_null(),
            "Coefficient of rolling friction of grains on the tread: limit of the couple over "
            "normal force × radius of the grain. Engines dem and liggghts. null: as among grains."));
  visit(s.elements_circumference, key("elements_circumference", "", from(8, 10000).or_null(),
                                      "Shell elements around the tire. null: as in the tire file."));
  visit(s.elements_width, key("elements_width", "", from(6, 1000).multiple_of(2).or_null(),
                              "Shell elements across the tire from bead to bead. null: as in the tire file."));
  visit(s.structural_damping,
        key("structural_damping", "s", from(0, 10).usual(1e-5, 0.2).or_null(),
            "Time constant τ of the Kelvin–Voigt law, the factor of the strain rate. null: as in the tire file."));
  visit(s.rigid, key("rigid", "", "Hold the tire rigid: same surface and mass, but no deformation."));
  visit(s.grousers, key("grousers", "", from(0, 1000),
                        "Number of straight grousers across the tread of a rigid tire, evenly spaced. Radius, slip and "
                        "sinkage stay those of the tread beneath; mass and inertia those of the file."));
  visit(s.grouser_height, key("grouser_height", "m", above(0).to(1).usual(1e-3, 0.1).or_null(),
                              "Height of the grousers beyond the tread. Needed with grousers."));
  visit(s.grouser_thickness, key("grouser_thickness", "m", above(0).to(1).usual(5e-4, 0.1).or_null(),
                                 "Thickness of the grousers along the circumference. Needed with grousers."));
  visit(s.contact_tangent,
        key("contact_tangent", "",
            "Contact tangents: with each contact force the terrain sends how it changes with the tire's motion, and "
            "the tire applies that within its step. The coupling is then stable at several times the step. Rigid tires "
            "do not use it."));
  visit(s.substeps,
        key("substeps", "", from(1, 1000), "Number of steps that the tire takes in one communication step."));
}

/// Properties of a tire before its model is made. The reach of the inflated tire needs the model (reach.hpp).
struct TireDescription {
  std::string kind;                                      // in results: "ancf", "rigid"
  std::string name;                                      // for people: "layered shell"
  std::string details;                                   // for people: mesh, unknowns, pressure
  double radius = 0.0;                                   // undeformed, m
  double width = 0.0;                                    // overall, m
  double tread_width = 0.0;                              // m
  double section_height = 0.0;                           // from the rim to the tread, undeformed, m; 0: not known
  double grouser_height = 0.0, grouser_thickness = 0.0;  // beyond the tread; along it, m
  int coordinates = 0;                                   // unknowns
  int vertices = 0;                                      // of the contact surface
  int facets = 0;                                        // equal pieces around the circumference
  MassProperties mass;                                   // undeformed, about the rim's centre
  double memory = 0.0;                                   // that the model needs, bytes
  double saved_bytes = 0.0;                              // in a checkpoint
  bool takes_tangents = false;                           // contact forces may follow its motion
  bool deflects = true;                                  // false: no load deforms it
  bool follows_rim = false;        // its surface is a function of the rim's state alone: Tire::surface_on
  std::vector<std::string> takes;  // names in TireOptions that the model uses: "pressure"
  /// Why the tire computes its contact by a law of its own (Tire::stated_contact): "its forces are those of …". Empty
  /// if it does not.
  std::string own_contact;
  bool own_contact_in_plane = false;  // it takes ground alone that is alike across
  /// Contact forces come one step late, which adds energy to a tire whose own damping is slower. Steps of at most
  /// `step_share` of `damping_time` are good; with a share of 0 any step is good.
  double damping_time = 0.0;  // s
  double step_share = 0.0;    // -
  /// For a tire with its own contact law, under its nominal load: N/m upwards; N/m along if slip relaxes over a length,
  /// N s/m along if it does not. 0: does not apply.
  double vertical_stiffness = 0.0, grip_stiffness = 0.0, grip_damping = 0.0;
  double contact_length = 0.0;  // likewise, m
  double most_load = 0.0;       // that its file was measured up to, N; 0: not known
  /// Why this tire can be pressed but not made and run: "whose key 'integrator' is …"; empty: it can.
  std::string static_only;
  NamedValues model;  // further properties of this model: "layers"
};

/// Settings of a model's computation, and gravity. The model chooses values that are not given.
struct TireContext {
  int threads = 1;
  std::optional<double> tolerance = {};  // of the solver's residual, relative
  std::optional<double> renewal = {};    // change of shape at which the solver renews its factors
  Vec3 gravity = standard_gravity();     // m/s²
  // For tires with a contact of their own.
  std::optional<double> ground_friction = {};  // where the scenario states it, -
  GroundHeights ground_heights = {};
  GroundProfilePoints ground_profile = {};  // the same, where own_contact_in_plane
  std::function<void()> alive = {};         // called now and then while the tire is inflated; may throw to stop
};

class TireSpec;

/// Names in TireOptions that the scenario states although the tire's model does not use them.
std::vector<std::string> idle_keys(const TireSpec& tire);

class ModalTest;
class StaticTest;

class TireSpec {
 public:
  explicit TireSpec(TireOptions options) : options_(std::move(options)) {}
  virtual ~TireSpec() = default;

  const TireOptions& options() const { return options_; }
  /// The rim as the tire's file describes it.
  const RimProperties& rim() const { return rim_; }
  void set_rim(const RimProperties& rim) { rim_ = rim; }
  virtual TireDescription describe() const = 0;
  /// @throws Error(bad_input)
  virtual std::unique_ptr<Tire> make(const TireContext& context = {}) const = 0;
  /// The undeformed shape. The key tire.rigid keeps any model in this shape.
  virtual TireShape shape() const = 0;
  /// Keys of the tire's file whose values seem to be in a wrong unit, and what is odd about them.
  virtual std::vector<std::pair<std::string, std::string>> unlikely_values() const { return {}; }
  /// Other files that the tire's file names. A digest counts their contents.
  virtual std::vector<std::filesystem::path> files() const { return {}; }
  /// Static pressing on an obstacle (press.hpp); null if the model has none.
  virtual std::unique_ptr<StaticTest> static_test() const;
  /// Natural frequencies (modes.hpp); null if the model has none.
  virtual std::unique_ptr<ModalTest> modal_test() const;

 private:
  TireOptions options_;
  RimProperties rim_;
};

}  // namespace furrow::tire
