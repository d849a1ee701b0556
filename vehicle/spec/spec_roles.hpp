// What a key of a vehicle's or a driver's file is besides a value of its struct (protocol/core/fields.hpp).
#pragma once

namespace furrow::vehicle {

/// A key that may be left out; its member keeps the value that it has.
inline constexpr unsigned kMayMiss = 1U << 16U;
/// A key that take_fields() leaves to its caller.
inline constexpr unsigned kReadApart = 1U << 17U;

}  // namespace furrow::vehicle
