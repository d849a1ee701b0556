// The walls and tires that act on the grains of one rank, and the sums of that rank: Furrow's work in each step of a
// distributed engine (engine.hpp). The laws are those of terrain/dem; the grains carry the histories.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/accounts/energy_accounts.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/parcel.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/dem/tires/tire_surface.hpp"
#include "terrain/dem/wall_forces.hpp"
#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/wall_contacts.hpp"

namespace furrow::terrain::liggghts {

/// Sums over the grains of one rank; cumulative since the run began unless stated.
struct RankSums {
  double elastic = 0.0;                 // normal springs and cohesion, last step, J
  Vec3 wall_impulse = Vec3::Zero();     // N s
  Vec3 surface_impulse = Vec3::Zero();  // N s
  double gravity_time = 0.0;            // time for which the weight has acted, s
  double floor_force = 0.0;             // last step, N
  double contacts = 0.0;                // last step
  MotionSums motion;                    // now
};
void visit_fields(FieldsOf<RankSums> auto& s, auto&& visit) {
  visit(s.elastic, Field{"elastic", "J"});
  visit(s.wall_impulse, Field{"wall_impulse", "N s"});
  visit(s.surface_impulse, Field{"surface_impulse", "N s"});
  visit(s.gravity_time, Field{"gravity_time", "s"});
  visit(s.floor_force, Field{"floor_force", "N"});
  visit(s.contacts, Field{"contacts"});
  visit(s.motion, Field{"motion", ""});
}

/// Outcome of an interval on one rank. All ranks receive the reports of all.
struct IntervalReport {
  double lost = -1.0;              // number of a grain; −1: none
  Vec3 lost_at = Vec3::Zero();     // m
  double overlap = 0.0;            // largest, m
  double share = 0.0;              // largest overlap over a diameter, -
  Vec3 hardest_at = Vec3::Zero();  // m
};
void visit_fields(FieldsOf<IntervalReport> auto& s, auto&& visit) {
  visit(s.lost, Field{"lost"});
  visit(s.lost_at, Field{"lost_at", "m"});
  visit(s.overlap, Field{"overlap", "m"});
  visit(s.share, Field{"share", "-"});
  visit(s.hardest_at, Field{"hardest_at", "m"});
}

class RankContacts final : public StepWork {
 public:
  explicit RankContacts(const dem::DemOptions& options);

  /// From now on contacts are evaluated for steps of `dt`, s.
  void set_step(double dt);

  void attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start);
  std::size_t vertices(int k) const { return tires_.at(k).end.size(); }
  int tires() const { return static_cast<int>(tires_.size()); }
  SurfaceBox swept_bounds(int k) const { return tires_.at(k).collider.swept_bounds(); }

  /// Declares the motion of the coming interval of `steps` steps.
  void begin_interval(std::span<const SurfaceState> targets, double duration, int steps);
  void set_times(const StepTimes& times) { times_ = times; }
  /// Call it when another engine has replaced the grains.
  void forget_grains();
  void lists_made(const OwnGrains& grains, std::span<const std::int32_t> order) override;
  void numbers_change(const OwnGrains& grains) override;
  StepWish begin_step() override;
  void add_forces(const OwnGrains& grains, int first, int last, bool losses) override;
  void end_step(const PairSums& pairs, const MotionSums& motion, bool losses) override;
  /// Returns this rank's share of the interval's means.
  void end_interval(double duration, std::span<NodalForces> forces, std::span<ContactSums> sums);

  /// Report on this rank's grains in the interval: the first one that was lost, and the hardest contact.
  const IntervalReport& interval() const { return interval_; }

  const RankSums& sums() const { return sums_; }
  const dem::EnergyAccounts& energies() const { return energies_; }
  dem::EnergyAccounts& energies() { return energies_; }
  const dem::GrainProperties& grain() const { return params_.grain; }
  const dem::SolverParams& params() const { return params_; }
  /// Setup of an engine for these grains; the caller sets ranks, borders and the height of the bed.
  EngineSetup setup() const;
  const dem::SolverCoefficients& coefficients() const { return coefficients_; }
  /// Begins the accounts. @param stored by the contacts of this rank's grains now  @param elastic J
  void begin_accounts(const dem::Stored& stored, double elastic);
  /// Sums the motion of the grains that the rank has now, after they were replaced.
  void sum_motion(const OwnGrains& grains);

  /// Histories of walls and tires that the grains carry, grain by grain.
  std::vector<CarriedBy> carried(const OwnGrains& grains) const;

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  struct Tire : dem::TireSurface {
    using TireSurface::TireSurface;
    SurfaceBox looked_for;  // where grains were last searched
    std::int64_t grid = 0;  // the collider's grid_rebuilds() at that time
    double way = 0.0;       // displacement of the fastest vertex in a step, m
    double moved = 0.0;     // largest displacement of vertices since grains were searched, m
  };

  struct Touchable {
    int place, grain;      // index in order_, index in OwnGrains
    int near = 0;          // in near_begin_: beginnings of its triangles for each tire, and their end
    bool carries = false;  // has a history with a tire
  };

  template <class Law, bool kRolling, bool kSizes>
  void add_forces_of(const OwnGrains& grains, int last, bool losses);
  template <class Law, bool kRolling>
  void touch_tires(const OwnGrains& grains, Touchable& t, bool losses);
  template <class Law, bool kRolling>
  void touch_tire(const OwnGrains& grains, int g, int k, std::span<const SurfaceHit> hits, bool losses);
  /// Finds the grains that may touch a wall or a tire, if the last result is no longer valid.
  void look(const OwnGrains& grains);
  bool looked_far_enough() const;
  bool any_near(const SurfaceBox& part) const;
  void look_at(const OwnGrains& grains, int first, int last);
  /// Distance by which a grain and a tire may approach each other before the next look, m.
  double look_room() const;
  void note_lost(const OwnGrains& grains, int g);
  void note(double overlap, double share, const double* at);

  dem::DemOptions options_;
  dem::SolverParams params_;
  dem::SolverCoefficients coefficients_;
  std::vector<Tire> tires_;
  bool tires_roll_ = false;  // whether some tire resists the rolling of grains, even if grains do not
  StepTimes times_;
  int steps_ = 1, step_ = 0;  // of the interval
  dem::EnergyAccounts energies_;
  RankSums sums_;
  dem::ContactTotals now_;         // walls and tires, this step
  Vec3 on_grains_ = Vec3::Zero();  // by tires, this step, N
  IntervalReport interval_;
  WallContacts walls_;
  bool walls_listed_ = false;            // the lists of walls are valid
  std::span<const std::int32_t> order_;  // from lists_made
  std::vector<Touchable> touchable_;     // in the order of order_
  std::vector<int> near_, near_begin_;   // triangles that touchable grains may touch
  std::size_t next_ = 0;                 // of touchable_, in this step
  std::vector<std::uint8_t> carries_;    // of each grain, during a look
  bool looked_ = false;                  // touchable_ is valid
  bool numbered_ = false;                // the indices of its grains are valid
  std::vector<SurfaceBox> parts_;        // boxes of kPart grains each in that order, when lists were made
  SurfaceBox box_;                       // of the centres, when lists were made
  std::vector<Carried> past_;            // histories of the present grain before this step
  std::vector<std::uint8_t> taken_;      // which of them a point has taken over
};

}  // namespace furrow::terrain::liggghts
