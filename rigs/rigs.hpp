// The kinds of rigs by their names in scenarios. A new kind is one entry of the table in rigs.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"
#include "rigs/wheel_tire.hpp"

namespace furrow::rigs {

/// Keys of the section `rig` that every kind has: every field is the key `rig.<name>`.
struct RigOptions {
  std::string type = "drawbar";
  int substeps = 1;          // of the rig in one communication step
  double drop_height = 0.0;  // of all tires above the ground at t = 0, m
};

void visit_fields(FieldsOf<RigOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.type, key("type", "", "Kind of rig."));
  visit(s.substeps,
        key("substeps", "", from(1, 1000), "Number of steps that the rig takes in one communication step."));
  visit(
      s.drop_height,
      key("drop_height", "m", from(0, 100),
          "Height that the tires fall before they meet the ground, beyond the gap they start with. The damper of "
          "touchdown_damping slows the fall unless that is 0. A vehicle falls freely unless lowering_speed is given."));
}

struct RigKind {
  const char* name;  // rig.type
  const char* says;  // its function, for the description of that key: "holds a wheel"
  KeyList keys;      // of its options
  /// @pre the section was checked against the schema. @throws Error(bad_input) naming file and key
  std::unique_ptr<RigSpec> (*read)(const nlohmann::json& section, const ReadContext& context);
  /// Returns the tires of a kind whose wheels bring them, one for each wheel; empty if the section gives too little.
  /// The section was not checked. null: the scenario must give the tires. @throws Error(bad_input)
  std::vector<WheelTire> (*tires)(const nlohmann::json& section, const ReadContext& context) = nullptr;
};

std::span<const RigKind> rig_kinds();

/// The tires that the rig of a section brings; empty if it brings none. The section was not checked.
/// @throws Error(bad_input)
std::vector<WheelTire> tires_of_rig(const nlohmann::json& section, const ReadContext& context);

/// The kinds that have this key of the section; empty for a key that all share and for an unknown key.
std::vector<std::string> kinds_of_key(const std::string& key);

/// Reads the section of a scenario that describes its rig.
/// @throws Error(bad_input); for an unknown type it lists the valid ones
std::unique_ptr<RigSpec> read_rig(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
