// Physical constants that all rooms share.
#pragma once

namespace furrow {

inline constexpr double kStandardGravity =
    9.81;  // m/s², magnitude; acts along −z unless a model is given another vector

}  // namespace furrow
