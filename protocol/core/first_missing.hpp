// Finds a member that was not set, in a struct whose members start as "not a number".
#pragma once

#include <cmath>

#include "protocol/core/fields.hpp"

namespace furrow {

/// Name of the first member that is not a finite number; null if all are finite.
template <HasFields S>
const char* first_missing(const S& values) {
  const char* name = nullptr;
  visit_fields(values, [&](const auto& value, const Field& field) {
    double sum = 0.0;
    if constexpr (requires { value.sum(); })
      sum = value.sum();
    else
      sum = value;
    if (!name && !std::isfinite(sum)) name = field.name;
  });
  return name;
}

}  // namespace furrow
