// A small complete rig, made by the recipe in CONTRIBUTING.md. It holds the hub of one wheel, lowers it and turns it as
// imposed, and adds its own column to the wheel's table.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/column.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// The keys of the section `rig` with type held_hub.
struct HeldHubOptions {
  double depth = 0.01;    // total lowering of the hub, m
  double lowering = 0.1;  // speed of lowering, m/s
  double spin = 0.0;      // about the hub's y axis, rad/s
};
void visit_fields(FieldsOf<HeldHubOptions> auto& s, auto&& visit) {
  visit(s.depth, key("depth", "m", allowed::from(0), "Depth by which the hub is lowered in all."));
  visit(s.lowering, key("lowering", "m/s", allowed::above(0), "Speed at which it is lowered."));
  visit(s.spin, key("spin", "rad/s", "Spin about the hub's y axis."));
}

/// The rig's column in the table of its wheel.
struct HeldHubRow {
  double hub_load = 0.0;  // with which the hub presses the wheel down, N
};
void visit_fields(FieldsOf<HeldHubRow> auto& r, auto&& visit) { visit(r.hub_load, column::mean("hub_load_N", "N")); }

/// @pre the section was checked against the schema
std::unique_ptr<RigSpec> read_held_hub(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
