#include "terrain/rigid/ground_pressure.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

using Weights = std::array<double, 3>;

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
