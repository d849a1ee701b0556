#include "vehicle/analysis/half_car.hpp"

#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {
namespace {

/// Of the travel w − y of an axle, by q.
Eigen::Vector4d travel_row(const HalfCarAxle& axle, bool front) {
  return front ? Eigen::Vector4d(-1.0, axle.distance, 1.0, 0.0) : Eigen::Vector4d(-1.0, -axle.distance, 0.0, 1.0);
}

}  // namespace

HalfCarMatrices half_car_matrices(const HalfCarParams& car) {
  FURROW_ASSERT(car.body_mass > 0.0 && car.pitch_inertia > 0.0, car.body_mass, car.pitch_inertia);
  HalfCarMatrices m;
  m.mass = Eigen::Vector4d(car.body_mass, car.pitch_inertia, car.front.wheel_mass, car.rear.wheel_mass).asDiagonal();
  m.stiffness = Eigen::Vector4d(0.0, 0.0, car.front.tire_stiffness, car.rear.tire_stiffness).asDiagonal();
  m.damping = Eigen::Vector4d(0.0, 0.0, car.front.tire_damping, car.rear.tire_damping).asDiagonal();
  for (const bool front : {true, false}) {
    const HalfCarAxle& axle = front ? car.front : car.rear;
    FURROW_ASSERT(axle.distance > 0.0 && axle.wheel_mass > 0.0 && axle.tire_stiffness > 0.0, axle.distance,
                  axle.wheel_mass, axle.tire_stiffness);
    const Eigen::Vector4d row = travel_row(axle, front);
    m.stiffness += axle.stiffness * row * row.transpose();
    m.damping += axle.damping * row * row.transpose();
  }
  return m;
}

HalfCarResponse half_car_response(const HalfCarParams& car, double omega, double delay) {
  using Complex = std::complex<double>;
  const HalfCarMatrices m = half_car_matrices(car);
  const Eigen::Matrix4cd dynamic =
      (m.stiffness - omega * omega * m.mass).cast<Complex>() + Complex(0.0, omega) * m.damping.cast<Complex>();
  Eigen::Vector4cd road = Eigen::Vector4cd::Zero();
  road[2] = Complex(car.front.tire_stiffness, omega * car.front.tire_damping);
  road[3] = Complex(car.rear.tire_stiffness, omega * car.rear.tire_damping) * std::polar(1.0, -omega * delay);
  const Eigen::Vector4cd q = dynamic.partialPivLu().solve(road);
  return {q[0], q[1], q[0] - car.front.distance * q[1], q[0] + car.rear.distance * q[1], q[2], q[3]};
}

HalfCarModes half_car_modes(const HalfCarParams& car) {
  const HalfCarMatrices m = half_car_matrices(car);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> solver(m.stiffness, m.mass);
  FURROW_ASSERT(solver.info() == Eigen::Success);
  return {solver.eigenvalues().cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi), solver.eigenvectors()};
}

}  // namespace furrow::vehicle
