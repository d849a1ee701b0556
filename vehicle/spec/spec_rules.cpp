#include "vehicle/spec/spec_rules.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "protocol/files/json_text.hpp"
#include "vehicle/spec/part_rules.hpp"
#include "vehicle/spec/value_rules.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kMostRadiusOfGyration = 100.0;  // radius of gyration of a body, m: as large as coordinates may be

// No principal moment of inertia of a body is larger than the sum of the other two; flat bodies have equality.
void check_inertia(const JsonReader& reader, const Mat3& inertia, double mass) {
  const Vec3 J = Eigen::SelfAdjointEigenSolver<Mat3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(J.x() > 0.0))
    reader.fail("inertia", fmt::format("has the principal moment {:.6g}, expected positive ones", J.x()));
  if (J.z() > (J.x() + J.y()) * (1.0 + 1e-9))
    reader.fail("inertia", fmt::format("has the principal moments {:.6g}, {:.6g}, {:.6g}, expected none "
                                       "larger than the sum of the other two",
                                       J.x(), J.y(), J.z()));
  if (const double gyration = std::sqrt(0.5 * J.sum() / mass); gyration > kMostRadiusOfGyration)
    reader.fail("inertia", fmt::format("gives a body of {} kg a radius of gyration of {:.3g} m, expected at "
                                       "most {:g} m",
                                       number_text(mass), gyration, kMostRadiusOfGyration));
}

void check_length(const JsonReader& reader, double shortest, double longest) {
  if (!(longest > shortest))
    reader.fail("longest",
                fmt::format("is {}, expected more than shortest, {}", number_text(longest), number_text(shortest)));
}

/// Checks that forces rise with their argument.
void check_rising(const JsonReader& reader, const char* key, const Points& points) {
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(points[i].second > points[i - 1].second))
      reader.fail(fmt::format("{}[{}]", key, i),
                  fmt::format("ends with {} after {}, expected forces that rise", number_text(points[i].second),
                              number_text(points[i - 1].second)));
}

/// Checks the part that a spring or shock absorber ends on.
void check_part(const JsonReader& reader, const char* strut, const std::optional<std::string>& on,
                const std::vector<std::string>& parts) {
  if (!on || std::find(parts.begin(), parts.end(), *on) != parts.end()) return;
  const std::string key = std::string(strut) + ".on", expected = ", expected " + one_of(parts);
  reader.fail(key,
              *on == "chassis" ? "is 'chassis', the body of its other end" + expected : "is '" + *on + "'" + expected);
}

}  // namespace

void check_apart(const JsonReader& reader, const char* key, const Vec3& point, const char* other_key,
                 const Vec3& other) {
  if (!((point - other).norm() > kSamePoint))
    reader.fail(key, fmt::format("is the point of {}, expected another one", reader.full(other_key)));
}

void check_struts(const JsonReader& reader, const std::optional<SpringSpec>& spring,
                  const std::optional<ShockSpec>& shock, const std::vector<std::string>& parts) {
  if (spring) check_part(reader, "spring", spring->on, parts);
  if (shock) check_part(reader, "shock", shock->on, parts);
}

void check_spec(const BodySpec& s, const JsonReader& reader) { check_inertia(reader, s.inertia, s.mass); }

void check_spec(const SpindleSpec& s, const JsonReader& reader) { check_inertia(reader, s.inertia, s.mass); }

void check_spec(const WheelSpec& s, const JsonReader& reader) { check_inertia(reader, s.inertia, s.mass); }

void check_spec(const ArmSpec& s, const JsonReader& reader) {
  check_inertia(reader, s.inertia, s.mass);
  check_apart(reader, "chassis_back", s.chassis_back, "chassis_front", s.chassis_front);
  const Vec3 hinge = (s.chassis_front - s.chassis_back).normalized();
  if (!(hinge.cross(s.upright - s.chassis_back).norm() > kSamePoint))
    reader.fail("upright", "lies on the hinge, expected a point beside it");
}

