// Energies of force elements, shafts and rows in speeds within a system.
#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kRateLimit = 1e-9;         // of a held speed, relative to its scale, if round-off stops the iteration
constexpr int kMaxRounds = 60;              // in which rows change between holding and slipping
constexpr double kDamperTolerance = 1e-13;  // of a damper's speed and flow, or
constexpr double kDamperFloor = 1e-14;      // of the largest speed
constexpr int kDamperPatience = 8;          // iterations after which the round-off of dampers is accepted

}  // namespace

void System::track_energy(int element) {
  FURROW_ASSERT(in_range(element, elements_.size()), element, elements_.size());
  tracked_.emplace_back();
  tracked_.back().element = element;
}

ElementEnergy System::element_energy(int element) const {
  const auto found = std::find_if(tracked_.begin(), tracked_.end(),
                                  [&](const Tracked& tracked) { return tracked.element == element; });
  FURROW_ASSERT(found != tracked_.end(), element);
  ElementEnergy energy = found->energy;
  const ForceElement& e = elements_[element];
  const Pose A = pose(e.row.a), B = pose(e.row.b);
  energy.stored = e.law(row_value(e.row, A, B), row_rate(e.row, row_jacobian(e.row, A, B)), time()).energy;
  return energy;
}

int System::add_shaft(const std::string& name, double inertia, int carrier, const Vec3& axis, double speed) {
  FURROW_ASSERT(carrier >= kGround && carrier < body_count(), name, carrier, body_count());
  Shaft shaft;
  shaft.name = name;
  shaft.inertia = inertia;
  shaft.carrier = carrier;
  shaft.axis = pose(carrier).R->transpose() * axis;
  shaft.state.speed = speed;
  prepared_ = false;
  return rates_.add_shaft(std::move(shaft));
}

int System::add_rate_row(const RateRow& given, const RateControl& control) {
  RateRow row = given;
  for (SpinTerm& term : row.spins) {
    FURROW_ASSERT(term.a >= kGround && term.a < body_count(), row.name, term.a, body_count());
    FURROW_ASSERT(term.b >= kGround && term.b < body_count(), row.name, term.b, body_count());
    const double length = term.axis.norm();
    if (!(length > 0.0) || !std::isfinite(length)) throw physics_error("'" + row.name + "': its axis has no direction");
    term.axis = pose(term.b).R->transpose() * (term.axis / length);
  }
  prepared_ = false;
  return rates_.add_row(std::move(row), control);
}

int System::add_rate_law(const RateRow& row, RateLaw law) { return add_rate_law(std::vector{row}, law).front(); }

std::vector<int> System::add_rate_law(const std::vector<RateRow>& rows, RateLaw law) {
  std::vector<int> indices;
  for (const RateRow& row : rows) indices.push_back(add_rate_row(row));
  rates_.add_law(indices, std::move(law));
  return indices;
}

double System::rate_speed(int row) const {
  FURROW_ASSERT(in_range(row, rate_count()), row, rate_count());
  const auto spin = [&](int body) {
    return body == kGround ? Vec3(Vec3::Zero()) : bodies_[body].state.angular_velocity;
  };
  double sum = 0.0;
  for (const ShaftTerm& term : rates_.row(row).shafts) {
    const Shaft& shaft = rates_.shafts()[term.shaft];
    sum += term.factor * (shaft.state.speed - spin(shaft.carrier).dot(*pose(shaft.carrier).R * shaft.axis));
  }
  for (const SpinTerm& term : rates_.row(row).spins)
    sum += term.factor * (spin(term.b) - spin(term.a)).dot(*pose(term.b).R * term.axis);
  return sum;
}

// A factor also changes the row's term of the shaft's carrier.
void System::set_rate_factor(int row, int term, double factor) {
  rates_.set_factor(row, term, factor);
  if (prepared_) rates_.update_axes(bodies_);
}

void System::recheck_rank() {
  FURROW_ASSERT(prepared_, bodies_.size());
  update_jacobians();
  find_redundancy();
}

double System::row_rate(const Row& row, const RowJacobian& J) const {
  double sum = 0.0;
  each_side(row, J, [&](int body, const Vec3& v, const Vec3& w) {
    sum += v.dot(bodies_[body].state.velocity) + w.dot(bodies_[body].state.angular_velocity);
  });
  return sum;
}

