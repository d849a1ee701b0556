#include "rigs/half_car_rig.hpp"

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "rigs/ride_car.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {
namespace {

constexpr double kHubShare = 0.01;    // of the body: moves up and down with it and does not pitch
constexpr double kStrutLength = 1.0;  // m, from the front carrier up to the body at rest

class HalfCar final : public RideCar<HalfCarOptions> {
 public:
  explicit HalfCar(const HalfCarOptions& o)
      : RideCar(o, {{o.body_mass * o.front_share, o.suspension_stiffness, o.suspension_damping},
                    {o.body_mass * (1.0 - o.front_share), o.rear_suspension_stiffness, o.rear_suspension_damping}}),
        along_{o.wheelbase * (1.0 - o.front_share), -o.wheelbase * o.front_share} {
    FURROW_ASSERT(o.pitch_inertia > 0.0 && o.wheelbase > 0.0, o.pitch_inertia, o.wheelbase);
  }

  std::string kind() const override { return "half_car"; }
  std::vector<Subject> subjects() const override {
    std::vector<Subject> all = RideCar::subjects();
    all.push_back({"body", columns_of<HalfCarBodyRow>()});
    return all;
  }
  void measure(int subject, std::span<double> values) const override {
    if (subject < wheel_count()) return RideCar::measure(subject, values);
    get_values(row_, values);
  }

 private:
  void build() override;
  void add_station(int k, const std::string& name, const vehicle::BodyState& body);
  Vec3 arm(int k) const { return state(body_).orientation * Vec3(along_[k], 0.0, 0.0); }
  double rise(int k) const override {
    return (state(body_).velocity + state(body_).angular_velocity.cross(arm(k))).z();
  }
  double pitch_rate() const { return state(body_).angular_velocity.y(); }
  double strut_force(int k) const override { return system_->element_force(suspensions_[k].element); }
  double held_force(int k) const override {
    return (system_->joint(sliders_[k]).frame_a.axes * system_->reaction(sliders_[k]).force).x();
  }
  void begin_rows() override {
    RideCar::begin_rows();
    row_ = {};
  }
  void begin_advance() override;
  void add_step() override;
  void end_advance(double duration, int substeps) override;
  void measure_rows() override;
  void save_rows(Archive& archive) const override {
    RideCar::save_rows(archive);
    save_fields(archive, "body", row_);
  }
  void restore_rows(const Archive& archive) override {
    RideCar::restore_rows(archive);
    restore_fields(archive, "body", row_);
  }

  std::array<double, 2> along_;        // of the axles ahead of the body's centre, m
  int body_ = 0, hinge_ = 0;           // body, joint
  std::array<int, 2> sliders_{};       // joints of the carriers
  double rose_ = 0.0, pitched_ = 0.0;  // rates of the body when the advance began, m/s, rad/s
  HalfCarBodyRow row_;
};

void HalfCar::build() {
  using vehicle::JointKind;
  const vehicle::BodyState state =
      add_trolley(Vec3(options_.start - along_[0], 0.0, wheels_[0].placed_height + kStrutLength));
  const double mass = kHubShare * options_.body_mass;
  const int hub = system_->add_body("hub", mass, guided(), state);
  body_ = system_->add_body("body", options_.body_mass - mass, options_.pitch_inertia * Mat3::Identity(), state);
  add_rail();
  const int guide = add_joint(JointKind::prismatic, "guide", trolley_, hub, state.position, Vec3::UnitZ());
  hinge_ = add_joint(JointKind::revolute, "hinge", hub, body_, state.position, Vec3::UnitY());
  add_drive();
  add_station(0, "front ", state);
  add_station(1, "rear ", state);
  add_lowering(guide);
}

void HalfCar::add_station(int k, const std::string& name, const vehicle::BodyState& body) {
  Suspension& suspension = suspensions_[k];
  vehicle::BodyState state = body;
  const Vec3 top = body.position + along_[k] * Vec3::UnitX();
  state.position = Vec3(top.x(), top.y(), wheels_[k].placed_height);
  add_wheel(k, name, state);
  sliders_[k] = add_joint(vehicle::JointKind::prismatic, name + "slider", trolley_, wheels_[k].carrier, state.position,
                          Vec3::UnitZ());
  add_spindle(k, name);
  const double weight = suspension.body_share * kStandardGravity, stiffness = suspension.stiffness,
               c = suspension.damping, length = top.z() - state.position.z();
  suspension.element = system_->add_line_element(
      name + "suspension", wheels_[k].carrier, body_, state.position, top, [=](double distance, double rate, double) {
        const double s = length - distance, elastic = weight + stiffness * s;
        return vehicle::ElementForce{elastic - c * rate, c, elastic, (weight + 0.5 * stiffness * s) * s};
      });
  keep_energy(suspension.element);
}

void HalfCar::begin_advance() {
  RideCar::begin_advance();
  rose_ = state(body_).velocity.z();
  pitched_ = pitch_rate();
  row_.drive_force = 0.0;
}

void HalfCar::add_step() {
  RideCar::add_step();
  row_.drive_force += system_->motor_force(drive_);
}

void HalfCar::end_advance(double duration, int substeps) {
  RideCar::end_advance(duration, substeps);
  row_.drive_force /= substeps;
  row_.acceleration = (state(body_).velocity.z() - rose_) / duration;
  row_.pitch_acceleration = (pitch_rate() - pitched_) / duration;
}

void HalfCar::measure_rows() {
  const double rest = wheels_[0].placed_height + kStrutLength;  // of the body
  row_.height = state(body_).position.z() - wheels_[0].placed_height - kStrutLength;
  row_.pitch = system_->coordinate(hinge_).value;
  for (int k = 0; k < wheel_count(); ++k) {
    const double height = state(body_).position.z() + arm(k).z();
    suspensions_[k].row.body_height = height - wheels_[0].placed_height - kStrutLength;
    suspensions_[k].row.travel = (rest - wheels_[k].placed_height) - (height - state(wheels_[k].rim).position.z());
  }
}

}  // namespace

std::unique_ptr<Rig> make_half_car(const HalfCarOptions& options) { return std::make_unique<HalfCar>(options); }

}  // namespace furrow::rigs
