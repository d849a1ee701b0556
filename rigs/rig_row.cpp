#include "rigs/rig_row.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/field_arithmetic.hpp"

namespace furrow::rigs {
namespace {

class RigRow final : public Rig {
 public:
  explicit RigRow(std::vector<std::unique_ptr<Rig>> rigs) : rigs_(std::move(rigs)) {
    FURROW_ASSERT(!rigs_.empty());
    FURROW_ASSERT(std::all_of(rigs_.begin(), rigs_.end(), [](const auto& rig) { return rig->wheel_count() == 1; }));
  }

  std::string kind() const override { return rigs_.front()->kind() + " row"; }
  int wheel_count() const override { return static_cast<int>(rigs_.size()); }
  Vec3 heading(int wheel) const override { return rigs_.at(wheel)->heading(0); }
  std::vector<Subject> subjects() const override {
    std::vector<Subject> all = plain_wheels(wheel_count());
    for (std::size_t k = 0; k < all.size(); ++k) all[k].columns = rigs_[k]->subjects().front().columns;
    return all;
  }
  void measure(int wheel, std::span<double> values) const override { rigs_.at(wheel)->measure(0, values); }
  void derive(int wheel, const LineView& line, std::span<double> values) const override {
    rigs_.at(wheel)->derive(0, line, values);
  }

 private:
  void do_add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) override {
    rigs_[wheel]->add_tire_mass(0, tire, tire_radius);
  }
  void do_place(std::span<const double> axle_height) override {
    for (std::size_t k = 0; k < rigs_.size(); ++k) rigs_[k]->place(axle_height.subspan(k, 1));
  }
  RimState do_rim(int wheel) const override { return rigs_[wheel]->rim(0); }
  Outcome do_advance(std::span<const Wrench> wrenches, double duration, int substeps) override {
    for (std::size_t k = 0; k < rigs_.size(); ++k)
      if (Outcome outcome = rigs_[k]->advance(wrenches.subspan(k, 1), duration, substeps); !outcome.ok)
        return Outcome::failure(outcome.what, "rig " + std::to_string(k) + " of the row: " + outcome.detail);
    return {};
  }
  RigAccounts do_accounts() const override {
    RigAccounts sum = RigAccounts::none();
    for (const auto& rig : rigs_) sum = sum_of(sum, rig->accounts());
    return sum;
  }
  WheelReport do_report(int wheel) const override { return rigs_[wheel]->report(0); }
  void do_save(Archive& archive) const override {
    for (std::size_t k = 0; k < rigs_.size(); ++k) {
      const Archive::Scope scope(archive, "row" + std::to_string(k) + "/");
      rigs_[k]->save(archive);
    }
  }
  void do_restore(const Archive& archive) override {
    for (std::size_t k = 0; k < rigs_.size(); ++k) {
      const Archive::Scope scope(archive, "row" + std::to_string(k) + "/");
      rigs_[k]->restore(archive);
    }
  }

  std::vector<std::unique_ptr<Rig>> rigs_;  // of each wheel
};

}  // namespace

std::unique_ptr<Rig> make_rig_row(std::vector<std::unique_ptr<Rig>> rigs) {
  return std::make_unique<RigRow>(std::move(rigs));
}

}  // namespace furrow::rigs
