#include "terrain/scm/scm_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/key_schema.hpp"
#include "terrain/scm/scm_contact.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain::scm {
namespace {

// How deep a surface may be in the ground when it is attached, m: static contact, not a misplaced tire.
constexpr double kMaxStartDepth = 5e-3;
constexpr double kMostNodes = 1e8;
constexpr double kLeastAcross = 4.0;  // nodes under the width of a surface: fewer give a fifth of error and more

/// One attached surface and the buffers of its substeps.
struct SoilSurface {
  SurfaceMesh mesh;
  ContactMaterial material;
  ShearLaw shear;
  std::vector<Vec3> last;      // where the ground last had the vertices, m
  std::vector<Vec3> end;       // where they will be at the end of the interval, m
  std::vector<Vec3> velocity;  // of the running interval, m/s
  std::vector<Vec3> position;  // at the middle of the running substep, m
  std::vector<ContactNode> bearing;
  std::vector<SurfaceContactForce> contacts;
  NodalForceSum sum;
  double floor_force = 0.0;  // N
};

std::vector<double> heights_at_nodes(const ScmOptions& options) {
  std::vector<double> out;
  const GroundHeights heights = options.shape.heights();
  if (!heights) return out;
  const Grid grid = Grid::over(options.length, options.width, options.grid_spacing);
  out.reserve(grid.count());
  for (int i = 0; i < grid.nx; ++i)
    for (int j = 0; j < grid.ny; ++j) out.push_back(heights(grid.x(i), grid.y(j)));
  return out;
}

class ScmGround final : public Terrain {
 public:
  explicit ScmGround(const ScmOptions& options)
      : Terrain(true),
        options_(options),
        soil_(Grid::over(options.length, options.width, options.grid_spacing),
              {.k_c = options.bekker_k_c,
               .k_phi = options.bekker_k_phi,
               .n = options.bekker_n,
               .unloading = options.unloading_stiffness,
               .unloading_rate = options.unloading_stiffness_rate,
               .damping = options.rebound_damping},
              options.patch_width, heights_at_nodes(options)),
        heights_(options.shape.heights()) {}

  double gather_top_height(double x_min, double x_max, double y_min, double y_max) const override;
  double gather_mean_height(double x_min, double x_max, double y_min, double y_max) const override;
  double floor_height() const override { return -std::numeric_limits<double>::infinity(); }
  HeightField gather_height_field() const override;
  TerrainState gather_state() const override;
  std::int64_t size() const override { return 0; }
  void gather_frame(TerrainFrame& out) const override;
  void save(Archive& archive) const override;

 private:
  double do_prepare(const ProgressCall&) override { return 0.0; }
  void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) override;
  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> contact) override;
  void do_restore(const Archive& archive) override;
  std::size_t attached() const override { return surfaces_.size(); }
  std::size_t vertices(std::size_t k) const override { return surfaces_[k].last.size(); }

  friend void visit_fields(FieldsOf<ScmGround> auto& s, auto&& visit) {
    visit(s.surface_impulse_, Field{"surface_impulse", "N s"});
    visit(s.surface_work_, Field{"surface_work", "J"});
    visit(s.losses_, Field{"losses", "J"});
  }

  template <class Use>
  void each_node(double x_min, double x_max, double y_min, double y_max, Use&& use) const;
  void add_surface(const SurfaceMesh& mesh, const ContactMaterial& material, std::vector<Vec3> last);
  double ground_at(const Vec3& x) const { return heights_ ? heights_(x.x(), x.y()) : 0.0; }  // before the run, m
  Outcome set_motion(SoilSurface& surface, const SurfaceState& target, double duration, std::size_t k) const;

  ScmOptions options_;
  SoilField soil_;
  GroundHeights heights_;  // before the run; empty: level
  std::vector<SoilSurface> surfaces_;
  Vec3 surface_impulse_ = Vec3::Zero();  // by surfaces on the ground, N s
  double surface_work_ = 0.0;            // by the ground on surfaces, J
  SoilLosses losses_;
};

template <class Use>
void ScmGround::each_node(double x_min, double x_max, double y_min, double y_max, Use&& use) const {
  const Grid& grid = soil_.grid();
  const int i_end = grid.first_x(x_max), j_begin = grid.first_y(y_min), j_end = grid.first_y(y_max);
  for (int i = grid.first_x(x_min); i < i_end; ++i)
    for (int j = j_begin; j < j_end; ++j) use(soil_.height(grid.index(i, j)));
}

double ScmGround::gather_top_height(double x_min, double x_max, double y_min, double y_max) const {
  double most = -std::numeric_limits<double>::infinity();
  each_node(x_min, x_max, y_min, y_max, [&](double height) { most = std::max(most, height); });
  return std::isfinite(most) ? most : 0.0;
}

