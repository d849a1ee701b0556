#include "terrain/scm/scm_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {
namespace {

// How far above the undisturbed ground a surface counts as coming down on it, in cells.
constexpr double kCover = 2.0;

/// The part of v along a surface with the unit normal n; what leans out of it is turned back into it.
Vec3 along(const Vec3& v, const Vec3& n) { return v - v.dot(n) * n; }
Vec3 laid_into(const Vec3& v, const Vec3& n) {
  const Vec3 flat = along(v, n);
  const double size = flat.norm();
  return size > 0.0 ? Vec3(v.norm() / size * flat) : Vec3(Vec3::Zero());
}

}  // namespace

SoilField::SoilField(const Grid& grid, const PressureLaw& law, double patch_width, std::vector<double> ground)
    : grid_(grid),
      law_(law),
      patch_width_(patch_width),
      finder_(grid, std::move(ground)),
      node_(grid.count()),
      mark_(grid.count(), kUncovered) {}

/// Bekker's k of each touching node, from the width of its patch.
void SoilField::find_moduli() {
  modulus_.assign(touching_.size(), 0.0);
  if (patch_width_ > 0.0) {
    std::fill(modulus_.begin(), modulus_.end(), law_.modulus(patch_width_));
    return;
  }
  patches_.find(cells_);
  of_patch_.clear();
  for (int p = 0; p < patches_.count(); ++p) of_patch_.push_back(law_.modulus(patches_.width(p, grid_.spacing)));
  for (std::size_t k = 0; k < modulus_.size(); ++k) modulus_[k] = of_patch_[patches_.patch()[k]];
}

/// m of the step before, moved along with the surface over the node for dt.
Vec3 SoilField::carried(int node, const Vec3& velocity, double dt) const {
  const auto [i, j] = grid_.cell(node);
  const Vec3 own = mark_[node] >= 0 ? before_[mark_[node]].mobilized : Vec3(Vec3::Zero());
  const auto upwind = [&](int a, int b) -> Vec3 {
    if (a < 0 || b < 0 || a >= grid_.nx || b >= grid_.ny) return own;
    const std::int32_t mark = mark_[grid_.index(a, b)];
    if (mark >= 0) return before_[mark].mobilized;
    return mark == kCovered ? Vec3(Vec3::Zero()) : own;  // comes down fresh, or is the surface's edge
  };
  double x = std::abs(velocity.x()) * dt / grid_.spacing, y = std::abs(velocity.y()) * dt / grid_.spacing;
  if (const double sum = x + y; sum > 1.0) x /= sum, y /= sum;
  const Vec3 from_x = upwind(i - (velocity.x() > 0.0 ? 1 : -1), j);
  const Vec3 from_y = upwind(i, j - (velocity.y() > 0.0 ? 1 : -1));
  return own + x * (from_x - own) + y * (from_y - own);
}

double SoilField::spring(const ContactNode& at) const {
  const SoilNode& node = node_[at.node];
  const double depth = std::max(at.sinkage - node.plastic, 0.0);
  return 0.5 * node.stiffness * depth * depth * grid_.spacing * grid_.spacing;
}

ContactNode SoilField::bear(const NodeHit& hit, double modulus, const Vec3& velocity, const ShearLaw& shear, double dt,
                            SurfaceContactForce& contact, SoilLosses& losses) {
  SoilNode& node = node_[hit.node];
  const bool bore = mark_[hit.node] >= 0;
  const double before = bore ? before_[mark_[hit.node]].sinkage : node.plastic;
  const double area = grid_.spacing * grid_.spacing, rate = -velocity.dot(hit.push);
  const PressureStep pressed = press(law_, modulus, before, hit.sinkage, rate, node);
  losses.compaction += area * pressed.compaction;
  losses.damping += area * (pressed.pressure - pressed.elastic) * rate * dt;

  const double tilt = hit.push.norm();  // 1/|n_z|
  const Vec3 normal = hit.push / tilt;
  ContactNode now{hit.node, hit.sinkage, area * tilt * shear.limit(pressed.pressure),
                  laid_into(carried(hit.node, velocity, dt), normal)};
  if (bore) {
    const ContactNode& old = before_[mark_[hit.node]];
    losses.opening += shear.stored(old.limit, old.mobilized);
  }
  losses.opening -= shear.stored(now.limit, now.mobilized);
  const ShearStep sheared = scm::shear(shear, along(velocity, normal), dt, now.mobilized);
  losses.sliding += now.limit * sheared.sliding;

  contact = SurfaceContactForce();
  contact.triangle = hit.triangle;
  contact.weight = hit.weight;
  contact.normal = area * pressed.pressure * hit.push;
  contact.tangential = -now.limit * sheared.mean;
  contact.tangent = tangent(normal, area * tilt * tilt, node, pressed.pressure, shear, now);
  return now;
}

