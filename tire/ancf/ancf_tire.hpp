// The layered ANCF shell tire. Bead nodes follow the rim exactly; the other nodes are integrated implicitly. The
// contact surface is the mid-surface (nodes). A disc closes it at each bead; its centre vertex moves with the rim, and
// forces on it act on the rim.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "tire/ancf/rim_clearance.hpp"
#include "tire/ancf/shell_integrator.hpp"

namespace furrow::tire {

class AncfTire final : public Tire {
 public:
  /// @param alive called repeatedly during inflation; may throw to stop
  explicit AncfTire(const TireFile& file, const ShellIntegratorParams& params = {}, std::function<void()> alive = {});

  int coordinates() const override { return 6 * ring_.nodes(); }

  void set_pressure(double pressure) override;
  void surface(SurfaceState& out) const override;
  std::vector<float> strain() const override;
  void acted(NodalForces& forces) const override;
  TireDiagnostics diagnostics() const override;
  NamedValues figures() const override;
  NamedValues times() const override;
  void add_state(Hash& hash) const override;
  void save(Archive& archive) const override;

  const ShellIntegrator& integrator() const { return integrator_; }

 private:
  void do_place(const RimState& rim) override;
  Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  void do_restore(const Archive& archive) override;
  Outcome step(const RimTrajectory& rim, double from, double to, int substeps, int halvings);

  std::function<void()> alive_;
  ShellMesh ring_;
  double undeformed_volume_ = 0.0;  // m³
  RimClearance clearance_;
  ShellIntegrator integrator_;
  // ∫ (V − V₀) dp since the tire was placed, J: change of the potential −p (V − V₀) by a changing pressure, which does
  // no work on the tire.
  double pressure_work_ = 0.0;
  Field force_;  // of the running interval
  std::vector<std::pair<std::size_t, std::size_t>>
      answering_;              // of the last interval: forces that answered to the motion, and their numbers there
  double interval_ = 0.0;      // s
  Vec3 about_ = Vec3::Zero();  // where its moments are taken, m
};

}  // namespace furrow::tire
