// The vector types that all folders share. World frame W: x forward, y left, z up. SI units throughout.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace furrow {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;  // orientation R_WB: rotates B components into W

}  // namespace furrow
