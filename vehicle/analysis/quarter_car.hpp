// The linear quarter car: body and wheel over each other on a spring and damper each, the road under the wheel.
//
// Heights y of body (b) and wheel (w) count from rest on a level road of height 0, which is r:
//   m_b ÿ_b = k (y_w − y_b) + c (ẏ_w − ẏ_b)
//   m_w ÿ_w = −k (y_w − y_b) − c (ẏ_w − ẏ_b) + k_t (r − y_w) + c_t (ṙ − ẏ_w)                                 (1)
// It knows of the road only how high it is under the wheel's centre, and its tire pulls as well as it pushes.
// For r = Re(R e^{iωt}), with Z = k + iωc and Z_t = k_t + iωc_t,
//   y_w/R = Z_t (Z − ω² m_b)/D,   y_b/R = Z_t Z/D,   D = (Z + Z_t − ω² m_w)(Z − ω² m_b) − Z²                  (2)
//
// M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, Springer 2014, ch. 13, doi:10.1007/978-3-658-05068-9.
#pragma once

#include <complex>

namespace furrow::vehicle {

struct QuarterCarParams {
  double body_mass = 0.0, wheel_mass = 0.0;         // kg
  double stiffness = 0.0, damping = 0.0;            // of the suspension, N/m, N s/m
  double tire_stiffness = 0.0, tire_damping = 0.0;  // N/m, N s/m
};

/// Of a road of amplitude 1, as complex factors.
struct QuarterCarResponse {
  std::complex<double> body, wheel;
  std::complex<double> tire_force;  // of the tire on the wheel beyond its force at rest, N/m
};
/// (2). @param omega rad/s. @pre masses and stiffnesses are positive
QuarterCarResponse quarter_car_response(const QuarterCarParams& car, double omega);

/// A suspension that suits a body: this natural frequency on a held wheel, and this share of critical damping.
inline constexpr double kUsualBodyFrequency = 1.5, kUsualBodyDamping = 0.3;  // Hz; –
double usual_stiffness(double body_mass);                                    // N/m
double usual_damping(double body_mass, double stiffness);                    // N s/m

}  // namespace furrow::vehicle
