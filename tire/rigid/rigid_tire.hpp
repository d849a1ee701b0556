// A tire that does not deform: the undeformed contact surface and mass of any tire, moving exactly with the rim.
#pragma once

#include <utility>

#include "protocol/core/constants.hpp"
#include "tire/tire.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

class RigidTire final : public Tire {
 public:
  explicit RigidTire(TireShape shape, const Vec3& gravity = standard_gravity()) : Tire(gravity, std::move(shape)) {}

  int coordinates() const override { return 0; }

  void surface(SurfaceState& out) const override { surface_on(rim_, out); }
  void surface_on(const RimState& rim, SurfaceState& out) const override;
  TireDiagnostics diagnostics() const override;
  void add_state(Hash& hash) const override;
  void save(Archive& archive) const override;

 private:
  void do_place(const RimState& rim) override;
  Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  void do_restore(const Archive& archive) override;
  Vec3 angular_momentum(const RimState& rim) const;  // about the rim centre, W
  void book_loss(const RimState& from, const RimState& to, double duration);

  double numerical_loss_ = 0.0;  // J
};

}  // namespace furrow::tire
