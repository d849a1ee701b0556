#include "tire/handling/tydex.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace furrow::tire::handling {
namespace {

struct Channel {
  const char *name, *what, *unit;
  double (*value)(const SweepPoint& point);
};

constexpr auto kChannels = std::to_array<Channel>({
    {"MEASNUMB", "Measurement point number", "-", nullptr},
    {"LONGSLIP", "Longitudinal slip", "-", [](const SweepPoint& p) { return p.state.slip; }},
    {"SLIPANGL", "Slip angle", "rad", [](const SweepPoint& p) { return p.state.slip_angle; }},
    {"INCLANGL", "Inclination angle", "rad", [](const SweepPoint& p) { return p.state.camber; }},
    {"FZW", "Vertical force, W-axis", "N", [](const SweepPoint& p) { return p.forces.fz; }},
    {"FXW", "Longitudinal force, W-axis", "N", [](const SweepPoint& p) { return p.forces.fx; }},
    {"FYW", "Lateral force, W-axis", "N", [](const SweepPoint& p) { return p.forces.fy; }},
    {"MXW", "Overturning moment, W-axis", "Nm", [](const SweepPoint& p) { return p.forces.mx; }},
    {"MYW", "Rolling moment, W-axis", "Nm", [](const SweepPoint& p) { return p.forces.my; }},
    {"MZW", "Aligning moment, W-axis", "Nm", [](const SweepPoint& p) { return p.forces.mz; }},
    {"DSTGRWHC", "Distance ground wheel centre", "m",
     [](const SweepPoint& p) { return p.loaded_radius * std::cos(p.state.camber); }},
});

}  // namespace

std::string tydex_text(const std::string& name, const MagicFormula& tire, std::span<const SweepPoint> points,
                       const std::vector<std::string>& comments) {
  std::string out = "**HEADER\n";
  const auto line = [&out](const char* key, const char* what, const char* unit, const std::string& value) {
    out += fmt::format("{:<10}{:<30}{:<10}{}\n", key, what, unit, value);
  };
  line("RELEASE", "Release of TYDEX-Format", "", "1.3");
  line("MEASID", "Measurement ID", "", name);
  line("SUPPLIER", "Data supplier", "", "furrow");
  out += "**COMMENTS\n";
  for (const std::string& comment : comments) out += comment + "\n";
  out += "**CONSTANTS\n";
  line("NOMWIDTH", "Nominal section width of tyre", "m", fmt::format("{:g}", tire.dimension.width));
  line("RIMRADIU", "Rim radius", "m", fmt::format("{:g}", tire.dimension.rim_radius));
  out += "**MEASURCHANNELS\n";
  for (const Channel& channel : kChannels)
    out += fmt::format("{:<10}{:<30}{:<10}{:<10}{:<10}{:<10}\n", channel.name, channel.what, channel.unit, 1, 0, 0);
  out += "**MEASURDATA\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    out += fmt::format("{:<6}", k + 1);
    for (const Channel& channel : kChannels)
      if (channel.value) out += fmt::format(" {:>13.6g}", channel.value(points[k]));
    out += "\n";
  }
  return out + "**END\n";
}

}  // namespace furrow::tire::handling
