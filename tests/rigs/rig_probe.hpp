// Values of any rig, for tests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rigs/rig.hpp"

namespace furrow::testing {

/// A rig's measurement of a subject, in addition to the report of every wheel, by the name of its column.
inline double measured(const rigs::Rig& rig, int subject, std::string_view column) {
  const rigs::Subject of = rig.subjects().at(subject);
  std::vector<double> values(of.columns.size());
  rig.measure(subject, values);
  return LineView{of.columns, values}[column];
}
inline double measured(const rigs::Rig& rig, std::string_view column) { return measured(rig, 0, column); }

/// Residual of the energy accounts between two reports, J.
inline double energy_residual(const rigs::RigAccounts& start, const rigs::RigAccounts& end) {
  return end.drive_work + end.tow_work + end.guide_work + end.tire_work - (end.stored() - start.stored()) -
         end.damper_loss;
}
/// Residual of the momentum accounts between two reports, N s.
inline Vec3 momentum_residual(const rigs::RigAccounts& start, const rigs::RigAccounts& end) {
  return end.momentum - start.momentum - end.gravity_impulse - end.guide_impulse - end.tire_impulse;
}

}  // namespace furrow::testing
