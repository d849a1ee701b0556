#include "vehicle/parts/suspension.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "vehicle/multibody/strut_laws.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

int joint(System& system, JointKind kind, const std::string& name, int a, int b, const Vec3& point,
          const Vec3& axis = Vec3::UnitZ()) {
  JointPlace place;
  place.point = point;
  place.axis = axis;
  return system.add_joint(kind, name, a, b, place);
}

void rod(System& system, const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b) {
  JointPlace place;
  place.point = point_a;
  place.second_point = point_b;
  system.add_joint(JointKind::distance, name, a, b, place);
}

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
  BodyState state;
  state.position = arm.center_of_mass;
  state.orientation = Quat(arm_axes(arm));
  const int body = system.add_body(name, arm.mass, arm.inertia, state);
  joint(system, JointKind::revolute, name + " hinge", chassis, body, 0.5 * (arm.chassis_front + arm.chassis_back),
        arm.chassis_front - arm.chassis_back);
  joint(system, JointKind::spherical, name + " ball", body, upright, arm.upright);
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

/// Parts of one side by the names that files give them.
struct Part {
  const char* name;
  int body;
};

/// Spring and shock absorber between the chassis and one of the parts, the first one unless the spec says otherwise.
template <class Spec>
void add_struts(System& system, Wheel& wheel, const Spec& spec, int chassis, std::initializer_list<Part> parts) {
  const auto end = [&](const std::optional<std::string>& on) {
    for (const Part& part : parts)
      if (on && *on == part.name) return part.body;
    return parts.begin()->body;
  };
  if (spec.spring) {
    const std::string name = wheel.name + " spring";
    wheel.spring = system.add_line_element(name, chassis, end(spec.spring->on), spec.spring->chassis, spec.spring->end,
                                           tabulated_spring(spring_options(name, *spec.spring)));
    system.track_energy(*wheel.spring);
  }
  if (spec.shock) {
    wheel.shock =
        system.add_line_element(wheel.name + " shock absorber", chassis, end(spec.shock->on), spec.shock->chassis,
                                spec.shock->end, shock_absorber(shock_options(*spec.shock)));
    system.track_energy(*wheel.shock);
  }
}

/// The body that turns, rim included, in its carrier.
void add_spindle(System& system, Wheel& wheel, const SpindleSpec& spindle, const WheelSpec& rim) {
  const double out = outward(wheel.side);
  BodyState state;
  state.position = spindle.center;
  state.orientation = Quat(Eigen::AngleAxisd(-out * spindle.toe_deg * kDegree, Vec3::UnitZ())) *
                      Quat(Eigen::AngleAxisd(-out * spindle.camber_deg * kDegree, Vec3::UnitX()));
  wheel.spindle =
      system.add_body(wheel.name + " spindle", spindle.mass + rim.mass, spindle.inertia + rim.inertia, state);
  wheel.bearing = joint(system, JointKind::revolute, wheel.name + " bearing", wheel.carrier, wheel.spindle,
                        spindle.center, state.orientation * Vec3::UnitY());
}

struct Builder {
  System& system;
  const AxleSpec& axle;
  int chassis, rods;
  const std::array<Wheel, 2>* host;
  std::array<Wheel, 2>& wheels;

  void add(const DoubleWishboneSpec&) {
    for (Wheel& wheel : wheels) {
      const auto& s = std::get<DoubleWishboneSpec>(wheel.corner->suspension);
      wheel.carrier = add_body(system, wheel.name + " upright", s.upright);
      add_spindle(system, wheel, s.spindle, wheel.corner->wheel);
      const int upper = add_arm(system, wheel.name + " upper arm", s.upper_arm, chassis, wheel.carrier);
      const int lower = add_arm(system, wheel.name + " lower arm", s.lower_arm, chassis, wheel.carrier);
      rod(system, wheel.name + " tie rod", rods, wheel.carrier, s.tie_rod.inner, s.tie_rod.outer);
      const Vec3 centre = s.upright.center_of_mass;
      wheel.kingpin = {s.lower_arm.upright - centre, s.upper_arm.upright - centre};
      add_struts(system, wheel, s, chassis, {{"lower_arm", lower}, {"upper_arm", upper}, {"upright", wheel.carrier}});
    }
  }

  void add(const TrailingArmSpec&) {
    for (Wheel& wheel : wheels) {
      const auto& s = std::get<TrailingArmSpec>(wheel.corner->suspension);
      wheel.carrier = add_body(system, wheel.name + " arm", s.arm);
      joint(system, JointKind::revolute, wheel.name + " arm hinge", chassis, wheel.carrier,
            0.5 * (s.pivot_inner + s.pivot_outer), s.pivot_outer - s.pivot_inner);
      add_spindle(system, wheel, s.spindle, wheel.corner->wheel);
      add_struts(system, wheel, s, chassis, {{"arm", wheel.carrier}});
    }
  }

  void add(const RigidAxleSpec& left) {
    const int housing = add_body(system, axle.name + " housing", left.housing);
    for (const LinkSpec& link : left.links) {
      const std::string name = axle.name + " " + link.name;
      rod(system, link.mirrored ? name + " left" : name, chassis, housing, link.chassis, link.axle);
      if (!link.mirrored) continue;
      const LinkSpec right = mirrored(link);
      rod(system, name + " right", chassis, housing, right.chassis, right.axle);
    }
    for (Wheel& wheel : wheels) {
      const auto& s = std::get<RigidAxleSpec>(wheel.corner->suspension);
      wheel.carrier = housing;
      add_spindle(system, wheel, s.spindle, wheel.corner->wheel);
      add_struts(system, wheel, s, chassis, {{"housing", housing}});
    }
  }

  void add(const FixedSpec&) {
    for (Wheel& wheel : wheels) {
      const auto& s = std::get<FixedSpec>(wheel.corner->suspension);
      wheel.travels = false;
      wheel.carrier = host ? (*host)[wheel.side].carrier : chassis;
      add_spindle(system, wheel, s.spindle, wheel.corner->wheel);
    }
  }
};

}  // namespace

int add_body(System& system, const std::string& name, const BodySpec& spec) {
  BodyState state;
  state.position = spec.center_of_mass;
  return system.add_body(name, spec.mass, spec.inertia, state);
}

std::array<Wheel, 2> add_axle(System& system, const AxleSpec& axle, int index, int chassis, int rods,
                              const std::array<Wheel, 2>* host) {
  std::array<Wheel, 2> wheels;
  for (int side = 0; side < 2; ++side) {
    wheels[side].name = axle.name + " " + kSideNames[side];
    wheels[side].axle = index;
    wheels[side].side = side;
    wheels[side].corner = &axle.corners[side];
  }
  Builder builder{system, axle, chassis, rods, host, wheels};
  std::visit([&](const auto& suspension) { builder.add(suspension); }, axle.corners[kLeft].suspension);
  return wheels;
}

}  // namespace furrow::vehicle
