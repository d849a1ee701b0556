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
  double dpi = 0.0;        // (4.E2b)
  double tan_alpha = 0.0;  // α* (4.E3)
  double radius = 0.0;     // R_0

  Terms(const MagicFormula& mf, const SlipState& state)
      : tire(mf),
        at(state),
        nominal(mf.scaling.lfzo * mf.vertical.fnomin),
        dfz((state.load - nominal) / nominal),
        dpi(pressure_change(mf)),
        tan_alpha(std::tan(state.slip_angle)),
        radius(mf.dimension.unloaded_radius) {}

  /// γ*, (4.E4)
  double lean(double camber) const { return tire.version61 ? sin(camber) : camber; }
  double pressure(double first, double second) const { return 1.0 + first * dpi + second * square(dpi); }
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
  x.c = p.pcx1 * l.lcx;  // (4.E11)
  x.friction =
      (p.pdx1 + p.pdx2 * t.dfz) * t.pressure(p.ppx3, p.ppx4) * (1.0 - p.pdx3 * square(gamma)) * l.lmux;  // (4.E13)
  x.d = x.friction * t.at.load;                                                                          // (4.E12)
  x.stiffness =
      t.at.load * (p.pkx1 + p.pkx2 * t.dfz) * std::exp(p.pkx3 * t.dfz) * t.pressure(p.ppx1, p.ppx2) * l.lkx;  // (4.E15)
  x.b = steepness(x.stiffness, x.c, x.d);                                                                     // (4.E16)
  x.shift = (p.phx1 + p.phx2 * t.dfz) * l.lhx;                                                                // (4.E17)
  x.lift = t.at.load * (p.pvx1 + p.pvx2 * t.dfz) * l.lvx * l.lmux;                                            // (4.E18)
  const double kappa = t.at.slip + x.shift;                                                                   // (4.E10)
  const double e = std::min(
      1.0, (p.pex1 + p.pex2 * t.dfz + p.pex3 * square(t.dfz)) * (1.0 - p.pex4 * sign(kappa)) * l.lex);  // (4.E14)
  x.force = x.d * sin(curve(x.b, x.c, e, kappa)) + x.lift;                                              // (4.E9)
  return x;
}

/// (4.E19) to (4.E30)
Pure lateral(const Terms& t, double camber) {
  const auto& p = t.tire.lateral;
  const auto& l = t.tire.scaling;
  const double gamma = t.lean(l.lgay * camber), load = t.at.load;
  Pure y;
  y.c = p.pcy1 * l.lcy;  // (4.E21)
  y.friction =
      (p.pdy1 + p.pdy2 * t.dfz) * t.pressure(p.ppy3, p.ppy4) * (1.0 - p.pdy3 * square(gamma)) * l.lmuy;  // (4.E23)
  y.d = y.friction * load;                                                                               // (4.E22)
  const double at_peak = (p.pky2 + p.pky5 * square(gamma)) * t.pressure(p.ppy2, 0.0);
  y.stiffness = p.pky1 * t.tire.vertical.fnomin * t.pressure(p.ppy1, 0.0) *
                sin(p.pky4 * atan(load / (at_peak * t.nominal))) * (1.0 - p.pky3 * std::abs(gamma)) * l.lfzo *
                l.lky;                     // (4.E25)
  y.b = steepness(y.stiffness, y.c, y.d);  // (4.E26)
  const double by_lean = (p.pvy3 + p.pvy4 * t.dfz) * gamma * l.lkyc;
  y.lift = load * ((p.pvy1 + p.pvy2 * t.dfz) * l.lvy + by_lean) * l.lmuy;  // (4.E28), (4.E29)
  y.shift = (p.phy1 + p.phy2 * t.dfz) * l.lhy;                             // (4.E27)
  if (!t.tire.version61)
    y.shift += p.phy3 * gamma * l.lkyc;
  else if (y.stiffness != 0.0) {
    const double by_camber = load * (p.pky6 + p.pky7 * t.dfz) * t.pressure(p.ppy5, 0.0) * l.lkyc;  // (4.E30)
    y.shift += (by_camber * gamma - load * by_lean * l.lmuy) / y.stiffness;
  }
  const double alpha = t.tan_alpha + y.shift;  // (4.E20)
  const double e =
      std::min(1.0, (p.pey1 + p.pey2 * t.dfz) *
                        (1.0 + p.pey5 * square(gamma) - (p.pey3 + p.pey4 * gamma) * sign(alpha)) * l.ley);  // (4.E24)
  y.force = y.d * sin(curve(y.b, y.c, e, alpha)) + y.lift;                                                  // (4.E19)
  return y;
}

