// Steps a bin of grains: contacts between grains, with walls and with tires, gravity, semi-implicit Euler
//   v ← v + dt (F/m + g),   ω ← ω + dt T/I,   x ← x + dt v.
//
// Data flow of one step. Strips (strips.hpp) are grouped into chunks, and one thread processes a chunk strip by strip.
// Each strip filters its pairs by distance and evaluates the law on the touching ones, its walls and tires. Forces are
// in scratch memory of the thread, which extends one strip ahead. After strip k all loads on its grains are complete,
// so they are moved at once, while they are still in the cache. So positions, velocities and spins are read from memory
// once per step, forces never. Only the first strip of a chunk waits for loads from the chunk before; it is moved in a
// second short pass. No thread writes to grains of another, and every sum has an order fixed by the lists: the bits do
// not depend on the number of threads.
//
// If strips are cut into parcels (parcel.hpp) and some of them sleep, a strip is stepped in rows of parcels
// (activity.hpp). Awake parcels are evaluated together. Each sleeping parcel is evaluated alone, so that its sums can
// be used in later steps that do not evaluate it. A grain's forces are added in the same order however the strip is
// divided, so awake parcels move with the same bits as a whole strip. Only the rounding of a strip's sums differs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/accounts/energy_accounts.hpp"
#include "terrain/dem/activity.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"
#include "terrain/dem/pair_forces.hpp"
#include "terrain/dem/strips.hpp"
#include "terrain/dem/tires/surface_contacts.hpp"
#include "terrain/dem/wall_forces.hpp"

namespace furrow::terrain::dem {

/// Precision of the contact law between grains; positions, sums and integration always use double precision.
enum class Precision { mixed, full };

struct SolverParams {
  LawKind law{};
  bool rolling = false;   // rolling resistance
  GrainProperties grain;  // of the reference radius, that of the coefficients
  double smallest = 0.0;  // radius of the smallest grain, m; 0: all have the reference radius
  double largest = 0.0;   // radius of the largest grain, m; 0: as above
  Bin bin;
  Vec3 gravity = standard_gravity();  // m/s²
  double skin = 0.0;                  // neighbours are listed if their surfaces are closer than this, m
  int threads = 1;
  Precision precision = Precision::mixed;
  bool activity = false;                // let resting grains sleep
  int sample_every = kLossSampleSteps;  // steps between samples of the losses

  /// Whether grains differ in size; only with a law that allows it.
  bool sizes() const { return largest > smallest; }
  double smallest_radius() const { return sizes() ? smallest : grain.radius; }
  double largest_radius() const { return sizes() ? largest : grain.radius; }
};

/// Cumulative since reset_accounts() unless stated otherwise.
struct Accounts {
  double contact_work = 0.0;            // ∫ contact forces · relative velocity, J
  double elastic = 0.0;                 // at the last force evaluation, J
  double elastic_start = 0.0;           // J
  Vec3 wall_impulse = Vec3::Zero();     // N s
  Vec3 surface_impulse = Vec3::Zero();  // N s
  double floor_force = 0.0;             // last step, N
  double kinetic = 0.0;                 // now, J
  double height = 0.0;                  // Σ m h / m₀ now, h against gravity, m
  Vec3 velocity = Vec3::Zero();         // Σ m v / m₀ now, m/s
  std::int64_t contacts = 0;            // last step
  double max_overlap = 0.0;             // largest since reset, m
  double contact_force = 0.0;           // Σ |F|, N, last measured step
  double net_force = 0.0;               // Σ |net force| of grains, N, last measured step
  double slept = 0.0;                   // kinetic energy of grains when they fell asleep, J
  // Momentum of grains when they fell asleep, and the impulse of loads on sleeping grains, kg m/s.
  Vec3 momentum_removed = Vec3::Zero();
  std::int64_t active = 0;  // grains awake, last step
};
void visit_fields(FieldsOf<Accounts> auto& s, auto&& visit) {
  visit(s.contact_work, Field{"contact_work", "J"});
  visit(s.elastic, Field{"elastic", "J"});
  visit(s.elastic_start, Field{"elastic_start", "J"});
  visit(s.wall_impulse, Field{"wall_impulse", "N s"});
  visit(s.surface_impulse, Field{"surface_impulse", "N s"});
  visit(s.floor_force, Field{"floor_force", "N"});
  visit(s.kinetic, Field{"kinetic", "J"});
  visit(s.height, Field{"height", "m"});
  visit(s.velocity, Field{"velocity", "m/s"});
  visit(s.contacts, Field{"contacts"});
  visit(s.max_overlap, Field{"max_overlap", "m"});
  visit(s.contact_force, Field{"contact_force", "N"});
  visit(s.net_force, Field{"net_force", "N"});
  visit(s.slept, Field{"slept", "J"});
  visit(s.momentum_removed, Field{"momentum_removed", "kg m/s"});
  visit(s.active, Field{"active"});
}

/// A step or a part of it: v ← v + kick (F/m + g), then x ← x + dt v.
struct StepPart {
  double dt = 0.0;     // s
  double since = 0.0;  // dt of the previous part, over which grains moved since the forces were last evaluated, s
  double whole = 0.0;  // the step to which it belongs, s
  bool last = true;    // whether it ends the step

