// A tire that the Magic Formula describes: on hard ground. It states its contact itself (stated_contact()): the
// terrain gives the forces that it asks for, on its own surface and in its own books, and adds none of its own.
//
// The forces of an interval of the length H from t are those of the rim's motion extrapolated from t to its middle;
// they act over the same interval. To patch and tire, which are springs, that is the leapfrog rule: it makes no energy.
//
// Surface: a cylinder of R_0, flattened where it would be below the ground, which where it is not level is the plane
// under the wheel (road_plane.hpp). Its vertices otherwise move with the rim.
// Force and moment about the contact centre C go to the vertices near the ground with the weights w = max(0, ε − z)²,
// z the height above that plane,
//
//   f_k = w_k [F/Σw + θ × (x_k − x̄)],   Σ w [d² I − d dᵀ] θ = M + (C − x̄) × F,   x̄ = Σ w x/Σ w, d = x − x̄,
//
// so that Σ f = F and Σ (x − C) × f = M; a vertex comes and goes with no force.
//
// Energy: ∫ F dρ of the spring is elastic; what the vertices' forces do on the surface beyond what they do on the rim
// is dissipated, as far as it is not stored: by VERTICAL_DAMPING, by rolling resistance, and by what the formula itself
// loses between R_e and the radius of the tread.
#pragma once

#include <string>
#include <vector>

#include "tire/handling/rolling_contact.hpp"
#include "tire/rigid/rigid_tire.hpp"

namespace furrow::tire::handling {

class HandlingTire final : public Tire {
 public:
  /// @param shape with the radius R_0 @param file for messages @param heights of the ground
  HandlingTire(MagicFormula formula, TireShape shape, const Vec3& gravity, std::string file,
               GroundHeights heights = {});

  int coordinates() const override { return 2; }

  void surface(SurfaceState& out) const override { surface_on(rim_, out); }
  void surface_on(const RimState& rim, SurfaceState& out) const override { move(rim, out.position, &out.velocity); }
  Outcome state_contact(const RimState& rim, double duration) override;
  const StatedContact* stated_contact() const override { return &stated_; }
  TireDiagnostics diagnostics() const override;
  NamedValues figures() const override;
  void add_state(Hash& hash) const override;
  void save(Archive& archive) const override;

 private:
  void do_place(const RimState& rim) override;
  Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override;
  void do_restore(const Archive& archive) override;
  friend void visit_fields(FieldsOf<HandlingTire> auto& s, auto&& visit) {
    visit(s.rim_, Field{"rim", ""});
    visit(s.met_, Field{"met", ""});
    visit(s.spindle_, Field{"spindle", ""});
    visit(s.patch_, Field{"patch", ""});
    visit(s.dissipation_, Field{"dissipation", "J"});
    visit(s.standing_, Field{"placed", ""});
  }

  /// Vertices of the wheel at a pose, flattened by the ground. @param velocity may be null
  void move(const RimState& rim, std::vector<Vec3>& position, std::vector<Vec3>* velocity) const;
  bool on_ground(const ContactMotion& motion) const;
  ContactMotion motion_of(const RimState& rim) const { return contact_motion(formula_, rim, road_); }
  /// Gives `wanted`, about the contact centre, to the vertices near the ground.
  void distribute(const Wrench& wanted, const WheelAxes& axes);

  MagicFormula formula_;
  std::string file_;
  RoadPlane road_;
  RigidTire body_;            // its mass
  RimState met_;              // where the last interval began
  PatchState patch_;          // there
  bool standing_ = false;     // placed and not yet moved: nothing is flattened
  double dissipation_ = 0.0;  // J
  StatedContact stated_;
  std::vector<Vec3> before_, after_, moving_;  // work
};

}  // namespace furrow::tire::handling
