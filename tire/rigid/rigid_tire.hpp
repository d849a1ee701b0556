// A tire that does not deform: the undeformed contact surface and mass of a tire file, moving exactly with
// the rim.
#pragma once

#include "tire/shell_mesh.hpp"
#include "tire/tire.hpp"

namespace furrow::tire {

class RigidTire final : public Tire {
 public:
  explicit RigidTire(const TireFile& file);

  const SurfaceMesh& mesh() const override { return surface_mesh_; }
  ContactMaterial material() const override { return material_; }
  MassProperties mass_properties() const override { return mass_; }
  double radius() const override { return radius_; }
  double tread_width() const override { return tread_width_; }
  int coordinates() const override { return 0; }

  void set_pressure(double) override {}
  void place(const RimState& rim) override;
  void surface(SurfaceState& out) const override;
  Outcome advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  Wrench spindle_wrench() const override { return spindle_; }
  TireDiagnostics diagnostics() const override;
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  Vec3 angular_momentum(const RimState& rim) const;  // about the rim centre, W

  SurfaceMesh surface_mesh_;
  ContactMaterial material_;
  MassProperties mass_;
  double radius_ = 0.0;       // m
  double tread_width_ = 0.0;  // m
  std::vector<Vec3> vertex_;  // rim axes, m
  RimState rim_;              // now
  Wrench spindle_;            // of the last advance
};

}  // namespace furrow::tire
