#include "terrain/rigid/rigid_ground.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/key_schema.hpp"
#include "terrain/rigid/ground_accounts.hpp"
#include "terrain/rigid/ground_friction.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/ground_pressure.hpp"
#include "terrain/rigid/ground_profile.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain {
namespace {

// How deep a surface may be in the ground when it is attached, m: static contact, not a misplaced tire.
constexpr double kMaxStartDepth = 5e-3;
// The plane has no end; one cell of this size stands for it in pictures of heights, m.
constexpr double kFieldCell = 10.0;
// A profile has so many cells from its first corner to its last, and half of them on
// either side, of this size at least.
constexpr int kFieldCells = 200;
constexpr double kLeastFieldCell = 0.01;  // m

/// One attached surface and the buffers of its substeps.
struct GroundSurface {
  SurfaceMesh mesh;
  ContactMaterial material;
  double friction = 0.0;            // -, of the pair
  std::vector<Vec3> last;           // where the ground last had the vertices, m
  std::vector<Vec3> velocity;       // of the running interval, m/s
  std::vector<Vec3> position;       // at the middle of the running substep, m
  std::vector<Vec3> shear;          // of the layer under each vertex, m
  std::vector<double> load, area;   // of each vertex in the running substep, N, m²
  std::vector<double> area_before;  // in the one before, m²
  std::vector<Vec3> push;           // of each vertex on a profile: its normal force in the running substep, N
  std::vector<SurfaceContactForce> contacts;
  std::vector<std::pair<int, int>> corner;  // of each vertex: one of its triangles, and which corner it is there
  StatedContact stated;                     // by the tire, of the running interval
  NodalForceSum sum;
  std::int64_t contact_count = 0;
  double pressed = 0.0, sheared = 0.0;  // elastic energy of the layer, J
  double floor_force = 0.0;             // N
};

Vec3 weighted(const std::array<double, 3>& weight, const std::vector<Vec3>& values, const std::array<int, 3>& at) {
  return weight[0] * values[at[0]] + weight[1] * values[at[1]] + weight[2] * values[at[2]];
}

class RigidGround final : public Terrain {
 public:
  explicit RigidGround(const GroundOptions& options)
      : Terrain(true),
        options_(options),
        profile_(options.profile),
        plane_(!options.map && profile_.level(profile_.first(), profile_.last(), 0.0)),
        height_(plane_ ? profile_.height(0.0) : 0.0) {
    if (options.map) map_.emplace(*options.map);
    check_values(options, options.scenario, "terrain");
  }

  double gather_top_height(double from, double to, double right, double left) const override {
    return map_ ? map_->highest(from, to, right, left) : profile_.highest(from, to);
  }
  double gather_mean_height(double from, double to, double right, double left) const override {
    return map_ ? map_->mean(from, to, right, left) : profile_.mean(from, to);
  }
  double floor_height() const override { return 0.0; }
  HeightField gather_height_field() const override;
  void state_contacts(std::span<const StatedContact> contacts) override;
  TerrainState gather_state() const override;
  std::int64_t size() const override { return 0; }
  void gather_frame(TerrainFrame& out) const override { out = TerrainFrame{}; }
  void save(Archive& archive) const override;

 private:
  double do_prepare(const ProgressCall&) override { return 0.0; }
  void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) override;
  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> contact) override;
  void do_restore(const Archive& archive) override;
  std::size_t attached() const override { return surfaces_.size(); }
  std::size_t vertices(std::size_t k) const override { return surfaces_[k].last.size(); }

  friend void visit_fields(FieldsOf<RigidGround> auto& s, auto&& visit) {
    visit(s.surface_impulse_, Field{"surface_impulse", "N s"});
    visit(s.surface_work_, Field{"surface_work", "J"});
    visit(s.losses_, Field{"losses", "J"});
  }

  void add_surface(const SurfaceMesh& mesh, const ContactMaterial& material, std::vector<Vec3> last);
  int plane_points(std::array<Vec3, 3> corner, std::array<GroundPoint, kMaxGroundPoints>& points) const;
  void press(GroundSurface& surface, double dt);
  void press_profile(GroundSurface& surface, const GroundLaw& law, double dt);
  void give_stated(GroundSurface& surface, double dt);
  void rub(GroundSurface& surface, const GroundLaw& law, double dt);
  void measure(GroundSurface& surface) const;
  double measure_profile(const GroundSurface& surface) const;
  int uneven_points(const std::array<Vec3, 3>& corner, ProfilePointList& points) const;
  Vec3 pressed_normal(const std::array<Vec3, 3>& x) const;

  GroundOptions options_;
  GroundProfile profile_;
  std::optional<GroundMap> map_;  // in place of the profile
  bool plane_;                    // there is no map, and no profile, or it is level everywhere
  double height_;                 // of the plane, m
  std::vector<GroundSurface> surfaces_;
  Vec3 surface_impulse_ = Vec3::Zero();  // by surfaces on the ground, N s
  double surface_work_ = 0.0;            // by the ground on surfaces, J
  GroundLosses losses_;
};

