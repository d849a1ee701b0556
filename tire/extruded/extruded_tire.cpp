#include "tire/extruded/extruded_tire.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/mean_turn.hpp"
#include "tire/extruded/wheel_plane.hpp"

namespace furrow::tire {
namespace {

/// Motion of the plane across itself.
struct Rigid {
  Vec3 lateral;  // velocity along the axis, m/s
  Vec3 tilt;     // ω without its part about the axis, rad/s
};

class ExtrudedTire final : public Tire {
 public:
  ExtrudedTire(std::unique_ptr<PlaneModel> model, TireShape shape, const Vec3& gravity)
      : Tire(gravity, std::move(shape)), model_(std::move(model)), load_(model_->position().size()) {
    const auto nodes = static_cast<double>(model_->tread().size());
    FURROW_ASSERT(shape_.mesh.vertex_count == 2 * static_cast<int>(nodes) + 2, shape_.mesh.vertex_count, nodes);
    const double facet = 2.0 * shape_.radius * std::sin(std::numbers::pi / nodes);
    shape_.material.area_density = model_->tread_mass() / (nodes * facet * shape_.tread_width);
  }

  int coordinates() const override { return model_->coordinates(); }

  void set_pressure(double pressure) override { model_->set_pressure(pressure); }
  void surface(SurfaceState& out) const override;
  const StatedContact* stated_contact() const override { return model_->contact() ? &stated_ : nullptr; }
  TireDiagnostics diagnostics() const override;
  NamedValues figures() const override { return model_->figures(); }
  void add_state(Hash& hash) const override;
  void save(Archive& archive) const override;

 private:
  void do_place(const RimState& rim) override;
  Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  void do_restore(const Archive& archive) override;
  /// The two vertices of an outer node are at ± half the width; the last two are at the middle of the sides.
  bool on_tread(int vertex) const { return vertex < 2 * static_cast<int>(model_->tread().size()); }
  double side(int vertex) const { return (vertex % 2 == 0 ? 0.5 : -0.5) * shape_.tread_width; }
  Rigid rigid(const RimState& rim) const;
  Vec3 momentum(const WheelPlane& plane, const RimState& rim) const;
  Vec3 angular_momentum(const WheelPlane& plane, const RimState& rim) const;
  Vec3 arm(const WheelPlane& plane, int vertex) const;
  void spread(const NodalForces& forces, const WheelPlane& plane);
  void state(const WheelPlane& plane, const PlaneSums& sums, const RimTrajectory& rim);
  Outcome run(const RimTrajectory& rim, const WheelPlane& plane, int steps, PlaneSums& sums);
  void book(const RimTrajectory& rim, const WheelPlane& plane, const Vec3& by_turning, const PlaneSums& sums);

  friend void visit_fields(FieldsOf<ExtrudedTire> auto& s, auto&& visit) {
    visit(s.rim_, Field{"rim", ""});
    visit(s.spindle_, Field{"spindle", ""});
    visit(s.dissipation_, Field{"dissipation", "J"});
    visit(s.numerical_loss_, Field{"numerical_loss", "J"});
    visit(s.solver_loss_, Field{"solver_loss", "J"});
    visit(s.solver_impulse_, Field{"solver_impulse", "N s"});
  }

