#include "terrain/dem/accounts/energy_accounts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/archive_fields.hpp"

namespace furrow::terrain::dem {

void EnergyAccounts::begin(std::vector<Stored> stored, double rotation) {
  state_ = {};
  state_.rotation = rotation;
  stored_ = std::move(stored);
  for (const Stored& one : stored_) add(state_.stored, one, 1.0);
}

void EnergyAccounts::take(const Losses& power) {
  if (state_.samples > 0) {
    const double between = 0.5 * (state_.since - state_.own);
    add(state_.lost, state_.power, state_.own + between);
    add(state_.lost, power, between);
    const double change = (total(power) - total(state_.power)) * state_.since;
    state_.error2 += 0.5 * change * change;
  }
  state_.power = power;
  state_.since = 0.0;
  ++state_.samples;
}

void EnergyAccounts::advance(double dt, bool whole, double rotation) {
  FURROW_ASSERT(dt > 0.0, dt);
  if (state_.since == 0.0) state_.own = dt;
  state_.since += dt;
  state_.time += dt;
  state_.rotation = rotation;
  if (whole) state_.until = (due() ? every_ : state_.until) - 1;
}

double EnergyAccounts::error() const { return std::sqrt(state_.error2); }

void EnergyAccounts::save(Archive& archive) const {
  save_fields(archive, "energies", state_);
  save_value(archive, "energies/strips", stored_);
}

void EnergyAccounts::restore(const Archive& archive, std::size_t strips) {
  begin(std::vector<Stored>(strips), 0.0);
  restore_fields(archive, "energies", state_);
  state_.until = std::max<std::int64_t>(state_.until, 0);
  ColumnReader<Stored> stored(archive, "energies/strips", strips);
  for (Stored& one : stored_) stored.take(one);
}

}  // namespace furrow::terrain::dem
