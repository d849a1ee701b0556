#include "tire/handling/magic_formula.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kLeastFriction = 1e-6;  // of smooth ground: the formula divides by it

using std::atan;
using std::cos;
using std::sin;

double sign(double value) { return value < 0.0 ? -1.0 : 1.0; }
double square(double value) { return value * value; }

/// The argument of the sine or cosine: C atan{Bx − E(Bx − atan(Bx))}.
double curve(double b, double c, double e, double x) {
  const double bx = b * x;
  return c * atan(bx - e * (bx - atan(bx)));
}

/// B = K/(C D), zero where the curve has no height.
double steepness(double stiffness, double shape, double height) {
  const double product = shape * height;
  return product != 0.0 ? stiffness / product : 0.0;
}

/// What all parts share.
struct Terms {
  const MagicFormula& tire;
  SlipState at;
  double nominal = 0.0;    // F'_z0 = λ_Fz0 F_z0, (4.E1)
  double dfz = 0.0;        // (4.E2a)
  double tan_alpha = 0.0;  // α* (4.E3)
  double radius = 0.0;     // R_0

  Terms(const MagicFormula& mf, const SlipState& state)
      : tire(mf),
        at(state),
        nominal(mf.scaling.lfzo * mf.vertical.fnomin),
        dfz((state.load - nominal) / nominal),
        tan_alpha(std::tan(state.slip_angle)),
        radius(mf.dimension.unloaded_radius) {}
};

struct Pure {
  double force = 0.0;      // N
  double stiffness = 0.0;  // K
  double shift = 0.0;      // S_H
  double lift = 0.0;       // S_V, N
  double b = 0.0, c = 0.0, d = 0.0;
  double friction = 0.0;  // μ
};

/// (4.E9) to (4.E18)
Pure longitudinal(const Terms& t) {
  const auto& p = t.tire.longitudinal;
  const auto& l = t.tire.scaling;
  const double gamma = l.lgax * t.at.camber;
  Pure x;
  x.c = p.pcx1 * l.lcx;                                                                    // (4.E11)
  x.friction = (p.pdx1 + p.pdx2 * t.dfz) * (1.0 - p.pdx3 * square(gamma)) * l.lmux;        // (4.E13)
  x.d = x.friction * t.at.load;                                                            // (4.E12)
  x.stiffness = t.at.load * (p.pkx1 + p.pkx2 * t.dfz) * std::exp(p.pkx3 * t.dfz) * l.lkx;  // (4.E15)
  x.b = steepness(x.stiffness, x.c, x.d);                                                  // (4.E16)
  x.shift = (p.phx1 + p.phx2 * t.dfz) * l.lhx;                                             // (4.E17)
  x.lift = t.at.load * (p.pvx1 + p.pvx2 * t.dfz) * l.lvx * l.lmux;                         // (4.E18)
  const double kappa = t.at.slip + x.shift;                                                // (4.E10)
  const double e = std::min(
      1.0, (p.pex1 + p.pex2 * t.dfz + p.pex3 * square(t.dfz)) * (1.0 - p.pex4 * sign(kappa)) * l.lex);  // (4.E14)
  x.force = x.d * sin(curve(x.b, x.c, e, kappa)) + x.lift;                                              // (4.E9)
  return x;
}

/// (4.E19) to (4.E29), camber as in version 5.2
Pure lateral(const Terms& t, double camber) {
  const auto& p = t.tire.lateral;
  const auto& l = t.tire.scaling;
  const double gamma = l.lgay * camber, load = t.at.load;
  Pure y;
  y.c = p.pcy1 * l.lcy;                                                              // (4.E21)
  y.friction = (p.pdy1 + p.pdy2 * t.dfz) * (1.0 - p.pdy3 * square(gamma)) * l.lmuy;  // (4.E23)
  y.d = y.friction * load;                                                           // (4.E22)
  y.stiffness = p.pky1 * t.tire.vertical.fnomin * sin(2.0 * atan(load / (p.pky2 * t.nominal))) *
                (1.0 - p.pky3 * std::abs(gamma)) * l.lfzo * l.lky;                                   // (4.E25)
  y.b = steepness(y.stiffness, y.c, y.d);                                                            // (4.E26)
  y.shift = (p.phy1 + p.phy2 * t.dfz) * l.lhy + p.phy3 * gamma;                                      // (4.E27)
  y.lift = load * ((p.pvy1 + p.pvy2 * t.dfz) * l.lvy + (p.pvy3 + p.pvy4 * t.dfz) * gamma) * l.lmuy;  // (4.E29)
  const double alpha = t.tan_alpha + y.shift;                                                        // (4.E20)
  const double e =
      std::min(1.0, (p.pey1 + p.pey2 * t.dfz) * (1.0 - (p.pey3 + p.pey4 * gamma) * sign(alpha)) * l.ley);  // (4.E24)
  y.force = y.d * sin(curve(y.b, y.c, e, alpha)) + y.lift;                                                 // (4.E19)
  return y;
}

