// One list of fields per struct serves all that sends, saves, reads, checks, prints or hashes it. The list stands
// beside the struct, in its namespace:
//
//   struct GroundOptions {
//     double stiffness = 4e8;  // N/m³
//   };
//   void visit_fields(FieldsOf<GroundOptions> auto& s, auto&& visit) {
//     visit(s.stiffness, Field{"stiffness", "N/m³"});
//   }
//
// A visitor is called with each member, const when the struct is, and with its name, unit and roles. Members
// that are structs with a list of their own are visited as one field; the visitor decides to go into them (concept
// HasFields).
#pragma once

#include <concepts>
#include <type_traits>

namespace furrow {

/// What a field is besides a value of its struct; any number of them together.
namespace role {
inline constexpr unsigned none = 0;
inline constexpr unsigned key = 1U << 0U;  // a key of the scenario, by this name in its struct's section
inline constexpr unsigned bed =
    1U << 1U;  // changes a settled bed: part of the bed's digest where it is not the default
inline constexpr unsigned soil = 1U << 2U;      // a property of soil: soil files may say it
inline constexpr unsigned harmless = 1U << 3U;  // changes no result: not part of the scenario's digest, free on resume
inline constexpr unsigned column = 1U << 4U;    // a column of the time series
}  // namespace role

struct Field {
  const char* name;        // snake_case, as users and files know it
  const char* unit = "-";  // SI; "-" for none, "" for what has no unit at all (text, switches)
  unsigned roles = role::none;
  constexpr bool is(unsigned wanted) const { return (roles & wanted) == wanted; }
};

/// S is T or const T: the type of the struct in its list of fields.
template <class S, class T>
concept FieldsOf = std::same_as<std::remove_const_t<S>, T>;

namespace detail {
struct IgnoreField {
  template <class T>
  void operator()(T&, const Field&) const {}
};
}  // namespace detail

/// Whether T has a list of fields.
template <class T>
concept HasFields = requires(T& t) {
  visit_fields(t, detail::IgnoreField{});
};

}  // namespace furrow
