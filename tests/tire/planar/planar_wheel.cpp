#include "tests/tire/planar/planar_wheel.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"
#include "tire/planar/planar_tangent.hpp"

namespace furrow::tire {
namespace {

constexpr long kStepsBetweenChecks = 1000;  // of the step's limit in the present shape

PlanarState moving(const PlanarMesh& mesh, PlanarPoint centre, PlanarPoint velocity, double spin) {
  PlanarState s{mesh.position, mesh.position};
  for (std::size_t n = 0; n < s.x.size(); ++n) {
    const double x = mesh.position.x[n], z = mesh.position.z[n];
    s.x.x[n] = centre.x + x, s.x.z[n] = centre.z + z;
    s.v.x[n] = velocity.x + spin * z, s.v.z[n] = velocity.z - spin * x;
  }
  return s;
}

PlanarPoint mean(const PlanarField& f, const std::vector<int>& nodes) {
  PlanarPoint sum;
  for (const int n : nodes) sum.x += f.x[n], sum.z += f.z[n];
  const double count = static_cast<double>(nodes.size());
  return {sum.x / count, sum.z / count};
}

}  // namespace

PlanarWheel::PlanarWheel(const PlanarParams& params, PlanarGround ground, PlanarPoint centre, PlanarPoint velocity,
                         double spin, double axle_mass, double gravity)
    : mesh_(planar_wheel(params.size)),
      motion_(planar_elements(mesh_, params), moving(mesh_, centre, velocity, spin), params.integrator),
      contact_(mesh_, std::move(ground), {params.contact_stiffness * params.options.width, params.friction}),
      gravity_(gravity) {
  FURROW_ASSERT(params.step_share > 0.0 && params.step_share <= 1.0 && axle_mass >= 0.0, params.step_share, axle_mass);
  step_ = params.step_share * step_limit(motion_.elements(), mesh_.position);
  motion_.add_mass(mesh_.centre, axle_mass);
  motion_.set_loads([this](const PlanarState& state, double step, PlanarField& force) { load(state, step, force); });
}

void PlanarWheel::link(const PlanarLink& link) {
  if (!linked_) motion_.hold(mesh_.centre, link.hold_x, link.hold_z);
  FURROW_ASSERT(!linked_ || (link.hold_x == link_.hold_x && link.hold_z == link_.hold_z), link.hold_x, link.hold_z);
  linked_ = true;
  link_ = link;
  PlanarPoint v = centre_velocity();
  if (link.hold_x) v.x = link.velocity_x;
  if (link.hold_z) v.z = link.velocity_z;
  motion_.set_velocity(mesh_.centre, v.x, v.z);
}

void PlanarWheel::load(const PlanarState& state, double step, PlanarField& force) {
  const std::vector<double>& mass = motion_.mass();
  for (std::size_t n = 0; n < force.size(); ++n) force.z[n] -= mass[n] * gravity_;
  contact_.load(state, mass, step, force);
  force.x[mesh_.centre] += link_.force_x, force.z[mesh_.centre] += link_.force_z;
  if (couple_ == 0.0) return;
  const PlanarPoint middle = mean(state.x, mesh_.rim);
  double inertia = 0.0;  // Σr², m²
  for (const int n : mesh_.rim) {
    const double x = state.x.x[n] - middle.x, z = state.x.z[n] - middle.z;
    inertia += x * x + z * z;
  }
  for (const int n : mesh_.rim) {
    force.x[n] += couple_ * (state.x.z[n] - middle.z) / inertia;
    force.z[n] -= couple_ * (state.x.x[n] - middle.x) / inertia;
  }
}

Outcome PlanarWheel::advance() {
  if (steps_++ % kStepsBetweenChecks == 0)
    if (const double limit = step_limit(motion_.elements(), motion_.state().x); !(step_ < limit))
      return Outcome::failure("is pressed too thin for its step",
                              fmt::format("{:.3g} s, expected less than {:.3g} s: try a smaller step_share, or a "
                                          "coarser mesh",
                                          step_, limit));
  if (motion_.step(step_)) return {};
  return Outcome::failure("has a triangle that is turned inside out",
                          "try a smaller step_share, a stiffer tire or a coarser mesh");
}

PlanarPoint PlanarWheel::centre_velocity() const {
  return {motion_.state().v.x[mesh_.centre], motion_.state().v.z[mesh_.centre]};
}

double PlanarWheel::spin() const {
  const PlanarState& s = motion_.state();
  const PlanarPoint at = mean(s.x, mesh_.rim), with = mean(s.v, mesh_.rim);
  double moment = 0.0, inertia = 0.0;
  for (const int n : mesh_.rim) {
    const double x = s.x.x[n] - at.x, z = s.x.z[n] - at.z;
    moment += z * (s.v.x[n] - with.x) - x * (s.v.z[n] - with.z), inertia += x * x + z * z;
  }
  return moment / inertia;
}

double PlanarWheel::mass() const {
  double sum = 0.0;
  for (const double one : motion_.mass()) sum += one;
  return sum;
}

}  // namespace furrow::tire