void check_spec(const TieRodSpec& s, const JsonReader& reader) {
  check_apart(reader, "outer", s.outer, "inner", s.inner);
}
void check_spec(const LinkSpec& s, const JsonReader& reader) {
  check_apart(reader, "axle", s.axle, "chassis", s.chassis);
}

void check_spec(const StopSpec& s, const JsonReader& reader) {
  check_length(reader, s.shortest, s.longest);
  if (s.force.front() != std::pair{0.0, 0.0})
    reader.fail("force[0]", "is not [0, 0], expected a stop that begins there");
  check_rising(reader, "force", s.force);
}

void check_spec(const SpringSpec& s, const JsonReader& reader) {
  check_apart(reader, "end", s.end, "chassis", s.chassis);
  if (s.rate && !s.force.empty()) reader.fail("force", "is given beside rate, expected one of the two");
  if (!s.rate && s.force.empty()) reader.fail("force", "is missing, expected a table of forces, or the key rate");
  if (s.force.empty()) return;
  if (s.force.front() != std::pair{0.0, 0.0})
    reader.fail("force[0]", "is not [0, 0], expected the deflection and the force of the free spring");
  check_rising(reader, "force", s.force);
}

void check_spec(const OuterShockSpec& s, const JsonReader& reader) {
  check_length(reader, s.shortest, s.longest);
  if (s.blend_length > s.longest - s.shortest)
    reader.fail("blend_length", fmt::format("is {}, expected at most longest - shortest, {:.6g}",
                                            number_text(s.blend_length), s.longest - s.shortest));
}

void check_spec(const ShockSpec& s, const JsonReader& reader) {
  check_apart(reader, "end", s.end, "chassis", s.chassis);
}

void check_spec(const DoubleWishboneSpec& s, const JsonReader& reader) {
  check_struts(reader, s.spring, s.shock, {"lower_arm", "upper_arm", "upright"});
  if (!((s.upper_arm.upright - s.lower_arm.upright).norm() > kSamePoint))
    reader.fail("upper_arm.upright", "is the point of lower_arm.upright, expected another one");
}

void check_spec(const TrailingArmSpec& s, const JsonReader& reader) {
  check_struts(reader, s.spring, s.shock, {"arm"});
  check_apart(reader, "pivot_outer", s.pivot_outer, "pivot_inner", s.pivot_inner);
  const Vec3 hinge = (s.pivot_outer - s.pivot_inner).normalized();
  if (!(hinge.cross(s.spindle.center - s.pivot_inner).norm() > kSamePoint))
    reader.fail("spindle.center", "lies on the arm's hinge, expected a point beside it");
}

void check_spec(const RigidAxleSpec& s, const JsonReader& reader) {
  check_struts(reader, s.spring, s.shock, {"housing"});
  int rods = 0;
  for (const LinkSpec& link : s.links) rods += link.mirrored ? 2 : 1;
  check_names_once(reader, "links", s.links);
  if (rods != 4)
    reader.fail("links",
                fmt::format("has {} rods (a mirrored one counts twice), expected 4: the axle rises and rolls", rods));
}

void check_spec(const PitmanArmSpec& s, const JsonReader& reader) {
  check_apart(reader, "arm_end", s.arm_end, "pivot", s.pivot);
  check_apart(reader, "idler_end", s.idler_end, "idler", s.idler);
  check_apart(reader, "idler_end", s.idler_end, "arm_end", s.arm_end);
  if (!(std::abs(s.left_angle_deg) > 0.0 && std::abs(s.left_angle_deg) < 90.0))
    reader.fail("left_angle_deg", "is " + number_text(s.left_angle_deg) +
                                      ", expected -90 to 90, not 0: the arm at full lock to the left");
}

void check_spec(const RackSpec& s, const JsonReader& reader) {
  if (s.left_travel == 0.0) reader.fail("left_travel", "is 0, expected the travel at full lock to the left in m");
}

}  // namespace furrow::vehicle
