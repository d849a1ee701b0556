#include "nodes/output/regressions.hpp"

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/json_number.hpp"

namespace furrow::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInch = 0.0254;          // m
constexpr double kAverageDepth = 3.47;    // cone index over its gradient, in [Mason 2016, Eq. (2)]
constexpr double kWesSlip = 0.2;          // of the net traction of wes_sand
constexpr double kLeastWesNumeric = 4.8;  // the net traction is negative below it

Traction of_load(double load, double gross, double resistance) {
  return {load * gross, load * resistance, load * (gross - resistance)};
}

/// δ/h
double relative_deflection(const SoilWheel& w) { return w.deflection == 0.0 ? 0.0 : w.deflection / w.section_height; }

struct BrixiusConstants {
  double slip_rate, rolling, soil;
};

/// C_n = CI b d/W,  B_n = C_n (1 + 5 δ/h)/(1 + 3 b/d)
/// gross/W = 0.88 (1 − e^(−0.1 B_n)) (1 − e^(−k s)) + c,  resistance/W = a/B_n + c + 0.5 s/√B_n
/// with k = 7.5, c = 0.04, a = 1 [Brixius 1987] and, radial, k = 9.5, c = 0.0325, a = 0.9 [Al-Hamed 1994]
Traction brixius(const SoilWheel& w, const BrixiusConstants& of) {
  if (!(w.slip >= 0.0)) return {};
  const double c_n = w.cone_index * w.width * w.diameter / w.load;
  const double b_n = c_n * (1.0 + 5.0 * relative_deflection(w)) / (1.0 + 3.0 * w.width / w.diameter);
  return of_load(w.load, 0.88 * (1.0 - std::exp(-0.1 * b_n)) * (1.0 - std::exp(-of.slip_rate * w.slip)) + of.rolling,
                 of.soil / b_n + of.rolling + 0.5 * w.slip / std::sqrt(b_n));
}

/// N_s = G (b d)^1.5/W δ/h [Turnage 1972], G = CI/3.47 in psi and psi/in [Mason 2016, Eq. (2)]
double wes_numeric(const SoilWheel& w) {
  const double gradient = w.cone_index / (kAverageDepth * kInch);
  return gradient * std::pow(w.width * w.diameter, 1.5) / w.load * relative_deflection(w);
}

/// CP/CI, CP = W/(2 b √(d a − a²) (b/h)^0.52), a = δ + 0.026 d [Mason 2016, Eq. (10)]
double pressure_ratio(const SoilWheel& w) {
  const double a = w.deflection + 0.026 * w.diameter;
  const double length = 2.0 * std::sqrt(w.diameter * a - a * a);
  return w.load / (w.width * length * std::pow(w.width / w.section_height, 0.52)) / w.cone_index;
}

using Reasons = std::vector<std::string>;

void expect(Reasons& reasons, const char* name, double value, double low, double high) {
  if (!std::isfinite(value))
    reasons.push_back(fmt::format("{} is not known", name));
  else if (value < low || value > high)
    reasons.push_back(fmt::format("{} is {:.3g}, expected {:g} to {:g}", name, value, low, high));
}

Reasons outside_brixius(const SoilWheel& w) {
  Reasons reasons;
  expect(reasons, "b/d", w.width / w.diameter, 0.1, 0.7);
  expect(reasons, "δ/h", relative_deflection(w), 0.1, 0.3);
  expect(reasons, "W/(b d), kN/m²", 1e-3 * w.load / (w.width * w.diameter), 15.0, 55.0);
  expect(reasons, "slip", w.slip, 0.0, 1.0);
  return reasons;
}

Reasons outside_wismer_luth(const SoilWheel& w) {
  Reasons reasons;
  expect(reasons, "b/d", w.width / w.diameter, 0.2, 0.4);
  expect(reasons, "δ/h", relative_deflection(w), 0.1, 0.3);
  expect(reasons, "slip", w.slip, 0.0, 1.0);
  return reasons;
}

Reasons outside_wes(const SoilWheel& w) {
  Reasons reasons;
  if (w.deflection == 0.0) return {"the numeric of a rigid wheel is 0"};
  expect(reasons, "δ/h", relative_deflection(w), 0.1, 0.4);
  expect(reasons, "N_s", wes_numeric(w), kLeastWesNumeric, 200.0);
  expect(reasons, "slip", w.slip, kWesSlip - 0.05, kWesSlip + 0.05);
  return reasons;
}

Reasons outside_mason(const SoilWheel& w) {
  Reasons reasons;
  expect(reasons, "CP/CI", pressure_ratio(w), 0.03, 1.0);
  expect(reasons, "slip", w.slip, -1.0, 1.0);
  return reasons;
}

