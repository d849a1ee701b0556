// Energy of the grains by mechanism. Summing the energy taken by springs, damping and sliding in every step is too
// expensive: contact_losses.hpp costs as much as the law itself. So every kLossSampleSteps-th step is a *sample*: the
// power of each mechanism is summed over all evaluated contacts, with the step's forces and velocities. It represents
// its own step and the nearer half of the steps on either side. If every step were a sample, the sums would be exact.
// Sleeping strips lose nothing. kLossSampleSteps is a prime, so that samples do not follow substeps or treads.
//
// Error of sampling: if powers of successive samples were independent, the variance of one would be
// ½⟨(P_k − P_{k−1})²⟩, so
//   error² = Σ ½ (P_k − P_{k−1})² Δt_k²,
// where P is the sum of all sampled losses. If powers change slowly compared with Δt, this is an upper bound.
//
// Summed in every step, without an error of sampling: kinetic and potential energy, the sum of normal springs and
// cohesion, the energy removed by sleep, and the work of tires.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "terrain/dem/accounts/contact_losses.hpp"

namespace furrow::terrain::dem {

inline constexpr int kLossSampleSteps = 47;

class EnergyAccounts {
 public:
  struct State {
    Losses lost;            // until the last sample, J
    Losses power;           // at the last sample, W
    double since = 0.0;     // time since the last sample, s
    double own = 0.0;       // part of `since`: the step, or part of one, in which the sample was taken, s
    double time = 0.0;      // time since the accounts began, s
    double error2 = 0.0;    // J²
    double rotation = 0.0;  // ½ Σ I ω² now, J
    Stored stored;          // at the last sample
    std::int64_t samples = 0;
    std::int64_t until = 0;  // until the next sample, whole steps
  };

  /// @pre every > 0
  explicit EnergyAccounts(int every = kLossSampleSteps) : every_(every) { FURROW_ASSERT(every > 0, every); }

  /// Starts the accounts again. @param stored by the contacts of each strip now
  void begin(std::vector<Stored> stored, double rotation);
  /// Whether the coming step is a sample.
  bool due() const { return state_.until == 0; }
  /// Adds a sample. strips: their number; of(k): the sums of strip k, or null if it was not evaluated. Such a strip
  /// loses nothing and stores as much as before.
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
  /// After forces have acted for dt. @param whole the step is over, rather than a part of it
  void advance(double dt, bool whole, double rotation);

  /// Losses until now, J.
  Losses lost() const {
    Losses now = state_.lost;
    add(now, state_.power, state_.since);
    return now;
  }
  double error() const;
  const State& state() const { return state_; }

  void save(Archive& archive) const;
  void restore(const Archive& archive, std::size_t strips);

 private:
  void take(const Losses& power);

  int every_;
  State state_;
  std::vector<Stored> stored_;  // per strip, from its last sample
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
