// Momentum and energy of a whole run: what each part has, received and lost, each from its own state, impulses and
// mechanisms. No entry is the difference of others, so a residual reveals a wrong entry. Signs, mechanisms and bounds:
// scripts/docs/results.md, Accounts.
#pragma once

#include <span>
#include <vector>

#include "nodes/output/table.hpp"
#include "protocol/core/archive.hpp"
#include "protocol/core/column.hpp"
#include "protocol/messages.hpp"
#include "rigs/rig_accounts.hpp"

namespace furrow::output {

inline constexpr char kAccountsTable[] = "accounts";  // name of the accounts' table

/// Account of one tire at a synchronization and of its rim on the rig's rank. Cumulative unless marked "now".
struct TireAccount {
  TireDiagnostics model;
  double terrain_work = 0.0, rim_work = 0.0;  // on the tire, J
  Vec3 gravity_impulse = Vec3::Zero();        // N s
  Vec3 terrain_impulse = Vec3::Zero();        // on the tire as it received it, N s
  Vec3 spindle_impulse = Vec3::Zero();        // on the rim by the tire, N s
  Vec3 sent_by_terrain = Vec3::Zero();        // given by the terrain, not yet received by the tire, now, N s
  Vec3 sent_to_rig = Vec3::Zero();            // given by the tire, not yet received by the rig, now, N s
  double added_energy = 0.0;           // of the tire's rigid-body mass on the rig: kinetic and of gravity, now, J
  Vec3 added_momentum = Vec3::Zero();  // of the added mass, now, kg m/s
  Vec3 added_gravity_impulse = Vec3::Zero();  // of the added mass, N s
  Vec3 rim_velocity = Vec3::Zero();           // now, m/s
};
void visit_fields(FieldsOf<TireAccount> auto& s, auto&& visit) {
  visit(s.model, Field{"model", ""});
  visit(s.terrain_work, Field{"terrain_work", "J"});
  visit(s.rim_work, Field{"rim_work", "J"});
  visit(s.gravity_impulse, Field{"gravity_impulse", "N s"});
  visit(s.terrain_impulse, Field{"terrain_impulse", "N s"});
  visit(s.spindle_impulse, Field{"spindle_impulse", "N s"});
  visit(s.sent_by_terrain, Field{"sent_by_terrain", "N s"});
  visit(s.sent_to_rig, Field{"sent_to_rig", "N s"});
  visit(s.added_energy, Field{"added_energy", "J"});
  visit(s.added_momentum, Field{"added_momentum", "kg m/s"});
  visit(s.added_gravity_impulse, Field{"added_gravity_impulse", "N s"});
  visit(s.rim_velocity, Field{"rim_velocity", "m/s"});
}

struct Books {
  double time = 0.0;  // s
  TerrainEnergies terrain;
  TerrainMomenta grains;
  rigs::RigAccounts rig;
  std::vector<TireAccount> tires;
};
void visit_fields(FieldsOf<Books> auto& s, auto&& visit) {
  visit(s.time, Field{"time", "s"});
  visit(s.terrain, Field{"terrain", ""});
  visit(s.grains, Field{"grains", ""});
  visit(s.rig, Field{"rig", ""});
  visit(s.tires, Field{"tires", ""});
}

/// Work done from outside, J.
struct WorkAccount {
  double drive = 0.0;  // by the drive of the wheels
  double tow = 0.0;    // by the drive that moves the rig along; negative while the tires pull
  double guide = 0.0;  // by rails and steering
  double walls = 0.0;  // by walls and floor on the terrain
};
void visit_fields(FieldsOf<WorkAccount> auto& s, auto&& visit) {
  using column::cumulative;
  visit(s.drive, cumulative("drive_work_J", "J"));
  visit(s.tow, cumulative("tow_work_J", "J"));
  visit(s.guide, cumulative("guide_work_J", "J"));
  visit(s.walls, cumulative("wall_work_J", "J"));
}

/// Energy that is stored in addition to that stored at the start, J.
struct StoredAccount {
  double terrain_kinetic = 0.0, terrain_rotational = 0.0, terrain_potential = 0.0, terrain_elastic_normal = 0.0,
         terrain_elastic_tangential = 0.0, terrain_cohesion = 0.0;
  double tire_kinetic = 0.0, tire_elastic = 0.0, tire_pressure = 0.0, tire_potential = 0.0;
  double rig_kinetic_and_potential = 0.0;  // without the tires' added masses
};
void visit_fields(FieldsOf<StoredAccount> auto& s, auto&& visit) {
  using column::instant;
  visit(s.terrain_kinetic, instant("terrain_kinetic_J", "J"));
  visit(s.terrain_rotational, instant("terrain_rotational_J", "J"));
  visit(s.terrain_potential, instant("terrain_potential_J", "J"));
  visit(s.terrain_elastic_normal, instant("terrain_elastic_normal_J", "J"));
  visit(s.terrain_elastic_tangential, instant("terrain_elastic_tangential_J", "J"));
  visit(s.terrain_cohesion, instant("terrain_cohesion_J", "J"));
  visit(s.tire_kinetic, instant("tire_kinetic_J", "J"));
  visit(s.tire_elastic, instant("tire_elastic_J", "J"));
  visit(s.tire_pressure, instant("tire_pressure_J", "J"));
  visit(s.tire_potential, instant("tire_potential_J", "J"));
  visit(s.rig_kinetic_and_potential, instant("rig_kinetic_and_potential_J", "J"));
}

/// Energy that was lost, by mechanism, J.
struct LostAccount {
  double sliding = 0.0, normal_damping = 0.0, tangential_damping = 0.0, rolling = 0.0, opening = 0.0,
         sleep = 0.0;  // in the terrain
  double tire_viscous = 0.0, tire_numerical = 0.0, tire_solver = 0.0;
  double damper = 0.0;       // of the rig
  double surface_lag = 0.0;  // at the contact surface, because forces act one step late
  double rim_lag = 0.0;      // at the rim, because forces act one step late
};
void visit_fields(FieldsOf<LostAccount> auto& s, auto&& visit) {
  using column::cumulative;
  visit(s.sliding, cumulative("sliding_loss_J", "J"));
  visit(s.normal_damping, cumulative("normal_damping_loss_J", "J"));
  visit(s.tangential_damping, cumulative("tangential_damping_loss_J", "J"));
  visit(s.rolling, cumulative("rolling_loss_J", "J"));
  visit(s.opening, cumulative("opening_loss_J", "J"));
  visit(s.sleep, cumulative("sleep_loss_J", "J"));
  visit(s.tire_viscous, cumulative("tire_viscous_loss_J", "J"));
  visit(s.tire_numerical, cumulative("tire_numerical_loss_J", "J"));
  visit(s.tire_solver, cumulative("tire_solver_loss_J", "J"));
  visit(s.damper, cumulative("damper_loss_J", "J"));
  visit(s.surface_lag, cumulative("surface_lag_loss_J", "J"));
  visit(s.rim_lag, cumulative("rim_lag_loss_J", "J"));
}

/// Energy since the start of the run. A line of the accounts' table contains it and the residual of momentum.
struct EnergyAccount {
  WorkAccount work;
  StoredAccount stored;
  LostAccount lost;
  double terrain_residual = 0.0, tire_residual = 0.0, rig_residual = 0.0;  // of each part alone, J
  double sample_error = 0.0;                                               // of the terrain's losses, J

