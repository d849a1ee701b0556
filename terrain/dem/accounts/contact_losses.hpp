// Energy that contacts lose, by mechanism, and energy that their springs store. A law computes these from its own
// inputs (Law::sample), so it may be sampled in addition to its evaluation, or not at all.
//
// Cohesion is a potential: the constant pull of a contact stores −F_c δ, and opening the contact loses nothing.
#pragma once

#include "protocol/core/fields.hpp"

namespace furrow::terrain::dem {

/// Energy lost, J, or its rate, W, by mechanism.
template <class T>
struct LossesOf {
  T sliding{}, normal_damping{}, tangential_damping{}, rolling{}, opening{};
};
using Losses = LossesOf<double>;
void visit_fields(FieldsOf<Losses> auto& s, auto&& visit) {
  visit(s.sliding, Field{"sliding", ""});
  visit(s.normal_damping, Field{"normal_damping", ""});
  visit(s.tangential_damping, Field{"tangential_damping", ""});
  visit(s.rolling, Field{"rolling", ""});
  visit(s.opening, Field{"opening", ""});
}
inline double total(const Losses& l) {
  return l.sliding + l.normal_damping + l.tangential_damping + l.rolling + l.opening;
}
/// Calls f(a's entry, b's entry) for each mechanism.
template <class A, class B, class F>
inline void for_both(LossesOf<A>& a, const LossesOf<B>& b, const F& f) {
  f(a.sliding, b.sliding), f(a.normal_damping, b.normal_damping), f(a.tangential_damping, b.tangential_damping);
  f(a.rolling, b.rolling), f(a.opening, b.opening);
}
inline void add(Losses& to, const Losses& l, double times) {
  for_both(to, l, [times](double& sum, double by) { sum += times * by; });
}

/// Energy stored in contacts besides their normal springs, J.
template <class T>
struct StoredOf {
  T cohesion{};    // Σ −F_c δ
  T tangential{};  // tangential and rolling springs
};
using Stored = StoredOf<double>;
void visit_fields(FieldsOf<Stored> auto& s, auto&& visit) {
  visit(s.cohesion, Field{"cohesion", "J"});
  visit(s.tangential, Field{"tangential", "J"});
}
inline void add(Stored& to, const Stored& s, double times) {
  to.cohesion += times * s.cohesion;
  to.tangential += times * s.tangential;
}

/// Sample of one contact, or of several, in one evaluation.
template <class T>
struct ContactSampleOf {
  LossesOf<T> power;   // W
  StoredOf<T> stored;  // after the evaluation
};
using ContactSample = ContactSampleOf<double>;
template <class A, class B, class F>
inline void for_both(ContactSampleOf<A>& a, const ContactSampleOf<B>& b, const F& f) {
  for_both(a.power, b.power, f);
  f(a.stored.cohesion, b.stored.cohesion), f(a.stored.tangential, b.stored.tangential);
}
inline void add(ContactSample& to, const ContactSample& s, double times = 1.0) {
  add(to.power, s.power, times);
  add(to.stored, s.stored, times);
}

}  // namespace furrow::terrain::dem
