// The table of contact laws, and the only place that turns the law of the options into code.
#pragma once

#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>

#include "terrain/dem/contact/hertz_tanh_law.hpp"
#include "terrain/dem/contact/mindlin_law.hpp"

namespace furrow::terrain::dem {

/// One line per law (contact.hpp); the first is the default of terrain.law.
using Laws = std::tuple<  //
    MindlinLaw,           //
    HertzTanhLaw>;

/// Index of a law in the table.
enum class LawKind : int {};

namespace detail {
template <std::size_t kPlace, class F>
decltype(auto) with_law_from(LawKind kind, const F& f) {
  if constexpr (kPlace + 1 < std::tuple_size_v<Laws>)
    if (kind != LawKind{kPlace}) return with_law_from<kPlace + 1>(kind, f);
  return f(std::tuple_element_t<kPlace, Laws>{});
}
}  // namespace detail

/// Calls f(law) with the law itself.
template <class F>
decltype(auto) with_law(LawKind kind, const F& f) {
  return detail::with_law_from<0>(kind, f);
}

/// Calls f(law, rolling, sizes) with the law itself and two std::bool_constant. @pre the law has kSizes if `sizes`
template <class F>
decltype(auto) with_law(LawKind kind, bool rolling, bool sizes, const F& f) {
  return with_law(kind, [&](auto law) -> decltype(auto) {
    constexpr std::true_type yes;
    constexpr std::false_type no;
    if constexpr (law.kSizes)
      if (sizes) return rolling ? f(law, yes, yes) : f(law, no, yes);
    return rolling ? f(law, yes, no) : f(law, no, no);
  });
}

/// Calls see(law) for each law of the table, in order.
template <class See>
void for_each_law(const See& see) {
  std::apply([&](auto... law) { (see(law), ...); }, Laws{});
}

inline const char* law_name(LawKind kind) {
  return with_law(kind, [](auto law) { return law.kName; });
}
/// Whether the law stores contact histories, and so has static friction.
inline bool has_history(LawKind kind) {
  return with_law(kind, [](auto law) { return law.kHistory; });
}
/// Whether the law allows grains of several sizes.
inline bool has_sizes(LawKind kind) {
  return with_law(kind, [](auto law) { return law.kSizes; });
}

/// The names of all laws, for messages: "mindlin or hertz_tanh".
std::string law_names();
/// @throws Error(bad_input) listing the valid names
LawKind law_from(const std::string& name);

/// The mixed coefficients of one kind of partner (grain, wall, tire), for whichever law made them. They are plain
/// numbers; the law reads them under its own names.
class ContactCoefficients {
 public:
  ContactCoefficients() = default;
  template <class OfLaw>
  explicit ContactCoefficients(const OfLaw& c) {
    static_assert(std::is_trivially_copyable_v<OfLaw> && sizeof c <= sizeof numbers_);
    std::memcpy(numbers_, &c, sizeof c);
  }
  /// The coefficients as numbers S. @pre `Law` made them
  template <class Law, class S = double>
  typename Law::template Coefficients<S> of() const {
    typename Law::template Coefficients<S> c;
    S numbers[sizeof c / sizeof(S)];
    for (std::size_t k = 0; k < sizeof c / sizeof(S); ++k) numbers[k] = static_cast<S>(numbers_[k]);
    std::memcpy(static_cast<void*>(&c), numbers, sizeof c);
    return c;
  }

 private:
  double numbers_[12] = {};
};

/// Coefficients for two grains with radii r_i, r_j. @param radius of the coefficients, m
template <class Law>
inline auto sized_pair(const typename Law::template Coefficients<double>& c, double radius, double r_i, double r_j) {
  if constexpr (Law::kSizes)
    if (r_i != radius || r_j != radius) return Law::scaled(c, pair_scale(r_i / radius, r_j / radius));
  return c;
}
/// Coefficients for a grain of radius r on a surface. @param share as for surface_scale
template <class Law>
inline auto sized_surface(const typename Law::template Coefficients<double>& c, double radius, double r, double share) {
  if constexpr (Law::kSizes)
    if (r != radius) return Law::scaled(c, surface_scale(r / radius, share));
  return c;
}

}  // namespace furrow::terrain::dem
