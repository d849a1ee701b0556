// Over an interval H with constant nodal forces f at vertices x, rim centre c, tire mass m at the centre and
// inertia J:
//   F_spindle = Σ f + m g − Δ(m v)/H
//   M_spindle = Σ (x − c) × f − Δ(J ω)/H,  x − c the mean of the interval's ends
// With the displacement X and the turn θ of the rim (mean_turn.hpp), −F·X − M·θ + Σ f·Δx − Δ(energy) is the numerical
// loss of the interval's rule, since the rim's velocities may differ from X/H and θ/H. It is
//   m Δv·(X/H − v̄) + ΔL·(θ/H − ω̄) + ½ (ω·L' − ω'·L),  L = J ω; v̄, ω̄ the means of the interval's ends.
#include "tire/rigid/rigid_tire.hpp"

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/mean_turn.hpp"

namespace furrow::tire {

void RigidTire::do_place(const RimState& rim) {
  rim_ = rim;
  spindle_ = {};
  numerical_loss_ = 0.0;
}

void RigidTire::surface_on(const RimState& rim, SurfaceState& out) const {
  out.position.resize(shape_.vertex.size());
  out.velocity.resize(shape_.vertex.size());
  const Mat3 turn = rim.orientation.toRotationMatrix();
  for (std::size_t k = 0; k < shape_.vertex.size(); ++k) {
    const Vec3 arm = turn * shape_.vertex[k];
    out.position[k] = rim.position + arm;
    out.velocity[k] = rim.velocity + rim.angular_velocity.cross(arm);
  }
}

Vec3 RigidTire::angular_momentum(const RimState& rim) const {
  const Mat3 turn = rim.orientation.toRotationMatrix();
  return turn * (shape_.mass.inertia * (turn.transpose() * rim.angular_velocity));
}

Outcome RigidTire::do_advance(const RimTrajectory& rim, const NodalForces& forces, int) {
  const RimState &start = rim.start(), &end = rim.end();
  const double duration = rim.duration();
  spindle_.force = shape_.mass.mass * (gravity_ - (end.velocity - start.velocity) / duration);
  spindle_.moment = -(angular_momentum(end) - angular_momentum(start)) / duration;
  const Mat3 mean = 0.5 * (start.orientation.toRotationMatrix() + end.orientation.toRotationMatrix());
  for (std::size_t k = 0; k < forces.vertex.size(); ++k) {
    spindle_.force += forces.force[k];
    spindle_.moment += (mean * shape_.vertex[forces.vertex[k]]).cross(forces.force[k]);
  }
  book_loss(start, end, duration);
  rim_ = end;
  return {};
}

void RigidTire::book_loss(const RimState& from, const RimState& to, double duration) {
  const Vec3 before = angular_momentum(from), after = angular_momentum(to);
  const Vec3 way = (to.position - from.position) / duration - 0.5 * (from.velocity + to.velocity),
             turn = mean_turn(from.orientation, to.orientation) / duration -
                    0.5 * (from.angular_velocity + to.angular_velocity);
  numerical_loss_ += shape_.mass.mass * (to.velocity - from.velocity).dot(way) + (after - before).dot(turn) +
                     0.5 * (from.angular_velocity.dot(after) - to.angular_velocity.dot(before));
}

TireDiagnostics RigidTire::diagnostics() const {
  TireDiagnostics d;
  d.momentum = shape_.mass.mass * rim_.velocity;
  d.kinetic_energy =
      0.5 * shape_.mass.mass * rim_.velocity.squaredNorm() + 0.5 * rim_.angular_velocity.dot(angular_momentum(rim_));
  d.potential_energy = -shape_.mass.mass * gravity_.dot(rim_.position);
  d.elastic_energy = d.pressure_energy = d.dissipation = d.solver_loss = 0.0;
  d.numerical_loss = numerical_loss_;
  d.solver_impulse = Vec3::Zero();
  return d;
}

void RigidTire::add_state(Hash& hash) const {
  for (const Vec3& vector : {rim_.position, rim_.velocity, rim_.angular_velocity})
    hash.add(vector.data(), 3 * sizeof(double));
  hash.add(rim_.orientation.coeffs().data(), 4 * sizeof(double));
}

void RigidTire::save(Archive& archive) const {
  save_fields(archive, "rigid/rim", rim_);
  save_fields(archive, "rigid/spindle", spindle_);
  archive.put("rigid/numerical_loss", numerical_loss_);
}

void RigidTire::do_restore(const Archive& archive) {
  restore_fields(archive, "rigid/rim", rim_);
  restore_fields(archive, "rigid/spindle", spindle_);
  numerical_loss_ = archive.get_double("rigid/numerical_loss");
}

}  // namespace furrow::tire