/// A weighting function of combined slip: cos[curve(x + shift)]/cos[curve(shift)].
double weight(double b, double c, double e, double x, double shift) {
  const double at_zero = cos(curve(b, c, e, shift));
  return at_zero != 0.0 ? cos(curve(b, c, e, x + shift)) / at_zero : 0.0;
}

/// How much of a pure force is left under the friction ellipse. @param slip its own, @param other the other one
/// @param force in units of the other's peak
double on_ellipse(double slip, double other, double force) {
  const double all = std::hypot(slip, other * force);
  return all > 0.0 ? std::abs(slip) / all : 1.0;
}

/// The slips of the ellipse: 0 where the pure forces are, nearly.
struct Sliding {
  double along = 0.0, across = 0.0;
  Sliding(const Terms& t, const Pure& x, const Pure& y)
      : along(t.at.slip + x.shift + (x.stiffness != 0.0 ? x.lift / x.stiffness : 0.0)),
        across(sin(t.at.slip_angle + y.shift + (y.stiffness != 0.0 ? y.lift / y.stiffness : 0.0))) {}
};

/// (4.E50) to (4.E57)
double combined_longitudinal(const Terms& t, const Pure& x, const Pure& y) {
  const auto& p = t.tire.longitudinal;
  if (ellipse_along(t.tire)) {
    const Sliding slide(t, x, y);
    return y.d != 0.0 ? x.force * on_ellipse(slide.along, slide.across, (x.force - x.lift) / y.d) : x.force;
  }
  const double gamma = t.lean(t.at.camber);
  const double b = (p.rbx1 + p.rbx3 * square(gamma)) * cos(atan(p.rbx2 * t.at.slip)) * t.tire.scaling.lxal;  // (4.E54)
  const double e = std::min(1.0, p.rex1 + p.rex2 * t.dfz);                                                   // (4.E56)
  return x.force * std::max(0.0, weight(b, p.rcx1, e, t.tan_alpha, p.rhx1));  // (4.E50) to (4.E53)
}

struct Combined {
  double force = 0.0;  // F_y, N
  double lift = 0.0;   // S_Vyκ, N
  double share = 1.0;  // G_yκ
};

/// (4.E58) to (4.E67)
Combined combined_lateral(const Terms& t, const Pure& x, const Pure& y) {
  const auto& p = t.tire.lateral;
  const auto& l = t.tire.scaling;
  const double gamma = t.lean(l.lgay * t.at.camber);
  Combined out;
  if (ellipse_across(t.tire)) {
    const Sliding slide(t, x, y);
    if (x.d != 0.0) out.share = on_ellipse(slide.across, slide.along, (y.force - y.lift) / x.d);
  } else {
    const double b =
        (p.rby1 + p.rby4 * square(gamma)) * cos(atan(p.rby2 * (t.tan_alpha - p.rby3))) * l.lyka;  // (4.E62)
    const double e = std::min(1.0, p.rey1 + p.rey2 * t.dfz);                                      // (4.E64)
    const double shift = p.rhy1 + p.rhy2 * t.dfz;                                                 // (4.E65)
    out.share = std::max(0.0, weight(b, p.rcy1, e, t.at.slip, shift));
  }
  const double height =
      y.friction * t.at.load * (p.rvy1 + p.rvy2 * t.dfz + p.rvy3 * gamma) * cos(atan(p.rvy4 * t.tan_alpha));  // (4.E67)
  out.lift = height * sin(p.rvy5 * atan(p.rvy6 * t.at.slip)) * l.lvyka;                                       // (4.E66)
  out.force = y.force * out.share + out.lift;  // (4.E58) to (4.E61)
  return out;
}

