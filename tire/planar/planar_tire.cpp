#include "tire/planar/planar_tire.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/mean_turn.hpp"
#include "tire/planar/planar_carcass.hpp"

namespace furrow::tire {
namespace {

constexpr int kStepsBetweenChecks = 500;  // of the step's limit in the present shape
constexpr int kMostSteps = 1000;          // in one step of the scenario
constexpr double kLeastRadius = 1.02;     // of outer nodes, in radii of the rim

/// How the plane moves across itself.
struct Rigid {
  Vec3 lateral;  // velocity along the axis, m/s
  Vec3 tilt;     // ω without its part about the axis, rad/s
};

class PlanarTire final : public Tire {
 public:
  PlanarTire(const PlanarFile& file, TireShape shape, const Vec3& gravity)
      : carcass_(file.params),
        shape_(std::move(shape)),
        gravity_(gravity),
        width_(file.params.options.width),
        rim_radius_(file.params.size.rim_radius),
        share_(file.params.step_share),
        load_(carcass_.mesh().position.size()) {
    FURROW_ASSERT(file.params.integrator == PlanarIntegrator::semi_implicit_euler);
    const int n = file.params.size.around;
    node_.resize(n);
    for (int k = 0; k < n; ++k) node_[(n - k) % n] = carcass_.mesh().outer[k];
    shape_.material.area_density = tread_density();
  }

  const SurfaceMesh& mesh() const override { return shape_.mesh; }
  ContactMaterial material() const override { return shape_.material; }
  MassProperties mass_properties() const override { return shape_.mass; }
  double radius() const override { return shape_.radius; }
  double tread_width() const override { return shape_.tread_width; }
  Vec3 gravity() const override { return gravity_; }
  int coordinates() const override { return 2 * carcass_.mesh().nodes(); }

  void set_pressure(double) override {}
  void place(const RimState& rim) override;
  void surface(SurfaceState& out) const override;
  Outcome advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  Wrench spindle_wrench() const override { return spindle_; }
  TireDiagnostics diagnostics() const override;
  NamedValues figures() const override {
    return {{"explicit_steps", static_cast<double>(steps_)}, {"step_limit_s", limit_}};
  }
  void add_state(Hash& hash) const override;
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  /// Vertices of an outer node's pair stand at ± half the width; the last two at the middle of the sides.
  bool on_tread(int vertex) const { return vertex < 2 * static_cast<int>(node_.size()); }
  double side(int vertex) const { return vertex % 2 == 0 ? 0.5 * width_ : -0.5 * width_; }
  double tread_density() const;
  Rigid rigid(const RimState& rim) const;
  Vec3 angular_momentum(const WheelPlane& plane, const RimState& rim) const;
  Vec3 arm(const WheelPlane& plane, int vertex) const;
  void spread(const NodalForces& forces, const WheelPlane& plane);
  Outcome check_step(double step);
  Outcome run(const RimTrajectory& rim, const WheelPlane& plane, int steps, PlanarSums& sums);
  void book(const RimTrajectory& rim, const WheelPlane& plane, const PlanarSums& sums);

  template <class Visit>
  friend void visit_fields(Visit&& visit, FieldsOf<PlanarTire> auto& s) {
    visit(Field{"rim", ""}, s.rim_);
    visit(Field{"spindle", ""}, s.spindle_);
    visit(Field{"dissipation", "J"}, s.dissipation_);
    visit(Field{"numerical_loss", "J"}, s.numerical_loss_);
    visit(Field{"step_limit", "s"}, s.limit_);
    visit(Field{"steps", ""}, s.steps_);
    visit(Field{"steps_since_check", ""}, s.since_check_);
  }

