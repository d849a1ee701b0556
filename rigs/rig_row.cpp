#include "rigs/rig_row.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::rigs {
namespace {

class RigRow final : public Rig {
 public:
  explicit RigRow(std::vector<std::unique_ptr<Rig>> rigs) : rigs_(std::move(rigs)) {
    FURROW_ASSERT(std::none_of(rigs_.begin(), rigs_.end(), [](const auto& rig) { return rig == nullptr; }),
                  rigs_.size());
    if (rigs_.empty()) throw physics_error("a row of rigs needs at least one rig");
    for (std::size_t i = 0; i < rigs_.size(); ++i)
      for (int wheel = 0; wheel < rigs_[i]->wheel_count(); ++wheel) wheels_.emplace_back(i, wheel);
    subjects_ = wheels_;
    for (std::size_t i = 0; i < rigs_.size(); ++i)
      for (int k = rigs_[i]->wheel_count(); k < static_cast<int>(rigs_[i]->subjects().size()); ++k)
        subjects_.emplace_back(i, k);
  }

  std::string kind() const override { return rigs_.front()->kind() + " row"; }
  int wheel_count() const override { return static_cast<int>(wheels_.size()); }
  Vec3 heading(int wheel) const override { return rig_of(wheel).heading(wheels_[wheel].second); }

  /// Wheels are numbered through; other subjects have their rig's number behind their name.
  std::vector<Subject> subjects() const override {
    std::vector<Subject> all = plain_wheels(wheel_count());
    for (std::size_t k = 0; k < subjects_.size(); ++k) {
      const auto& [rig, inner] = subjects_[k];
      Subject subject = rigs_[rig]->subjects().at(inner);
      if (k < wheels_.size())
        all[k].columns = std::move(subject.columns);
      else
        all.push_back({subject.name + std::to_string(rig), std::move(subject.columns)});
    }
    return all;
  }
  void measure(int subject, std::span<double> values) const override {
    const auto& [rig, inner] = subjects_.at(subject);
    rigs_[rig]->measure(inner, values);
  }
  void derive(int subject, const LineView& line, std::span<double> values) const override {
    const auto& [rig, inner] = subjects_.at(subject);
    rigs_[rig]->derive(inner, line, values);
  }

  void add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) override {
    rig_of(wheel).add_tire_mass(wheels_[wheel].second, tire, tire_radius);
  }
  void place(std::span<const double> axle_height) override {
    for_each_rig(axle_height, [](Rig& rig, std::span<const double> part) { rig.place(part); });
  }
  RimState rim(int wheel) const override { return rig_of(wheel).rim(wheels_[wheel].second); }
  Outcome advance(std::span<const Wrench> wrenches, double duration, int substeps) override {
    Outcome outcome;
    int index = 0;
    for_each_rig(wrenches, [&](Rig& rig, std::span<const Wrench> part) {
      if (!outcome.ok) return;
      outcome = rig.advance(part, duration, substeps);
      if (!outcome.ok) outcome.detail = "rig " + std::to_string(index) + " of the row: " + outcome.detail;
      ++index;
    });
    return outcome;
  }
  RigAccounts accounts() const override {
    RigAccounts sum = RigAccounts::none();
    for (const auto& rig : rigs_) sum = sum + rig->accounts();
    return sum;
  }
  WheelReport report(int wheel) const override { return rig_of(wheel).report(wheels_[wheel].second); }

  void save(Archive& archive) const override {
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
      const Archive::Scope scope(archive, "row" + std::to_string(i) + "/");
      rigs_[i]->save(archive);
    }
  }
  void restore(const Archive& archive) override {
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
      const Archive::Scope scope(archive, "row" + std::to_string(i) + "/");
      rigs_[i]->restore(archive);
    }
  }

 private:
  Rig& rig_of(int wheel) const {
    FURROW_ASSERT(in_range(wheel, wheels_.size()), wheel, wheels_.size());
    return *rigs_[wheels_.at(wheel).first];
  }

  /// Gives each rig its own wheels' part of `values`.
  template <class T, class Call>
  void for_each_rig(std::span<const T> values, Call call) {
    FURROW_ASSERT(values.size() == wheels_.size(), values.size(), wheels_.size());
    for (auto& rig : rigs_) {
      call(*rig, values.first(rig->wheel_count()));
      values = values.subspan(rig->wheel_count());
    }
  }

  std::vector<std::unique_ptr<Rig>> rigs_;
  std::vector<std::pair<std::size_t, int>> wheels_;    // rig, and wheel within it
  std::vector<std::pair<std::size_t, int>> subjects_;  // rig, and subject within it
};

}  // namespace

std::unique_ptr<Rig> make_rig_row(std::vector<std::unique_ptr<Rig>> rigs) {
  return std::make_unique<RigRow>(std::move(rigs));
}

}  // namespace furrow::rigs