double ScmGround::gather_mean_height(double x_min, double x_max, double y_min, double y_max) const {
  double sum = 0.0;
  std::int64_t count = 0;
  each_node(x_min, x_max, y_min, y_max, [&](double height) { sum += height, ++count; });
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

HeightField ScmGround::gather_height_field() const {
  const Grid& grid = soil_.grid();
  HeightField field;
  field.x0 = grid.x(0);
  field.y0 = grid.y(0);
  field.cell = grid.spacing;
  field.nx = grid.nx;
  field.ny = grid.ny;
  field.height.reserve(soil_.nodes().size());
  for (int k = 0; k < grid.count(); ++k) field.height.push_back(soil_.height(k));
  return field;
}

/// A point for each node.
void ScmGround::gather_frame(TerrainFrame& out) const {
  const Grid& grid = soil_.grid();
  out = TerrainFrame{};
  for (int k = 0; k < grid.count(); ++k) {
    const auto [i, j] = grid.cell(k);
    for (const double value : {grid.x(i), grid.y(j), soil_.height(k)})
      out.position.push_back(static_cast<float>(value));
  }
  out.speed.assign(grid.count(), 0.0F);
  out.radius.assign(grid.count(), static_cast<float>(0.5 * grid.spacing));
}

void ScmGround::add_surface(const SurfaceMesh& mesh, const ContactMaterial& material, std::vector<Vec3> last) {
  FURROW_ASSERT(last.size() == static_cast<std::size_t>(mesh.vertex_count), last.size(), mesh.vertex_count);
  const ShearLaw shear{.cohesion = options_.mohr_cohesion,
                       .tan_phi = std::tan(kDegree * options_.mohr_friction_angle),
                       .K = options_.janosi_k,
                       .friction = material.friction};
  surfaces_.push_back({.mesh = mesh,
                       .material = material,
                       .shear = shear,
                       .last = std::move(last),
                       .end = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                       .velocity = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                       .position = std::vector<Vec3>(mesh.vertex_count, Vec3::Zero()),
                       .bearing = {},
                       .contacts = {},
                       .sum = NodalForceSum(mesh.vertex_count, options_.contact_tangents)});
}

void ScmGround::do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) {
  double deepest = 0.0;
  for (const Vec3& x : start.position) deepest = std::max(deepest, ground_at(x) - x.z());
  if (deepest > kMaxStartDepth)
    throw input_error(fmt::format("surface {}", surfaces_.size()), "",
                      fmt::format("starts {:g} m below the ground, expected at most {:g} m", deepest, kMaxStartDepth));
  add_surface(mesh, material, start.position);
}

/// Where the vertices will be at the end of the interval, and their velocity.
Outcome ScmGround::set_motion(SoilSurface& surface, const SurfaceState& target, double duration, std::size_t k) const {
  const std::size_t count = surface.last.size();
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3 end = target.position[v] + duration * target.velocity[v];
    if ((end.x() < 0.0 || end.x() > options_.length || std::abs(end.y()) > 0.5 * options_.width) &&
        end.z() < ground_at(end))
      return Outcome::failure(
          "was left by a tire",
          fmt::format("surface {} stands beside it, x = ({:.6g}, {:.6g}, {:.6g}) m", k, end.x(), end.y(), end.z()));
    surface.velocity[v] = (end - surface.last[v]) / duration;
    surface.end[v] = end;
  }
  return {};
}

Outcome ScmGround::do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                              std::span<NodalForces> forces, std::span<ContactSums> contact) {
  const double dt = duration / substeps;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    SoilSurface& surface = surfaces_[k];
    if (Outcome moved = set_motion(surface, targets[k], duration, k); !moved.ok) return moved;
    for (int s = 0; s < substeps; ++s) {
      const double share = (s + 0.5) / substeps;
      for (std::size_t v = 0; v < surface.end.size(); ++v)
        surface.position[v] = surface.last[v] + share * (surface.end[v] - surface.last[v]);
      const SurfaceNow now{surface.mesh.triangles, surface.position, surface.velocity};
      soil_.step(now, surface.shear, dt, surface.bearing, surface.contacts, losses_);
      surface.sum.add_substep(surface.contacts, now, dt);
    }
    surface.floor_force = 0.0;
    for (const auto& one : surface.contacts) surface.floor_force += one.normal.z() + one.tangential.z();
    surface_impulse_ -= surface.sum.impulse();
    surface.sum.finish(duration, forces[k], contact[k]);
    surface_work_ += contact[k].work;
    surface.last = surface.end;
  }
  return {};
}