  PlanarCarcass carcass_;
  TireShape shape_;
  Vec3 gravity_;  // m/s²
  double width_, rim_radius_, share_;
  std::vector<int> node_;  // of the pairs of vertices around the tread
  PlanarField load_;       // of the running interval, N
  std::vector<Vec3> arms_before_;  // of the vertices with a force, as the interval began, m
  RimState rim_;           // now
  Wrench spindle_;         // of the last advance
  double dissipation_ = 0.0, numerical_loss_ = 0.0;  // J
  double limit_ = 0.0;                               // of the last check, s
  std::int64_t steps_ = 0, since_check_ = 0;
};

double PlanarTire::tread_density() const {
  double mass = 0.0;
  for (const int n : node_) mass += carcass_.mass()[n];
  const double facet = 2.0 * shape_.radius * std::sin(std::numbers::pi / static_cast<double>(node_.size()));
  return mass / (static_cast<double>(node_.size()) * facet * width_);
}

void PlanarTire::place(const RimState& rim) {
  const WheelPlane plane = WheelPlane::of(rim.orientation);
  rim_ = rim;
  spindle_ = {};
  dissipation_ = numerical_loss_ = 0.0;
  steps_ = since_check_ = 0;
  carcass_.place(plane.angle(rim.orientation), rim.angular_velocity.dot(plane.axis), plane.in(rim.velocity));
  limit_ = carcass_.step_limit();
}

Rigid PlanarTire::rigid(const RimState& rim) const {
  const Vec3 axis = WheelPlane::of(rim.orientation).axis;
  return {axis.dot(rim.velocity) * axis, rim.angular_velocity - axis.dot(rim.angular_velocity) * axis};
}

/// About the rim's centre, W.
Vec3 PlanarTire::angular_momentum(const WheelPlane& plane, const RimState& rim) const {
  return carcass_.angular_momentum() * plane.axis + shape_.mass.inertia(0, 0) * rigid(rim).tilt;
}

Vec3 PlanarTire::arm(const WheelPlane& plane, int vertex) const {
  if (!on_tread(vertex)) return side(vertex) * plane.axis;
  const int n = node_[vertex / 2];
  return plane.out(carcass_.position().x[n], carcass_.position().z[n]) + side(vertex) * plane.axis;
}

void PlanarTire::surface(SurfaceState& out) const {
  const int count = shape_.mesh.vertex_count;
  out.position.resize(count);
  out.velocity.resize(count);
  const WheelPlane plane = WheelPlane::of(rim_.orientation);
  const Rigid with = rigid(rim_);
  const PlanarPoint centre = carcass_.centre_velocity();
  for (int v = 0; v < count; ++v) {
    const Vec3 from = arm(plane, v);
    out.position[v] = rim_.position + from;
    Vec3 velocity = plane.out(centre.x, centre.z) + with.lateral + with.tilt.cross(from);
    if (on_tread(v)) {
      const int n = node_[v / 2];
      velocity += plane.out(carcass_.velocity().x[n], carcass_.velocity().z[n]);
    }
    out.velocity[v] = velocity;
  }
}

/// Of the vertices on the nodes, in the wheel's plane.
void PlanarTire::spread(const NodalForces& forces, const WheelPlane& plane) {
  std::fill(load_.x.begin(), load_.x.end(), 0.0);
  std::fill(load_.z.begin(), load_.z.end(), 0.0);
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    if (!on_tread(forces.vertex[k])) continue;
    const PlanarPoint f = plane.in(forces.force[k]);
    const int n = node_[forces.vertex[k] / 2];
    load_.x[n] += f.x, load_.z[n] += f.z;
  }
}

/// Renews the step's limit now and then. @param step of the scenario, s
Outcome PlanarTire::check_step(double step) {
  if (since_check_ >= kStepsBetweenChecks) limit_ = carcass_.step_limit(), since_check_ = 0;
  if (step <= kMostSteps * share_ * limit_) return {};
  return Outcome::failure("is pressed too thin for its explicit steps",
                          fmt::format("stable steps are below {:.3g} s, more than {} of them in {:.3g} s: "
                                      "try a smaller run.step, a stiffer tire or a coarser mesh",
                                      share_ * limit_, kMostSteps, step));
}

Outcome PlanarTire::run(const RimTrajectory& rim, const WheelPlane& plane, int steps, PlanarSums& sums) {
  const double h = rim.duration() / steps;
  const PlanarPoint gravity = plane.in(gravity_);
  Vec3 from = rim.start().position;
  for (int k = 1; k <= steps; ++k) {
    const RimState at = k == steps ? rim.end() : rim.at(static_cast<double>(k) / steps).state;
    const WheelPlane now = WheelPlane::of(at.orientation);
    if (!carcass_.step(h, {plane.in((at.position - from) / h), now.angle(at.orientation)}, load_, gravity,
                       sums))
      return Outcome::failure("has a triangle that is turned inside out",
                              "try a smaller run.step or step_share, a stiffer tire or a coarser mesh");
    from = at.position;
  }
  steps_ += steps, since_check_ += steps;
  const double least = carcass_.least_radius();
  if (!std::isfinite(least))
    return Outcome::failure("has a motion that is not finite", "try a smaller run.step");
  if (least < kLeastRadius * rim_radius_)
    return Outcome::failure("was pressed to its rim",
                            fmt::format("a node of the tread is {:.4g} m from the axle, the rim {:.4g} m",
                                        least, rim_radius_));
  return {};
}

Outcome PlanarTire::advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) {
  FURROW_ASSERT(substeps > 0 && rim.duration() > 0.0, substeps, rim.duration());
  FURROW_ASSERT(forces.force.size() == forces.vertex.size(), forces.force.size(), forces.vertex.size());
  const double duration = rim.duration();
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    FURROW_ASSERT(in_range(forces.vertex[k], shape_.mesh.vertex_count), forces.vertex[k]);
    if (!forces.force[k].allFinite())
      return Outcome::failure("was given a force that is not finite",
                              fmt::format("on vertex {}; try a smaller run.step", forces.vertex[k]));
  }
  if (const Outcome outcome = check_step(duration / substeps); !outcome.ok) return outcome;
  const int parts = static_cast<int>(std::ceil(duration / substeps / (share_ * limit_)));
  const WheelPlane plane = WheelPlane::of(rim.at(0.5).state.orientation);
  const WheelPlane first = WheelPlane::of(rim.start().orientation), last = WheelPlane::of(rim.end().orientation);
  spread(forces, plane);
  spindle_ = {};
  // Across the plane, with lever arms that are means of the interval's ends.
  const Vec3 momentum = rigid(rim.start()).lateral, turning = angular_momentum(first, rim.start());
  const PlanarPoint moment_before = carcass_.first_moment();
  std::vector<Vec3>& arms = arms_before_;
  arms.clear();
  for (const int v : forces.vertex) arms.push_back(arm(first, v));
  PlanarSums sums;
  if (const Outcome outcome = run(rim, plane, substeps * parts, sums); !outcome.ok) return outcome;
  const PlanarPoint moment_after = carcass_.first_moment();
  const double mass = shape_.mass.mass;
  const Vec3 acceleration = (rim.end().velocity - rim.start().velocity) / duration;
  Vec3 force = mass * gravity_ - mass * (rigid(rim.end()).lateral - momentum) / duration;
  Vec3 moment = plane.out(0.5 * (moment_before.x + moment_after.x), 0.5 * (moment_before.z + moment_after.z))
                    .cross(gravity_ - acceleration) -
                (angular_momentum(last, rim.end()) - turning) / duration;
  Vec3 direct = Vec3::Zero();  // forces on the middles of the sides, which are the rim's
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    force += forces.force[k];
    moment += (0.5 * (arms[k] + arm(last, forces.vertex[k]))).cross(forces.force[k]);
    if (!on_tread(forces.vertex[k])) direct += forces.force[k];
  }
  spindle_.force = plane.out(sums.impulse_x / duration, sums.impulse_z / duration) +
                   plane.axis.dot(force) * plane.axis + (direct - plane.axis.dot(direct) * plane.axis);
  spindle_.moment =
      sums.turn_impulse / duration * plane.axis + moment - plane.axis.dot(moment) * plane.axis;
  book(rim, plane, sums);
  rim_ = rim.end();
  return {};
}