HeightField RigidGround::gather_height_field() const {
  HeightField field;
  field.cell = kFieldCell;
  field.x0 = 0.5 * kFieldCell;
  field.nx = field.ny = 1;
  field.height = {height_};
  if (plane_) return field;
  if (map_) return map_->field();
  field.cell = std::max(kLeastFieldCell, (profile_.last() - profile_.first()) / kFieldCells);
  field.x0 = profile_.first() - 0.5 * kFieldCells * field.cell;
  field.nx = 2 * kFieldCells;
  field.height.clear();
  for (int k = 0; k < field.nx; ++k) field.height.push_back(profile_.height(field.x0 + k * field.cell));
  return field;
}

void RigidGround::add_surface(const SurfaceMesh& mesh, const ContactMaterial& material, std::vector<Vec3> last) {
  FURROW_ASSERT(last.size() == static_cast<std::size_t>(mesh.vertex_count), last.size(), mesh.vertex_count);
  GroundSurface surface{.mesh = mesh,
                        .material = material,
                        .friction = material.pair_friction >= 0.0 ? material.pair_friction
                                                                  : std::min(options_.friction, material.friction),
                        .last = std::move(last),
                        .velocity = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                        .position = {},
                        .shear = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                        .load = std::vector<double>(mesh.vertex_count, 0.0),
                        .area = std::vector<double>(mesh.vertex_count, 0.0),
                        .area_before = std::vector<double>(mesh.vertex_count, 0.0),
                        .push = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                        .contacts = {},
                        .corner = std::vector<std::pair<int, int>>(mesh.vertex_count, {-1, 0}),
                        .stated = {},
                        .sum = NodalForceSum(mesh.vertex_count, options_.contact_tangents)};
  surface.position = surface.last;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) surface.corner[mesh.triangles[t][k]] = {t, k};
  surfaces_.push_back(std::move(surface));
  measure(surfaces_.back());
}

void RigidGround::do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) {
  double deepest = 0.0;
  for (const Vec3& x : start.position)
    deepest = std::max(deepest, plane_ ? height_ - x.z() : map_ ? map_->depth(x) : profile_.depth(x.x(), x.z()));
  if (deepest > kMaxStartDepth)
    throw input_error("surface " + std::to_string(surfaces_.size()), "",
                      "starts " + std::to_string(deepest) + " m below the ground, expected at most " +
                          std::to_string(kMaxStartDepth) + " m");
  add_surface(mesh, material, start.position);
}

/// Integration points of the part of a triangle below the plane.
int RigidGround::plane_points(std::array<Vec3, 3> corner, std::array<GroundPoint, kMaxGroundPoints>& points) const {
  if (corner[0].z() >= height_ && corner[1].z() >= height_ && corner[2].z() >= height_) return 0;
  for (Vec3& x : corner) x.z() -= height_;
  return ground_points(corner, points);
}

/// Contact forces with the surface at `position`, moving with `velocity` for dt.
void RigidGround::press(GroundSurface& surface, double dt) {
  const GroundLaw law{.stiffness = options_.ground_stiffness,
                      .damping = options_.ground_damping,
                      .shear_stiffness = options_.ground_shear_stiffness,
                      .friction = surface.friction,
                      .velocity_scale = options_.friction_velocity_scale};
  surface.contacts.clear();
  surface.area.swap(surface.area_before);
  std::fill(surface.load.begin(), surface.load.end(), 0.0);
  std::fill(surface.area.begin(), surface.area.end(), 0.0);
  if (!plane_) {
    press_profile(surface, law, dt);
    return;
  }
  std::array<GroundPoint, kMaxGroundPoints> points;
  const auto& x = surface.position;
  for (int t = 0; t < static_cast<int>(surface.mesh.triangles.size()); ++t) {
    const auto& v = surface.mesh.triangles[t];
    const int count = plane_points({x[v[0]], x[v[1]], x[v[2]]}, points);
    for (int i = 0; i < count; ++i) {
      const Vec3 velocity = weighted(points[i].weight, surface.velocity, v);
      const double force =
          add_ground_force(law, t, points[i], weighted(points[i].weight, x, v), velocity, surface.contacts);
      add_normal_loss(law, points[i], force, velocity.z(), dt, losses_);
      for (int k = 0; k < 3 && force > 0.0; ++k) {
        surface.load[v[k]] += points[i].weight[k] * force;
        surface.area[v[k]] += points[i].weight[k] * points[i].area;
      }
    }
  }
  surface.contact_count = static_cast<std::int64_t>(surface.contacts.size());
  surface.floor_force = 0.0;
  for (const auto& one : surface.contacts) surface.floor_force += one.normal.z();
  rub(surface, law, dt);
}

