// Checks of structs with a list of fields: that no member was forgotten, and values in which all numbers differ.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "protocol/core/archive_fields.hpp"

namespace furrow::testing {

/// Converts to a member of any type.
struct Anything {
  template <class T>
  operator T() const;
};

template <class T, std::size_t... N>
consteval bool takes(std::index_sequence<N...>) {
  return requires { T{(static_cast<void>(N), Anything())...}; };
}

/// Number of direct members of an aggregate.
template <class T, std::size_t kCount = 0>
consteval std::size_t member_count() {
  static_assert(std::is_aggregate_v<T>);
  if constexpr (takes<T>(std::make_index_sequence<kCount + 1>()))
    return member_count<T, kCount + 1>();
  else
    return kCount;
}

/// Names of the fields in the list of T.
template <class T>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  const T none{};
  visit_fields(none, [&](const auto&, const Field& field) { names.emplace_back(field.name); });
  return names;
}

/// Gives every number in a value a different number, counting on from `next`; vectors get two elements.
template <class T>
void fill(T& value, int& next) {
  if constexpr (HasFields<T>) {
    visit_fields(value, [&](auto& member, const Field&) { fill(member, next); });
  } else if constexpr (std::is_same_v<T, bool>) {
    value = true;
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    value = static_cast<T>(++next);
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = "text " + std::to_string(++next);
  } else if constexpr (std::is_same_v<T, Quat>) {
    for (double& x : value.coeffs()) fill(x, next);
  } else if constexpr (requires { T::SizeAtCompileTime; }) {
    for (double& x : value.reshaped()) fill(x, next);
  } else if constexpr (requires { value.resize(2); }) {
    value.resize(2);
    for (auto& one : value) fill(one, next);
  } else {
    for (auto& one : value) fill(one, next);
  }
}
template <class T>
T filled() {
  T value{};
  int next = 0;
  fill(value, next);
  return value;
}

/// Names and values of all numbers in a value.
template <class T>
Archive numbers_of(const T& value) {
  Archive archive;
  save_fields(archive, "", value);
  return archive;
}

}  // namespace furrow::testing
