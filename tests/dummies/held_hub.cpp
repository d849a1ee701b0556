#include "tests/dummies/held_hub.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "protocol/core/archive_fields.hpp"
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

 private:
  void do_place(std::span<const double> axle_height) override {
    top_ = axle_height[0];
    time_ = 0.0;
    accounts_ = RigAccounts::none();
    held_ = momentum();
  }

  RimState do_rim(int) const override {
    RimState rim;
    const double way = options_.lowering * time_;
    rim.position = Vec3(0.0, 0.0, top_ - std::min(way, options_.depth));
    if (way < options_.depth) rim.velocity = Vec3(0.0, 0.0, -options_.lowering);
    rim.orientation = Quat(Eigen::AngleAxisd(options_.spin * time_, Vec3::UnitY()));
    rim.angular_velocity = Vec3(0.0, options_.spin, 0.0);
    return rim;
  }

  Outcome do_advance(std::span<const Wrench> wrenches, double duration, int) override {
    wrench_ = wrenches[0];
    row_.hub_load = wrench_.force.z();
    const RimState from = do_rim(0);
    time_ += duration;
    const Vec3 way = do_rim(0).position - from.position, turn = mean_turn(from.orientation, do_rim(0).orientation);
    const Vec3 weight = mass() * Vec3(0.0, 0.0, -kStandardGravity);
    const Vec3 guide = (momentum() - held_) / duration - wrench_.force - weight;  // holds the hub
    held_ = momentum();
    add_tire(accounts_, from, do_rim(0), wrench_, duration);
    accounts_.drive_work -= wrench_.moment.dot(turn);  // the spin is constant
    accounts_.guide_work += guide.dot(way);
    accounts_.guide_impulse += duration * guide;
    accounts_.gravity_impulse += duration * weight;
    return {};
  }

  WheelReport do_report(int) const override {
    WheelReport report;
    report.spin = options_.spin;
    report.drive_torque = -wrench_.moment.y();
    report.lateral_force = wrench_.force.y();
    report.aligning_moment = wrench_.moment.z();
    report.axle_height = do_rim(0).position.z();
    report.vertical_speed = do_rim(0).velocity.z();
    report.carried_mass = mass();
    return report;
  }

  RigAccounts do_accounts() const override {
    RigAccounts now = accounts_;
    now.momentum = momentum();
    now.kinetic_energy =
        0.5 * (momentum().dot(do_rim(0).velocity) + tire(0).mass.inertia(1, 1) * options_.spin * options_.spin);
    now.potential_energy = mass() * kStandardGravity * do_rim(0).position.z();
    return now;
  }

  void do_save(Archive& archive) const override {
    save_fields(archive, "accounts", accounts_);
    save_value(archive, "held", held_);
    save_value(archive, "time", time_);
    save_value(archive, "top", top_);
    save_fields(archive, "wrench", wrench_);
  }
  void do_restore(const Archive& archive) override {
    restore_fields(archive, "accounts", accounts_);
    restore_value(archive, "held", held_);
    restore_value(archive, "time", time_);
    restore_value(archive, "top", top_);
    restore_fields(archive, "wrench", wrench_);
    row_.hub_load = wrench_.force.z();
  }

  double mass() const { return tire(0).mass.mass; }  // the hub itself has none
  Vec3 momentum() const { return mass() * do_rim(0).velocity; }

  HeldHubOptions options_;
  double time_ = 0.0, top_ = 0.0;  // s; of the hub at first, m
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
