// A quarter car that drives over a curb at a constant speed, once on a planar tire and once on a spring and a damper.
// These depend only on the ground's height under the wheel's centre.
//
// Displacements y of axle and y' of body are relative to rest on the flat. The force down on the axle and up on the
// body is
//   F = m' g + k (y − y') + c (ẏ − ẏ').                                                                         (1)
// The tire of the simple model pushes the axle up with (m + m') g + k_t (w − y) − c_t ẏ, w the ground's height: it can
// also pull.
#pragma once

#include <vector>

#include "tests/tire/planar/planar_wheel.hpp"

namespace furrow::test {

struct QuarterCar {
  double body = 1290.0, axle = 210.0;                // m', m with disc and tire, kg: 1.5 t
  double spring = 115e3, damper = 7.5e3;             // N/m, N s/m: body at 1.5 Hz, 0.3 of its critical damping
  double tire_spring = 639782.0, tire_damper = 3e3;  // N/m, N s/m: 0.13 of the axle's critical damping
  double speed = 4.0, curb = 0.2;                    // m/s, m
  double from = -6.0, to = 3.0;                      // x of the wheel's centre, m
};

struct CurbLine {
  double x = 0.0;                 // of the wheel's centre from the curb, m
  double axle = 0.0, body = 0.0;  // y, y', m
  double force = 0.0;             // of the ground, upwards, N
  double simple_axle = 0.0, simple_force = 0.0;
};

struct CurbRun {
  std::vector<CurbLine> lines;
  double first_touch = 0.0, simple_first = 0.0;  // x of the first contact with the curb, m
  double airborne = 0.0;                         // time without contact, s
  double step = 0.0;                             // s
  struct Picture {
    double x = 0.0;
    tire::PlanarField nodes;
  };
  std::vector<Picture> pictures;
  tire::PlanarMesh mesh;
};

/// @param pictures x of the wheel's centre at which its shape is kept. @param every number of steps between kept lines
CurbRun drive_over_curb(const tire::PlanarParams& tire, const QuarterCar& car, const std::vector<double>& pictures,
                        int every);

}  // namespace furrow::test
