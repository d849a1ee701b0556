// How finely a bed is stepped: a step of the scenario is taken in 2, 4, 8, … equal parts for as long as a contact is so
// deep that the whole step would be unstable.
//
// Hertz's stiffness grows with the overlap δ, so that the stable step falls as δ^(−1/4). Before each part the deepest
// overlap is known from where grains and surfaces stand, which is the very overlap at which the forces of that part are
// taken: no force is ever taken with a step above the stable one, and nothing has to be taken back. Once a part is too
// long, the overlap that its approach speed would make of the contact within a whole step chooses the new one. The
// parts grow again, one level at a time, after the overlap stayed below kRelaxShare of what the larger part bears for
// kRelaxSteps steps: a contact that swings about the limit does not make the step flicker.
//
// What stays consistent when the step changes. Semi-implicit Euler is the leapfrog whose velocities belong to the
// middle between two positions: where a part of dt follows one of dt′, forces act for ½ (dt + dt′) (StepPart::kick).
// Else the energy would jump by ½ (dt′ − dt) F·v: elastic collisions caught half-way would part 3 to 13 % too fast,
// where now they lose 0 to 5 %, the second order of the whole step at which they began. Impulses and work are booked
// for the same time, so that momentum and energy balance as ever (the weight acts for the time between velocities).
// Tangential and rolling springs grow by the way since their forces were last taken, which is v dt′. Means over an
// interval are impulses, surfaces stand where the part begins. Sleep counts whole steps, and neighbour
// lists stay good for a whole one.
//
// Every decision follows from positions and velocities, in a fixed order: it is alike for any number of threads, and
// `State` makes a continued run decide alike.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/refinement/hard_contacts.hpp"

namespace furrow::terrain::dem {

inline constexpr int kFinestLevel = 8;      // a step is taken in at most 2⁸ parts
inline constexpr double kRelaxShare = 0.8;  // of the overlap that the larger part bears
inline constexpr int kRelaxSteps = 100;     // whole steps

class StepRefinement {
 public:
  struct State {
    int level = 0;           // a step is taken in 2^level parts now
    int calm = 0;            // whole steps for which larger parts would have done
    std::int64_t added = 0;  // parts beyond one per step, since the run began
    double time = 0.0;       // taken in parts, s
    int finest = 0;          // the highest level so far
    double since = 0.0;      // the part before, s
  };

  /// Refines nothing where the options allow an unstable step.
  explicit StepRefinement(const DemOptions& options) : options_(options) {}

  /// Another whole step, s: begins at level 0. @pre step > 0
  void set_step(double step);

  /// Before a part: chooses its length from the contacts as they stand. @param begins it is the first of its step
  /// @returns failure when a contact is deeper than any step can hold
  Outcome choose(const GrainSolver& solver, bool begins);
  /// For an engine that learns of its contacts once they were evaluated: chooses the parts of the coming steps from the
  /// hardest contact of those before. It refines sooner, at kRelaxShare of what a part bears, since it is late.
  /// @returns failure when a contact was deeper than any step can hold
  Outcome follow(const HardContacts& met);
  int level() const { return state_.level; }
  double since() const { return state_.since; }
  void took(double dt) { state_.since = dt; }
  /// After a step that was taken in this many parts.
  void count(int parts);

  const State& state() const { return state_; }
  /// Saves nothing as long as no step was taken in parts.
  void save(Archive& archive) const;
  void restore(const Archive& archive);
  /// What the terrain says of its steps.
  void report(TerrainState& state) const;

  /// The overlap at which 2^level parts of the step are just stable, m; infinite: beyond kDeepestShare.
  double limit(int level) const { return limits_.at(level); }

 private:
  void relax(const GrainSolver& solver);
  Outcome too_hard(const HardContacts& hard) const;
  Outcome too_deep(double overlap) const;

  DemOptions options_;
  double step_ = 0.0;           // s
  double deepest_ = 0.0;        // overlap at kDeepestShare of the smallest grains, m
  std::vector<double> limits_;  // by level, m
  State state_;
};
void visit_fields(FieldsOf<StepRefinement::State> auto& s, auto&& visit) {
  visit(s.level, Field{"level"});
  visit(s.calm, Field{"calm"});
  visit(s.added, Field{"added"});
  visit(s.time, Field{"time", "s"});
  visit(s.finest, Field{"finest"});
  visit(s.since, Field{"since", "s"});
}

}  // namespace furrow::terrain::dem