int RigidGround::uneven_points(const std::array<Vec3, 3>& corner, ProfilePointList& points) const {
  return map_ ? map_->points(corner, points) : profile_points(profile_, corner, points);
}

/// Unit normal of a triangle, outwards, on a profile without its part along y: what the ground presses on per area.
Vec3 RigidGround::pressed_normal(const std::array<Vec3, 3>& x) const {
  Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const double size = normal.norm();
  if (!(size > 0.0)) return Vec3::Zero();
  if (!map_) normal.y() = 0.0;
  return normal / size;
}

/// The same on a profile or a height map: the pressure acts along the surface's normal.
void RigidGround::press_profile(GroundSurface& surface, const GroundLaw& law, double dt) {
  std::fill(surface.push.begin(), surface.push.end(), Vec3::Zero());
  ProfilePointList points;
  const auto& x = surface.position;
  for (int t = 0; t < static_cast<int>(surface.mesh.triangles.size()); ++t) {
    const auto& v = surface.mesh.triangles[t];
    const std::array<Vec3, 3> corner{x[v[0]], x[v[1]], x[v[2]]};
    const Vec3 normal = pressed_normal(corner);
    const int count = uneven_points(corner, points);
    for (int i = 0; i < count; ++i) {
      const GroundPoint& at = points[i];
      const Vec3 velocity = weighted(at.weight, surface.velocity, v);
      const double rate = normal.dot(velocity);  // into the ground, m/s
      const double pressure = std::max(0.0, law.stiffness * at.depth + law.damping * rate);
      losses_.normal_damping += (pressure - law.stiffness * at.depth) * at.area * rate * dt;
      if (!(pressure > 0.0)) continue;
      const double length = normal.norm();
      SurfaceContactForce contact;
      contact.triangle = t;
      contact.weight = at.weight;
      contact.point = weighted(at.weight, x, v);
      contact.normal = -pressure * at.area * normal;
      contact.tangent = {normal / length, law.stiffness * at.area * length, 0.0, law.damping * at.area * length, 0.0};
      surface.contacts.push_back(contact);
      for (int k = 0; k < 3; ++k) {
        surface.push[v[k]] += at.weight[k] * contact.normal;
        surface.area[v[k]] += at.weight[k] * at.area * length;
      }
    }
  }
  for (std::size_t k = 0; k < surface.push.size(); ++k) surface.load[k] = surface.push[k].norm();
  surface.contact_count = static_cast<std::int64_t>(surface.contacts.size());
  surface.floor_force = 0.0;
  for (const auto& one : surface.contacts) surface.floor_force += one.normal.z();
  rub(surface, law, dt);
}