  std::unique_ptr<PlaneModel> model_;
  PlanarField load_;               // of the running interval, N
  std::vector<Vec3> arms_before_;  // of the vertices at the interval's start, m
  StatedContact stated_;
  double dissipation_ = 0.0, numerical_loss_ = 0.0, solver_loss_ = 0.0;  // J
  Vec3 solver_impulse_ = Vec3::Zero();                                   // N s
};

void ExtrudedTire::do_place(const RimState& rim) {
  const WheelPlane plane = WheelPlane::of(rim.orientation);
  rim_ = rim;
  spindle_ = {};
  dissipation_ = numerical_loss_ = solver_loss_ = 0.0;
  solver_impulse_.setZero();
  model_->place(plane.angle(rim.orientation), rim.angular_velocity.dot(plane.axis), plane.in(rim.velocity));
}

Rigid ExtrudedTire::rigid(const RimState& rim) const {
  const WheelPlane plane = WheelPlane::of(rim.orientation);
  return {plane.along(rim.velocity), plane.across(rim.angular_velocity)};
}

Vec3 ExtrudedTire::momentum(const WheelPlane& plane, const RimState& rim) const {
  return plane.out(model_->momentum()) + shape_.mass.mass * rigid(rim).lateral;
}

/// Angular momentum about the rim's centre, W.
Vec3 ExtrudedTire::angular_momentum(const WheelPlane& plane, const RimState& rim) const {
  return model_->angular_momentum() * plane.axis + shape_.mass.inertia(0, 0) * rigid(rim).tilt;
}

Vec3 ExtrudedTire::arm(const WheelPlane& plane, int vertex) const {
  if (!on_tread(vertex)) return side(vertex) * plane.axis;
  const int n = model_->tread()[vertex / 2];
  return plane.out({model_->position().x[n], model_->position().z[n]}) + side(vertex) * plane.axis;
}

void ExtrudedTire::surface(SurfaceState& out) const {
  const int count = shape_.mesh.vertex_count;
  out.position.resize(count);
  out.velocity.resize(count);
  const WheelPlane plane = WheelPlane::of(rim_.orientation);
  const Rigid with = rigid(rim_);
  const Vec3 centre = plane.out(model_->centre_velocity());
  for (int v = 0; v < count; ++v) {
    const Vec3 from = arm(plane, v);
    out.position[v] = rim_.position + from;
    Vec3 velocity = centre + with.lateral + with.tilt.cross(from);
    if (on_tread(v)) {
      const int n = model_->tread()[v / 2];
      velocity += plane.out({model_->velocity().x[n], model_->velocity().z[n]});
    }
    out.velocity[v] = velocity;
  }
}

/// Applies the vertices' forces to the nodes, in the wheel's plane.
void ExtrudedTire::spread(const NodalForces& forces, const WheelPlane& plane) {
  std::fill(load_.x.begin(), load_.x.end(), 0.0);
  std::fill(load_.z.begin(), load_.z.end(), 0.0);
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    if (!on_tread(forces.vertex[k])) continue;
    const PlanarPoint f = plane.in(forces.force[k]);
    const int n = model_->tread()[forces.vertex[k] / 2];
    load_.x[n] += f.x, load_.z[n] += f.z;
  }
}

Outcome ExtrudedTire::run(const RimTrajectory& rim, const WheelPlane& plane, int steps, PlaneSums& sums) {
  const double h = rim.duration() / steps;
  const PlanarPoint gravity = plane.in(gravity_);
  const Rigid with = rigid(rim.start());
  Vec3 from = rim.start().position;
  for (int k = 1; k <= steps; ++k) {
    const RimState at = k == steps ? rim.end() : rim.at(static_cast<double>(k) / steps).state;
    const WheelPlane now = WheelPlane::of(at.orientation);
    const PlaneRimStep way{plane.in((at.position - from) / h), now.angle(at.orientation)};
    if (PlaneContact* contact = model_->contact()) contact->place({plane, from, with.lateral, with.tilt});
    if (const Outcome outcome = model_->step(h, way, load_, gravity, sums); !outcome.ok) return outcome;
    from = at.position;
  }
  return model_->check();
}

Outcome ExtrudedTire::do_advance(const RimTrajectory& rim, const NodalForces& given, int substeps) {
  FURROW_ASSERT(!model_->contact() || given.vertex.empty(), given.vertex.size());
  const NodalForces& forces = model_->contact() ? stated_.forces : given;  // that acted, after the steps
  const double duration = rim.duration();
  int parts = 1;
  if (const Outcome outcome = model_->parts(duration / substeps, parts); !outcome.ok) return outcome;
  const WheelPlane plane = WheelPlane::of(rim.at(0.5).state.orientation);
  const WheelPlane first = WheelPlane::of(rim.start().orientation), last = WheelPlane::of(rim.end().orientation);
  spread(given, plane);
  spindle_ = {};
  // Forces follow from the balance of momentum in space, which equals the balance of the plane's steps if the plane
  // does not turn. Moments across the plane have the means of the lever arms at the interval's ends.
  const Vec3 before = momentum(first, rim.start()), turning = angular_momentum(first, rim.start());
  const PlanarPoint moment_before = model_->first_moment();
  std::vector<Vec3>& arms = arms_before_;
  arms.resize(shape_.mesh.vertex_count);
  if (PlaneContact* contact = model_->contact()) {
    contact->begin();
    for (int v = 0; v < shape_.mesh.vertex_count; ++v) arms[v] = arm(first, v);
  }
  for (const int v : given.vertex) arms[v] = arm(first, v);
  PlaneSums sums;
  if (const Outcome outcome = run(rim, plane, substeps * parts, sums); !outcome.ok) return outcome;
  if (model_->contact()) state(plane, sums, rim);
  const PlanarPoint moment_after = model_->first_moment();
  const double mass = shape_.mass.mass;
  const Vec3 acceleration = (rim.end().velocity - rim.start().velocity) / duration;
  Vec3 force = mass * gravity_ - (momentum(last, rim.end()) - before) / duration;
  Vec3 moment = plane.out({0.5 * (moment_before.x + moment_after.x), 0.5 * (moment_before.z + moment_after.z)})
                    .cross(gravity_ - acceleration) -
                (angular_momentum(last, rim.end()) - turning) / duration;
  Vec3 direct = Vec3::Zero();  // in the plane, on the middles of the sides; acts on the rim
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    force += forces.force[k];
    moment += (0.5 * (arms[forces.vertex[k]] + arm(last, forces.vertex[k]))).cross(forces.force[k]);
    if (!on_tread(forces.vertex[k])) direct += plane.across(forces.force[k]);
  }
  spindle_.force = force;
  spindle_.moment = sums.turn_impulse / duration * plane.axis + plane.across(moment);
  const Vec3 by_steps = plane.out({sums.impulse_x / duration, sums.impulse_z / duration}) + direct;
  book(rim, plane, plane.across(force) - by_steps, sums);
  rim_ = rim.end();
  return {};
}

