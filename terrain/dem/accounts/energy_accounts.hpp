// Energy of the grains by mechanism. What springs, damping and sliding take is too dear to be summed in every step:
// contact_losses.hpp costs as much as the law itself. So every kLossSampleSteps-th step is a *sample*: in it the power
// of each mechanism is summed over all contacts that are evaluated, with the forces and velocities of that step, and it
// stands for its own step and for the nearer half of those on either side. Were every step a sample, the sums would be
// exact. Strips that sleep lose nothing. kLossSampleSteps is a prime: samples do not fall into step with substeps or
// treads.
//
// The error of that: were powers of successive samples independent, the variance of one were ½⟨(P_k − P_{k−1})²⟩, so
//   error² = Σ ½ (P_k − P_{k−1})² Δt_k²,
// P the sum of all sampled losses. Where powers change slowly against Δt it is an upper bound.
//
// What is summed in every step, without an error of sampling: kinetic and potential energy, the sum of normal springs
// and cohesion, what sleep takes, and the work of tires.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "terrain/dem/accounts/contact_losses.hpp"

namespace furrow::terrain::dem {

/// Steps from one sample to the next.
inline constexpr int kLossSampleSteps = 47;

class EnergyAccounts {
 public:
  struct State {
    Losses lost;            // until the last sample, J
    Losses power;           // at the last sample, W
    double since = 0.0;     // the last sample, s
    double own = 0.0;       // of that: the step, or part of one, in which it was taken, s
    double time = 0.0;      // since the accounts began, s
    double error2 = 0.0;    // J²
    double rotation = 0.0;  // ½ Σ I ω² now, J
    Stored stored;          // at the last sample
    std::int64_t samples = 0;
    std::int64_t until = 0;  // the next sample, whole steps
  };

  /// @pre every > 0
  explicit EnergyAccounts(int every = kLossSampleSteps) : every_(every) { FURROW_ASSERT(every > 0, every); }

  /// Begins again. @param stored by the contacts of each strip now
  void begin(std::vector<Stored> stored, double rotation);
  /// Whether the coming step is a sample.
  bool due() const { return state_.until == 0; }
  /// Adds a sample. strips: how many; of(k): the sums of strip k, or null when it was not evaluated: it loses nothing
  /// and holds what it held.
  template <class Of>
  void sample(int strips, const Of& of) {
    Losses power;
    stored_.resize(strips);
    state_.stored = {};
    for (int k = 0; k < strips; ++k) {
      if (const ContactSample* const now = of(k)) {
        add(power, now->power, 1.0);
        stored_[k] = now->stored;
      }
      add(state_.stored, stored_[k], 1.0);
    }
    take(power);
  }
  /// Forces have acted for dt. @param whole the step is over, rather than a part of it
  void advance(double dt, bool whole, double rotation);

  /// Until now, J.
  Losses lost() const {
    Losses now = state_.lost;
    add(now, state_.power, state_.since);
    return now;
  }
  double error() const;
  const State& state() const { return state_; }

  void save(Archive& archive) const;
  /// @param strips how many
  void restore(const Archive& archive, std::size_t strips);

 private:
  void take(const Losses& power);

  int every_;
  State state_;
  std::vector<Stored> stored_;  // per strip, when it was last part of a sample
};
void visit_fields(FieldsOf<EnergyAccounts::State> auto& s, auto&& visit) {
  visit(s.lost, Field{"lost", "J"});
  visit(s.power, Field{"power", "W"});
  visit(s.since, Field{"since", "s"});
  visit(s.own, Field{"own", "s"});
  visit(s.time, Field{"time", "s"});
  visit(s.error2, Field{"error2", "J²"});
  visit(s.rotation, Field{"rotation", "J"});
  visit(s.stored, Field{"stored", "J"});
  visit(s.samples, Field{"samples"});
  visit(s.until, Field{"until"});
}

}  // namespace furrow::terrain::dem
