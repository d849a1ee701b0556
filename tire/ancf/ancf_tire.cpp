#include "tire/ancf/ancf_tire.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "tire/ancf/inflation.hpp"
#include "tire/surface_strain.hpp"

namespace furrow::tire {
namespace {

constexpr int kMaxHalvings = 4;  // of a step that does not converge

/// Area of the shell, m².
double shell_area(const ShellMesh& ring, const SurfaceMesh& surface, const ShellLayout& layout) {
  FURROW_ASSERT(surface.vertex_count >= ring.nodes(), surface.vertex_count, ring.nodes());
  const Field shape = undeformed(ring);
  const auto at = [&](int v) { return layout.get(shape, v / ring.rows, v % ring.rows, 0); };
  double area = 0.0;
  for (const auto& [a, b, c] : surface.triangles)
    if (std::max({a, b, c}) < ring.nodes()) area += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
  return area;
}

}  // namespace

AncfTire::AncfTire(const TireFile& file, const ShellIntegratorParams& params, std::function<void()> alive)
    : Tire(params.gravity),
      alive_(std::move(alive)),
      ring_(make_shell_mesh(file)),
      clearance_(file, ring_),
      integrator_(file, ring_, [&] {
        ShellIntegratorParams p = params;
        p.damping = file.structural_damping;
        return p;
      }()) {
  TireFile bare = file;
  bare.tread_mass_per_area = 0.0;
  shape_.mesh = make_surface_mesh(ring_);
  shape_.material = file.contact;
  shape_.material.area_density =
      rigid_mass(ring_, element_masses(bare, ring_)).mass / shell_area(ring_, shape_.mesh, integrator_.layout()) +
      file.tread_mass_per_area;
  shape_.mass = rigid_mass(ring_, element_masses(file, ring_));
  shape_.radius = file.radius;
  shape_.tread_width = furrow::tire::tread_width(file, ring_);
  undeformed_volume_ = integrator_.shell().volume(undeformed(ring_), Vec3::Zero());
  force_.assign(integrator_.layout().size(), 0.0);
}

void AncfTire::set_pressure(double pressure) {
  FURROW_ASSERT(std::isfinite(pressure), pressure);
  const double before = integrator_.shell().pressure();
  if (pressure == before) return;
  if (placed())
    pressure_work_ +=
        (pressure - before) * (integrator_.shell().volume(integrator_.q(), rim_.position) - undeformed_volume_);
  integrator_.set_pressure(pressure);
}

void AncfTire::do_place(const RimState& rim) {
  const ShellLayout& layout = integrator_.layout();
  InflationReport inflation;
  const Field shape = inflate(integrator_.shell(), ring_, inflation, alive_);
  const Mat3 turn = rim.orientation.toRotationMatrix();
  Field q(layout.size()), v(layout.size());
  for (int j = 0; j < layout.rows; ++j)
    for (int i = 0; i < layout.columns; ++i) {
      const Vec3 arm = turn * layout.get(shape, i, j, 0), director = turn * layout.get(shape, i, j, 3);
      layout.set(q, i, j, 0, rim.position + arm);
      layout.set(q, i, j, 3, director);
      layout.set(v, i, j, 0, rim.velocity + rim.angular_velocity.cross(arm));
      layout.set(v, i, j, 3, rim.angular_velocity.cross(director));
    }
  layout.fill_padding(q);
  layout.fill_padding(v);
  integrator_.start(q, v);
  rim_ = rim;
  spindle_ = {};
  pressure_work_ = 0.0;
}

void AncfTire::surface(SurfaceState& out) const {
  const ShellLayout& layout = integrator_.layout();
  out.position.resize(shape_.mesh.vertex_count);
  out.velocity.resize(shape_.mesh.vertex_count);
  for (int i = 0; i < layout.columns; ++i)
    for (int j = 0; j < layout.rows; ++j) {
      out.position[ring_.node(i, j)] = layout.get(integrator_.q(), i, j, 0);
      out.velocity[ring_.node(i, j)] = layout.get(integrator_.v(), i, j, 0);
    }
  for (int side = 0; side < 2; ++side) {
    const Vec3 arm = rim_.orientation * ring_.disc_centre(side);
    out.position[ring_.nodes() + side] = rim_.position + arm;
    out.velocity[ring_.nodes() + side] = rim_.velocity + rim_.angular_velocity.cross(arm);
  }
}

std::vector<float> AncfTire::strain() const {
  SurfaceState now;
  surface(now);
  std::vector<Vec3> undeformed(now.position.size());
  for (int i = 0; i < ring_.columns; ++i)
    for (int j = 0; j < ring_.rows; ++j) undeformed[ring_.node(i, j)] = ring_.node_position(i, j);
  for (int side = 0; side < 2; ++side) undeformed[ring_.nodes() + side] = ring_.disc_centre(side);
  return surface_strain(shape_.mesh, undeformed, now.position);
}

Outcome AncfTire::do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) {
  const ShellLayout& layout = integrator_.layout();
  about_ = 0.5 * (rim.start().position + rim.end().position);
  spindle_ = {};
  Wrench disc;
  std::fill(force_.begin(), force_.end(), 0.0);
  ShellContact& contact = integrator_.contact();
  contact.clear();
  answering_.clear();
  interval_ = rim.duration();
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    const int vertex = forces.vertex[k];
    if (vertex < ring_.nodes()) {
      const int i = vertex / ring_.rows, j = vertex % ring_.rows;
      layout.set(force_, i, j, 0, forces.force[k]);
      const bool answers = !forces.tangent.empty() && j > 0 && j + 1 < ring_.rows &&
                           !(forces.tangent[k].stiffness.isZero(0.0) && forces.tangent[k].damping.isZero(0.0));
      if (answers) answering_.emplace_back(k, contact.add(i, j, forces.force[k], forces.tangent[k]));
      continue;
    }
    const Mat3 mean = 0.5 * (rim.start().orientation.toRotationMatrix() + rim.end().orientation.toRotationMatrix());
    disc.force += forces.force[k];
    disc.moment += (mean * ring_.disc_centre(vertex - ring_.nodes())).cross(forces.force[k]);
  }
  for (int n = 1; n <= substeps; ++n) {
    Outcome outcome = step(rim, n - 1.0, n, substeps, kMaxHalvings);
    if (!outcome.ok) return outcome;
  }
  rim_ = rim.end();
  spindle_.force += disc.force;
  spindle_.moment += disc.moment;
  return clearance_.outcome(clearance_.measure(layout, integrator_.q(), rim_));
}

