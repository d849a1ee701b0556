// What late forces make or take where a wheel meets its ground and its rim. A force that acts one communication step
// after the motion that it belongs to does other work on one side than on the other. The difference is energy that
// comes from nowhere or goes nowhere. It is judged against what passes the wheel,
//
//   passed = Σ over steps (|F·Δx| + |M·Δθ|),  F, M on the rim by the tire, at least kFloor × load × radius:
//
// a wheel that stands passes little.
#pragma once

#include <optional>

#include "nodes/output/wheel_row.hpp"
#include "protocol/core/fields.hpp"

namespace furrow::output {

inline constexpr double kGoodShare = 0.01;  // of what passes a wheel: late forces up to this do not spoil a result
inline constexpr double kMostShare = 0.1;   // above this a run is not worth going on with

/// Energies of one wheel's interfaces, cumulative, J.
struct InterfaceEnergies {
  double ground = 0.0, rim = 0.0;  // made by late forces; negative: taken
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

/// |made| as a share of what passes; infinite where one is not finite. @param load N @param radius m
double lag_share(double made, double passed, double load, double radius);

/// A step with which late forces keep below kGoodShare, s: a number of one digit. At most what the pair of tire and
/// ground bears where that is less than the step; else smaller in proportion to the share, as their energy grows with
/// the step, and by no more than ten, as a motion that ran away says nothing of it.
double better_step(double step, double share, double bears);

/// Judges a wheel of a running simulation, window by window, each as long as a bounce of a wheel that its tire and
/// ground let down by a twentieth of its radius. The first begins where it touches the ground.
class LagWatch {
 public:
  struct Window {
    const char* interface = "";  // "ground", "rim": where the share is largest
    double made = 0.0, passed = 0.0, share = 0.0;
    double from = 0.0, to = 0.0;  // s
  };

  /// @param radius undeformed, m @param gravity m/s²
  LagWatch(double radius, double gravity);

  /// At every synchronization. @param now of the wheel @param touches the ground @returns the window that ends there
  std::optional<Window> add(const WheelRow& now, double load, bool touches);

 private:
  friend void visit_fields(FieldsOf<LagWatch> auto& s, auto&& visit) {
    visit(s.from_, Field{"from", "s"});
    visit(s.begin_, Field{"begin", ""});
  }

  double radius_, length_;  // m, s
  double from_ = -1.0;      // of the running window, s; below 0: it has not touched the ground
  InterfaceEnergies begin_;
};

}  // namespace furrow::output