/// The spring's answer, on the curve of first loading as well: a surface that goes back meets the spring there.
/// @param area of the cell over n_z², m²: a motion along the normal sinks that much faster, and is pushed as much more
SurfaceContactTangent SoilField::tangent(const Vec3& normal, double area, const SoilNode& node, double pressure,
                                         const ShearLaw& shear, const ContactNode& now) const {
  const bool damped = pressure > 0.0 && pressure < node.yield;
  const double free = std::max(0.0, 1.0 - now.mobilized.squaredNorm());
  return {normal, area * node.stiffness, now.limit / shear.K * free, damped ? area * law_.damping : 0.0, 0.0};
}

/// Nodes that bore the surface and do not any more: what their springs held is gone.
void SoilField::release(const ShearLaw& shear, SoilLosses& losses) {
  for (const ContactNode& old : before_) {
    if (mark_[old.node] == kUncovered) continue;  // bears still
    losses.opening += spring(old) + shear.stored(old.limit, old.mobilized);
  }
}

void SoilField::step(const SurfaceNow& now, const ShearLaw& shear, double dt, std::vector<ContactNode>& bearing,
                     std::vector<SurfaceContactForce>& contacts, SoilLosses& losses) {
  FURROW_ASSERT(dt > 0.0, dt);
  finder_.find(now.triangles, now.position, kCover * grid_.spacing, hits_);
  before_.swap(bearing);
  for (const NodeHit& hit : hits_) mark_[hit.node] = kCovered;
  for (std::size_t k = 0; k < before_.size(); ++k) mark_[before_[k].node] = static_cast<std::int32_t>(k);

  touching_.clear(), cells_.clear(), contacts.clear(), bearing.clear();
  for (std::size_t k = 0; k < hits_.size(); ++k) {
    if (!(hits_[k].sinkage > node_[hits_[k].node].plastic)) continue;
    touching_.push_back(static_cast<int>(k));
    cells_.push_back(grid_.cell(hits_[k].node));
  }
  find_moduli();
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    const NodeHit& hit = hits_[touching_[k]];
    const auto& v = now.triangles[hit.triangle];
    Vec3 velocity = Vec3::Zero(), point = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      velocity += hit.weight[c] * now.velocity[v[c]];
      point += hit.weight[c] * now.position[v[c]];
    }
    SurfaceContactForce contact;
    bearing.push_back(bear(hit, modulus_[k], velocity, shear, dt, contact, losses));
    contact.point = point;
    contacts.push_back(contact);
  }
  for (const NodeHit& hit : hits_)
    if (mark_[hit.node] == kCovered) mark_[hit.node] = kUncovered;
  for (const ContactNode& one : bearing) mark_[one.node] = kUncovered;
  release(shear, losses);
  for (const ContactNode& old : before_) mark_[old.node] = kUncovered;
}

double SoilField::pressed(std::span<const ContactNode> bearing) const {
  double sum = 0.0;
  for (const ContactNode& one : bearing) sum += spring(one);
  return sum;
}

double SoilField::sheared(const ShearLaw& shear, std::span<const ContactNode> bearing) const {
  double sum = 0.0;
  for (const ContactNode& one : bearing) sum += shear.stored(one.limit, one.mobilized);
  return sum;
}

}  // namespace furrow::terrain::scm
