// Columns that quarter car and half car add to the table of a wheel.
#pragma once

#include "protocol/core/column.hpp"

namespace furrow::rigs {

struct RideRow {
  double body_height = 0.0;        // of the body above where it was placed, at this wheel, m
  double body_acceleration = 0.0;  // of the body at this wheel, upwards, m/s²
  double travel = 0.0;             // of the suspension, positive in compression, m
  double force = 0.0;              // of the suspension upwards on the body, N
  double drive_force = 0.0;        // that keeps the wheel at its speed, N
};
void visit_fields(FieldsOf<RideRow> auto& r, auto&& visit) {
  visit(r.body_height, column::instant("body_height_m", "m"));
  visit(r.body_acceleration, column::mean("body_acceleration_m_per_s2", "m/s²"));
  visit(r.travel, column::instant("suspension_travel_m", "m"));
  visit(r.force, column::mean("suspension_force_N", "N"));
  visit(r.drive_force, column::mean("trolley_force_N", "N"));
}

}  // namespace furrow::rigs