/// Losses of the interval: those of the steps; what mean force times way and mean moment times turn say of the rim's work
/// otherwise than its steps; and what a rigid body's rule loses across the plane.
void PlanarTire::book(const RimTrajectory& rim, const WheelPlane& plane, const PlanarSums& sums) {
  const RimState &from = rim.start(), &to = rim.end();
  const double h = rim.duration();
  const Vec3 way = to.position - from.position, turn = mean_turn(from.orientation, to.orientation);
  const PlanarPoint in = plane.in(way);
  const double mean = -(sums.impulse_x * in.x + sums.impulse_z * in.z + sums.turn_impulse * plane.axis.dot(turn)) / h;
  dissipation_ += sums.dissipation;
  numerical_loss_ += sums.numerical_loss + mean - sums.rim_work;
  const Rigid before = rigid(from), after = rigid(to);
  const Vec3 across = plane.axis.dot(way) * plane.axis, tilt = turn - plane.axis.dot(turn) * plane.axis;
  numerical_loss_ +=
      shape_.mass.mass * (after.lateral - before.lateral).dot(across / h - 0.5 * (before.lateral + after.lateral)) +
      shape_.mass.inertia(0, 0) * (after.tilt - before.tilt).dot(tilt / h - 0.5 * (before.tilt + after.tilt));
}