/// (4.E71) to (4.E78), with (4.E33) to (4.E47); B_t, D_t and the arm of F_x as in [3]
double aligning(const Terms& t, const Pure& x, const Pure& y, double fx, const Combined& side) {
  const auto& q = t.tire.aligning;
  const auto& l = t.tire.scaling;
  const double gamma = t.lean(l.lgaz * t.at.camber), load = t.at.load;
  const double stiffness = l.lky / l.lmuy;
  const double cos_alpha = cos(t.at.slip_angle);
  const double longitudinal_slip = y.stiffness != 0.0 ? square(x.stiffness / y.stiffness) * square(t.at.slip) : 0.0;
  const auto equivalent = [&](double alpha) {  // (4.E77), (4.E78)
    return std::sqrt(square(alpha) + longitudinal_slip) * sign(alpha);
  };
  const double alpha_t = t.tan_alpha + q.qhz1 + q.qhz2 * t.dfz + (q.qhz3 + q.qhz4 * t.dfz) * gamma;  // (4.E34), (4.E35)
  const double bt = (q.qbz1 + q.qbz2 * t.dfz + q.qbz3 * square(t.dfz)) *
                    (1.0 + q.qbz4 * gamma + q.qbz5 * std::abs(gamma)) * stiffness;  // (4.E40)
  const double ct = q.qcz1;                                                         // (4.E41)
  const double dt = load * (q.qdz1 + q.qdz2 * t.dfz) * t.pressure(-q.ppz1, 0.0) *
                    (1.0 + q.qdz3 * gamma + q.qdz4 * square(gamma)) * (t.radius / t.nominal) *
                    l.ltr;  // (4.E42), (4.E43)
  const double et = std::min(
      1.0, (q.qez1 + q.qez2 * t.dfz + q.qez3 * square(t.dfz)) *
               (1.0 + (q.qez4 + q.qez5 * gamma) * 2.0 / std::numbers::pi * atan(bt * ct * alpha_t)));  // (4.E44)
  const double trail = dt * cos(curve(bt, ct, et, equivalent(alpha_t))) * cos_alpha;                   // (4.E73)

  const double shift = y.shift + (y.stiffness != 0.0 ? y.lift / y.stiffness : 0.0);  // (4.E38)
  const double alpha_r = equivalent(t.tan_alpha + shift);
  const double br = q.qbz9 * stiffness + q.qbz10 * y.b * y.c;  // (4.E45)
  const double by_camber =
      (q.qdz8 + q.qdz9 * t.dfz) * t.pressure(q.ppz2, 0.0) + (q.qdz10 + q.qdz11 * t.dfz) * std::abs(gamma);
  const double dr =
      load * ((q.qdz6 + q.qdz7 * t.dfz) * l.lres + by_camber * gamma * l.lkzc) * t.radius * l.lmuy;  // (4.E47)
  const double residual = dr * cos(atan(br * alpha_r)) * cos_alpha;                                  // (4.E75), C_r = 1
  const double arm =
      t.radius * (q.ssz1 + q.ssz2 * side.force / t.nominal + (q.ssz3 + q.ssz4 * t.dfz) * gamma) * l.ls;  // (4.E76)
  const double pulled = t.tire.version61 ? side.share * lateral(t, 0.0).force : side.force - side.lift;  // (4.E74)
  return -trail * pulled + residual + arm * fx;  // (4.E71), (4.E72)
}

/// (4.E69), with QSX6 as [3] has it
double overturning(const Terms& t, double fy) {
  const auto& q = t.tire.overturning;
  const auto& l = t.tire.scaling;
  const double gamma = t.at.camber, load = t.at.load / t.tire.vertical.fnomin, side = fy / t.tire.vertical.fnomin;
  const double turned =
      -q.qsx2 * gamma * t.pressure(q.ppmx1, 0.0) + q.qsx3 * side +
      q.qsx4 * cos(q.qsx5 * atan(square(q.qsx6 * load))) * sin(q.qsx7 * gamma + q.qsx8 * atan(q.qsx9 * side)) +
      q.qsx10 * atan(q.qsx11 * load) * gamma - q.qsx12 * gamma * std::abs(gamma);
  const double lift = q.qsx1 * l.lvmx * (t.tire.version61 ? l.lmx : 1.0);
  return t.radius * (t.at.load * (lift + turned * l.lmx) + fy * (q.qsx13 + q.qsx14 * std::abs(gamma)) * l.lmx);
}