/// A weighting function of combined slip: cos[curve(x + shift)]/cos[curve(shift)].
double weight(double b, double c, double e, double x, double shift) {
  const double at_zero = cos(curve(b, c, e, shift));
  return at_zero != 0.0 ? cos(curve(b, c, e, x + shift)) / at_zero : 0.0;
}

/// (4.E50) to (4.E57)
double combined_longitudinal(const Terms& t, const Pure& x) {
  const auto& p = t.tire.longitudinal;
  const double b = p.rbx1 * cos(atan(p.rbx2 * t.at.slip)) * t.tire.scaling.lxal;  // (4.E54)
  const double e = std::min(1.0, p.rex1 + p.rex2 * t.dfz);                        // (4.E56)
  return x.force * std::max(0.0, weight(b, p.rcx1, e, t.tan_alpha, p.rhx1));      // (4.E50) to (4.E53)
}

struct Combined {
  double force = 0.0;  // F_y, N
  double lift = 0.0;   // S_Vyκ, N
};

/// (4.E58) to (4.E67)
Combined combined_lateral(const Terms& t, const Pure& y) {
  const auto& p = t.tire.lateral;
  const auto& l = t.tire.scaling;
  const double gamma = l.lgay * t.at.camber;
  const double b = p.rby1 * cos(atan(p.rby2 * (t.tan_alpha - p.rby3))) * l.lyka;  // (4.E62)
  const double e = std::min(1.0, p.rey1 + p.rey2 * t.dfz);                        // (4.E64)
  const double shift = p.rhy1 + p.rhy2 * t.dfz;                                   // (4.E65)
  const double height =
      y.friction * t.at.load * (p.rvy1 + p.rvy2 * t.dfz + p.rvy3 * gamma) * cos(atan(p.rvy4 * t.tan_alpha));  // (4.E67)
  Combined out;
  out.lift = height * sin(p.rvy5 * atan(p.rvy6 * t.at.slip)) * l.lvyka;                    // (4.E66)
  out.force = y.force * std::max(0.0, weight(b, p.rcy1, e, t.at.slip, shift)) + out.lift;  // (4.E58) to (4.E61)
  return out;
}

/// (4.E71) to (4.E78), with (4.E33) to (4.E47)
double aligning(const Terms& t, const Pure& x, const Pure& y, double fx, const Combined& side) {
  const auto& q = t.tire.aligning;
  const auto& l = t.tire.scaling;
  const double gamma = l.lgaz * t.at.camber, load = t.at.load;
  const double stiffness = l.lky / l.lmuy;
  const double cos_alpha = cos(t.at.slip_angle);
  const double longitudinal_slip = y.stiffness != 0.0 ? square(x.stiffness / y.stiffness) * square(t.at.slip) : 0.0;
  const auto equivalent = [&](double alpha) {  // (4.E77), (4.E78)
    return std::sqrt(square(alpha) + longitudinal_slip) * sign(alpha);
  };
  const double alpha_t = equivalent(t.tan_alpha + q.qhz1 + q.qhz2 * t.dfz + (q.qhz3 + q.qhz4 * t.dfz) * gamma);
  const double bt = (q.qbz1 + q.qbz2 * t.dfz + q.qbz3 * square(t.dfz)) *
                    (1.0 + q.qbz4 * gamma + q.qbz5 * std::abs(gamma)) * stiffness;  // (4.E40)
  const double ct = q.qcz1;                                                         // (4.E41)
  const double dt = load * (q.qdz1 + q.qdz2 * t.dfz) * (1.0 + q.qdz3 * gamma + q.qdz4 * square(gamma)) *
                    (t.radius / t.tire.vertical.fnomin) * l.ltr;  // (4.E42), (4.E43)
  const double et = std::min(
      1.0, (q.qez1 + q.qez2 * t.dfz + q.qez3 * square(t.dfz)) *
               (1.0 + (q.qez4 + q.qez5 * gamma) * 2.0 / std::numbers::pi * atan(bt * ct * alpha_t)));  // (4.E44)
  const double trail = dt * cos(curve(bt, ct, et, alpha_t)) * cos_alpha;                               // (4.E73)

  const double shift = y.shift + (y.stiffness != 0.0 ? y.lift / y.stiffness : 0.0);  // (4.E38)
  const double alpha_r = equivalent(t.tan_alpha + shift);
  const double br = q.qbz9 * stiffness + q.qbz10 * y.b * y.c;  // (4.E45)
  const double dr =
      load * ((q.qdz6 + q.qdz7 * t.dfz) * l.lres + (q.qdz8 + q.qdz9 * t.dfz) * gamma) * t.radius * l.lmuy;  // (4.E47)
  const double residual = dr * cos(atan(br * alpha_r)) * cos_alpha;  // (4.E75), C_r = 1
  const double arm = t.radius *
                     (q.ssz1 + q.ssz2 * side.force / t.tire.vertical.fnomin + (q.ssz3 + q.ssz4 * t.dfz) * gamma) *
                     l.ls;                                         // (4.E76)
  return -trail * (side.force - side.lift) + residual + arm * fx;  // (4.E71), (4.E72), (4.E74)
}

}  // namespace

