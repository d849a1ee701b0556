#include "nodes/output/accounts.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/field_arithmetic.hpp"

namespace furrow::output {
namespace {

// Bounds: the energy residual as a share of the turnover, plus the error of sampled losses in standard errors; the
// residual of momentum as a share of the largest impulse, plus the estimated impulse on sleeping grains
// (scripts/docs/results.md, Accounts).
constexpr double kEnergyShare = 0.03, kSampleErrors = 3.0;
constexpr double kMomentumShare = 1e-6;

struct AccountsRow {
  double time = 0.0;  // s
  EnergyAccount energy;
  double residual = 0.0, turnover = 0.0;  // J
  Vec3 momentum_residual = Vec3::Zero();  // N s
};
void visit_fields(FieldsOf<AccountsRow> auto& r, auto&& visit) {
  using column::cumulative;
  visit(r.time, column::instant("time_s", "s"));
  visit_fields(r.energy.work, visit);
  visit_fields(r.energy.stored, visit);
  visit_fields(r.energy.lost, visit);
  visit(r.energy.terrain_residual, cumulative("terrain_residual_J", "J"));
  visit(r.energy.tire_residual, cumulative("tire_residual_J", "J"));
  visit(r.energy.rig_residual, cumulative("rig_residual_J", "J"));
  visit(r.residual, cumulative("residual_J", "J"));
  visit(r.turnover, cumulative("turnover_J", "J"));
  visit(r.momentum_residual.x(), cumulative("momentum_residual_x_Ns", "N s"));
  visit(r.momentum_residual.y(), cumulative("momentum_residual_y_Ns", "N s"));
  visit(r.momentum_residual.z(), cumulative("momentum_residual_z_Ns", "N s"));
}

/// Returns Σ entries and Σ|entries|.
template <HasFields S>
std::pair<double, double> sums(const S& entries) {
  std::pair<double, double> sum{0.0, 0.0};
  visit_fields(entries, [&](const double& value, const Column&) {
    sum.first += value;
    sum.second += std::abs(value);
  });
  return sum;
}

void add_terrain(const TerrainEnergies& start, const TerrainEnergies& now, EnergyAccount& a) {
  const TerrainEnergies grown = difference_of(now, start);
  a.work.walls = grown.wall_work;
  StoredAccount& s = a.stored;
  s.terrain_kinetic = grown.kinetic;
  s.terrain_rotational = grown.rotational;
  s.terrain_potential = grown.potential;
  s.terrain_elastic_normal = grown.elastic_normal;
  s.terrain_elastic_tangential = grown.elastic_tangential;
  s.terrain_cohesion = grown.cohesion;
  LostAccount& l = a.lost;
  l.sliding = grown.sliding_loss;
  l.normal_damping = grown.normal_damping_loss;
  l.tangential_damping = grown.tangential_damping_loss;
  l.rolling = grown.rolling_loss;
  l.opening = grown.opening_loss;
  l.sleep = grown.sleep_loss;
  l.surface_lag -= grown.surface_work;
  a.terrain_residual =
      grown.surface_work + a.work.walls - (now.stored() - start.stored()) - (now.losses() - start.losses());
  a.sample_error = now.sample_error;
}

void add_tire(const TireAccount& start, const TireAccount& now, EnergyAccount& a) {
  const TireAccount grown = difference_of(now, start);
  a.stored.tire_kinetic += grown.model.kinetic_energy;
  a.stored.tire_elastic += grown.model.elastic_energy;
  a.stored.tire_pressure += grown.model.pressure_energy;
  a.stored.tire_potential += grown.model.potential_energy;
  a.lost.tire_viscous += grown.model.dissipation;
  a.lost.tire_numerical += grown.model.numerical_loss;
  a.lost.tire_solver += grown.model.solver_loss;
  a.lost.surface_lag -= grown.terrain_work;
  a.lost.rim_lag += grown.added_energy - grown.rim_work;
  a.stored.rig_kinetic_and_potential -= grown.added_energy;
  a.tire_residual += tire_residual(start, now);
}

void add_rig(const rigs::RigAccounts& start, const rigs::RigAccounts& now, EnergyAccount& a) {
  const rigs::RigAccounts grown = difference_of(now, start);
  const double stored = now.stored() - start.stored();
  a.work.drive = grown.drive_work;
  a.work.tow = grown.tow_work;
  a.work.guide = grown.guide_work;
  a.lost.damper = grown.damper_loss;
  a.lost.rim_lag -= grown.tire_work;
  a.stored.rig_kinetic_and_potential += stored;
  a.rig_residual = a.work.drive + a.work.tow + a.work.guide + grown.tire_work - stored - a.lost.damper;
}

}  // namespace

double tire_residual(const TireAccount& start, const TireAccount& now) {
  return now.rim_work - start.rim_work + now.terrain_work - start.terrain_work -
         (now.model.stored() - start.model.stored()) - (now.model.losses() - start.model.losses());
}

double EnergyAccount::residual() const { return sums(work).first - sums(stored).first - sums(lost).first; }

double EnergyAccount::turnover() const { return 0.5 * (sums(work).second + sums(stored).second + sums(lost).second); }

double EnergyAccount::bound() const { return kEnergyShare * turnover() + kSampleErrors * sample_error; }

bool EnergyAccount::closes() const {
  return std::isfinite(residual()) && std::abs(residual()) <= bound();  // false for a residual that is not a number
}

EnergyAccount energy_account(const Books& start, const Books& now) {
  FURROW_ASSERT(start.tires.size() == now.tires.size(), start.tires.size(), now.tires.size());
  EnergyAccount account;
  add_terrain(start.terrain, now.terrain, account);
  for (std::size_t k = 0; k < now.tires.size(); ++k) add_tire(start.tires[k], now.tires[k], account);
  add_rig(start.rig, now.rig, account);
  return account;
}

MomentumAccount momentum_account(const Books& start, const Books& now) {
  FURROW_ASSERT(start.tires.size() == now.tires.size(), start.tires.size(), now.tires.size());
  MomentumAccount a;
  const TerrainMomenta grains = difference_of(now.grains, start.grains);
  const rigs::RigAccounts rig = difference_of(now.rig, start.rig);
  a.grains = grains.grains;
  a.terrain_gravity = grains.gravity_impulse;
  a.walls = grains.wall_impulse;
  a.sleep = grains.sleep_impulse;
  a.carrier = rig.momentum;
  a.carrier_gravity = rig.gravity_impulse;
  a.guide = rig.guide_impulse;
  for (std::size_t k = 0; k < now.tires.size(); ++k) {
    const TireAccount tire = difference_of(now.tires[k], start.tires[k]);
    a.tires += tire.model.momentum;
    a.tire_gravity += tire.gravity_impulse;
    a.carrier -= tire.added_momentum;
    a.carrier_gravity -= tire.added_gravity_impulse;
    a.surface_under_way += tire.sent_by_terrain;
    a.spindle_under_way += tire.sent_to_rig;
    a.spindle_of_tires += tire.spindle_impulse;
  }
  a.under_way = a.surface_under_way + a.spindle_under_way;
  a.surface_of_grains = a.terrain_gravity + a.walls + a.sleep - a.grains;
  a.surface_of_tires = a.tires - a.tire_gravity + a.spindle_of_tires;
  a.spindle_of_carrier = a.carrier - a.carrier_gravity - a.guide;
  return a;
}

Vec3 MomentumAccount::residual() const {
  return terrain_gravity + tire_gravity + carrier_gravity + walls + guide + sleep - grains - tires - carrier -
         under_way;
}

double MomentumAccount::largest() const {
  double largest = 0.0;
  for (const Vec3& one : {grains, tires, carrier, terrain_gravity, tire_gravity, carrier_gravity, walls, guide, sleep,
                          surface_of_tires, spindle_of_tires})
    largest = std::max(largest, one.norm());
  return largest;
}

bool MomentumAccount::closes() const {
  const double round_off = kMomentumShare * largest(), most = round_off + sleep.norm();
  return residual().norm() <= most && surface_difference().norm() <= most && spindle_difference().norm() <= round_off;
}

TireAccount Accounts::account_of(const Reports& r, std::size_t k) const {
  FURROW_ASSERT(k < r.tires.size() && k < r.rims.size() && k < r.terrain.contact.size(), k, r.tires.size());
  const SpindleReport& tire = r.tires[k];
  const RimState& rim = r.rims[k];
  const MassProperties& added = added_[k];
  const Mat3 turn = rim.orientation.toRotationMatrix();
  const Vec3 spin = turn * (added.inertia * (turn.transpose() * rim.angular_velocity));
  const bool first = now_.tires.empty();
  TireAccount a;
  a.model = tire.diagnostics;
  a.terrain_work = tire.terrain_work;
  a.rim_work = tire.rim_work;
  a.gravity_impulse = tire.gravity_impulse;
  a.terrain_impulse = tire.impulse_received;
  a.spindle_impulse = tire.spindle_impulse;
  a.sent_by_terrain = step_ * r.terrain.contact[k].force - tire.impulse_ahead;
  a.added_energy = 0.5 * added.mass * rim.velocity.squaredNorm() + 0.5 * rim.angular_velocity.dot(spin) -
                   added.mass * r.gravity.dot(rim.position);
  a.added_momentum = added.mass * rim.velocity;
  a.added_gravity_impulse = added.mass * r.time * r.gravity;
  a.rim_velocity = rim.velocity;
  // The wrench under way makes the added mass follow the tire's own motion, which continues with the rim's velocity of
  // one step before.
  const Vec3 before = first ? rim.velocity : now_.tires[k].rim_velocity;
  a.sent_to_rig = added.mass * (rim.velocity - before);
  if (!tire.prompt) a.sent_to_rig += step_ * tire.wrench.force;
  return a;
}

void Accounts::add(const Reports& r) {
  FURROW_ASSERT(r.tires.size() == added_.size(), r.tires.size(), added_.size());
  Books next;
  next.time = r.time;
  next.terrain = r.terrain.state.energies;
  next.grains = r.terrain.state.momenta;
  next.rig = r.rig;
  for (std::size_t k = 0; k < r.tires.size(); ++k) next.tires.push_back(account_of(r, k));
  const bool first = now_.tires.empty();
  now_ = std::move(next);
  if (first) start_ = now_;
}

Table Accounts::empty_table() { return {kAccountsTable, columns_of<AccountsRow>(), {}}; }

std::span<const double> Accounts::line() {
  AccountsRow row;
  row.time = now_.time;
  row.energy = energy();
  row.residual = row.energy.residual();
  row.turnover = row.energy.turnover();
  row.momentum_residual = momentum().residual();
  line_.resize(columns_of<AccountsRow>().size());
  get_values(row, line_);
  return line_;
}

void Accounts::save(Archive& archive) const {
  save_fields(archive, "accounts/start", start_);
  save_fields(archive, "accounts/now", now_);
}

void Accounts::restore(const Archive& archive) {
  restore_fields(archive, "accounts/start", start_);
  restore_fields(archive, "accounts/now", now_);
}

}  // namespace furrow::output