// The work of an impulse is its product with the mean of the coordinate's rates before and after it.
void System::finish_work(bool first_half) {
  for (Tracked& tracked : tracked_) {
    const std::size_t row = constraint_rows_.size() + tracked.element;
    const double mean = 0.5 * (tracked.rate_before + rate(static_cast<int>(row)));
    const double damper = first_half ? impulses_[row] : 0.0;
    tracked.energy.elastic += tracked.elastic_impulse * mean;
    tracked.energy.dissipated -= (tracked.other_impulse + damper) * mean;
  }
  if (!rates_.empty()) rates_.finish(rate_part(impulses_), bodies_);
}

void System::turn_rotors() {
  for (int i = 0; i < body_count(); ++i)
    if (const Vec3* p = rates_.rotor_momentum(i)) bodies_[i].angular_momentum -= bodies_[i].R * *p - base_[i].R * *p;
}

// Solves one half of the step, and repeats it while rows change between holding and slipping.
Outcome System::solve_half(bool first_half, double h, double end_time) {
  for (int round = 0; round < kMaxRounds; ++round) {
    Outcome outcome = first_half ? solve_positions(h, end_time) : solve_velocities(end_time);
    if (!outcome.ok || rate_count() == 0 || !rates_.change_sides(rate_part(impulses_), bodies_, round)) return outcome;
    if (outcome = factorize(first_half); !outcome.ok) return outcome;
  }
  return Outcome::failure("cannot decide which of its brakes and clutches slip", "");
}

// Whether the rows in speeds are satisfied, or their error is round-off and no longer falls.
bool System::rates_done(double& before, int iteration) {
  double worst = 0.0;
  const std::span<const double> compliance = std::span<const double>(compliance_).subspan(first_rate());
  const bool small = rates_.residuals(rate_part(impulses_), compliance, bodies_, rate_part(residual_), worst);
  const bool settled = iteration > 2 && worst <= kRateLimit && worst > 0.25 * before;
  before = worst;
  return small || settled;
}

// Whether the damper rows are satisfied: speed + flow = 0. Closing the joints moves the bodies, so their speeds contain
// the rounding of positions, divided by the step. Far from the origin the error therefore stops falling.
bool System::dampers_done(double scale, double& before, int iteration) {
  const auto first = static_cast<int>(constraint_rows_.size()), last = static_cast<int>(rows_.size());
  FURROW_ASSERT(residual_.size() >= last, residual_.size(), last);
  bool small = true;
  double worst = 0.0, fastest = scale;
  for (int i = first; i < last; ++i) {
    const double compliance = dampers_factored_ ? compliance_[i] : -1.0;
    residual_[i] = 0.0;
    if (compliance < 0.0) continue;
    const double speed = rate(i), flow = impulses_[i] * compliance;
    residual_[i] = -(speed + flow);
    worst = std::max(worst, std::abs(residual_[i]));
    fastest = std::max({fastest, std::abs(speed), std::abs(flow)});
    small =
        small && std::abs(residual_[i]) <= kDamperTolerance * (std::abs(speed) + std::abs(flow)) + kDamperFloor * scale;
  }
  const bool settled = iteration > kDamperPatience && worst <= kRateLimit * fastest && worst > 0.25 * before;
  before = worst;
  return small || settled;
}

void System::save_drives(Archive& archive) const {
  if (!tracked_.empty()) {
    ColumnWriter<ElementEnergy> energies;
    for (const Tracked& tracked : tracked_) energies.add(tracked.energy);
    energies.put(archive, "element_energies");
  }
  if (rates_.empty()) return;
  Archive::Scope scope(archive, "rates/");
  rates_.save(archive);
}

void System::restore_drives(const Archive& archive) {
  if (!tracked_.empty()) {
    ColumnReader<ElementEnergy> energies(archive, "element_energies", tracked_.size());
    for (Tracked& tracked : tracked_) energies.take(tracked.energy);
  }
  if (rates_.empty()) return;
  Archive::Scope scope(archive, "rates/");
  rates_.restore(archive);
}

}  // namespace furrow::vehicle
