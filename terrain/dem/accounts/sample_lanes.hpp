// Collects samples of single contacts (contact_losses.hpp) and evaluates four at a time.
#pragma once

#include "protocol/core/assert.hpp"
#include "protocol/core/simd.hpp"
#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/contact/contact.hpp"

namespace furrow::terrain::dem {

/// All contacts must have the same coefficients.
template <class Law, bool kRolling>
class SampleLanes {
  using Coefficients = typename Law::template Coefficients<double>;

 public:
  /// @param sum  receives the samples, at the latest in finish()  @pre dt > 0, s
  SampleLanes(const Coefficients& c, double dt, ContactSample& sum) : c_(c), dt_(dt), sum_(sum) {
    FURROW_ASSERT(dt > 0.0, dt);
  }

  /// @param share  weight of the sample
  void add(const ContactMotion<double>& motion, const ContactHistory<double>& history, double share) {
    put(motion_.normal, motion.normal), put(motion_.velocity, motion.velocity);
    put(motion_.roll, motion.roll);
    motion_.overlap[count_] = motion.overlap, motion_.root_overlap[count_] = motion.root_overlap;
    motion_.spin[count_] = motion.spin;
    put(history_.tangential, history.tangential), put(history_.rolling, history.rolling);
    history_.root_overlap[count_] = history.root_overlap;
    share_[count_] = share;
    if (++count_ == kDoubleLanes) evaluate();
  }
  /// Evaluates the remaining contacts.
  void finish() {
    if (count_ > 0) evaluate();
  }

 private:
  void put(Triple<Double4>& to, const Triple<double>& v) const {
    to.x[count_] = v.x, to.y[count_] = v.y, to.z[count_] = v.z;
  }
  /// Not inlined, like sample_of(). Unused lanes contain an earlier contact, with weight zero.
  [[gnu::noinline]] void evaluate() {
    for (int k = count_; k < kDoubleLanes; ++k) share_[k] = 0.0;
    const ContactSampleOf<Double4> s = Law::template sample<kRolling>(c_, dt_, motion_, history_);
    for_both(sum_, s, [this](double& to, const Double4& by) { to += simd::sum(share_ * by); });
    count_ = 0;
  }

  /// A valid motion for lanes that were never used.
  static ContactMotion<Double4> some_motion() {
    const Double4 none{}, one = spread(1.0);
    return {{none, none, one}, one, one, {none, none, none}, none, {none, none, none}};
  }

  Coefficients c_;
  double dt_;  // s
  ContactSample& sum_;
  int count_ = 0;
  ContactMotion<Double4> motion_ = some_motion();
  ContactHistory<Double4> history_{};
  Double4 share_{};
};

}  // namespace furrow::terrain::dem
