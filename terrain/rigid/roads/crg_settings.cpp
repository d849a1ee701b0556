#include "terrain/rigid/roads/crg_settings.hpp"

#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::terrain {
namespace {

constexpr double kAny = std::numeric_limits<double>::quiet_NaN();

struct Setting {
  std::string_view name;
  double only = kAny;    // the only value that is read; kAny: every one
  const char* why = "";  // no other is
};

constexpr auto kParameters =
    std::to_array<Setting>({{"REFERENCE_LINE_START_U"},   {"REFERENCE_LINE_START_X"},   {"REFERENCE_LINE_START_Y"},
                            {"REFERENCE_LINE_START_Z"},   {"REFERENCE_LINE_START_PHI"}, {"REFERENCE_LINE_START_B"},
                            {"REFERENCE_LINE_START_S"},   {"REFERENCE_LINE_START_LON"}, {"REFERENCE_LINE_START_LAT"},
                            {"REFERENCE_LINE_START_ALT"}, {"REFERENCE_LINE_END_U"},     {"REFERENCE_LINE_END_X"},
                            {"REFERENCE_LINE_END_Y"},     {"REFERENCE_LINE_END_Z"},     {"REFERENCE_LINE_END_PHI"},
                            {"REFERENCE_LINE_END_B"},     {"REFERENCE_LINE_END_S"},     {"REFERENCE_LINE_END_LON"},
                            {"REFERENCE_LINE_END_LAT"},   {"REFERENCE_LINE_END_ALT"},   {"REFERENCE_LINE_OFFSET_X"},
                            {"REFERENCE_LINE_OFFSET_Y"},  {"REFERENCE_LINE_OFFSET_Z"},  {"REFERENCE_LINE_OFFSET_PHI"},
                            {"REFERENCE_LINE_INCREMENT"}, {"LONG_SECTION_V_RIGHT"},     {"LONG_SECTION_V_LEFT"},
                            {"LONG_SECTION_V_INCREMENT"}});

constexpr const char* kGoesOn = "the road goes on with its last height";
constexpr auto kOptions = std::to_array<Setting>({{"BORDER_MODE_U", 2, kGoesOn},
                                                  {"BORDER_OFFSET_U", 0, kGoesOn},
                                                  {"BORDER_MODE_V", 2, kGoesOn},
                                                  {"BORDER_OFFSET_V", 0, kGoesOn},
                                                  {"BORDER_SMOOTH_UBEG", 0, "the heights are taken as they are"},
                                                  {"BORDER_SMOOTH_UEND", 0, "the heights are taken as they are"},
                                                  {"REFLINE_CONTINUATION"},
                                                  {"REFLINE_SEARCH_FAR"},
                                                  {"REFLINE_SEARCH_CLOSE"},
                                                  {"REFLINE_SEARCH_U"},
                                                  {"REFLINE_SEARCH_UFRAC"},
                                                  {"WARN_MSGS"},
                                                  {"WARN_CURV_LOCAL"},
                                                  {"WARN_CURV_GLOBAL"},
                                                  {"LOG_MSGS"},
                                                  {"LOG_EVAL"},
                                                  {"LOG_EVAL_FREQ"},
                                                  {"LOG_HIST"},
                                                  {"LOG_HIST_FREQ"},
                                                  {"LOG_STAT"},
                                                  {"LOG_STAT_FREQ"},
                                                  {"CHECK_EPS"},
                                                  {"CHECK_INC"},
                                                  {"CHECK_TOL"}});

// Where the line lies and how it is turned in the plane changes no height.
constexpr auto kModifiers = std::to_array<Setting>({{"SCALE_Z_GRID"},
                                                    {"SCALE_SLOPE"},
                                                    {"SCALE_BANKING"},
                                                    {"SCALE_LENGTH", 1, "lengths are taken as they are"},
                                                    {"SCALE_WIDTH", 1, "widths are taken as they are"},
                                                    {"SCALE_CURVATURE"},
                                                    {"GRID_NAN_MODE"},
                                                    {"GRID_NAN_OFFSET"},
                                                    {"REFLINE_ROTCENTER_X"},
                                                    {"REFLINE_ROTCENTER_Y"},
                                                    {"REFLINE_OFFSET_PHI"},
                                                    {"REFLINE_OFFSET_X"},
                                                    {"REFLINE_OFFSET_Y"},
                                                    {"REFLINE_OFFSET_Z"},
                                                    {"REFPOINT_U_FRACTION"},
                                                    {"REFPOINT_U_OFFSET"},
                                                    {"REFPOINT_U"},
                                                    {"REFPOINT_V_FRACTION"},
                                                    {"REFPOINT_V_OFFSET"},
                                                    {"REFPOINT_V"},
                                                    {"REFPOINT_X"},
                                                    {"REFPOINT_Y"},
                                                    {"REFPOINT_Z"},
                                                    {"REFPOINT_PHI"}});

std::span<const Setting> settings_of(const std::string& section) {
  if (section == "ROAD_CRG") return kParameters;
  if (section == "ROAD_CRG_OPTS") return kOptions;
  if (section == "ROAD_CRG_MODS") return kModifiers;
  return {};
}

}  // namespace

bool has_crg_settings(const std::string& section) { return !settings_of(section).empty(); }

std::string crg_setting_fault(const std::string& section, const std::string& name, double value) {
  FURROW_ASSERT(has_crg_settings(section), section);
  std::vector<std::string> known;
  for (const Setting& setting : settings_of(section)) {
    known.emplace_back(setting.name);
    if (setting.name != name) continue;
    if (name == "GRID_NAN_MODE" && value != 0.0 && value != 1.0 && value != 2.0)
      return fmt::format("is {:g}, expected 0, 1 or 2", value);
    const bool read = setting.only != setting.only || setting.only == value;
    return read ? "" : fmt::format("is {:g}, expected {:g}: {}", value, setting.only, setting.why);
  }
  for (const char* const other : {"ROAD_CRG", "ROAD_CRG_OPTS", "ROAD_CRG_MODS"})
    for (const Setting& setting : settings_of(other))
      if (setting.name == name) return fmt::format("is given in ${}, expected it in ${}", section, other);
  return unknown_text(nearest_words(name, known), known);
}

}  // namespace furrow::terrain
