// Rows in speeds, on which gears, differentials, clutches, brakes and engines act. A row is the sum
//
//   u = Σ f (Ω − ω_C·a_C) + Σ f (ω_B − ω_A)·a_B
//
// of speeds of shafts relative to their carriers C and of relative spins of two bodies about an axis fixed in B. A
// torque λ in the row has the power λ u: it acts on each shaft with f λ and on its carrier with −f λ, on B with f λ and
// on A with −f λ. A common rotation of everything does not change u, so the torques of a row have no total moment.
//
// A row does one of four things:
//   free     nothing
//   torque   λ is given
//   hold u = target with lower ≤ λ ≤ upper. Without bounds it is a gear; with bounds it is dry friction as a set-valued
//            law: λ = upper if u < target, λ = lower if u > target, any value between if u = target. A row with
//            compliance holds u = target − give λ instead.
//   law      λ = f(u, t), set by add_rate_law
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/body.hpp"
#include "vehicle/multibody/force_element.hpp"

namespace furrow::vehicle {

struct ShaftTerm {
  int shaft = 0;
  double factor = 1.0;  // f
};

struct SpinTerm {
  int a = kGround, b = kGround;
  Vec3 axis = Vec3::UnitX();  // a_B: W when the row is added, kept in the axes of B
  double factor = 1.0;        // f
};

struct RateRow {
  std::string name;
  std::vector<ShaftTerm> shafts;  // no shaft twice
  std::vector<SpinTerm> spins;
  double give = 0.0;  // compliance while held between bounds, rad/s per N m
};

enum class RateMode { free, torque, hold, law };

struct RateControl {
  RateMode mode = RateMode::free;
  double target = 0.0;  // of u, rad/s
  double lower = -std::numeric_limits<double>::infinity(),
         upper = std::numeric_limits<double>::infinity();  // N m
  double torque = 0.0;                                     // N m
};
void visit_fields(FieldsOf<RateControl> auto& s, auto&& visit) {
  visit(s.mode, Field{"mode", ""});
  visit(s.target, Field{"target", "rad/s"});
  visit(s.lower, Field{"lower", "N m"});
  visit(s.upper, Field{"upper", "N m"});
  visit(s.torque, Field{"torque", "N m"});
}

struct RateState {
  int side = 0;         // of a held row: −1 at its lower bound, 0 holding, 1 at its upper bound
  double torque = 0.0;  // λ, mean over the last step, N m
  double work = 0.0;    // ∫ λ u dt since the start, J; negative: taken from the system
};
void visit_fields(FieldsOf<RateState> auto& s, auto&& visit) {
  visit(s.side, Field{"side"});
  visit(s.torque, Field{"torque", "N m"});
  visit(s.work, Field{"work", "J"});
}

/// λ of several rows as a function of their speeds u (rad/s) and time (s), each with its damping −∂λ/∂u ≥ 0, N m s.
using RateLaw = std::function<void(std::span<const double> speeds, double time, std::span<ElementForce> torques)>;

/// Derivative of a row's speed with respect to one body (∂u/∂ω, W) and to one shaft (∂u/∂Ω).
struct SpinSide {
  int row = 0, body = 0;
  Vec3 w = Vec3::Zero();
};
struct ShaftSide {
  int row = 0, shaft = 0;
  double factor = 1.0;
};

}  // namespace furrow::vehicle
