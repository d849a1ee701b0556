#include "rigs/quarter_car_rig.hpp"

#include "rigs/ride_car.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {
namespace {

class QuarterCar final : public RideCar<QuarterCarOptions> {
 public:
  explicit QuarterCar(const QuarterCarOptions& o)
      : RideCar(o, {{o.body_mass, o.suspension_stiffness, o.suspension_damping}}) {}

  std::string kind() const override { return "quarter_car"; }

 private:
  void build() override;
  double rise(int) const override { return state(body_).velocity.z(); }
  double strut_force(int) const override { return -system_->element_force(suspensions_[0].element); }
  double held_force(int) const override { return system_->motor_force(drive_); }
  void measure_rows() override {
    suspensions_[0].row.body_height = state(body_).position.z() - wheels_[0].placed_height;
    suspensions_[0].row.travel = system_->coordinate(strut_).value;
  }

  int body_ = 0, strut_ = 0;  // body, joint
};

void QuarterCar::build() {
  using vehicle::JointKind;
  Suspension& suspension = suspensions_[0];
  const vehicle::BodyState state = add_trolley(Vec3(options_.start, 0.0, wheels_[0].placed_height));
  body_ = system_->add_body("body", options_.body_mass, guided(), state);
  add_wheel(0, "", state);
  add_rail();
  const int guide = add_joint(JointKind::prismatic, "guide", trolley_, body_, state.position, Vec3::UnitZ());
  strut_ = add_joint(JointKind::prismatic, "suspension", body_, wheels_[0].carrier, state.position, Vec3::UnitZ());
  add_spindle(0, "");
  add_drive();
  const double weight = options_.body_mass * kStandardGravity, k = suspension.stiffness, c = suspension.damping;
  suspension.element = system_->add_joint_element("suspension", strut_, [=](double s, double rate, double) {
    const double elastic = -(weight + k * s);
    return vehicle::ElementForce{elastic - c * rate, c, elastic, (weight + 0.5 * k * s) * s};
  });
  keep_energy(suspension.element);
  add_lowering(guide);
}

}  // namespace

std::unique_ptr<Rig> make_quarter_car(const QuarterCarOptions& options) {
  return std::make_unique<QuarterCar>(options);
}

}  // namespace furrow::rigs
