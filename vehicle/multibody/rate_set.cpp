// Building, queries and saving; the solution is in rate_set_step.cpp.
#include "vehicle/multibody/rate_set.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {

int RateSet::add_shaft(Shaft shaft) {
  if (!(shaft.inertia > 0.0) || !std::isfinite(shaft.inertia))
    throw physics_error("shaft '" + shaft.name + "': its inertia must be positive");
  const double length = shaft.axis.norm();
  if (!(length > 0.0) || !std::isfinite(length))
    throw physics_error("shaft '" + shaft.name + "': its axis has no direction");
  shaft.axis /= length;
  shafts_.push_back(std::move(shaft));
  return static_cast<int>(shafts_.size()) - 1;
}

int RateSet::add_row(RateRow row, const RateControl& control) {
  for (const ShaftTerm& term : row.shafts) {
    FURROW_ASSERT(in_range(term.shaft, shafts_.size()), row.name, term.shaft, shafts_.size());
    if (!std::isfinite(term.factor)) throw physics_error("'" + row.name + "': its factors must be finite");
    if (std::count_if(row.shafts.begin(), row.shafts.end(),
                      [&](const ShaftTerm& other) { return other.shaft == term.shaft; }) > 1)
      throw physics_error("'" + row.name + "': shaft '" + shafts_[term.shaft].name + "' is named twice");
  }
  for (const SpinTerm& term : row.spins)
    if (term.a == term.b) throw physics_error("'" + row.name + "': a body turns against itself");
  rows_.push_back(std::move(row));
  controls_.emplace_back();
  states_.emplace_back();
  const int index = row_count() - 1;
  set_control(index, control);
  return index;
}

void RateSet::add_law(std::vector<int> rows, RateLaw law) {
  FURROW_ASSERT(law != nullptr && !rows.empty(), rows.size());
  for (const int row : rows) {
    FURROW_ASSERT(in_range(row, rows_.size()), row, rows_.size());
    controls_[row].mode = RateMode::law;
  }
  laws_.push_back({std::move(rows), std::move(law)});
}

void RateSet::set_control(int row, const RateControl& control) {
  FURROW_ASSERT(in_range(row, rows_.size()), row, rows_.size());
  if (!(control.lower <= control.upper))
    throw physics_error("'" + rows_[row].name + "': its lower torque lies above the upper one");
  if (!std::isfinite(control.torque) || !std::isfinite(control.target))
    throw physics_error("'" + rows_[row].name + "': its torque and its speed must be finite");
  int& side = states_[row].side;
  const bool boundless = (side > 0 && std::isinf(control.upper)) || (side < 0 && std::isinf(control.lower));
  if (boundless || controls_[row].mode != control.mode) side = 0;
  controls_[row] = control;
}

void RateSet::set_factor(int row, int term, double factor) {
  FURROW_ASSERT(in_range(row, rows_.size()), row, rows_.size());
  FURROW_ASSERT(in_range(term, rows_[row].shafts.size()), rows_[row].name, term);
  rows_[row].shafts[term].factor = factor;
  if (first_shaft_.size() > static_cast<std::size_t>(row)) shaft_sides_[first_shaft_[row] + term].factor = factor;
}

void RateSet::set_speed(int shaft, double speed) {
  FURROW_ASSERT(in_range(shaft, shafts_.size()), shaft, shafts_.size());
  shafts_[shaft].state.speed = speed;
}

bool RateSet::is_ideal(int row) const {
  const RateControl& control = controls_[row];
  return control.mode == RateMode::hold && std::isinf(control.lower) && std::isinf(control.upper);
}

double RateSet::largest_speed() const {
  double largest = 0.0;
  for (const Shaft& shaft : shafts_) largest = std::max(largest, std::abs(shaft.state.speed));
  return largest;
}

double RateSet::kinetic_energy() const {
  double energy = 0.0;
  for (const Shaft& shaft : shafts_) energy += 0.5 * shaft.inertia * shaft.state.speed * shaft.state.speed;
  return energy;
}

Vec3 RateSet::angular_momentum(std::span<const Body> bodies) const {
  Vec3 sum = Vec3::Zero();
  for (const Shaft& shaft : shafts_) {
    const double p = shaft.inertia * shaft.state.speed;
    if (shaft.carrier == kGround)
      sum += p * shaft.axis;
    else
      sum += p * (bodies[shaft.carrier].R * shaft.axis);
  }
  return sum;
}

bool RateSet::finite() const {
  return std::all_of(shafts_.begin(), shafts_.end(),
                     [](const Shaft& s) { return std::isfinite(s.state.speed + s.state.angle); });
}

void RateSet::save(Archive& archive) const {
  ColumnWriter<ShaftState> shafts;
  for (const Shaft& shaft : shafts_) shafts.add(shaft.state);
  shafts.put(archive, "shafts");
  save_value(archive, "controls", controls_);
  save_value(archive, "rows", states_);
  std::vector<double> factors;
  for (const RateRow& row : rows_)
    for (const ShaftTerm& term : row.shafts) factors.push_back(term.factor);
  archive.put("factors", factors);
}

void RateSet::restore(const Archive& archive) {
  ColumnReader<ShaftState> shafts(archive, "shafts", shafts_.size());
  for (Shaft& shaft : shafts_) shafts.take(shaft.state);
  ColumnReader<RateControl> controls(archive, "controls", controls_.size());
  for (RateControl& control : controls_) controls.take(control);
  ColumnReader<RateState> states(archive, "rows", states_.size());
  for (RateState& state : states_) states.take(state);
  std::size_t count = 0;
  for (const RateRow& row : rows_) count += row.shafts.size();
  const std::vector<double>& factors = archive.get<double>("factors", count);
  std::size_t k = 0;
  for (int i = 0; i < row_count(); ++i)
    for (int t = 0; t < static_cast<int>(rows_[i].shafts.size()); ++t) set_factor(i, t, factors[k++]);
}

}  // namespace furrow::vehicle