/// (4.E70)
double rolling(const Terms& t, double fx) {
  const auto& r = t.tire.rolling;
  const double fz0 = t.tire.vertical.fnomin, load = t.at.load / fz0;
  const double speed = t.tire.reference_speed > 0.0 ? t.at.speed / t.tire.reference_speed : 0.0;
  const double scale =
      std::pow(load, r.qsy7) * std::pow(std::max(0.0, 1.0 + t.dpi), r.qsy8) * (t.tire.version61 ? 1.0 : load);
  return -fz0 * t.radius *
         (r.qsy1 + r.qsy2 * fx / fz0 + r.qsy3 * std::abs(speed) + r.qsy4 * square(square(speed)) +
          (r.qsy5 + r.qsy6 * load) * square(t.at.camber)) *
         scale * t.tire.scaling.lmy;
}

/// Of the spring of the file: F = stiffness ρ + growth ρ².
std::pair<double, double> quadratic_spring(const MagicFormula& tire) {
  const auto& v = tire.vertical;
  const double radius = tire.dimension.unloaded_radius,
               scale = tire.scaling.lcz * (1.0 + v.pfz1 * pressure_change(tire));
  if (v.q_fz1 == 0.0 && v.q_fz2 == 0.0) return {scale * v.vertical_stiffness, 0.0};
  const double first = v.q_fz1 > 0.0
                           ? v.q_fz1
                           : std::sqrt(std::max(0.0, square(v.vertical_stiffness * radius / v.fnomin) - 4.0 * v.q_fz2));
  return {scale * v.fnomin * first / radius, scale * v.fnomin * v.q_fz2 / square(radius)};
}

/// The piece of the curve that holds at the deflection, the last one beyond it. @return index of its end
std::size_t piece_of(const std::vector<std::pair<double, double>>& curve, double deflection) {
  std::size_t end = 1;
  while (end + 1 < curve.size() && curve[end].first < deflection) ++end;
  return end;
}

double slope_of(const std::vector<std::pair<double, double>>& curve, std::size_t end) {
  return (curve[end].second - curve[end - 1].second) / (curve[end].first - curve[end - 1].first);
}

}  // namespace

HandlingForces evaluate_formula(const MagicFormula& tire, const SlipState& state) {
  FURROW_ASSERT(state.load > 0.0, state.load);
  const Terms t(tire, state);
  const Pure x = longitudinal(t), y = lateral(t, state.camber);
  HandlingForces f;
  f.fz = state.load;
  f.slip_stiffness = x.stiffness;
  f.cornering_stiffness = y.stiffness;
  f.fx = combined_longitudinal(t, x, y);
  const Combined side = combined_lateral(t, x, y);
  f.fy = side.force;
  f.mx = overturning(t, f.fy);
  f.my = rolling(t, f.fx);
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
  if (const auto& c = tire.structural; tire.version61 && c.longitudinal_stiffness > 0.0 && c.lateral_stiffness > 0.0) {
    const Terms t(tire, {.load = load, .camber = camber});
    const auto carcass = [&](double stiffness, double first, double second, double pressure) {
      return stiffness * (1.0 + first * dfz + second * square(dfz)) * (1.0 + pressure * t.dpi);
    };
    s.longitudinal = longitudinal(t).stiffness / carcass(c.longitudinal_stiffness, c.pcfx1, c.pcfx2, c.pcfx3);
    s.lateral = std::abs(lateral(t, camber).stiffness) / carcass(c.lateral_stiffness, c.pcfy1, c.pcfy2, c.pcfy3);
    s.longitudinal = std::max(0.0, s.longitudinal) * l.lsgkp;
    s.lateral = std::max(0.0, s.lateral) * l.lsgal;
    return s;
  }
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
  const Terms t(tire, {});
  hold(tire.scaling.lmux, tire.longitudinal.pdx1 * t.pressure(tire.longitudinal.ppx3, tire.longitudinal.ppx4));
  hold(tire.scaling.lmuy, tire.lateral.pdy1 * t.pressure(tire.lateral.ppy3, tire.lateral.ppy4));
  return tire;
}