HandlingForces evaluate_formula(const MagicFormula& tire, const SlipState& state) {
  FURROW_ASSERT(state.load > 0.0, state.load);
  const Terms t(tire, state);
  const auto& l = tire.scaling;
  const Pure x = longitudinal(t), y = lateral(t, state.camber);
  HandlingForces f;
  f.fz = state.load;
  f.slip_stiffness = x.stiffness;
  f.cornering_stiffness = y.stiffness;
  f.fx = combined_longitudinal(t, x);
  const Combined side = combined_lateral(t, y);
  f.fy = side.force;
  const double fz0 = tire.vertical.fnomin;
  f.mx = state.load * t.radius *
         (tire.overturning.qsx1 * l.lvmx +
          (-tire.overturning.qsx2 * state.camber + tire.overturning.qsx3 * f.fy / fz0) * l.lmx);  // (4.E69)
  const auto& r = tire.rolling;
  const double speed = tire.reference_speed > 0.0 ? state.speed / tire.reference_speed : 0.0;
  f.my = -state.load * t.radius *
         (r.qsy1 + r.qsy2 * f.fx / fz0 + r.qsy3 * std::abs(speed) + r.qsy4 * square(square(speed))) * l.lmy;  // (4.E70)
  f.mz = aligning(t, x, y, f.fx, side);
  return f;
}

HandlingForces evaluate(const MagicFormula& tire, const SlipState& state) {
  FURROW_ASSERT(std::isfinite(state.load + state.slip + state.slip_angle + state.camber + state.speed), state.load,
                state.slip, state.slip_angle);
  if (!(state.load > 0.0)) return {};
  const auto held = [](double value, const Range& range) { return std::clamp(value, range.least, range.most); };
  SlipState at = state;
  at.load = held(state.load, tire.load);
  at.slip = held(state.slip, tire.slip);
  at.slip_angle = held(state.slip_angle, tire.slip_angle);
  at.camber = held(state.camber, tire.camber);
  HandlingForces f = evaluate_formula(tire, at);
  const double share = state.load / at.load;
  if (share != 1.0)
    for (double* value : {&f.fx, &f.fy, &f.fz, &f.mx, &f.my, &f.mz, &f.slip_stiffness, &f.cornering_stiffness})
      *value *= share;
  return f;
}

RelaxationLengths relaxation_lengths(const MagicFormula& tire, double load, double camber) {
  FURROW_ASSERT(load >= 0.0, load);
  const auto& l = tire.scaling;
  const auto& x = tire.longitudinal;
  const auto& y = tire.lateral;
  const double fz0 = tire.vertical.fnomin, nominal = l.lfzo * fz0, dfz = (load - nominal) / nominal,
               radius = tire.dimension.unloaded_radius;
  RelaxationLengths s;
  s.longitudinal = load * (x.ptx1 + x.ptx2 * dfz) * std::exp(-x.ptx3 * dfz) * (radius / fz0) * l.lsgkp;
  if (y.pty2 != 0.0)
    s.lateral = y.pty1 * sin(2.0 * atan(load / (y.pty2 * nominal))) * (1.0 - y.pky3 * std::abs(l.lgay * camber)) *
                radius * l.lfzo * l.lsgal;
  s.longitudinal = std::max(0.0, s.longitudinal);
  s.lateral = std::max(0.0, s.lateral);
  return s;
}

MagicFormula on_ground_of(MagicFormula tire, double friction) {
  FURROW_ASSERT(friction >= 0.0, friction);
  const double most = std::max(friction, kLeastFriction);
  const auto hold = [&](double& factor, double peak) { factor = std::min(factor, most / std::abs(peak)); };
  hold(tire.scaling.lmux, tire.longitudinal.pdx1);
  hold(tire.scaling.lmuy, tire.lateral.pdy1);
  return tire;
}

double rolling_radius(const MagicFormula& tire, double deflection) {
  const auto& v = tire.vertical;
  const double nominal = v.fnomin / v.vertical_stiffness, depth = deflection / nominal;
  return tire.dimension.unloaded_radius - nominal * (v.dreff * atan(v.breff * depth) + v.freff * depth);
}

}  // namespace furrow::tire::handling
