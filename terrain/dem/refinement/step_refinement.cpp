#include "terrain/dem/refinement/step_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/no_step_helps.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr char kSaved[] = "refinement";
constexpr int kHalvings = 60;        // of the interval in which the limit is searched
constexpr double kSoundShare = 0.1;  // overlap over the diameter that the advice aims at

/// The overlap at which `step` is just stable, infinite if it is stable at `deepest`; the stable step falls with it.
double limit_of(const DemOptions& options, double step, double deepest) {
  const auto stable = [&](double overlap) { return stable_at(options, overlap).step >= step; };
  if (stable(deepest)) return kInfinite;
  double low = std::log(1e-9 * deepest), high = std::log(deepest);
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (stable(std::exp(middle)) ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace

void StepRefinement::set_step(double step) {
  FURROW_ASSERT(step > 0.0, step);
  step_ = step;
  state_.level = state_.calm = 0;
  state_.since = step;
  limits_.clear();
  if (options_.allow_unstable_step) return;
  deepest_ = 2.0 * kDeepestShare * smallest_radius(options_);
  const double deepest = 2.0 * kDeepestShare * largest_radius(options_);
  do {
    limits_.push_back(limit_of(options_, std::ldexp(step, -static_cast<int>(limits_.size())), deepest));
  } while (limits_.back() < deepest && limits_.size() <= kFinestLevel);
}

double StepRefinement::watched() const {
  return limits_.empty() ? kInfinite : std::min(limits_[state_.level], deepest_);
}

Outcome StepRefinement::choose(const FindHard& find, bool begins) {
  FURROW_ASSERT(step_ > 0.0, step_);
  if (limits_.empty()) return {};
  if (begins && state_.level > 0) relax(find);
  const HardContacts hard = find(watched(), step_);
  if (hard.past > 0) return too_hard(hard);
  const int finest = static_cast<int>(limits_.size()) - 1;
  if (!(hard.overlap > limits_[state_.level])) return {};
  if (hard.overlap > limits_[finest]) return too_deep(hard.overlap);
  while (state_.level < finest && std::max(hard.overlap, hard.coming) > limits_[state_.level]) ++state_.level;
  state_.calm = 0;
  return {};
}

Outcome StepRefinement::follow(const HardContacts& met) {
  FURROW_ASSERT(step_ > 0.0, step_);
  if (limits_.empty()) return {};
  if (met.share > kDeepestShare) return too_hard(met);
  const int finest = static_cast<int>(limits_.size()) - 1;
  if (met.overlap > limits_[finest]) return too_deep(met.overlap);
  const int before = state_.level;
  while (state_.level < finest && met.overlap > kRelaxShare * limits_[state_.level]) ++state_.level;
  const bool calm = state_.level > 0 && met.overlap <= kRelaxShare * kRelaxShare * limits_[state_.level - 1];
  state_.calm = calm && state_.level == before ? state_.calm + 1 : 0;
  if (state_.calm >= kRelaxSteps) --state_.level, state_.calm = 0;
  return {};
}

Outcome StepRefinement::too_deep(double overlap) const {
  const StableStep stable = stable_at(options_, overlap);
  return Outcome::failure(
      "needs a smaller step",
      fmt::format("grains overlap by {:.3g} m, where {:.3g} s is the stable step ({}): {} parts of the step of "
                  "{:.3g} s are not enough; expected a smaller run.step or more terrain.substeps",
                  overlap, stable.step, stable.reason, 1 << (limits_.size() - 1), step_));
}

void StepRefinement::relax(const FindHard& find) {
  const double calm = std::min(kRelaxShare * limits_[state_.level - 1], deepest_);
  if (find(calm, 0.0).count > 0) {
    state_.calm = 0;
  } else if (++state_.calm >= kRelaxSteps) {
    --state_.level;
    state_.calm = 0;
  }
}

void StepRefinement::count(int parts) {
  FURROW_ASSERT(parts > 0, parts);
  state_.finest = std::max(state_.finest, state_.level);
  if (parts == 1) return;
  state_.added += parts - 1;
  state_.time += step_;
}

void StepRefinement::save(Archive& archive) const {
  if (state_.finest > 0) save_fields(archive, kSaved, state_);
}

void StepRefinement::restore(const Archive& archive) {
  FURROW_ASSERT(step_ > 0.0, step_);
  state_ = {};
  if (archive.has(std::string(kSaved) + "/level")) restore_fields(archive, kSaved, state_);
  if (!(state_.since > 0.0)) state_.since = step_;
  state_.level = std::clamp(state_.level, 0, std::max(0, static_cast<int>(limits_.size()) - 1));
}

void StepRefinement::report(TerrainState& state) const {
  state.substeps_added = state_.added;
  state.refined_time = state_.time;
  state.most_parts = 1 << state_.finest;
}

Outcome StepRefinement::too_hard(const HardContacts& hard) const {
  const double stiffer = std::pow(hard.share / kSoundShare, 1.5);
  DemOptions other = options_;
  const StiffnessKey key = stiffness_key(other);
  *key.value *= stiffer;
  return Outcome::failure(
      "has contacts that are too hard for its grains",
      fmt::format("{} {} deeper than {:.0f} % of a grain's diameter, the deepest by {:.3g} m ({:.0f} %) between {} "
                  "at "
                  "({:.4g}, {:.4g}, {:.4g}) m; expected stiffer grains (about {:.2g} {} in terrain.{}, which needs a "
                  "step of at most {:.2g} s), or less load or speed; {}",
                  hard.past, hard.past == 1 ? "contact is" : "contacts are", 100.0 * kDeepestShare, hard.deepest,
                  100.0 * hard.share, hard.between, hard.at.x(), hard.at.y(), hard.at.z(), *key.value, key.unit,
                  key.name, stable_at(other, stated_overlap(other)).step, kNoStepHelps));
}

}  // namespace furrow::terrain::dem
