// Sums and differences of structs of numbers and vectors, field by field.
#pragma once

#include <vector>

#include "protocol/core/fields.hpp"

namespace furrow {

/// The struct whose members are call(member of a, member of b); structs within it are combined in the same way.
template <HasFields T, class Call>
T combined(T a, const T& b, const Call& call) {
  std::vector<const void*> others;
  visit_fields(b, [&](const auto& value, const auto&) { others.push_back(&value); });
  auto next = others.begin();
  visit_fields(a, [&](auto& value, const auto&) {
    using Value = std::remove_reference_t<decltype(value)>;
    const auto& other = *static_cast<const Value*>(*next++);
    if constexpr (HasFields<Value>)
      value = combined(value, other, call);
    else
      value = call(value, other);
  });
  return a;
}

template <HasFields T>
T sum_of(const T& a, const T& b) {
  return combined(a, b, [](const auto& x, const auto& y) { return x + y; });
}

/// a − b
template <HasFields T>
T difference_of(const T& a, const T& b) {
  return combined(a, b, [](const auto& x, const auto& y) { return x - y; });
}

}  // namespace furrow
