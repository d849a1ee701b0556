// Natural frequencies of a flexible ring at rest, inflated, on a rim that does not move, order by order
// (tire/modes.hpp). Displacements are in each segment's own axes, so stiffness and mass of an order are the tangent's
// blocks with the phases of the neighbours. The air contributes to order 0 alone. Damping is left out.
#pragma once

#include "tire/modes.hpp"
#include "tire/ring/ring_mechanics.hpp"

namespace furrow::tire {

class RingModes final : public ModalTest {
 public:
  /// @pre as for RingMechanics and belt_mass()
  RingModes(const RingParams& params, const RingMotion& motion, const MassProperties& mass);
  int sections() const override { return ring_.segments(); }
  int unknowns() const override { return 2; }
  ModesResults modes(const ModesOptions& options, const ProgressCall& progress) const override;

  /// Unknowns: u, v. N/m
  Eigen::MatrixXcd stiffness(int order) const;

 private:
  RingMechanics ring_;
  double rim_radius_, segment_mass_;  // m, kg
  MassProperties total_;
};

}  // namespace furrow::tire
