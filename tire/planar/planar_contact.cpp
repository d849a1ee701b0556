#include "tire/planar/planar_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

PlanarContact::PlanarContact(const PlanarMesh& mesh, PlanarGround ground, const PlanarContactLaw& law)
    : outer_(mesh.outer), reach_(0.0), ground_(std::move(ground)), law_(law) {
  FURROW_ASSERT(law.stiffness > 0.0 && law.friction >= 0.0, law.stiffness, law.friction);
  const PlanarField& p = mesh.position;
  for (std::size_t j = 0; j < outer_.size(); ++j) {
    const int a = outer_[j], b = outer_[(j + 1) % outer_.size()];
    reach_ = std::max(reach_, std::hypot(p.x[b] - p.x[a], p.z[b] - p.z[a]));
  }
  touches_.reserve(2 * outer_.size());
}

void PlanarContact::find_nodes(const PlanarField& x) {
  for (const int n : outer_) {
    if (x.z[n] >= ground_.top()) continue;
    const PlanarDepth depth = ground_.depth(x.x[n], x.z[n]);
    if (depth.depth > 0.0) touches_.push_back({n, -1, 0.0, depth.depth, depth.out_x, depth.out_z});
  }
}

void PlanarContact::find_corners(const PlanarField& x) {
  double left = x.x[outer_[0]], right = left, low = x.z[outer_[0]];
  for (const int n : outer_)
    left = std::min(left, x.x[n]), right = std::max(right, x.x[n]), low = std::min(low, x.z[n]);
  double area = 0.0;  // twice that of the tire; negative: its nodes run clockwise here
  for (std::size_t j = 0; j < outer_.size(); ++j) {
    const int a = outer_[j], b = outer_[j + 1 < outer_.size() ? j + 1 : 0];
    area += x.x[a] * x.z[b] - x.x[b] * x.z[a];
  }
  const auto& corners = ground_.corners();
  auto corner =
      std::lower_bound(corners.begin(), corners.end(), left, [](const PlanarPoint& p, double at) { return p.x < at; });
  for (; corner != corners.end() && corner->x <= right; ++corner) {
    if (corner->z <= low) continue;
    PlanarTouch touch;
    touch.depth = reach_;
    bool found = false, inside = false;
    for (std::size_t j = 0; j < outer_.size(); ++j) {
      const int a = outer_[j], b = outer_[j + 1 < outer_.size() ? j + 1 : 0];
      const double to_x = corner->x - x.x[a], to_z = corner->z - x.z[a];
      if (std::max(std::abs(to_x), std::abs(to_z)) > 3.0 * reach_) continue;  // bounding boxes
      const double dx = x.x[b] - x.x[a], dz = x.z[b] - x.z[a];
      const double share = std::clamp((to_x * dx + to_z * dz) / (dx * dx + dz * dz), 0.0, 1.0);
      const double in_x = to_x - share * dx, in_z = to_z - share * dz, distance = std::hypot(in_x, in_z);
      if (!(distance < touch.depth)) continue;
      found = distance > 0.0;
      inside = (dx * to_z - dz * to_x) * area > 0.0;
      touch = {a, b, share, distance, in_x / distance, in_z / distance};
    }
    if (found && inside) touches_.push_back(touch);
  }
}

void PlanarContact::find(const PlanarField& x) {
  touches_.clear();
  find_nodes(x);
  find_corners(x);
  for (PlanarTouch& t : touches_) t.force = law_.stiffness * t.depth;
}

double PlanarContact::energy() const {
  double sum = 0.0;
  for (const PlanarTouch& t : touches_) sum += 0.5 * law_.stiffness * t.depth * t.depth;
  return sum;
}

double PlanarContact::force_z() const {
  double sum = 0.0;
  for (const PlanarTouch& t : touches_) sum += t.force_z();
  return sum;
}

}  // namespace furrow::tire
