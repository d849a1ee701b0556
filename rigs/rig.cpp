#include "rigs/rig.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/error.hpp"

namespace furrow::rigs {

void Rig::add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) {
  FURROW_ASSERT(in_range(wheel, wheel_count()) && !placed_, wheel, wheel_count(), placed_);
  FURROW_ASSERT(tire.mass >= 0.0 && tire.inertia.allFinite() && tire_radius > 0.0, tire.mass, tire_radius);
  tires_.resize(wheel_count());
  tires_[wheel] = {tire, tire_radius};
  do_add_tire_mass(wheel, tire, tire_radius);
}

void Rig::place(std::span<const double> axle_height) {
  check_tires();
  FURROW_ASSERT(axle_height.size() == tires_.size(), axle_height.size(), tires_.size());
  FURROW_ASSERT(std::all_of(axle_height.begin(), axle_height.end(), [](double z) { return std::isfinite(z); }));
  do_place(axle_height);
  placed_ = true;
}

RimState Rig::rim(int wheel) const {
  check_wheel(wheel);
  return do_rim(wheel);
}

Outcome Rig::advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  FURROW_ASSERT(placed_ && wrenches.size() == tires_.size(), placed_, wrenches.size(), tires_.size());
  FURROW_ASSERT(duration > 0.0 && substeps >= 1, duration, substeps);
  for (std::size_t k = 0; k < wrenches.size(); ++k)
    if (!wrenches[k].force.allFinite() || !wrenches[k].moment.allFinite())
      return Outcome::failure("was pulled with a wrench that is not finite",
                              "it comes from the tire of wheel " + std::to_string(k) + "; try a smaller run.step");
  return do_advance(wrenches, duration, substeps);
}

WheelReport Rig::report(int wheel) const {
  check_wheel(wheel);
  return do_report(wheel);
}

RigAccounts Rig::accounts() const {
  FURROW_ASSERT(placed_);
  return do_accounts();
}

void Rig::save(Archive& archive) const {
  FURROW_ASSERT(placed_);
  const Archive::Scope scope(archive, "rig/");
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    const Archive::Scope of_tire(archive, "tire" + std::to_string(k) + "/");
    archive.put("mass", tires_[k].mass.mass);
    archive.put("radius", tires_[k].radius);
  }
  do_save(archive);
}

void Rig::restore(const Archive& archive) {
  check_tires();
  const Archive::Scope scope(archive, "rig/");
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    const Archive::Scope of_tire(archive, "tire" + std::to_string(k) + "/");
    if (archive.get_double("mass") != tires_[k].mass.mass || archive.get_double("radius") != tires_[k].radius)
      throw Error(ExitCode::io, "saved rig state belongs to another tire (mass or radius differ)");
  }
  do_restore(archive);
  placed_ = true;
}

void Rig::check_tires() const {
  FURROW_ASSERT(in_range(wheel_count() - 1, tires_.size()) &&
                    std::all_of(tires_.begin(), tires_.end(), [](const RigTire& tire) { return tire.radius > 0.0; }),
                wheel_count(), tires_.size());
}

void Rig::check_wheel(int wheel) const {
  FURROW_ASSERT(placed_ && in_range(wheel, tires_.size()), placed_, wheel, tires_.size());
}

}  // namespace furrow::rigs
