// Natural frequencies of a planar tire whose inner nodes are held, order by order (tire/modes.hpp). As the rings of
// nodes are turned against each other, a node has the phase of its own angle, and K_n is the sum over all elements
// divided by their number around. Viscosity is left out.
#pragma once

#include "tire/modes.hpp"
#include "tire/planar/planar_carcass.hpp"

namespace furrow::tire {

class PlanarModes final : public ModalTest {
 public:
  explicit PlanarModes(const PlanarParams& params);
  int sections() const override { return around_; }
  int unknowns() const override { return 2 * rings_; }
  ModesResults modes(const ModesOptions& options, const ProgressCall& progress) const override;

  /// N/m. Unknowns: displacements forward at the top and radial, of each ring except the inner one, from the inside
  /// outwards.
  Eigen::MatrixXcd stiffness(int order) const;
  Eigen::MatrixXcd mass() const;  // kg

 private:
  PlanarCarcass carcass_;
  int around_, rings_;
  MassProperties total_;
};

}  // namespace furrow::tire