double pressure_change(const MagicFormula& tire) {
  const OperatingConditions& c = tire.conditions;
  return c.inflpres > 0.0 && c.nompres > 0.0 ? c.inflpres / (tire.scaling.lip * c.nompres) - 1.0 : 0.0;
}

bool ellipse_along(const MagicFormula& tire) {
  return tire.friction_ellipse || tire.longitudinal.rbx1 == 0.0 || tire.longitudinal.rcx1 == 0.0;
}
bool ellipse_across(const MagicFormula& tire) {
  return tire.friction_ellipse || tire.lateral.rby1 == 0.0 || tire.lateral.rcy1 == 0.0;
}

double spring_force(const MagicFormula& tire, double deflection) {
  if (!(deflection > 0.0)) return 0.0;
  if (const auto& curve = tire.load_curve; !curve.empty()) {
    const std::size_t end = piece_of(curve, deflection);
    return tire.scaling.lcz * (curve[end].second + slope_of(curve, end) * (deflection - curve[end].first));
  }
  const auto [stiffness, growth] = quadratic_spring(tire);
  return (stiffness + growth * deflection) * deflection;
}

double spring_energy(const MagicFormula& tire, double deflection) {
  if (!(deflection > 0.0)) return 0.0;
  if (const auto& curve = tire.load_curve; !curve.empty()) {
    double energy = 0.0;
    const std::size_t last = piece_of(curve, deflection);
    for (std::size_t end = 1; end <= last; ++end) {
      const double to = end == last ? deflection : curve[end].first, from = curve[end - 1].first;
      energy += (curve[end - 1].second + 0.5 * slope_of(curve, end) * (to - from)) * (to - from);
    }
    return tire.scaling.lcz * energy;
  }
  const auto [stiffness, growth] = quadratic_spring(tire);
  return (0.5 * stiffness + growth * deflection / 3.0) * square(deflection);
}

double spring_deflection(const MagicFormula& tire, double load) {
  FURROW_ASSERT(load >= 0.0, load);
  if (const auto& curve = tire.load_curve; !curve.empty()) {
    std::size_t end = 1;
    while (end + 1 < curve.size() && tire.scaling.lcz * curve[end].second < load) ++end;
    return curve[end].first + (load / tire.scaling.lcz - curve[end].second) / slope_of(curve, end);
  }
  const auto [stiffness, growth] = quadratic_spring(tire);
  return growth == 0.0 ? load / stiffness
                       : 2.0 * load / (stiffness + std::sqrt(std::max(0.0, square(stiffness) + 4.0 * growth * load)));
}

double contact_length(const MagicFormula& tire) {
  const double radius = tire.dimension.unloaded_radius;
  const double loaded = std::max(0.0, radius - spring_deflection(tire, tire.vertical.fnomin));
  return 2.0 * std::sqrt(radius * radius - loaded * loaded);
}

double spring_stiffness(const MagicFormula& tire, double load) {
  const double deflection = spring_deflection(tire, load);
  if (const auto& curve = tire.load_curve; !curve.empty())
    return tire.scaling.lcz * slope_of(curve, piece_of(curve, deflection));
  const auto [stiffness, growth] = quadratic_spring(tire);
  return stiffness + 2.0 * growth * deflection;
}

double rolling_radius(const MagicFormula& tire, double deflection) {
  const auto& v = tire.vertical;
  const double nominal = v.fnomin / (v.vertical_stiffness * tire.scaling.lcz),
               depth = tire.version61 ? spring_force(tire, deflection) / v.fnomin : deflection / nominal;
  return tire.dimension.unloaded_radius - nominal * (v.dreff * atan(v.breff * depth) + v.freff * depth);
}

}  // namespace furrow::tire::handling
