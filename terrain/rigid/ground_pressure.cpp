#include "terrain/rigid/ground_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

using Weights = std::array<double, 3>;

constexpr int kParts = 8;  // of a side of a triangle where the ground is not level
static_assert(kParts * kParts <= std::tuple_size_v<ProfilePointList>);
constexpr double kUpright = 1e-6;  // cosine of the normal's angle below which a triangle counts as upright

/// The part of a triangle below z = 0 as a polygon in barycentric coordinates; returns its corners.
int clip_below(const std::array<Vec3, 3>& x, std::array<Weights, 4>& corner) {
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double z = x[k].z(), z_next = x[next].z();
    if (z < 0.0) {
      corner[count] = {};
      corner[count++][k] = 1.0;
    }
    if ((z < 0.0) != (z_next < 0.0)) {
      const double share = z / (z - z_next);
      corner[count] = {};
      corner[count][k] = 1.0 - share;
      corner[count++][next] = share;
    }
  }
  return count;
}

/// Area of a triangle of barycentric points over the area of the whole.
double area_share(const Weights& a, const Weights& b, const Weights& c) {
  return std::abs((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
}

}  // namespace

int ground_points(const std::array<Vec3, 3>& x, std::array<GroundPoint, kMaxGroundPoints>& out) {
  const Vec3 ab = x[1] - x[0], ac = x[2] - x[0];
  const double projected = 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  std::array<Weights, 4> corner;
  const int corners = clip_below(x, corner);
  int count = 0;
  for (int part = 1; part + 1 < corners; ++part) {
    const Weights* own[3] = {&corner[0], &corner[part], &corner[part + 1]};
    const double area = projected * area_share(*own[0], *own[1], *own[2]);
    if (!(area > 0.0)) continue;
    for (int q = 0; q < 3; ++q) {
      GroundPoint& point = out[count++];
      point.area = area / 3.0;
      point.depth = 0.0;
      for (int k = 0; k < 3; ++k) {
        point.weight[k] = 0.0;
        for (int j = 0; j < 3; ++j) point.weight[k] += (j == q ? 2.0 / 3.0 : 1.0 / 6.0) * (*own[j])[k];
        point.depth -= point.weight[k] * x[k].z();
      }
    }
  }
  return count;
}

int profile_points(const GroundProfile& profile, const std::array<Vec3, 3>& x, ProfilePointList& out) {
  const auto [left, right] = std::minmax({x[0].x(), x[1].x(), x[2].x()});
  const double lowest = std::min({x[0].z(), x[1].z(), x[2].z()});
  const double deep = profile.highest(left, right) - lowest;
  if (!(deep > 0.0)) return 0;
  const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const double area = 0.5 * normal.norm();
  if (!(std::hypot(normal.x(), normal.z()) > kUpright * 2.0 * area)) return 0;
  if (std::abs(normal.z()) > kUpright * 2.0 * area && profile.level(left, right, deep)) {
    const Vec3 down(0.0, 0.0, profile.height(left));
    std::array<GroundPoint, kMaxGroundPoints> points;
    const int count = ground_points({x[0] - down, x[1] - down, x[2] - down}, points);
    for (int i = 0; i < count; ++i) {
      out[i] = points[i];
      out[i].area *= 2.0 * area / std::abs(normal.z());
    }
    return count;
  }
  int count = 0;
  GroundPoint point;
  point.level = false;
  point.area = area / (kParts * kParts);
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; i + j < kParts; ++j)
      for (const double middle : {1.0 / 3.0, 2.0 / 3.0}) {  // of the part that stands, and of the one that hangs
        const double a = (i + middle) / kParts, b = (j + middle) / kParts;
        if (a + b >= 1.0) continue;
        point.weight = {1.0 - a - b, a, b};
        const Vec3 at = point.weight[0] * x[0] + a * x[1] + b * x[2];
        point.depth = profile.depth(at.x(), at.z());
        if (point.depth > 0.0) out[count++] = point;
      }
  return count;
}

double add_ground_force(const GroundLaw& law, int triangle, const GroundPoint& at, const Vec3& position,
                        const Vec3& velocity, std::vector<SurfaceContactForce>& contacts) {
  FURROW_ASSERT(triangle >= 0 && at.area > 0.0, triangle, at.area);
  const double pressure = law.stiffness * at.depth - law.damping * velocity.z();
  if (!(pressure > 0.0)) return 0.0;
  SurfaceContactForce contact;
  contact.triangle = triangle;
  contact.weight = at.weight;
  contact.point = position;
  contact.normal = Vec3(0.0, 0.0, pressure * at.area);
  contact.tangent = {Vec3::UnitZ(), law.stiffness * at.area, 0.0, law.damping * at.area, 0.0};
  contacts.push_back(contact);
  return contact.normal.z();
}

}  // namespace furrow::terrain