void AncfTire::acted(NodalForces& forces) const {
  FURROW_ASSERT(answering_.empty() || interval_ > 0.0, answering_.size(), interval_);
  FURROW_ASSERT(answering_.empty() || answering_.back().first < forces.force.size(), answering_.size(),
                forces.force.size());
  for (const auto& [k, entry] : answering_) forces.force[k] = integrator_.contact().impulse(entry) / interval_;
}

/// Makes the step from `from` to `to`, counted in substeps; in halves if the iteration does not converge.
Outcome AncfTire::step(const RimTrajectory& rim, double from, double to, int substeps, int halvings) {
  FURROW_ASSERT(from < to && to <= substeps && halvings >= 0, from, to, substeps, halvings);
  const double share = (to - from) / substeps;
  const RimState start = from == 0.0 ? rim.start() : rim.at(from / substeps).state,
                 end = to == substeps ? rim.end() : rim.at(to / substeps).state;
  Wrench part;
  Outcome outcome = integrator_.step(share * rim.duration(), start, end, force_, about_, part);
  if (outcome.ok) {
    spindle_.force += share * part.force;
    spindle_.moment += share * part.moment;
    return outcome;
  }
  if (halvings == 0) return outcome;
  const double middle = 0.5 * (from + to);
  outcome = step(rim, from, middle, substeps, halvings - 1);
  return outcome.ok ? step(rim, middle, to, substeps, halvings - 1) : outcome;
}

TireDiagnostics AncfTire::diagnostics() const {
  const ShellLayout& layout = integrator_.layout();
  const Field &q = integrator_.q(), &v = integrator_.v(), &p = integrator_.momenta();
  TireDiagnostics d;
  d.kinetic_energy = 0.0;
  d.momentum = Vec3::Zero();
  for (int j = 0; j < layout.rows; ++j)
    for (int c = 0; c < 6; ++c) {
      double sum = 0.0, energy = 0.0;
      for (int i = 0; i < layout.columns; ++i) {
        const std::size_t k = layout.offset(j, c) + i;
        sum += p[k];
        energy += 0.5 * p[k] * v[k];
      }
      d.kinetic_energy += energy;
      if (c < 3) d.momentum[c] += sum;
    }
  const double volume = integrator_.shell().volume(q, rim_.position);
  d.elastic_energy = integrator_.elastic_energy();
  d.pressure_energy = pressure_work_ - integrator_.shell().pressure() * (volume - undeformed_volume_);
  d.potential_energy = integrator_.potential_energy();
  d.dissipation = integrator_.dissipation();
  d.numerical_loss = integrator_.numerical_loss();
  d.solver_loss = integrator_.solver_loss();
  d.solver_impulse = integrator_.solver_impulse();
  return d;
}

NamedValues AncfTire::figures() const {
  return {{"newton_iterations", static_cast<double>(integrator_.iterations())},
          {"factorizations", static_cast<double>(integrator_.factorizations())},
          {"factorizations_whole", integrator_.factor_work()},
          {"residual", integrator_.residual()}};
}

NamedValues AncfTire::times() const {
  const ShellIntegrator::Times t = integrator_.times();
  return {{"force", t.force}, {"jacobian", t.jacobian}, {"factorize", t.factorize}, {"solve", t.solve}};
}

void AncfTire::add_state(Hash& hash) const {
  hash.add(std::span<const double>(integrator_.q()));
  hash.add(std::span<const double>(integrator_.v()));
}

void AncfTire::save(Archive& archive) const {
  const Archive::Scope scope(archive, "ancf/");
  save_fields(archive, "rim", rim_);
  save_fields(archive, "spindle", spindle_);
  archive.put("pressure_work", pressure_work_);
  integrator_.save(archive);
}

void AncfTire::do_restore(const Archive& archive) {
  const Archive::Scope scope(archive, "ancf/");
  restore_fields(archive, "rim", rim_);
  restore_fields(archive, "spindle", spindle_);
  pressure_work_ = archive.get_double("pressure_work");
  integrator_.restore(archive);
}

}  // namespace furrow::tire
