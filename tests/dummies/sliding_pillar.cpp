#include "tests/dummies/sliding_pillar.hpp"

#include "vehicle/spec/part_rules.hpp"

namespace furrow::vehicle {

void check_spec(const SlidingPillarSpec& s, const JsonReader& reader) {
  check_apart(reader, "top", s.top, "bottom", s.bottom);
  check_struts(reader, s.spring, s.shock, {"upright"});
}

void add_suspension(AxleBuild& build, const Sides<SlidingPillarSpec>& sides) {
  for (Wheel& wheel : build.wheels) {
    const SlidingPillarSpec& s = *sides[wheel.side];
    wheel.carrier = add_body(build.system, wheel.name + " upright", s.upright);
    add_joint(build.system, JointKind::prismatic, wheel.name + " pillar", build.chassis, wheel.carrier, s.bottom,
              s.top - s.bottom);
    add_spindle(build.system, wheel, s.spindle);
    add_struts(build, wheel, s.spring, s.shock, {{"upright", wheel.carrier}});
  }
}

}  // namespace furrow::vehicle