TerrainState ScmGround::gather_state() const {
  TerrainState state;
  for (const SoilSurface& surface : surfaces_) {
    state.energies.elastic_normal += soil_.pressed(surface.bearing);
    state.energies.elastic_tangential += soil_.sheared(surface.shear, surface.bearing);
    state.floor_force += surface.floor_force;
    state.contacts += static_cast<std::int64_t>(surface.bearing.size());
  }
  TerrainEnergies& e = state.energies;
  state.elastic_energy = e.elastic_normal + e.elastic_tangential;
  e.sliding_loss = losses_.sliding;
  e.normal_damping_loss = losses_.compaction + losses_.damping;
  e.opening_loss = losses_.opening;
  e.surface_work = -surface_work_;
  state.momenta = held_by_the_world(surface_impulse_);
  return state;
}

void ScmGround::save(Archive& archive) const {
  std::vector<double> plastic, yield, stiffness;
  for (const SoilNode& node : soil_.nodes()) {
    plastic.push_back(node.plastic);
    yield.push_back(node.yield);
    stiffness.push_back(node.stiffness);
  }
  save_fields(archive, "ground", *this);
  archive.put("ground/plastic", plastic);
  archive.put("ground/yield", yield);
  archive.put("ground/stiffness", stiffness);
  archive.put("ground/surfaces", static_cast<std::int64_t>(surfaces_.size()));
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const SoilSurface& surface = surfaces_[k];
    const Archive::Scope scope(archive, "ground/surface_" + std::to_string(k) + "/");
    save_fields(archive, "mesh", surface.mesh);
    save_fields(archive, "material", surface.material);
    save_value(archive, "last", surface.last);
    save_value(archive, "bearing", surface.bearing);
    archive.put("floor_force", surface.floor_force);
  }
}

void ScmGround::do_restore(const Archive& archive) {
  surfaces_.clear();
  restore_fields(archive, "ground", *this);
  std::vector<double> plastic, yield, stiffness;
  const std::size_t nodes = soil_.nodes().size();
  restore_value(archive, "ground/plastic", plastic, nodes);
  restore_value(archive, "ground/yield", yield, nodes);
  restore_value(archive, "ground/stiffness", stiffness, nodes);
  for (std::size_t k = 0; k < nodes; ++k) soil_.nodes()[k] = {plastic[k], yield[k], stiffness[k]};
  const std::int64_t count = archive.get_int("ground/surfaces");
  for (std::int64_t k = 0; k < count; ++k) {
    const Archive::Scope scope(archive, "ground/surface_" + std::to_string(k) + "/");
    SurfaceMesh mesh;
    ContactMaterial material;
    std::vector<Vec3> last;
    restore_fields(archive, "mesh", mesh);
    restore_fields(archive, "material", material);
    restore_value(archive, "last", last, mesh.vertex_count);
    add_surface(mesh, material, std::move(last));
    SoilSurface& surface = surfaces_.back();
    restore_value(archive, "bearing", surface.bearing);
    for (const ContactNode& one : surface.bearing)
      if (one.node < 0 || one.node >= soil_.grid().count())
        throw Error(ExitCode::io, "a saved contact names a node that is not in the grid");
    surface.floor_force = archive.get_double("floor_force");
  }
}

}  // namespace

void check_scm_width(const ScmOptions& o, double width) {
  if (o.grid_spacing > width / kLeastAcross)
    throw input_error(
        o.scenario, "terrain.grid_spacing",
        fmt::format("is {:g} m, expected at most {:.3g} m, a quarter of the tire's width (a tenth is good)",
                    o.grid_spacing, width / kLeastAcross));
  const double least = -o.bekker_k_phi * width;
  if (o.patch_width < 0.0 && o.bekker_k_c <= least)
    throw input_error(
        o.scenario, "terrain.bekker_k_c",
        fmt::format("is {:g}, expected above {:.3g}: k_c/b + k_phi has to be above 0 for a b of the tire's "
                    "width, {:.3g} m",
                    o.bekker_k_c, least, width));
}

void check_scm_options(const ScmOptions& o) {
  check_values(o, o.scenario, "terrain");
  if (o.patch_width >= 0.0 && !(o.bekker_k_c / o.patch_width + o.bekker_k_phi > 0.0))
    throw input_error(
        o.scenario, "terrain.bekker_k_c",
        fmt::format("is {:g}, expected k_c/b + k_phi above 0 with b = terrain.patch_width", o.bekker_k_c));
  const double nodes = std::ceil(o.length / o.grid_spacing) * std::ceil(o.width / o.grid_spacing);
  if (!(nodes <= kMostNodes))
    throw input_error(o.scenario, "terrain.grid_spacing",
                      fmt::format("is {:g}: {:g} m x {:g} m have {:.3g} nodes, expected at most {:g}", o.grid_spacing,
                                  o.length, o.width, nodes, kMostNodes));
}

std::int64_t scm_nodes(const ScmOptions& options) {
  return Grid::over(options.length, options.width, options.grid_spacing).count();
}

std::unique_ptr<Terrain> make_scm_ground(const ScmOptions& options) {
  check_scm_options(options);
  return std::make_unique<ScmGround>(options);
}

}  // namespace furrow::terrain::scm