  /// Velocities are at the middle between two positions, so a change of dt does not change the energy.
  double kick() const { return 0.5 * (since + dt); }
};

class GrainSolver {
 public:
  /// @pre radius, mass, inertia, bin and threads are positive; the law allows grains of several sizes if there are any
  explicit GrainSolver(const SolverParams& params);

  const SolverParams& params() const { return params_; }
  void set_threads(int threads) {
    FURROW_ASSERT(threads > 0, threads);
    params_.threads = threads;
  }
  void set_coefficients(const SolverCoefficients& c) { coefficients_ = c; }
  const SolverCoefficients& coefficients() const { return coefficients_; }
  /// Extra damping of all motion while settling: dv/dt = −drag v, 1/s. @pre drag ≥ 0
  void set_drag(double drag) {
    FURROW_ASSERT(drag >= 0.0, drag);
    drag_ = drag;
  }

  /// Puts grains at rest with ids 0, 1, …; w of each position is its radius, m, or 0 for the reference radius.
  /// @throws Error(bad_input) when a radius is outside the limits of the parameters.
  void place(const std::vector<Quad>& positions);
  Grains& grains() { return grains_; }
  const Grains& grains() const { return grains_; }
  const Strips& strips() const { return strips_; }
  Strips& strips() { return strips_; }  // for setting contact histories
  /// Number of rebuilds of the neighbour list since reset_accounts(), weighted by the share of grains in each.
  double rebuilds() const;
  SurfaceContacts& surfaces() { return surfaces_; }
  const SurfaceContacts& surfaces() const { return surfaces_; }
  const Accounts& accounts() const { return accounts_; }
  /// Also begin with reset_accounts().
  const EnergyAccounts& energies() const { return energies_; }
  /// The accounts of the grains as a terrain reports them, without the work of surfaces.
  TerrainEnergies reported_energies() const;
  /// Weight of all grains × the time since reset_accounts(), N s.
  Vec3 gravity_impulse() const {
    return params_.grain.mass * relative_mass_ * energies_.state().time * params_.gravity;
  }
  /// Determines sleep and waking; sampled every kSampleSteps steps while grains may sleep, N.
  double mean_contact_force() const { return mean_contact_force_; }
  void reset_accounts();
  /// Wakes the parcel of a grain whose motion was set from outside.
  void wake(int grain);
  void wake_all();
  /// Σ m / m₀ of all grains.
  double relative_mass() const;
  /// Current index of the grain with this id. @pre there is one
  int index_of(int id) const;
  /// Height that no grain exceeds, m.
  double top() const;
  std::size_t bytes() const;

  /// One step. With `measure`, the force sums of Accounts are taken too.
  /// Returns the index of a grain that left the bin or is not finite, or −1. @pre dt > 0
  int step(double dt, bool measure = false) { return step_part({dt, dt, dt, true}, measure); }
  /// Takes one part of a step. All counts of steps count whole steps. The lists stay valid for a whole step after it.
  int step_part(const StepPart& part, bool measure = false);

  /// Whether any contact that strip k lists may overlap by more than `overlap`, m, at the present positions. The bound
  /// is from the last step's overlaps and the displacements of grains and surfaces since. True if there is no bound.
  bool may_overlap(int k, double overlap) const {
    FURROW_ASSERT(in_range(k, strips_.count()), k, strips_.count());
    return overlap_bound_.empty() || !(overlap_bound_[k] <= overlap);
  }

  void save(Archive& archive) const;
  /// Wakes all grains if this solver lets none sleep, or if the saved state has other parcels.
  void restore(const Archive& archive);

