// The continuous (C¹) motion that a tire gives its bead over one communication interval. The rim's state arrives at the
// interval's start t₀, and the tire extrapolates it to t₁ = t₀ + H. The motion from the pose last used to there is a
// cubic Hermite curve in position, and in the rotation vector relative to the starting orientation.
#pragma once

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::tire {

/// Rim motion with its acceleration at one instant, W.
struct RimKinematics {
  RimState state;
  Vec3 acceleration = Vec3::Zero();  // m/s²
};

class RimTrajectory {
 public:
  /// At rest on `start`; start() = end() = start.
  explicit RimTrajectory(const RimState& start = {});

  /// Begins the next interval where the last one ended. Its end is `received`, extrapolated by `duration` at constant
  /// velocity and angular velocity. @pre duration > 0
  void extend(const RimState& received, double duration);
  /// Extrapolates at the acceleration of the rim's last step instead. Only a change of that acceleration makes the end
  /// differ from the rim's. A body on a spring whose forces are taken over this path, and act over the same interval,
  /// is stable for ω H below 1.2. Up to 1 it is damped by a share (ω H)³/8 of the critical damping.
  /// @pre every extension was of this kind
  void extend_accelerated(const RimState& received, double duration);

  /// @param s share of the interval. @pre 0 ≤ s ≤ 1
  RimKinematics at(double s) const;
  const RimState& start() const { return start_; }
  const RimState& end() const { return end_; }
  double duration() const { return duration_; }

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  void extend(const RimState& received, double duration, const Vec3& way, const Vec3& turn);
  friend void visit_fields(FieldsOf<RimTrajectory> auto& s, auto&& visit) {
    visit(s.start_, furrow::Field{"start", ""});
    visit(s.end_, furrow::Field{"end", ""});
    visit(s.duration_, furrow::Field{"duration", "s"});
    visit(s.turn_, furrow::Field{"turn", "rad"});
  }

  RimState start_, end_;
  double duration_ = 0.0;
  Vec3 turn_ = Vec3::Zero();  // rotation vector from start to end orientation, W, rad
};

}  // namespace furrow::tire