  double residual() const;  // work − stored − lost, J
  double turnover() const;  // ½ Σ|entries|: the energy that came in and went somewhere, J
  double bound() const;     // largest |residual| for which the account closes, J
  bool closes() const;
};

/// Momentum since the start of the run, N s: changes of the momentum of grains, tires and rig, and the impulses on
/// them. The rig is without the tires' added masses.
struct MomentumAccount {
  Vec3 grains = Vec3::Zero(), tires = Vec3::Zero(), carrier = Vec3::Zero();  // changes
  Vec3 under_way = Vec3::Zero();  // impulses that one part has given and another has not yet received
  Vec3 terrain_gravity = Vec3::Zero(), tire_gravity = Vec3::Zero(), carrier_gravity = Vec3::Zero();
  Vec3 walls = Vec3::Zero(), guide = Vec3::Zero(), sleep = Vec3::Zero();
  // The impulse on the tires through their surfaces, and on the carrier through the spindles, each from both sides.
  Vec3 surface_of_grains = Vec3::Zero(), surface_of_tires = Vec3::Zero(), surface_under_way = Vec3::Zero();
  Vec3 spindle_of_tires = Vec3::Zero(), spindle_of_carrier = Vec3::Zero(), spindle_under_way = Vec3::Zero();

  Vec3 residual() const;
  Vec3 surface_difference() const { return surface_of_grains - surface_of_tires - surface_under_way; }
  Vec3 spindle_difference() const { return spindle_of_tires - spindle_of_carrier - spindle_under_way; }
  double largest() const;  // largest impulse or change among these
  bool closes() const;
};

EnergyAccount energy_account(const Books& start, const Books& now);
MomentumAccount momentum_account(const Books& start, const Books& now);
/// J
double tire_residual(const TireAccount& start, const TireAccount& now);

class Accounts {
 public:
  struct Reports {
    double time = 0.0;  // t_n, s
    std::span<const SpindleReport> tires;
    std::span<const RimState> rims;
    const TerrainReport& terrain;
    const rigs::RigAccounts& rig;
    Vec3 gravity = Vec3::Zero();  // on the rig, m/s²
  };

  /// @param added masses that the rig carries for its tires @param step H, s
  Accounts(std::vector<MassProperties> added, double step) : added_(std::move(added)), step_(step) {}

  /// Adds the reports of each synchronization, from the start on. @pre one report and one rim for each tire
  void add(const Reports& reports);

  const Books& start() const { return start_; }
  const Books& now() const { return now_; }
  EnergyAccount energy() const { return energy_account(start_, now_); }
  MomentumAccount momentum() const { return momentum_account(start_, now_); }

  static Table empty_table();
  /// The table's line after the last add(), valid until the next.
  std::span<const double> line();

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  TireAccount account_of(const Reports& reports, std::size_t tire) const;

  std::vector<MassProperties> added_;
  double step_ = 0.0;
  Books start_, now_;
  std::vector<double> line_;
};

}  // namespace furrow::output