/// Friction of the vertices that bear load, after press().
void RigidGround::rub(GroundSurface& surface, const GroundLaw& law, double dt) {
  for (std::size_t vertex = 0; vertex < surface.shear.size(); ++vertex) {
    const double before = surface.area_before[vertex], now = surface.area[vertex];
    const GroundShear left{surface.shear[vertex], before};
    if (now > before) surface.shear[vertex] *= before / now;  // what has just touched is not yet sheared
    const GroundShear begin{surface.shear[vertex], now};
    double grip = 0.0;
    // Elsewhere shear and friction lie in the plane that the vertex's normal force stands on: x', y'.
    Vec3 along = Vec3::UnitX(), across = Vec3::UnitY(), velocity = surface.velocity[vertex], normal = Vec3::UnitZ();
    if (!plane_ && surface.load[vertex] > 0.0) {
      normal = surface.push[vertex] / surface.load[vertex];
      along = Vec3(normal.z(), 0.0, -normal.x());
      if (map_) along.normalize(), across = normal.cross(along);
      velocity = Vec3(along.dot(velocity), across.dot(velocity), 0.0);
    }
    Vec3 force = slide(law, surface.load[vertex], surface.area[vertex], velocity, dt, surface.shear[vertex], &grip);
    if (before > 0.0 || now > 0.0)
      add_shear_losses(law, left, begin, {surface.shear[vertex], now}, force, velocity, dt, losses_);
    if (!plane_) force = force.x() * along + force.y() * across;
    if (force.isZero(0.0) && !(options_.contact_tangents && grip > 0.0)) continue;
    SurfaceContactForce contact;
    const auto [triangle, corner] = surface.corner[vertex];
    contact.triangle = triangle;
    contact.weight[corner] = 1.0;
    contact.point = surface.position[vertex];
    contact.tangential = force;
    const double held = grip * surface.area[vertex];
    contact.tangent = {normal, 0.0, law.shear_stiffness * held, 0.0, law.damping * held};
    surface.contacts.push_back(contact);
  }
}

void RigidGround::state_contacts(std::span<const StatedContact> contacts) {
  FURROW_ASSERT(contacts.size() == surfaces_.size(), contacts.size(), surfaces_.size());
  for (std::size_t k = 0; k < surfaces_.size(); ++k) surfaces_[k].stated = contacts[k];
}

/// The forces that a tire states, in place of the ground's own: what friction does is lost by sliding, what the others
/// do and the contact does not store is the damping of the pair.
void RigidGround::give_stated(GroundSurface& surface, double dt) {
  const NodalForces& stated = surface.stated.forces;
  FURROW_ASSERT(surface.stated.friction.size() == stated.force.size(), surface.stated.friction.size());
  surface.contacts.clear();
  surface.floor_force = 0.0;
  for (std::size_t i = 0; i < stated.vertex.size(); ++i) {
    FURROW_ASSERT(in_range(stated.vertex[i], surface.corner.size()), stated.vertex[i], surface.corner.size());
    const auto vertex = static_cast<std::size_t>(stated.vertex[i]);
    const auto [triangle, corner] = surface.corner[vertex];
    SurfaceContactForce contact;
    contact.triangle = triangle;
    contact.weight[corner] = 1.0;
    contact.point = surface.position[vertex];
    contact.tangential = surface.stated.friction[i];
    contact.normal = stated.force[i] - contact.tangential;
    surface.contacts.push_back(contact);
    surface.floor_force += contact.normal.z();
    losses_.sliding -= contact.tangential.dot(surface.velocity[vertex]) * dt;
    losses_.normal_damping -= contact.normal.dot(surface.velocity[vertex]) * dt;
  }
  surface.contact_count = static_cast<std::int64_t>(surface.contacts.size());
}

/// Elastic energy ½ κ ∫ g² dA with the surface where the interval ended, and ½ κ_t Σ A ξ² of its shear.
void RigidGround::measure(GroundSurface& surface) const {
  std::array<GroundPoint, kMaxGroundPoints> points;
  surface.pressed = surface.sheared = 0.0;
  if (surface.stated.given) {
    surface.pressed = surface.stated.energy;
    return;
  }
  for (std::size_t v = 0; v < surface.shear.size(); ++v)
    surface.sheared += 0.5 * options_.ground_shear_stiffness * surface.area[v] * surface.shear[v].squaredNorm();
  if (!plane_) {
    surface.pressed = measure_profile(surface);
    return;
  }
  const auto& x = surface.last;
  for (const auto& v : surface.mesh.triangles) {
    const int count = plane_points({x[v[0]], x[v[1]], x[v[2]]}, points);
    for (int i = 0; i < count; ++i)
      surface.pressed += 0.5 * options_.ground_stiffness * points[i].depth * points[i].depth * points[i].area;
  }
}

/// (1) of ground_profile.hpp, (2) of ground_map.hpp.
double RigidGround::measure_profile(const GroundSurface& surface) const {
  double energy = 0.0;
  ProfilePointList points;
  const auto& x = surface.last;
  for (const auto& v : surface.mesh.triangles) {
    const std::array<Vec3, 3> corner{x[v[0]], x[v[1]], x[v[2]]};
    const double down = -pressed_normal(corner).z();
    const int count = uneven_points(corner, points);
    for (int i = 0; i < count; ++i) {
      const GroundPoint& at = points[i];
      const Vec3 point = weighted(at.weight, x, v);
      const double column =
          at.level || map_ ? 0.5 * at.depth * at.depth / at.cosine : profile_.column(point.x(), point.z());
      energy += options_.ground_stiffness * column * down * at.area;
    }
  }
  return energy;
}

