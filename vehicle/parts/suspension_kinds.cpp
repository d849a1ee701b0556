#include "vehicle/parts/suspension_kinds.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "vehicle/multibody/strut_laws.hpp"

namespace furrow::vehicle {
namespace {

/// x along the hinge, forward; z normal to the plane of the arm, upward.
Mat3 arm_axes(const ArmSpec& arm) {
  const Vec3 x = (arm.chassis_front - arm.chassis_back).normalized();
  Vec3 z = x.cross(arm.upright - arm.chassis_back).normalized();
  if (z.z() < 0.0) z = -z;
  Mat3 axes;
  axes << x, z.cross(x), z;
  return axes;
}

int add_arm(System& system, const std::string& name, const ArmSpec& arm, int chassis, int upright) {
  const int body = system.add_body(name, arm.mass, arm.inertia,
                                   {.position = arm.center_of_mass, .orientation = Quat(arm_axes(arm))});
  add_joint(system, JointKind::revolute, name + " hinge", chassis, body, 0.5 * (arm.chassis_front + arm.chassis_back),
            arm.chassis_front - arm.chassis_back);
  add_joint(system, JointKind::spherical, name + " ball", body, upright, arm.upright);
  return body;
}

SpringOptions spring_options(const std::string& name, const SpringSpec& spec) {
  SpringOptions options;
  options.free_length = spec.free_length;
  options.force = Table::odd(name, spec.rate ? Points{{0.0, 0.0}, {1.0, *spec.rate}} : spec.force);
  if (spec.stop) {
    options.stop = Table(name + " stop", spec.stop->force);
    options.shortest = spec.stop->shortest;
    options.longest = spec.stop->longest;
  }
  return options;
}

ShockOptions shock_options(const ShockSpec& spec) {
  ShockOptions options;
  options.bump = spec.compression;
  options.rebound = spec.rebound;
  if (spec.outer) {
    options.outer_bump = spec.outer->compression;
    options.outer_rebound = spec.outer->rebound;
    options.first_mark = spec.outer->shortest;
    options.last_mark = spec.outer->longest;
    options.blend_length = spec.outer->blend_length;
  }
  return options;
}

}  // namespace

int add_joint(System& system, JointKind kind, const std::string& name, int a, int b, const Vec3& point,
              const Vec3& axis) {
  return system.add_joint(kind, name, a, b, {.point = point, .axis = axis});
}

void add_rod(System& system, const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b) {
  system.add_joint(JointKind::distance, name, a, b, {.point = point_a, .second_point = point_b});
}

void add_struts(AxleBuild& build, Wheel& wheel, const std::optional<SpringSpec>& spring,
                const std::optional<ShockSpec>& shock, std::initializer_list<Part> parts) {
  const auto end = [&](const std::optional<std::string>& on) {
    for (const Part& part : parts)
      if (on && *on == part.name) return part.body;
    return parts.begin()->body;
  };
  if (spring) {
    const std::string name = wheel.name + " spring";
    wheel.spring = build.system.add_line_element(name, build.chassis, end(spring->on), spring->chassis, spring->end,
                                                 tabulated_spring(spring_options(name, *spring)));
    build.system.track_energy(*wheel.spring);
  }
  if (shock) {
    wheel.shock = build.system.add_line_element(wheel.name + " shock absorber", build.chassis, end(shock->on),
                                                shock->chassis, shock->end, shock_absorber(shock_options(*shock)));
    build.system.track_energy(*wheel.shock);
  }
}

void add_spindle(System& system, Wheel& wheel, const SpindleSpec& spindle) {
  const double out = outward(wheel.side);
  const WheelSpec& rim = wheel.corner->wheel;
  const Quat turn = Quat(Eigen::AngleAxisd(-out * spindle.toe_deg * kDegree, Vec3::UnitZ())) *
                    Quat(Eigen::AngleAxisd(-out * spindle.camber_deg * kDegree, Vec3::UnitX()));
  wheel.spindle = system.add_body(wheel.name + " spindle", spindle.mass + rim.mass, spindle.inertia + rim.inertia,
                                  {.position = spindle.center, .orientation = turn});
  wheel.bearing = add_joint(system, JointKind::revolute, wheel.name + " bearing", wheel.carrier, wheel.spindle,
                            spindle.center, turn * Vec3::UnitY());
}

void add_suspension(AxleBuild& build, const Sides<DoubleWishboneSpec>& sides) {
  System& system = build.system;
  for (Wheel& wheel : build.wheels) {
    const DoubleWishboneSpec& s = *sides[wheel.side];
    wheel.carrier = add_body(system, wheel.name + " upright", s.upright);
    add_spindle(system, wheel, s.spindle);
    const int upper = add_arm(system, wheel.name + " upper arm", s.upper_arm, build.chassis, wheel.carrier);
    const int lower = add_arm(system, wheel.name + " lower arm", s.lower_arm, build.chassis, wheel.carrier);
    add_rod(system, wheel.name + " tie rod", build.rods, wheel.carrier, s.tie_rod.inner, s.tie_rod.outer);
    const Vec3 centre = s.upright.center_of_mass;
    wheel.kingpin = {s.lower_arm.upright - centre, s.upper_arm.upright - centre};
    add_struts(build, wheel, s.spring, s.shock,
               {{"lower_arm", lower}, {"upper_arm", upper}, {"upright", wheel.carrier}});
  }
}

void add_suspension(AxleBuild& build, const Sides<TrailingArmSpec>& sides) {
  for (Wheel& wheel : build.wheels) {
    const TrailingArmSpec& s = *sides[wheel.side];
    wheel.carrier = add_body(build.system, wheel.name + " arm", s.arm);
    add_joint(build.system, JointKind::revolute, wheel.name + " arm hinge", build.chassis, wheel.carrier,
              0.5 * (s.pivot_inner + s.pivot_outer), s.pivot_outer - s.pivot_inner);
    add_spindle(build.system, wheel, s.spindle);
    add_struts(build, wheel, s.spring, s.shock, {{"arm", wheel.carrier}});
  }
}

void add_suspension(AxleBuild& build, const Sides<RigidAxleSpec>& sides) {
  System& system = build.system;
  const RigidAxleSpec& left = *sides[kLeft];
  const int housing = add_body(system, build.axle.name + " housing", left.housing);
  for (const LinkSpec& link : left.links) {
    const std::string name = build.axle.name + " " + link.name;
    add_rod(system, link.mirrored ? name + " left" : name, build.chassis, housing, link.chassis, link.axle);
    if (!link.mirrored) continue;
    const LinkSpec right = mirrored(link);
    add_rod(system, name + " right", build.chassis, housing, right.chassis, right.axle);
  }
  for (Wheel& wheel : build.wheels) {
    const RigidAxleSpec& s = *sides[wheel.side];
    wheel.carrier = housing;
    add_spindle(system, wheel, s.spindle);
    add_struts(build, wheel, s.spring, s.shock, {{"housing", housing}});
  }
}

void add_suspension(AxleBuild& build, const Sides<FixedSpec>& sides) {
  for (Wheel& wheel : build.wheels) {
    wheel.travels = false;
    wheel.carrier = build.host ? (*build.host)[wheel.side].carrier : build.chassis;
    add_spindle(build.system, wheel, sides[wheel.side]->spindle);
  }
}

int add_body(System& system, const std::string& name, const BodySpec& spec) {
  return system.add_body(name, spec.mass, spec.inertia, {.position = spec.center_of_mass});
}

}  // namespace furrow::vehicle