 private:
  struct LoadBuffer {
    std::vector<Quad> force, torque;
    void copy(const Loads& from, int first, int last);
  };
  /// Strips [from, to), which one thread steps.
  struct Chunk {
    int from = 0, to = 0;
    LoadBuffer own;    // on the grains of strip `from`, from this chunk
    LoadBuffer ahead;  // on the grains of the strip after the last, from this chunk
  };
  template <class Real>
  struct Scratch {
    MotionRows<Real> motion;
    LoadBuffer loads;
    std::vector<Quad> shifted;  // positions as seen across periodic ends
    TouchingPairs<Real> touching;
  };

  void make_chunks();
  template <class Real>
  Scratch<Real>& scratch();
  template <class Real, bool kSizes>
  void gather(Scratch<Real>& scratch, int strip, int offset);
  /// Positions of a strip's grains and those of the next strip, in the numbering of the lists.
  template <class Real>
  const Quad* positions(Scratch<Real>& scratch, int strip);
  /// Evaluates contacts that a part of the strip lists; adds their sums to `sums`.
  template <class Real, class Law, bool kRolling, bool kSizes>
  void contacts_of_part(Scratch<Real>& scratch, int strip, const StripPart& part, const Quad* x, int offset, double dt,
                        Wanted wanted, ContactTotals& sums);
  template <class Real, class Law, bool kRolling, bool kSizes>
  void contacts_of_strip(Scratch<Real>& scratch, int strip, int offset, double dt, Wanted wanted);
  template <class Real, class Law, bool kRolling, bool kSizes>
  void run_chunk(Chunk& chunk, const StepPart& part, Wanted wanted);
  void finish_chunk(Chunk& chunk, const Chunk* before, const StepPart& part, Wanted wanted);
  template <class Real>
  void evaluate(const StepPart& part, Wanted wanted);
  /// For each parcel of strip k with complete loads: moves its grains if it is awake, else sums the forces on it.
  void finish_strip(int k, const Loads& loads, const StepPart& part, Wanted wanted);
  void move_parcel(const Strip& strip, Parcel& parcel, const Loads& loads, const StepPart& part, Wanted wanted);
  /// `loads` start at the parcel's first grain.
  template <bool kMaySleep, bool kSizes>
  void integrate(const Strip& strip, Parcel& parcel, const Loads& loads, const StepPart& part, Wanted wanted);
  void load_sleeper(const Strip& strip, Parcel& parcel, const Loads& loads) const;
  /// Steps of the window over which the drift of a grain is averaged.
  int sway_steps(double dt) const;
  void change_activity(bool counts);
  void bound_overlaps(double dt);
  /// After strips were sorted again, spreads their largest bound, because pairs may have moved to other lists.
  void spread_bounds(const Resorted& range);
  /// Σ |F| of a strip, N: the present value, or that of its last sample if it is not evaluated. Only samples are saved.
  double measured_force(int k) const;
  bool sample_now() const { return params_.activity && until_sample_ == 0; }
  void restore_drift(const Archive& archive);
  /// Samples the contact forces of the strips that this step evaluated. Sleeping strips do not change and keep theirs.
  void take_samples();
  std::int32_t grains_awake(const Strip& strip) const;
  void reduce(const StepPart& part, Wanted wanted);

  SolverParams params_;
  Vec3 up_;  // unit vector against gravity, along which heights are measured; z without gravity
  SolverCoefficients coefficients_;
  double drag_ = 0.0;
  Grains grains_;
  Strips strips_;
  SurfaceContacts surfaces_;
  Activity activity_;
  /// Contacts that a strip lists, when they were last evaluated in a step that took samples.
  struct ForceSample {
    double force = 0.0;  // Σ |F|, N
    std::int64_t contacts = 0;
  };
  std::vector<ForceSample> samples_;  // per strip
  std::int64_t until_sample_ = 0;     // steps
  double mean_contact_force_ = 0.0;   // of the bed, from the samples, N
  Accounts accounts_;
  EnergyAccounts energies_;
  double relative_mass_ = 0.0;
  std::vector<double> overlap_bound_;  // per strip, m; empty: not known
  std::vector<Chunk> chunks_;
  std::vector<Scratch<float>> single_;  // per thread
  std::vector<Scratch<double>> full_;
};

}  // namespace furrow::terrain::dem
