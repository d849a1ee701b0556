// A gearbox: one ratio at a time between an input and an output shaft, u_out = g u_in. A shift changes it in a given
// time T. With the slip in the new gear, s = u_out − g_new u_in:
//
//   torque phase, ≤ T/2  the old gear holds like a freewheel; the new one slips and takes the torque over along the C²
//                        smoothstep, until the old one carries no torque. This phase is left out without an old gear,
//                        between forward and reverse, and if friction would have to drive the slip (a down-shift under
//                        power).
//   speed phase, rest    the old gear is free; the new one slips, s → 0 along the C² smoothstep, with a torque that
//                        only opposes s. It ends early when s passes 0.
//   end                  the new gear holds; the rest of s vanishes at once, inelastically.
//
// With T = 0 there is only the end. The gearbox records the energy that slip dissipates. Nothing is assembled again;
// the rank of the constraints is checked whenever a gear starts to hold.
#pragma once

#include <string>
#include <vector>

#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {

inline constexpr int kNeutral = -1;

enum class ShiftPhase { none, torque, speed };

struct GearboxState {
  int gear = kNeutral;      // that holds, or will hold after the shift
  int old_gear = kNeutral;  // during a shift
  ShiftPhase phase = ShiftPhase::none;
  int row = 0;                                // row of `gear`
  double phase_start = 0.0, phase_end = 0.0;  // s
  double slip = 0.0;                          // s at the start of the speed phase, rad/s
  double hand_over = 0.0;                     // torque of the new gear at the end of the torque phase, N m
  int redundant = 0;                          // redundant constraints before the shift
};
void visit_fields(FieldsOf<GearboxState> auto& s, auto&& visit) {
  visit(s.gear, Field{"gear"});
  visit(s.old_gear, Field{"old_gear"});
  visit(s.phase, Field{"phase", ""});
  visit(s.row, Field{"row"});
  visit(s.phase_start, Field{"phase_start", "s"});
  visit(s.phase_end, Field{"phase_end", "s"});
  visit(s.slip, Field{"slip", "rad/s"});
  visit(s.hand_over, Field{"hand_over", "N m"});
  visit(s.redundant, Field{"redundant"});
}

class Gearbox {
 public:
  /// `ratios`: g of each gear, output over input, a reverse gear negative. `gear`: the one engaged at the start.
  /// @throws Error(physics) for a ratio 0 or a negative shift time
  Gearbox(System& system, const std::string& name, int in, int out, const std::vector<double>& ratios,
          double shift_time, int gear = kNeutral);

  /// Engages a gear without a shift. @pre before the first step; assemble() must follow
  void begin_in(System& system, int gear);
  /// Starts a shift with the next step. @pre not shifting
  Outcome shift(System& system, int gear);
  /// To be called before every step of size h. @returns failure when the new gear closes a loop of gears
  Outcome advance(System& system, double h);

  int gear() const { return state_.gear; }
  bool shifting() const { return state_.phase != ShiftPhase::none; }
  double output_torque(const System& system) const;  // mean over the last step, N m
  double loss(const System& system) const;           // energy dissipated by shifts since the start, J

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  Outcome engage(System& system);  // the new gear holds
  void begin_speed_phase(System& system, double start, double end);

  std::string name_;
  std::vector<double> ratios_;
  double shift_time_ = 0.0;  // s
  int rows_[2] = {0, 0};
  GearboxState state_;
};

}  // namespace furrow::vehicle
