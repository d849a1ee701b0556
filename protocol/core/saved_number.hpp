// Checks numbers of a saved state, beyond its checksum.
#pragma once

#include <cmath>
#include <string>

#include "protocol/core/archive.hpp"
#include "protocol/core/error.hpp"

namespace furrow {

/// @throws Error(io) when it is missing or not finite
inline double saved_finite(const Archive& archive, const std::string& name) {
  const double value = archive.get_double(name);
  if (!std::isfinite(value))
    throw Error(ExitCode::io, "saved state '" + name + "' is not finite, expected a number: it is damaged");
  return value;
}

}  // namespace furrow