TireDiagnostics PlanarTire::diagnostics() const {
  const WheelPlane plane = WheelPlane::of(rim_.orientation);
  const Rigid with = rigid(rim_);
  const PlanarPoint momentum = carcass_.momentum(), moment = carcass_.first_moment();
  const double mass = shape_.mass.mass;
  TireDiagnostics d;
  d.momentum = plane.out(momentum.x, momentum.z) + mass * with.lateral;
  d.kinetic_energy = carcass_.kinetic_energy() + 0.5 * mass * with.lateral.squaredNorm() +
                     0.5 * shape_.mass.inertia(0, 0) * with.tilt.squaredNorm();
  d.elastic_energy = carcass_.elastic_energy();
  d.potential_energy = -gravity_.dot(mass * rim_.position + plane.out(moment.x, moment.z));
  d.pressure_energy = d.solver_loss = 0.0;
  d.dissipation = dissipation_;
  d.numerical_loss = numerical_loss_;
  d.solver_impulse = Vec3::Zero();
  return d;
}

void PlanarTire::add_state(Hash& hash) const {
  for (const PlanarField* field : {&carcass_.position(), &carcass_.velocity()}) {
    hash.add(std::span<const double>(field->x));
    hash.add(std::span<const double>(field->z));
  }
}

void PlanarTire::save(Archive& archive) const {
  const PlanarField &r = carcass_.position(), &u = carcass_.velocity();
  save_value(archive, "planar/x", r.x), save_value(archive, "planar/z", r.z);
  save_value(archive, "planar/velocity_x", u.x), save_value(archive, "planar/velocity_z", u.z);
  const PlanarPoint centre = carcass_.centre_velocity();
  save_value(archive, "planar/centre_velocity_x", centre.x);
  save_value(archive, "planar/centre_velocity_z", centre.z);
  save_fields(archive, "planar", *this);
}

void PlanarTire::restore(const Archive& archive) {
  const std::size_t nodes = carcass_.mesh().position.size();
  PlanarField r(nodes), u(nodes);
  PlanarPoint centre;
  restore_value(archive, "planar/x", r.x, nodes), restore_value(archive, "planar/z", r.z, nodes);
  restore_value(archive, "planar/velocity_x", u.x, nodes);
  restore_value(archive, "planar/velocity_z", u.z, nodes);
  restore_value(archive, "planar/centre_velocity_x", centre.x);
  restore_value(archive, "planar/centre_velocity_z", centre.z);
  restore_fields(archive, "planar", *this);
  carcass_.restore(std::move(r), std::move(u), centre);
}

}  // namespace

WheelPlane WheelPlane::of(const Quat& rim) {
  WheelPlane plane;
  plane.axis = rim * Vec3::UnitY();
  const Vec3 forward = plane.axis.cross(Vec3::UnitZ());
  FURROW_ASSERT(forward.norm() > 0.0, plane.axis.z());
  plane.forward = forward.normalized();
  plane.up = plane.forward.cross(plane.axis);
  return plane;
}

double WheelPlane::angle(const Quat& rim) const {
  const Vec3 top = rim * Vec3::UnitZ();
  return std::atan2(forward.dot(top), up.dot(top));
}

MassProperties planar_mass(const PlanarParams& params) {
  const PlanarCarcass carcass(params);
  const double mass = carcass.total_mass(), spin = carcass.spin_inertia();
  const double diametral = 0.5 * spin + mass * params.options.width * params.options.width / 12.0;
  return {mass, Vec3(diametral, spin, diametral).asDiagonal()};
}

std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity) {
  return std::make_unique<PlanarTire>(file, std::move(shape), gravity);
}

}  // namespace furrow::tire
