#include "vehicle/parts/suspension.hpp"

#include <variant>

namespace furrow::vehicle {

std::array<Wheel, 2> add_axle(System& system, const AxleSpec& axle, int index, int chassis, int rods,
                              const std::array<Wheel, 2>* host) {
  AxleBuild build{system, axle, chassis, rods, host, {}};
  for (Wheel& wheel : build.wheels) {
    wheel.side = &wheel == &build.wheels[kLeft] ? kLeft : kRight;
    wheel.name = axle.name + " " + kSideNames[wheel.side];
    wheel.axle = index;
    wheel.corner = &axle.corners[wheel.side];
  }
  std::visit(
      [&]<class Spec>(const Spec& left) {
        add_suspension(build, Sides<Spec>{&left, &std::get<Spec>(axle.corners[kRight].suspension)});
      },
      axle.corners[kLeft].suspension);
  return build.wheels;
}

}  // namespace furrow::vehicle
