#include "terrain/soil/bekker_wong.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr int kIntervals = 2000;   // of the contact arc on each side of θ_m; midpoint rule
constexpr double kMaxEntry = 1.5;  // rad: nearly half the wheel

double modulus(const SoilStrength& s, double width) {
  FURROW_ASSERT(width > 0.0 && s.k_c / width + s.k_phi > 0.0, width, s.k_c, s.k_phi);
  return s.k_c / width + s.k_phi;
}

struct Integrals {
  double lift = 0.0, thrust = 0.0, resistance = 0.0, torque = 0.0, pressure = 0.0;
};

Integrals integrate(const SoilStrength& s, const RigidWheel& w, double slip, double entry) {
  const double k = modulus(s, w.width), R = w.radius, tan_phi = std::tan(s.phi);
  const double middle = std::clamp(w.c1 + w.c2 * slip, 0.0, 1.0) * entry;
  Integrals sum;
  const auto part = [&](double from, double to) {
    const double step = (to - from) / kIntervals;
    for (int q = 0; q < kIntervals && step > 0.0; ++q) {
      const double theta = from + (q + 0.5) * step;
      const double front = theta >= middle ? theta : entry - theta * (entry - middle) / middle;
      const double depth = std::max(R * (std::cos(front) - std::cos(entry)), 0.0);
      const double sigma = k * std::pow(depth, s.n);
      const double j = R * (entry - theta - (1.0 - slip) * (std::sin(entry) - std::sin(theta)));
      const double mobilized = -std::expm1(-std::abs(j) / s.K);
      const double tau = std::copysign((s.cohesion + sigma * tan_phi) * mobilized, j);
      const double area = w.width * R * step;
      sum.lift += area * (sigma * std::cos(theta) + tau * std::sin(theta));
      sum.thrust += area * tau * std::cos(theta);
      sum.resistance += area * sigma * std::sin(theta);
      sum.torque += area * R * tau;
      sum.pressure = std::max(sum.pressure, sigma);
    }
  };
  part(0.0, middle);
  part(middle, entry);
  return sum;
}

}  // namespace

WheelEstimate rigid_wheel(const SoilStrength& soil, const RigidWheel& wheel, double slip) {
  FURROW_ASSERT(soil.n > 0.0 && soil.K > 0.0, soil.n, soil.K);
  FURROW_ASSERT(wheel.radius > 0.0 && wheel.load > 0.0, wheel.radius, wheel.load);
  FURROW_ASSERT(std::isfinite(slip) && std::isfinite(soil.cohesion) && std::isfinite(soil.phi), slip, soil.cohesion,
                soil.phi);
  WheelEstimate e;
  double low = 0.0, high = kMaxEntry;
  if (!(integrate(soil, wheel, slip, high).lift >= wheel.load)) return e;  // also if its numbers overflow
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (integrate(soil, wheel, slip, middle).lift < wheel.load ? low : high) = middle;
  }
  e.entry_angle = 0.5 * (low + high);
  const Integrals sum = integrate(soil, wheel, slip, e.entry_angle);
  e.sinkage = wheel.radius * (1.0 - std::cos(e.entry_angle));
  e.thrust = sum.thrust;
  e.resistance = sum.resistance;
  e.pull = sum.thrust - sum.resistance;
  e.torque = sum.torque;
  e.pressure = sum.pressure;
  e.found = std::isfinite(e.pull) && std::isfinite(e.torque) && std::isfinite(e.pressure);
  return e;
}

}  // namespace furrow::terrain::soil
