#include "terrain/surface/surface_forces.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

// A force directed at the mean vertex has no moment to compare with; this share of |x||f| replaces it.
constexpr double kArmFloor = 1e-3;

}  // namespace

NodalForceSum::NodalForceSum(int vertex_count, bool tangents, SurfacePatches patches)
    : patches_(std::move(patches)),
      impulse_(vertex_count, Vec3::Zero()),
      touched_(vertex_count, 0),
      substep_force_(vertex_count, Vec3::Zero()),
      substep_touched_(vertex_count, 0),
      tangent_(tangents ? vertex_count : 0) {}

void NodalForceSum::add_tangents(std::span<const SurfaceContactForce> contacts, const SurfaceNow& surface, double dt) {
  FURROW_ASSERT(surface.position.size() == tangent_.size(), surface.position.size(), tangent_.size());
  FURROW_ASSERT(surface.velocity.size() == tangent_.size(), surface.velocity.size(), tangent_.size());
  for (std::size_t v = 0; v < tangent_.size(); ++v) {
    tangent_[v].position += dt * surface.position[v];
    tangent_[v].velocity += dt * surface.velocity[v];
  }
  for (const auto& contact : contacts) {
    const Mat3 stiffness = dt * contact.tangent.stiffness(), damping = dt * contact.tangent.damping();
    for (int k = 0; k < 3; ++k) {
      ContactTangent& t = tangent_[surface.triangles[contact.triangle][k]];
      t.stiffness += contact.weight[k] * stiffness;
      t.damping += contact.weight[k] * damping;
    }
    if (contact.tangent.k_r == 0.0 && contact.tangent.c_r == 0.0) continue;
    const PatchTurn patch(patches_.of(contact.triangle), surface.position);
    const Vec3& n = contact.tangent.normal;
    const Mat3 across = dt * (Mat3::Identity() - n * n.transpose());
    for (const int v : patches_.of(contact.triangle)) {
      const Mat3 resists = patch.resistance(v, across);
      tangent_[v].stiffness += contact.tangent.k_r * resists;
      tangent_[v].damping += contact.tangent.c_r * resists;
    }
  }
}

void NodalForceSum::finish_tangents(double duration, NodalForces& forces) {
  FURROW_ASSERT(forces.tangent.empty() && forces.vertex.size() <= tangent_.size(), forces.tangent.size(),
                forces.vertex.size());
  for (const int v : forces.vertex) {
    const ContactTangent& t = tangent_[v];
    forces.tangent.push_back(
        {t.stiffness / duration, t.damping / duration, t.position / duration, t.velocity / duration});
  }
  std::fill(tangent_.begin(), tangent_.end(), ContactTangent());
}

void NodalForceSum::add_substep(std::span<const SurfaceContactForce> contacts, const SurfaceNow& surface, double dt,
                                double advance) {
  FURROW_ASSERT(dt > 0.0 && advance > 0.0, dt, advance);
  FURROW_ASSERT(surface.position.size() == impulse_.size(), surface.position.size(), impulse_.size());
  FURROW_ASSERT(surface.velocity.size() == impulse_.size(), surface.velocity.size(), impulse_.size());
  sums_.contacts = static_cast<std::int64_t>(contacts.size());
  sums_.sliding = std::count_if(contacts.begin(), contacts.end(), [](const auto& contact) { return contact.slides; });
  if (!tangent_.empty()) add_tangents(contacts, surface, advance);
  if (contacts.empty()) return;
  const auto& [triangles, position, velocity] = surface;

  // Residuals are taken about the mean vertex, so that the distance to the world origin cannot hide them.
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : position) mean += x;
  mean /= static_cast<double>(position.size());

  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_scale = 0.0, moment_scale = 0.0;
  const auto add = [&](int v, const Vec3& f) {
    if (!substep_touched_[v]) {
      substep_touched_[v] = 1;
      substep_list_.push_back(v);
    }
    substep_force_[v] += f;
  };
  for (const auto& contact : contacts) {
    const Vec3 total = contact.normal + contact.tangential;
    const Vec3 arm = contact.point - mean;
    const Vec3 turn = arm.cross(total);
    force += total;
    moment += turn + contact.couple.moment;
    force_scale += total.norm();
    moment_scale += std::max(turn.norm(), kArmFloor * arm.norm() * total.norm()) + contact.couple.moment.norm();
    sums_.normal += dt * contact.normal;
    sums_.tangential += dt * contact.tangential;
    for (int k = 0; k < 3; ++k) add(triangles[contact.triangle][k], contact.weight[k] * total);
    if (contact.couple.moment.isZero(0.0)) continue;
    for (const int v : patches_.of(contact.triangle)) add(v, contact.couple.force_at(position[v]));
  }
  Vec3 nodal_force = Vec3::Zero(), nodal_moment = Vec3::Zero();
  for (int v : substep_list_) {
    const Vec3& f = substep_force_[v];
    nodal_force += f;
    nodal_moment += (position[v] - mean).cross(f);
    sums_.work += dt * f.dot(velocity[v]);
    if (!touched_[v]) {
      touched_[v] = 1;
      touched_list_.push_back(v);
    }
    impulse_[v] += dt * f;
    substep_force_[v].setZero();
    substep_touched_[v] = 0;
  }
  substep_list_.clear();
  if (force_scale > 0.0)
    sums_.transfer_force_residual = std::max(sums_.transfer_force_residual, (nodal_force - force).norm() / force_scale);
  if (moment_scale > 0.0)
    sums_.transfer_moment_residual =
        std::max(sums_.transfer_moment_residual, (nodal_moment - moment).norm() / moment_scale);
}

void NodalForceSum::finish(double duration, NodalForces& forces, ContactSums& sums) {
  FURROW_ASSERT(duration > 0.0, duration);
  std::sort(touched_list_.begin(), touched_list_.end());
  forces.clear();
  for (int v : touched_list_) {
    forces.vertex.push_back(v);
    forces.force.push_back(impulse_[v] / duration);
    impulse_[v].setZero();
    touched_[v] = 0;
  }
  touched_list_.clear();
  if (!tangent_.empty()) finish_tangents(duration, forces);
  sums = sums_;
  sums.normal /= duration;
  sums.tangential /= duration;
  sums.force = sums.normal + sums.tangential;
  sums_ = ContactSums{};
}

Vec3 NodalForceSum::impulse() const { return sums_.normal + sums_.tangential; }

}  // namespace furrow::terrain
