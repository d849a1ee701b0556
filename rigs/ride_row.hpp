// What the rigs for ride, quarter car and half car, add to the table of a wheel.
#pragma once

#include "protocol/core/column.hpp"

namespace furrow::rigs {

struct RideRow {
  double body_height = 0.0;        // above where the body was placed, over this wheel, m
  double body_acceleration = 0.0;  // likewise, upwards, m/s²
  double travel = 0.0;             // of the suspension, positive in compression, m
  double force = 0.0;              // of the suspension upwards on the body, N
  double drive_force = 0.0;        // of what keeps the wheel at its speed, N
};
void visit_fields(auto&& visit, FieldsOf<RideRow> auto& r) {
  visit(column::instant("body_height_m", "m"), r.body_height);
  visit(column::mean("body_acceleration_m_per_s2", "m/s²"), r.body_acceleration);
  visit(column::instant("suspension_travel_m", "m"), r.travel);
  visit(column::mean("suspension_force_N", "N"), r.force);
  visit(column::mean("trolley_force_N", "N"), r.drive_force);
}

}  // namespace furrow::rigs
