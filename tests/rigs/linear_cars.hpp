// Linear cars for ride in closed form, for comparison with quarter car and half car.
//
// Quarter car: body (b) above wheel (w), each on a spring and damper, with the road r under the wheel. Heights are
// relative to rest on a level road:
//   m_b ÿ_b = k (y_w − y_b) + c (ẏ_w − ẏ_b)
//   m_w ÿ_w = −k (y_w − y_b) − c (ẏ_w − ẏ_b) + k_t (r − y_w) + c_t (ṙ − ẏ_w)                                 (1)
// For r = Re(R e^{iωt}), with Z = k + iωc and Z_t = k_t + iωc_t,
//   y_w/R = Z_t (Z − ω² m_b)/D,   y_b/R = Z_t Z/D,   D = (Z + Z_t − ω² m_w)(Z − ω² m_b) − Z²                  (2)
//
// Half car: one body that rises and pitches on two such wheels. Heights y of its centre and w of the wheels, pitch θ
// with the nose down, front axle a ahead of the centre, rear axle b behind it; y_f = y − aθ, y_r = y + bθ:
//   m ÿ = F_f + F_r,   J θ̈ = −a F_f + b F_r,   F_i = k_i (w_i − y_i) + c_i (ẇ_i − ẏ_i)
//   m_i ẅ_i = −F_i + k_ti (r_i − w_i) + c_ti (ṙ_i − ẇ_i)                                                       (3)
// as M q̈ + C q̇ + K q = (0, 0, Z_tf r_f, Z_tr r_r), q = (y, θ, w_f, w_r). Both wheels follow one road at the speed v,
// so that r_r(t) = r_f(t − (a + b)/v): R_r = R_f e^{−iω(a + b)/v}. If J = m a b, y_f and y_r are not coupled: the half
// car is two quarter cars, with the bodies m b/(a + b) and m a/(a + b).
//
// M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, Springer 2014, ch. 13 and 14,
// doi:10.1007/978-3-658-05068-9.
#pragma once

#include <complex>

#include <Eigen/Core>
#include <Eigen/LU>

namespace furrow::testing {

struct QuarterCarParams {
  double body_mass = 0.0, wheel_mass = 0.0;         // kg
  double stiffness = 0.0, damping = 0.0;            // of the suspension, N/m, N s/m
  double tire_stiffness = 0.0, tire_damping = 0.0;  // N/m, N s/m
};

/// Response to a road of amplitude 1, as complex factors.
struct QuarterCarResponse {
  std::complex<double> body, wheel;
};

/// (2). @param omega rad/s
inline QuarterCarResponse quarter_car_response(const QuarterCarParams& car, double omega) {
  const std::complex<double> z(car.stiffness, omega * car.damping), tire(car.tire_stiffness, omega * car.tire_damping);
  const std::complex<double> body = z - omega * omega * car.body_mass;
  const std::complex<double> d = (z + tire - omega * omega * car.wheel_mass) * body - z * z;
  return {tire * z / d, tire * body / d};
}

/// Wheel of a half car with its suspension.
struct HalfCarAxle {
  double distance = 0.0;                            // from the body's centre, a or b, m
  double wheel_mass = 0.0;                          // kg
  double stiffness = 0.0, damping = 0.0;            // of the suspension, N/m, N s/m
  double tire_stiffness = 0.0, tire_damping = 0.0;  // N/m, N s/m
};

struct HalfCarParams {
  double body_mass = 0.0;      // kg
  double pitch_inertia = 0.0;  // J, about the centre, kg m²
  HalfCarAxle front, rear;
};

/// Matrices of (3): kg and kg m²; N s/m and N m s; N/m and N m.
struct HalfCarMatrices {
  Eigen::Matrix4d mass, damping, stiffness;
};

inline HalfCarMatrices half_car_matrices(const HalfCarParams& car) {
  HalfCarMatrices m;
  m.mass = Eigen::Vector4d(car.body_mass, car.pitch_inertia, car.front.wheel_mass, car.rear.wheel_mass).asDiagonal();
  m.stiffness = Eigen::Vector4d(0.0, 0.0, car.front.tire_stiffness, car.rear.tire_stiffness).asDiagonal();
  m.damping = Eigen::Vector4d(0.0, 0.0, car.front.tire_damping, car.rear.tire_damping).asDiagonal();
  const auto add = [&](const HalfCarAxle& axle, const Eigen::Vector4d& travel) {  // w − y of the axle by q
    m.stiffness += axle.stiffness * travel * travel.transpose();
    m.damping += axle.damping * travel * travel.transpose();
  };
  add(car.front, Eigen::Vector4d(-1.0, car.front.distance, 1.0, 0.0));
  add(car.rear, Eigen::Vector4d(-1.0, -car.rear.distance, 0.0, 1.0));
  return m;
}

/// Response to a road of amplitude 1 under the front wheel, as complex factors.
struct HalfCarResponse {
  std::complex<double> body;                   // at the centre
  std::complex<double> pitch;                  // rad/m
  std::complex<double> body_front, body_rear;  // above the axles
  std::complex<double> wheel_front, wheel_rear;
};

/// @param omega rad/s. @param delay (a + b)/v, by which the rear wheel follows, s
inline HalfCarResponse half_car_response(const HalfCarParams& car, double omega, double delay) {
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

}  // namespace furrow::testing