Outcome RigidGround::do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                                std::span<NodalForces> forces, std::span<ContactSums> contact) {
  const double dt = duration / substeps;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    GroundSurface& surface = surfaces_[k];
    const std::size_t count = surface.last.size();
    std::vector<Vec3> end(count);
    for (std::size_t v = 0; v < count; ++v) {
      end[v] = targets[k].position[v] + duration * targets[k].velocity[v];
      surface.velocity[v] = (end[v] - surface.last[v]) / duration;
    }
    for (int s = 0; s < substeps; ++s) {
      const double share = (s + 0.5) / substeps;
      for (std::size_t v = 0; v < count; ++v)
        surface.position[v] = surface.last[v] + share * (end[v] - surface.last[v]);
      if (surface.stated.given)
        give_stated(surface, dt);
      else
        press(surface, dt);
      surface.sum.add_substep(surface.contacts, {surface.mesh.triangles, surface.position, surface.velocity}, dt);
    }
    surface_impulse_ -= surface.sum.impulse();
    surface.sum.finish(duration, forces[k], contact[k]);
    surface_work_ += contact[k].work;
    surface.last.swap(end);
    const double pressed = surface.pressed;
    measure(surface);
    if (surface.stated.given) losses_.normal_damping -= surface.pressed - pressed;
  }
  return {};
}

TerrainState RigidGround::gather_state() const {
  TerrainState state;
  for (const GroundSurface& surface : surfaces_) {
    state.energies.elastic_normal += surface.pressed;
    state.energies.elastic_tangential += surface.sheared;
    state.floor_force += surface.floor_force;
    state.contacts += surface.contact_count;
  }
  TerrainEnergies& e = state.energies;
  state.elastic_energy = e.elastic_normal + e.elastic_tangential;
  e.sliding_loss = losses_.sliding;
  e.normal_damping_loss = losses_.normal_damping;
  e.tangential_damping_loss = losses_.tangential_damping;
  e.opening_loss = losses_.opening;
  e.surface_work = -surface_work_;
  state.momenta = held_by_the_world(surface_impulse_);
  return state;
}

void RigidGround::save(Archive& archive) const {
  archive.put("ground/surfaces", static_cast<std::int64_t>(surfaces_.size()));
  save_fields(archive, "ground", *this);
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const GroundSurface& surface = surfaces_[k];
    const Archive::Scope scope(archive, "ground/surface_" + std::to_string(k) + "/");
    save_fields(archive, "mesh", surface.mesh);
    save_fields(archive, "material", surface.material);
    save_value(archive, "last", surface.last);
    save_value(archive, "shear", surface.shear);
    archive.put("area", surface.area);
    archive.put("floor_force", surface.floor_force);
    archive.put("contacts", surface.contact_count);
    if (surface.stated.given) archive.put("stated", surface.stated.energy);
  }
}

void RigidGround::do_restore(const Archive& archive) {
  surfaces_.clear();
  const std::int64_t count = archive.get_int("ground/surfaces");
  restore_fields(archive, "ground", *this);
  for (std::int64_t k = 0; k < count; ++k) {
    const Archive::Scope scope(archive, "ground/surface_" + std::to_string(k) + "/");
    SurfaceMesh mesh;
    ContactMaterial material;
    std::vector<Vec3> last;
    restore_fields(archive, "mesh", mesh);
    restore_fields(archive, "material", material);
    restore_value(archive, "last", last, mesh.vertex_count);
    add_surface(mesh, material, std::move(last));
    restore_value(archive, "shear", surfaces_.back().shear, mesh.vertex_count);
    surfaces_.back().area = archive.get<double>("area");
    if (StatedContact& stated = surfaces_.back().stated; archive.has("stated"))
      stated.given = true, stated.energy = archive.get_double("stated");
    measure(surfaces_.back());
    surfaces_.back().floor_force = archive.get_double("floor_force");
    surfaces_.back().contact_count = archive.get_int("contacts");
  }
}

}  // namespace

std::unique_ptr<Terrain> make_rigid_ground(const GroundOptions& options) {
  return std::make_unique<RigidGround>(options);
}

}  // namespace furrow::terrain
