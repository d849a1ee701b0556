// Flexible rings for tests, about the size of a light truck's tire.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "tire/ring/ring_solver.hpp"

namespace furrow::tire {

inline RingParams truck_ring(int segments = 480) {
  RingParams p;
  p.segments = segments;
  p.radius = 0.39, p.width = 0.2, p.air_share = 0.35, p.pressure = 300e3;
  p.bending = 800.0, p.shear = 4e4, p.tangential = 2e5;
  p.sidewall_1 = 4e5, p.sidewall_2 = 6e6, p.sidewall_3 = 6e7;
  return p;
}

/// A ring whose belt carries a share of the pressure by hoop tension.
inline RingParams with_tension(RingParams p, double share = 0.5) {
  p.tension_share = share;
  return p;
}

/// A ring whose forces are linear in displacements: no pressure, a linear sidewall and linearised air.
inline RingParams linear_ring(int segments = 480) {
  RingParams p = truck_ring(segments);
  p.pressure = p.sidewall_2 = p.sidewall_3 = 0.0;
  p.gas = RingGas::linearised;
  return p;
}

inline RingField random_field(const RingMechanics& ring, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-size, size);
  RingField q = ring.zero();
  for (int j = 0; j < ring.segments(); ++j) q.u[j] = any(random), q.v[j] = any(random);
  return q;
}

/// The field u cos(wave θ) in the radial and v sin(wave θ) in the tangential direction.
inline RingField wave(const RingMechanics& ring, int wave, double u, double v) {
  RingField q = ring.zero();
  for (int j = 0; j < ring.segments(); ++j)
    q.u[j] = u * std::cos(wave * j * ring.angle()), q.v[j] = v * std::sin(wave * j * ring.angle());
  return q;
}

inline double dot(const RingField& a, const RingField& b) {
  double sum = 0.0;
  for (std::size_t j = 0; j < a.u.size(); ++j) sum += a.u[j] * b.u[j] + a.v[j] * b.v[j];
  return sum;
}

inline RingField along(const RingField& a, const RingField& b, double share) {  // a + share × b
  RingField out = a;
  for (std::size_t j = 0; j < a.u.size(); ++j) out.u[j] += share * b.u[j], out.v[j] += share * b.v[j];
  return out;
}

inline double largest(const RingField& a) {
  double most = 0.0;
  for (std::size_t j = 0; j < a.u.size(); ++j) most = std::max({most, std::abs(a.u[j]), std::abs(a.v[j])});
  return most;
}

/// Mean of f over 0…1 with five points of Gauss and Legendre: exact for polynomials of degree nine.
template <class Function>
auto gauss_mean(Function f) {
  constexpr double kPoint[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  double sum = 0.5 * kWeight[0] * f(0.5);
  for (int i = 1; i < 3; ++i) sum += 0.5 * kWeight[i] * (f(0.5 + 0.5 * kPoint[i]) + f(0.5 - 0.5 * kPoint[i]));
  return sum;
}

}  // namespace furrow::tire