/// States what the contact did in the interval. Mean forces of the vertices do more or less work than the forces of the
/// steps: that is a loss of the rule.
void ExtrudedTire::state(const WheelPlane& plane, const PlaneSums& sums, const RimTrajectory& rim) {
  const Rigid with = rigid(rim.end());
  model_->contact()->place({plane, rim.end().position, with.lateral, with.tilt});
  model_->contact()->state(model_->position(), rim.duration(), stated_);
  const WheelPlane last = WheelPlane::of(rim.end().orientation);
  const Vec3 way = rim.end().position - rim.start().position;
  double work = 0.0;
  for (std::size_t k = 0; k < stated_.forces.vertex.size(); ++k) {
    const int v = stated_.forces.vertex[k];
    work += plane.across(stated_.forces.force[k]).dot(way + arm(last, v) - arms_before_[v]);
  }
  numerical_loss_ += work - sums.contact_work;
}

/// Records the losses of the interval. They are the losses of the steps, the difference of the rim's work, and the loss
/// of a rigid body's rule across the plane. The difference is between mean force times displacement plus mean moment
/// times turn, and the work in the steps. The additional force of a turning plane contributes to it.
void ExtrudedTire::book(const RimTrajectory& rim, const WheelPlane& plane, const Vec3& by_turning,
                        const PlaneSums& sums) {
  const RimState &from = rim.start(), &to = rim.end();
  const double h = rim.duration();
  const Vec3 way = to.position - from.position, turn = mean_turn(from.orientation, to.orientation);
  const PlanarPoint in = plane.in(way);
  const double mean = -(sums.impulse_x * in.x + sums.impulse_z * in.z + sums.turn_impulse * plane.axis.dot(turn)) / h -
                      by_turning.dot(way);
  dissipation_ += sums.dissipation;
  numerical_loss_ += sums.numerical_loss + mean - sums.rim_work;
  solver_loss_ += sums.solver_loss;
  solver_impulse_ += plane.out(sums.solver_impulse);
  const Rigid before = rigid(from), after = rigid(to);
  const Vec3 along = plane.along(way), tilt = plane.across(turn);
  numerical_loss_ +=
      shape_.mass.mass * (after.lateral - before.lateral).dot(along / h - 0.5 * (before.lateral + after.lateral)) +
      shape_.mass.inertia(0, 0) * (after.tilt - before.tilt).dot(tilt / h - 0.5 * (before.tilt + after.tilt));
}

TireDiagnostics ExtrudedTire::diagnostics() const {
  const WheelPlane plane = WheelPlane::of(rim_.orientation);
  const Rigid with = rigid(rim_);
  const double mass = shape_.mass.mass;
  TireDiagnostics d;
  d.momentum = momentum(plane, rim_);
  d.kinetic_energy = model_->kinetic_energy() + 0.5 * mass * with.lateral.squaredNorm() +
                     0.5 * shape_.mass.inertia(0, 0) * with.tilt.squaredNorm();
  d.elastic_energy = model_->elastic_energy();
  d.pressure_energy = model_->pressure_energy();
  d.potential_energy = -gravity_.dot(mass * rim_.position + plane.out(model_->first_moment()));
  d.dissipation = dissipation_;
  d.numerical_loss = numerical_loss_;
  d.solver_loss = solver_loss_;
  d.solver_impulse = solver_impulse_;
  return d;
}

void ExtrudedTire::add_state(Hash& hash) const {
  for (const PlanarField* field : {&model_->position(), &model_->velocity()}) {
    hash.add(std::span<const double>(field->x));
    hash.add(std::span<const double>(field->z));
  }
}

void ExtrudedTire::save(Archive& archive) const {
  model_->save(archive);
  save_fields(archive, "extruded", *this);
}

void ExtrudedTire::do_restore(const Archive& archive) {
  model_->restore(archive);
  restore_fields(archive, "extruded", *this);
}

}  // namespace

std::unique_ptr<Tire> make_extruded_tire(std::unique_ptr<PlaneModel> model, TireShape shape, const Vec3& gravity) {
  return std::make_unique<ExtrudedTire>(std::move(model), std::move(shape), gravity);
}

}  // namespace furrow::tire
