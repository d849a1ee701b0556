#include "tire/rigid/rigid_spec.hpp"

#include "tire/rigid/rigid_tire.hpp"

namespace furrow::tire {
namespace {

class RigidSpec final : public TireSpec {
 public:
  explicit RigidSpec(std::unique_ptr<TireSpec> flexible)
      : TireSpec(flexible->options()), flexible_(std::move(flexible)) {}

  TireDescription describe() const override {
    TireDescription d = flexible_->describe();
    d.kind = d.name = d.details = "rigid";
    d.coordinates = 0;
    d.memory = d.saved_bytes = 0.0;
    d.takes_tangents = d.deflects = false;
    d.follows_rim = true;
    d.own_contact.clear();
    d.vertical_stiffness = d.grip_stiffness = d.grip_damping = 0.0;
    d.static_only.clear();
    d.damping_time = d.step_share = 0.0;
    return d;
  }
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    return std::make_unique<RigidTire>(flexible_->shape(), context.gravity);
  }
  TireShape shape() const override { return flexible_->shape(); }
  std::vector<std::filesystem::path> files() const override { return flexible_->files(); }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    return flexible_->unlikely_values();
  }

 private:
  std::unique_ptr<TireSpec> flexible_;
};

}  // namespace

std::unique_ptr<TireSpec> make_rigid(std::unique_ptr<TireSpec> flexible) {
  return std::make_unique<RigidSpec>(std::move(flexible));
}

}  // namespace furrow::tire
