#include "tire/ring/ring_modes.hpp"

#include <complex>

namespace furrow::tire {
namespace {

using Complex = std::complex<double>;

}  // namespace

RingModes::RingModes(const RingParams& params, const RingMotion& motion, const MassProperties& mass)
    : ring_(params),
      rim_radius_(motion.rim_radius),
      segment_mass_(belt_mass(motion, params.radius) / params.segments),
      total_(mass) {}

/// Waves e^{i n θ} with θ from the top forwards, opposite to the numbering of the segments.
Eigen::MatrixXcd RingModes::stiffness(int order) const {
  RingTangent t = ring_.no_tangent();
  ring_.tangent(ring_.zero(), t);
  Eigen::MatrixXcd k = Eigen::MatrixXcd::Zero(2, 2);
  for (int d = 0; d < 3; ++d) {
    const Complex phase = std::polar(1.0, -order * d * ring_.angle());
    Eigen::Matrix2cd block;
    block << t.uu[d][0] * phase, t.uv[d][0] * phase, t.vu[d][0] * phase, t.vv[d][0] * phase;
    k += block;
    if (d > 0) k += block.adjoint();
  }
  if (order % ring_.segments() == 0) k(0, 0) += t.gas * ring_.segments();
  return k;
}

ModesResults RingModes::modes(const ModesOptions& options, const ProgressCall& progress) const {
  ModesResults results;
  results.mass = total_;
  results.pressure = ring_.params().pressure;
  results.around = ring_.segments();
  results.section = {{0.0, rim_radius_}, {0.0, ring_.radius()}};
  results.lines = {{0, 1}};
  const Eigen::MatrixXcd mass = segment_mass_ * Eigen::MatrixXcd::Identity(2, 2);
  for (int order = 0; order <= options.orders; ++order) {
    if (progress) progress("solving", static_cast<double>(order) / (options.orders + 1));
    const LowestModes lowest = lowest_modes(stiffness(order), mass, options.count);
    for (int k = 0; k < options.count; ++k)
      results.modes.push_back(mode_of(lowest, order, k, 2, [](const auto& vector, int node) {
        std::array<Complex, 3> shape{};  // of the rim: none
        if (node == 1) shape[0] = -vector[1], shape[2] = vector[0];
        return shape;
      }));
  }
  return results;
}

}  // namespace furrow::tire
