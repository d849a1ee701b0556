// One list of fields per struct serves all code that sends, saves, reads, checks, prints or hashes the struct. The list
// is next to the struct, in its namespace:
//
//   struct GroundOptions {
//     double stiffness = 4e8;  // N/m³
//   };
//   void visit_fields(FieldsOf<GroundOptions> auto& s, auto&& visit) {
//     visit(s.stiffness, Field{"stiffness", "N/m³"});
//   }
//
// A visitor is called with each member, const if the struct is, and with its name, unit and roles. Members that are
// structs with a list of their own are visited as one field; the visitor decides whether to visit their fields (concept
// HasFields).
#pragma once

#include <concepts>
#include <type_traits>

namespace furrow {

/// Uses of a field; one field may have any number of them.
namespace role {
inline constexpr unsigned none = 0;
inline constexpr unsigned key = 1U << 0U;   // a key of the scenario, by this name in its struct's section
inline constexpr unsigned bed = 1U << 1U;   // changes a settled bed: part of the bed's digest unless it is the default
inline constexpr unsigned soil = 1U << 2U;  // a property of soil: soil files may contain it
inline constexpr unsigned harmless = 1U << 3U;  // changes no result: not part of the scenario's digest, free on resume
inline constexpr unsigned column = 1U << 4U;    // a column of the time series
}  // namespace role

struct Field {
  const char* name;        // snake_case, as in files and messages
  const char* unit = "-";  // SI; "-" for a number without dimension, "" for text and switches
  unsigned roles = role::none;
  constexpr bool is(unsigned wanted) const { return (roles & wanted) == wanted; }
};

/// S is T or const T: the type that the list of fields of T takes.
template <class S, class T>
concept FieldsOf = std::same_as<std::remove_const_t<S>, T>;

namespace detail {
struct IgnoreField {
  template <class T>
  void operator()(T&, const Field&) const {}
};
}  // namespace detail

template <class T>
concept HasFields = requires(T& t) {
  visit_fields(t, detail::IgnoreField{});
};

}  // namespace furrow
