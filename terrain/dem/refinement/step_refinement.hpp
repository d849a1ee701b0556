// Refines the step of a bed: a step of the scenario is taken in 2, 4, 8, … equal parts while a contact is so deep that
// the whole step would be unstable.
//
// Hertz's stiffness grows with the overlap δ, so the stable step falls as δ^(−1/4). Before each part the deepest
// overlap follows from the positions of grains and surfaces, the same positions at which the forces of that part are
// evaluated. So no force is ever used with a step above the stable one, and no step has to be repeated. When a part is
// too long, the new one is chosen by the overlap that the contact would reach within a whole step at its approach
// speed. The parts grow again, one level at a time, after the overlap has stayed below kRelaxShare of the limit of the
// larger part for kRelaxSteps steps. So an overlap that oscillates about the limit does not make the step flicker.
//
// Consistency when the step changes. Semi-implicit Euler is the leapfrog whose velocities are those at the middle
// between two positions. If a part of dt follows one of dt′, forces act for ½ (dt + dt′) (StepPart::kick). Otherwise
// the energy would jump by ½ (dt′ − dt) F·v: elastic collisions caught half-way would part 3 to 13 % too fast, whereas
// now they lose 0 to 5 %, the second-order error of the whole step at which they began. Impulses and work are recorded
// for the same time, so momentum and energy balance as always (the weight acts for the time between velocities).
// Tangential and rolling springs grow by the displacement since their forces were last evaluated, v dt′. Means over an
// interval are impulses, and surfaces are where the part begins. Sleep counts whole steps, and neighbour lists remain
// valid for a whole one.
//
// Every decision follows from positions and velocities, in a fixed order. So it is the same for any number of threads,
// and with `State` a continued run makes the same decisions.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/refinement/hard_contacts.hpp"

namespace furrow::terrain::dem {

inline constexpr int kFinestLevel = 8;      // a step is taken in at most 2⁸ parts
inline constexpr double kRelaxShare = 0.8;  // of the overlap at which the larger part is just stable
inline constexpr int kRelaxSteps = 100;     // whole steps

class StepRefinement {
 public:
  struct State {
    int level = 0;           // a step is taken in 2^level parts now
    int calm = 0;            // whole steps for which larger parts would have been stable
    std::int64_t added = 0;  // parts beyond one per step, since the run began
    double time = 0.0;       // time taken in parts, s
    int finest = 0;          // highest level so far
    double since = 0.0;      // length of the previous part, s
  };

  /// Refines nothing if the options allow an unstable step.
  explicit StepRefinement(const DemOptions& options) : options_(options) {}

  /// Sets another whole step, s, and begins at level 0. @pre step > 0
  void set_step(double step);

  /// The contacts that now overlap by more than `above`, as hard_contacts() finds them.
  using FindHard = std::function<HardContacts(double above, double ahead)>;
  /// Chooses the length of the coming part from the contacts now. @param begins whether it is the first of its step
  /// @returns failure when a contact is deeper than any step can hold
  Outcome choose(const FindHard& find, bool begins);
  Outcome choose(const GrainSolver& solver, bool begins) {
    return choose([&](double above, double ahead) { return hard_contacts(solver, above, ahead); }, begins);
  }
  /// The overlap above which choose() may refine or fail at the present level, m; infinite: never.
  double watched() const;
  /// For an engine that obtains its contacts only by evaluating them: chooses the parts of the coming steps from the
  /// hardest contact of the last ones. It refines earlier, at kRelaxShare of a part's limit, because its data are late.
  /// @returns failure when a contact was deeper than any step can hold
  Outcome follow(const HardContacts& met);
  int level() const { return state_.level; }
  double since() const { return state_.since; }
  void took(double dt) { state_.since = dt; }
  /// Call it after a step that was taken in this many parts.
  void count(int parts);

  const State& state() const { return state_; }
  /// Saves nothing as long as no step has been taken in parts.
  void save(Archive& archive) const;
  void restore(const Archive& archive);
  void report(TerrainState& state) const;

  /// The overlap at which 2^level parts of the step are just stable, m; infinite if it is beyond kDeepestShare.
  double limit(int level) const { return limits_.at(level); }

 private:
  void relax(const FindHard& find);
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
