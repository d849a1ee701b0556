// Shift points of an automatic gearbox: up above one speed, down below another, at most once in a given time.
#pragma once

#include "protocol/core/fields.hpp"

namespace furrow::vehicle {

struct ShiftLogicOptions {
  double up_speed = 0.0, down_speed = 0.0;  // rad/s of the gearbox's input
  double latency = 0.0;                     // between the starts of two shifts, s
};

struct ShiftLogic {
  ShiftLogicOptions options;
  double last_shift = -1e300;  // s

  /// The gear wanted at a time (s), between 0 and gears − 1; the present gear unless a shift is due.
  int wanted(int gear, int gears, double speed, double time) {
    if (time - last_shift < options.latency) return gear;
    int next = gear;
    if (speed > options.up_speed && gear + 1 < gears) next = gear + 1;
    if (speed < options.down_speed && gear > 0) next = gear - 1;
    if (next != gear) last_shift = time;
    return next;
  }
};
void visit_fields(FieldsOf<ShiftLogic> auto& s, auto&& visit) { visit(s.last_shift, Field{"last_shift", "s"}); }

}  // namespace furrow::vehicle
