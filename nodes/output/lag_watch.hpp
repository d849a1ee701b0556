// Energy that late forces create or take at a wheel's ground and rim. A force that acts one communication step after
// the motion to which it belongs does different work on the two sides. The difference is energy without a source. It is
// judged against the work that passes the wheel,
//
//   passed = Σ over steps (|F·Δx| + |M·Δθ|),  F, M on the rim by the tire, at least kFloor × load × radius:
//
// because a wheel at rest passes little work.
#pragma once

#include <optional>

#include "nodes/output/wheel_row.hpp"
#include "protocol/core/fields.hpp"

namespace furrow::output {

inline constexpr double kGoodShare = 0.01;  // of the work that passes a wheel: up to this a result is not spoiled
inline constexpr double kMostShare = 0.1;   // above this share a run is not worth continuing

/// Energies of one wheel's interfaces, cumulative, J.
struct InterfaceEnergies {
  double ground = 0.0, rim = 0.0;  // created by late forces; negative: taken
  double passed = 0.0;
};
void visit_fields(FieldsOf<InterfaceEnergies> auto& s, auto&& visit) {
  visit(s.ground, Field{"ground", "J"});
  visit(s.rim, Field{"rim", "J"});
  visit(s.passed, Field{"passed", "J"});
}

inline InterfaceEnergies interface_energies(const WheelRow& row) {
  return {row.energy_error, row.rim_energy_error, row.passed_work};
}

/// |made| as a share of the passed work; infinite if one of them is not finite. @param load N @param radius m
double lag_share(double made, double passed, double load, double radius);

/// Returns a step, s, rounded down to one digit, at which late forces stay below kGoodShare. If tire and ground only
/// bear `bears` < `step`, it is at most `bears` and `step`/2. Otherwise it is 0.1 to 0.5 of `step`, in proportion to
/// 1/share: the energy grows with the step, and a motion that ran away shows no more.
double better_step(double step, double share, double bears);

/// Judges a wheel during a run, window by window. A window lasts one bounce period of a wheel whose tire and ground
/// give way by a twentieth of its radius. The first begins when the wheel touches the ground.
class LagWatch {
 public:
  struct Window {
    const char* interface = "";  // "ground" or "rim": the one with the largest share
    double made = 0.0, passed = 0.0, share = 0.0;
    double from = 0.0, to = 0.0;  // s
  };

  /// @param radius undeformed, m @param gravity m/s²
  LagWatch(double radius, double gravity);

  /// Call it at every synchronization. @param touches whether the wheel touches the ground @returns the window that
  /// ends now
  std::optional<Window> add(const WheelRow& now, double load, bool touches);

 private:
  friend void visit_fields(FieldsOf<LagWatch> auto& s, auto&& visit) {
    visit(s.from_, Field{"from", "s"});
    visit(s.begin_, Field{"begin", ""});
  }

  double radius_, length_;  // m, s
  double from_ = -1.0;      // start of the current window, s; below 0: the wheel has not touched the ground
  InterfaceEnergies begin_;
};

}  // namespace furrow::output
