#include "tests/dummies/held_hub.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/files/json_fields.hpp"

namespace furrow::rigs {
namespace {

class HeldHub final : public Rig {
 public:
  explicit HeldHub(const HeldHubOptions& options) : options_(options) {}

  std::string kind() const override { return "held_hub"; }
  int wheel_count() const override { return 1; }
  Vec3 heading(int) const override { return Vec3::UnitX(); }
  std::vector<Subject> subjects() const override { return {{"wheel0", columns_of<HeldHubRow>()}}; }
  void measure(int, std::span<double> values) const override { get_values(row_, values); }

  void add_tire_mass(int, const MassProperties& tire, double) override {
    mass_ = tire.mass;
    inertia_ = tire.inertia(1, 1);
  }

  void place(std::span<const double> axle_height) override {
    FURROW_ASSERT(axle_height.size() == 1, axle_height.size());
    top_ = axle_height[0];
    time_ = 0.0;
    accounts_ = RigAccounts::none();
    held_ = momentum();
  }

  RimState rim(int) const override {
    RimState rim;
    const double way = options_.lowering * time_;
    rim.position = Vec3(0.0, 0.0, top_ - std::min(way, options_.depth));
    if (way < options_.depth) rim.velocity = Vec3(0.0, 0.0, -options_.lowering);
    rim.orientation = Quat(Eigen::AngleAxisd(options_.spin * time_, Vec3::UnitY()));
    rim.angular_velocity = Vec3(0.0, options_.spin, 0.0);
    return rim;
  }

  Outcome advance(std::span<const Wrench> wrenches, double duration, int) override {
    FURROW_ASSERT(wrenches.size() == 1 && duration > 0.0, wrenches.size(), duration);
    wrench_ = wrenches[0];
    row_.hub_load = wrench_.force.z();
    const RimState from = rim(0);
    time_ += duration;
    const RimState to = rim(0);
    const Vec3 way = to.position - from.position, turn = mean_turn(from.orientation, to.orientation);
    const Vec3 weight = mass_ * Vec3(0.0, 0.0, -kStandardGravity);
    const Vec3 guide = (momentum() - held_) / duration - wrench_.force - weight;  // what holds the hub
    held_ = momentum();
    accounts_.tire_work += wrench_.force.dot(way) + wrench_.moment.dot(turn);
    accounts_.drive_work -= wrench_.moment.dot(turn);  // the spin is constant
    accounts_.guide_work += guide.dot(way);
    accounts_.tire_impulse += duration * wrench_.force;
    accounts_.guide_impulse += duration * guide;
    accounts_.gravity_impulse += duration * weight;
    return {};
  }

  WheelReport report(int) const override {
    WheelReport report;
    report.spin = options_.spin;
    report.drive_torque = -wrench_.moment.y();
    report.lateral_force = wrench_.force.y();
    report.aligning_moment = wrench_.moment.z();
    report.axle_height = rim(0).position.z();
    report.vertical_speed = rim(0).velocity.z();
    report.carried_mass = mass_;
    return report;
  }

  RigAccounts accounts() const override {
    RigAccounts now = accounts_;
    now.momentum = momentum();
    now.kinetic_energy = 0.5 * (momentum().dot(rim(0).velocity) + inertia_ * options_.spin * options_.spin);
    now.potential_energy = mass_ * kStandardGravity * rim(0).position.z();
    return now;
  }

  void save(Archive& archive) const override {
    save_fields(archive, "held_hub/accounts", accounts_);
    save_value(archive, "held_hub/held", held_);
    save_value(archive, "held_hub/time", time_);
    save_value(archive, "held_hub/top", top_);
    save_fields(archive, "held_hub/wrench", wrench_);
  }
  void restore(const Archive& archive) override {
    restore_fields(archive, "held_hub/accounts", accounts_);
    restore_value(archive, "held_hub/held", held_);
    restore_value(archive, "held_hub/time", time_);
    restore_value(archive, "held_hub/top", top_);
    restore_fields(archive, "held_hub/wrench", wrench_);
    row_.hub_load = wrench_.force.z();
  }

 private:
  Vec3 momentum() const { return mass_ * rim(0).velocity; }  // the hub itself has no mass

  HeldHubOptions options_;
  double time_ = 0.0, top_ = 0.0;      // s; of the hub at first, m
  double mass_ = 0.0, inertia_ = 0.0;  // of the tire, kg, kg m²
  RigAccounts accounts_ = RigAccounts::none();
  Vec3 held_ = Vec3::Zero();  // momentum at the end of the last advance, kg m/s
  Wrench wrench_;             // on the hub, of the last advance
  HeldHubRow row_;
};

class HeldHubSpec final : public RigSpec {
 public:
  explicit HeldHubSpec(const HeldHubOptions& options) : options_(options) {}

  std::size_t wheel_count() const override { return 1; }
  RigDescription describe(std::span<const WheelSize> tires, double) const override {
    RigDescription d;
    d.kind = "held_hub";
    d.text = "1 held hub";
    WheelDescription wheel;
    wheel.along = tires[0].radius;
    wheel.across = 0.5 * tires[0].width;
    d.wheels = {wheel};
    return d;
  }
  std::unique_ptr<Rig> make() const override { return std::make_unique<HeldHub>(options_); }
  void fill_starts(std::span<const WheelSize>, double, std::optional<double>, std::span<const double>) override {}
  void complete(nlohmann::json&) const override {}

 private:
  HeldHubOptions options_;
};

}  // namespace

std::unique_ptr<RigSpec> read_held_hub(const nlohmann::json& section, const ReadContext& context) {
  HeldHubOptions options;
  read_fields(section, options);
  if (!(options.depth >= 0.0))
    throw input_error(context.file, context.key("depth"), "is negative, expected 0 or more, m");
  return std::make_unique<HeldHubSpec>(options);
}

}  // namespace furrow::rigs
