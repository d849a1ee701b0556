// The linear half car: one body that rises and pitches on two wheels behind each other, each on a spring and damper,
// the road under each wheel.
//
// Heights y of the body's centre and w of the wheels, pitch θ with the nose down, front axle a ahead of the centre,
// rear axle b behind it; all count from rest on a level road. Above the wheels the body stands at y_f = y − aθ, y_r =
// y + bθ.
//   m ÿ = F_f + F_r,   J θ̈ = −a F_f + b F_r,   F_i = k_i (w_i − y_i) + c_i (ẇ_i − ẏ_i)
//   m_i ẅ_i = −F_i + k_ti (r_i − w_i) + c_ti (ṙ_i − ẇ_i)                                                       (1)
// as M q̈ + C q̇ + K q = (0, 0, Z_tf r_f, Z_tr r_r), q = (y, θ, w_f, w_r). Both wheels follow one road at the speed
// v, so that r_r(t) = r_f(t − (a + b)/v): R_r = R_f e^{−iω(a + b)/v}.
// Where J = m a b, nothing couples y_f with y_r: the half car is two quarter cars, of the bodies m b/(a + b) and
// m a/(a + b).
//
// M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, Springer 2014, ch. 14, doi:10.1007/978-3-658-05068-9.
#pragma once

#include <complex>

#include <Eigen/Core>

namespace furrow::vehicle {

/// Wheel of a half car with what carries the body on it.
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

/// Of (1): kg and kg m²; N s/m and N m s; N/m and N m.
struct HalfCarMatrices {
  Eigen::Matrix4d mass, damping, stiffness;
};
/// @pre masses, inertia, distances and tire stiffnesses are positive
HalfCarMatrices half_car_matrices(const HalfCarParams& car);

/// Of a road of amplitude 1 under the front wheel, as complex factors.
struct HalfCarResponse {
  std::complex<double> body;                   // at the centre
  std::complex<double> pitch;                  // rad/m
  std::complex<double> body_front, body_rear;  // above the axles
  std::complex<double> wheel_front, wheel_rear;
};
/// @param omega rad/s. @param delay (a + b)/v, by which the rear wheel follows, s
HalfCarResponse half_car_response(const HalfCarParams& car, double omega, double delay);

/// Without dampers.
struct HalfCarModes {
  Eigen::Vector4d frequencies;  // Hz, from the lowest
  Eigen::Matrix4d shapes;       // columns (y, θ, w_f, w_r), of modal mass 1
};
HalfCarModes half_car_modes(const HalfCarParams& car);

}  // namespace furrow::vehicle