struct Regression {
  const char *key, *name, *range;
  Traction (*traction)(const SoilWheel&);
  Reasons (*outside)(const SoilWheel&);
  bool of_sand;
};

constexpr const char* kBrixiusRange = "lugged tires on loam, b/d 0.1 to 0.7, δ/h 0.1 to 0.3, W/(b d) 15 to 55 kN/m²";

constexpr auto kRegressions = std::to_array<Regression>({
    {"brixius_bias", "Brixius, bias ply", kBrixiusRange, brixius_bias, outside_brixius, false},
    {"brixius_radial", "Brixius, radial", kBrixiusRange, brixius_radial, outside_brixius, false},
    {"wes_sand", "WES sand", "pneumatic tires on dry sand; the net traction at 20 % slip", wes_sand, outside_wes, true},
    {"mason", "Mason 2018", "wheels on dry sand, CP/CI 0.03 to 1", mason_sand, outside_mason, true},
    {"wismer_luth", "Wismer–Luth", "lugged tires on loam, b/d near 0.3, δ/h near 0.2", wismer_luth, outside_wismer_luth,
     false},
});

}  // namespace

Traction brixius_bias(const SoilWheel& wheel) { return brixius(wheel, {7.5, 0.04, 1.0}); }

Traction brixius_radial(const SoilWheel& wheel) { return brixius(wheel, {9.5, 0.0325, 0.9}); }

/// gross/W = 0.75 (1 − e^(−0.3 C_n s)),  resistance/W = 1.2/C_n + 0.04 [Wismer 1973]
Traction wismer_luth(const SoilWheel& w) {
  if (!(w.slip >= 0.0)) return {};
  const double c_n = w.cone_index * w.width * w.diameter / w.load;
  return of_load(w.load, 0.75 * (1.0 - std::exp(-0.3 * c_n * w.slip)), 1.2 / c_n + 0.04);
}

/// gross/W = X − X Y/(N_s + 10 + Y), X = 0.66, Y = 4.71 + 1.72/s [Mason 2016]
/// net/W = 0.53 − 4.5/(N_s + 3.7) at 20 % slip [Turnage 1972]
Traction wes_sand(const SoilWheel& w) {
  const double n_s = wes_numeric(w);
  if (!(n_s > 0.0) || !(w.slip > 0.0)) return {};
  const double x = 0.66, y = 4.71 + 1.72 / w.slip;
  return {w.load * (x - x * y / (n_s + 10.0 + y)), NAN, w.load * (0.53 - 4.5 / (n_s + 3.7))};
}

/// gross/W = −0.5 + (T + 0.5)/(1 + A e^(−7 s))^(1/C),  T = 0.42 + 0.009/r,  A = 0.76 + 0.014/r,  C = 1.56 − 0.022/r,
/// r = CP/CI [Mason 2018, Eqs. (5) to (8)]
/// resistance/W = 0.4 r + 0.6 s − 0.03 powered, 0.21 r − 0.75 s + 0.04 towed [Williams 2019, Eqs. (10), (9)]
Traction mason_sand(const SoilWheel& w) {
  const double r = pressure_ratio(w), c = 1.56 - 0.022 / r;
  if (!(c > 0.0)) return {};  // the soil is so hard that the equation has no meaning
  const double most = 0.42 + 0.009 / r, a = 0.76 + 0.014 / r;
  const double gross = -0.5 + (most + 0.5) / std::pow(1.0 + a * std::exp(-7.0 * w.slip), 1.0 / c);
  return of_load(w.load, gross, w.slip >= 0.0 ? 0.4 * r + 0.6 * w.slip - 0.03 : 0.21 * r - 0.75 * w.slip + 0.04);
}

Json regressions_json(SoilWheel wheel, const SlipZeros& slip, bool cohesive) {
  if (!std::isfinite(wheel.cone_index)) return nullptr;
  Json json{{"cone_index_Pa", wheel.cone_index}};
  for (const Regression& of : kRegressions) {
    wheel.slip = of.of_sand ? slip.free_rolling : slip.no_pull;
    Reasons reasons = of.outside(wheel);
    if (of.of_sand == cohesive) reasons.emplace_back(cohesive ? "the soil is cohesive" : "the soil is not cohesive");
    const Traction traction = of.traction(wheel);
    json[of.key] = {{"name", of.name},
                    {"gross_N", json_number(traction.gross)},
                    {"resistance_N", json_number(traction.resistance)},
                    {"net_N", json_number(traction.net)},
                    {"slip", json_number(wheel.slip)},
                    {"in_range", reasons.empty()},
                    {"out_of_range_because", reasons},
                    {"range", of.range},
                    {"scatter", nullptr}};
  }
  return json;
}

}  // namespace furrow::output
