#include "tire/handling/tir_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/handling/magic_formula.hpp"

namespace furrow::tire::handling {
namespace {

// [MODEL] FITTYP: of MF-Tyre 5.2, as various programs write it, and from kLater on of Magic Formula 6.1 and 6.2.
constexpr std::array<double, 6> kVersions{5.0, 6.0, 21.0, 52.0, 61.0, 62.0};
constexpr double kWritten = 5.0, kLater = 61.0;
constexpr double kQuarter = 0.5 * std::numbers::pi + 1e-4;  // rad: π/2, as files round it
constexpr double kMostAngle = 1.57;                         // rad: where tan α stays finite
constexpr double kNarrow = 0.02;                            // end of a range of slip or slip angle

constexpr const char* kCurve = "DEFLECTION_LOAD_CURVE";
/// Sections that are read. What others hold may be any text.
constexpr std::array<std::string_view, 20> kRead{"UNITS",
                                                 "MODEL",
                                                 "DIMENSION",
                                                 "VERTICAL",
                                                 "INERTIA",
                                                 "STRUCTURAL",
                                                 "OPERATING_CONDITIONS",
                                                 "TIRE_CONDITIONS",
                                                 kCurve,
                                                 "LONG_SLIP_RANGE",
                                                 "SLIP_ANGLE_RANGE",
                                                 "INCLINATION_ANGLE_RANGE",
                                                 "VERTICAL_FORCE_RANGE",
                                                 "SCALING_COEFFICIENTS",
                                                 "LONGITUDINAL_COEFFICIENTS",
                                                 "OVERTURNING_COEFFICIENTS",
                                                 "LATERAL_COEFFICIENTS",
                                                 "ROLLING_COEFFICIENTS",
                                                 "ALIGNING_COEFFICIENTS",
                                                 "TURNSLIP_COEFFICIENTS"};

bool is_read(std::string_view section) { return std::find(kRead.begin(), kRead.end(), section) != kRead.end(); }

/// Names that PAC2002 has for the same.
const std::map<std::string, std::string> kOtherNames{{"INFLPRES", "IP"}, {"NOMPRES", "IP_NOM"}, {"PPMX1", "QPX1"},
                                                     {"PPZ1", "QPZ1"},   {"PPZ2", "QPZ2"},      {"Q_FZ1", "QFZ1"},
                                                     {"Q_FZ2", "QFZ2"},  {"PFZ1", "QPFZ1"},     {"LKYC", "LKYG"}};

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with("+-")) return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What stands before a `$` or `!` outside of quotes.
std::string_view without_comment(std::string_view line) {
  char quote = '\0';
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (quote != '\0')
      quote = c == quote ? '\0' : quote;
    else if (c == '\'' || c == '"')
      quote = c;
    else if (c == '$' || c == '!')
      return line.substr(0, at);
  }
  return line;
}

struct Section {
  int line = 0;
  std::map<std::string, std::string> values;       // NAME to VALUE, without quotes
  std::vector<std::pair<int, std::string>> table;  // of DEFLECTION_LOAD_CURVE: lines
};

/// The sections of a file, as text, and what is found of them.
class Sections {
 public:
  Sections(const std::string& text, std::string file) : file_(std::move(file)) {
    std::size_t begin = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
    for (int line = 1; begin <= text.size(); ++line) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      take(std::string_view(text).substr(begin, end - begin), line);
      begin = end + 1;
    }
  }

  bool has(const std::string& section) const { return sections_.contains(section); }
  const Section& at(const std::string& section) const {
    const auto found = sections_.find(section);
    if (found == sections_.end()) throw input_error(file_, "[" + section + "]", "is missing, expected this section");
    return found->second;
  }
  Error wrong(const std::string& section, const std::string& key, const std::string& what) const {
    return input_error(file_, "[" + section + "] " + key, what);
  }

  void miss(const std::string& section, const std::string& key) { missing_.push_back("[" + section + "] " + key); }
  /// @throws Error(bad_input) naming all that is missing
  void refuse_missing() const {
    if (missing_.empty()) return;
    const std::vector<std::string> others(missing_.begin() + 1, missing_.end());
    throw input_error(file_, missing_.front(),
                      "is missing, expected a number" +
                          (others.empty() ? "" : fmt::format("; missing too: {}", fmt::join(others, ", "))));
  }
  void leave(const std::string& section, const std::string& key) {
    std::vector<std::string>& keys = unused_[section];
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  /// Pairs of a section that is not read and the missing one that its name resembles.
  std::vector<std::pair<std::string, std::string>> misspelt() const {
    std::vector<std::string> missing;
    for (const std::string_view name : kRead)
      if (!sections_.contains(std::string(name))) missing.emplace_back(name);
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& [name, section] : sections_)
      if (!is_read(name))
        if (const std::vector<std::string> others = nearest_words(name, missing); !others.empty())
          pairs.emplace_back(name, others.front());
    return pairs;
  }
  /// "[A] X, Y; [B] Z" of what is not used; empty: nothing.
  std::string unused() const {
    std::vector<std::string> all;
    for (const auto& [section, keys] : unused_)
      all.push_back(keys.front().empty() ? "[" + section + "]"
                                         : fmt::format("[{}] {}", section, fmt::join(keys, ", ")));
    return fmt::format("{}", fmt::join(all, "; "));
  }

 private:
  void take(std::string_view line, int number) {
    line = trimmed(without_comment(line));
    if (line.empty()) return;
    const auto wrong_line = [&](const char* expected) {
      return input_error(file_, "",
                         fmt::format("line {}: '{}', expected {}", number, excerpt(std::string(line)), expected));
    };
    if (line.front() == '[' && (line.back() == ']' || reads_ || open_.empty())) {
      if (line.back() != ']') throw wrong_line("a section [NAME]");
      begin_section(upper(trimmed(line.substr(1, line.size() - 2))), number);
      return;
    }
    if (line.front() == '*' || line.front() == '#') return;
    if (open_.empty()) throw wrong_line("a section [NAME] or a line NAME = VALUE");
    if (!reads_) return;
    Section& section = sections_[open_];
    if (open_ == kCurve) {
      if (line.front() != '{') section.table.emplace_back(number, std::string(line));
      return;
    }
    if (line.front() == '{' || line.front() == '(') block_ = true;
    if (block_) return;
    if (const std::size_t bad = find_invalid_utf8(std::string(line)); bad != std::string::npos)
      throw input_error(file_, "",
                        fmt::format("line {}: byte 0x{:02x} is not UTF-8, expected it in comments alone", number,
                                    static_cast<unsigned char>(line[bad])));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) throw wrong_line("a section [NAME] or a line NAME = VALUE");
    std::string_view value = trimmed(line.substr(equals + 1));
    if (value.size() >= 2 && value.front() == value.back() && (value.front() == '\'' || value.front() == '"'))
      value = trimmed(value.substr(1, value.size() - 2));
    const std::string key = upper(trimmed(line.substr(0, equals)));
    if (!section.values.emplace(key, std::string(value)).second)
      throw wrong(open_, printable(key), fmt::format("is given twice, again in line {}", number));
  }

  void begin_section(std::string name, int number) {
    open_ = std::move(name);
    block_ = false;
    reads_ = is_read(open_);
    const auto [section, fresh] = sections_.try_emplace(open_, Section{number, {}, {}});
    if (!fresh && reads_)
      throw input_error(
          file_, "[" + open_ + "]",
          fmt::format("is given twice, in lines {} and {}, expected it once", section->second.line, number));
  }

  std::string file_, open_;
  bool reads_ = false, block_ = false;
  std::map<std::string, Section> sections_;
  std::vector<std::string> missing_;
  std::map<std::string, std::vector<std::string>> unused_;
};

/// Takes the numbers of one section by their names.
class SectionReader {
 public:
  SectionReader(Sections& sections, std::string name)
      : sections_(sections), name_(std::move(name)), values_(sections.at(name_).values) {}

  /// With a value: files leave some empty.
  bool has(const std::string& key) { return find(key) != nullptr; }
  /// 0 where it is missing: Sections::refuse_missing()
  double number(const std::string& key) {
    const std::string* text = find(key);
    if (!text) {
      sections_.miss(name_, key);
      return 0.0;
    }
    const std::optional<double> value = number_of(*text);
    if (!value || !std::isfinite(*value))
      throw wrong(key, fmt::format("is '{}', expected a finite number", excerpt(*text)));
    return *value;
  }
  double positive(const std::string& key) {
    const double value = number(key);
    if (!(value > 0.0)) throw wrong(key, fmt::format("is {:g}, expected a number above 0", value));
    return value;
  }
  double number_or(const std::string& key, double otherwise) { return has(key) ? number(key) : otherwise; }
  double not_negative_or(const std::string& key, double otherwise) {
    const double value = number_or(key, otherwise);
    if (value < 0.0) throw wrong(key, fmt::format("is {:g}, expected 0 or more", value));
    return value;
  }
  std::string text(const std::string& key) {
    const std::string* found = find(key);
    if (!found) throw wrong(key, "is missing, expected a text in quotes");
    return *found;
  }
  /// What is unknown and would change a result with the value that it has is left. @param harmless such a value, not 0
  void finish(double harmless = 0.0) {
    for (const auto& [key, value] : values_) {
      if (used_.contains(key) || value.empty()) continue;
      const std::optional<double> number = number_of(value);
      if (number && (*number == 0.0 || *number == harmless)) continue;
      sections_.leave(name_, printable(key));
    }
  }
  Error wrong(const std::string& key, const std::string& what) const { return sections_.wrong(name_, key, what); }

 private:
  const std::string* find(const std::string& key) {
    used_.insert(key);
    auto found = values_.find(key);
    if (const auto other = kOtherNames.find(key); found == values_.end() && other != kOtherNames.end()) {
      used_.insert(other->second);
      found = values_.find(other->second);
    }
    return found == values_.end() || found->second.empty() ? nullptr : &found->second;
  }

  Sections& sections_;
  std::string name_;
  const std::map<std::string, std::string>& values_;
  std::set<std::string> used_;
};

void read_units(Sections& sections) {
  SectionReader units(sections, "UNITS");
  for (const auto& [key, unit] : {std::pair{"LENGTH", "METER"},
                                  {"FORCE", "NEWTON"},
                                  {"ANGLE", "RADIANS"},
                                  {"MASS", "KG"},
                                  {"TIME", "SECOND"},
                                  {"PRESSURE", "PASCAL"}}) {
    if (key == std::string_view("PRESSURE") && !units.has(key)) continue;  // of PAC2002
    const std::string given = units.text(key);
    const std::string name = upper(given);
    if (name != unit && name + "S" != unit && name != std::string(unit) + "S")
      throw units.wrong(key, fmt::format("is '{}', expected '{}'", excerpt(given), unit));
  }
  units.finish();
}

void read_model(Sections& sections, MagicFormula& tire) {
  SectionReader model(sections, "MODEL");
  if (model.has("FITTYP")) {
    const double version = model.number("FITTYP");
    if (std::find(kVersions.begin(), kVersions.end(), version) == kVersions.end())
      throw model.wrong(
          "FITTYP", fmt::format("is {:g}, expected one of {}: the Magic Formula of MF-Tyre 5.2, 6.1 or 6.2", version,
                                fmt::join(kVersions, ", ")));
    tire.version61 = version >= kLater;
  } else if (const std::string format = model.text("PROPERTY_FILE_FORMAT");
             upper(format) != "PAC2002" && upper(format) != "MF-TYRE" && upper(format) != "MF_05")
    throw model.wrong(
        "PROPERTY_FILE_FORMAT",
        fmt::format("is '{}', expected 'MF-TYRE', 'MF_05' or 'PAC2002', or a FITTYP of 5", excerpt(format)));
  if (model.has("TYRESIDE")) {
    const std::string side = upper(model.text("TYRESIDE"));
    if (side != "LEFT" && side != "RIGHT" && side != "SYMMETRIC" && side != "UNKNOWN")
      throw model.wrong("TYRESIDE", fmt::format("is '{}', expected 'LEFT' or 'RIGHT'", excerpt(side)));
  }
  tire.friction_ellipse = model.has("FE_METHOD") && upper(model.text("FE_METHOD")) == "YES";
  for (const auto& [key, plain] : {std::pair{"CONTACT_MODEL", "DEFAULT"}, {"BELT_DYNAMICS", "NO"}})
    if (model.has(key) && upper(model.text(key)) != plain) sections.leave("MODEL", key);
  tire.low_speed = model.has("VXLOW") ? model.positive("VXLOW") : tire.low_speed;
  tire.reference_speed = model.has("LONGVL") ? model.positive("LONGVL") : 0.0;
}

/// @param limit of both ends' sizes; 0: none
Range read_range(Sections& sections, const std::string& name, const std::string& prefix, double limit) {
  SectionReader reader(sections, name);
  const Range range{reader.number(prefix + "MIN"), reader.number(prefix + "MAX")};
  sections.refuse_missing();
  if (!(range.least < range.most))
    throw reader.wrong(prefix + "MIN",
                       fmt::format("is {:g}, expected less than {}MAX of {:g}", range.least, prefix, range.most));
  if (limit > 0.0 && (range.least < -limit || range.most > limit))
    throw reader.wrong(range.least < -limit ? prefix + "MIN" : prefix + "MAX",
                       fmt::format("is {:g}, expected between {:.5g} and {:.5g} rad",
                                   range.least < -limit ? range.least : range.most, -limit, limit));
  reader.finish();
  return range;
}

/// A range of slip or angle. A wheel rolls on both sides of 0: a range that has no room on one of them says how far was
/// measured, not that there is no force, and the curve holds on either side.
Range read_slips(Sections& sections, const std::string& name, const std::string& prefix, double limit,
                 MagicFormula& tire) {
  Range range = read_range(sections, name, prefix, limit);
  const auto remark = [&](const char* end, double value, const std::string& what) {
    tire.remarks.emplace_back("[" + name + "] " + prefix + end, fmt::format("is {:g}: {}", value, what));
  };
  if (limit > 0.0) range = {std::max(range.least, -kMostAngle), std::min(range.most, kMostAngle)};
  if (!(range.least < 0.0 && range.most > 0.0)) {
    const bool above = range.least >= 0.0;
    const double most = std::max(std::abs(range.least), std::abs(range.most));
    remark(
        above ? "MIN" : "MAX", above ? range.least : range.most,
        fmt::format("the range has nothing {} 0 and is taken as -{:g} to {:g}", above ? "below" : "above", most, most));
    range = {-most, most};
  } else if (prefix != "CAM") {
    for (const auto& [end, value] : {std::pair{"MIN", range.least}, {"MAX", range.most}})
      if (std::abs(value) < kNarrow)
        remark(end, value,
               fmt::format("forces stay the same beyond it, expected {:g} or more in size ({})", kNarrow,
                           limit > 0.0 ? "rad" : "a share, not per cent"));
  }
  return range;
}

std::vector<std::pair<double, double>> read_curve(const Sections& sections) {
  std::vector<std::pair<double, double>> curve;
  if (!sections.has(kCurve)) return curve;
  for (const auto& [line, text] : sections.at(kCurve).table) {
    const std::size_t gap = text.find_first_of(" \t,");
    const std::optional<double> deflection = number_of(std::string_view(text).substr(0, gap)),
                                load = gap == std::string::npos
                                           ? std::nullopt
                                           : number_of(trimmed(std::string_view(text).substr(gap + 1)));
    const auto wrong = [&](const char* expected) {
      return sections.wrong(kCurve, fmt::format("line {}", line),
                            fmt::format("is '{}', expected {}", excerpt(text), expected));
    };
    if (!deflection || !load || !std::isfinite(*deflection + *load)) throw wrong("a deflection in m and a load in N");
    if (curve.empty() && (*deflection != 0.0 || *load != 0.0)) {
      if (!(*deflection > 0.0 && *load > 0.0)) throw wrong("the curve to begin with no load at no deflection");
      curve.emplace_back(0.0, 0.0);
    }
    if (!curve.empty() && !(*deflection > curve.back().first && *load > curve.back().second))
      throw wrong("a deflection and a load above those of the line before");
    curve.emplace_back(*deflection, *load);
  }
  if (curve.size() < 2)
    throw sections.wrong(kCurve, "", "has no points, expected lines of deflection in m and load in N");
  return curve;
}

template <class Coefficients>
void read_section(Sections& sections, const std::string& name, bool required, Coefficients& into,
                  const std::vector<std::string>& must = {}, double harmless = 0.0) {
  if (!required && !sections.has(name)) return;
  SectionReader reader(sections, name);
  for (const std::string& key : must)
    if (reader.number(key) == 0.0 && reader.has(key)) throw reader.wrong(key, "is 0, expected another number");
  visit_fields(into, [&](double& value, const Field& field) { value = reader.number_or(field.name, value); });
  reader.finish(harmless);
}

void check(const Sections& sections, const MagicFormula& t) {
  const auto positive = [&](const char* section, const char* key, double value) {
    if (!(value > 0.0)) throw sections.wrong(section, key, fmt::format("is {:g}, expected a number above 0", value));
  };
  const auto not_negative = [&](const char* section, const char* key, double value) {
    if (value < 0.0) throw sections.wrong(section, key, fmt::format("is {:g}, expected 0 or more", value));
  };
  positive("DIMENSION", "UNLOADED_RADIUS", t.dimension.unloaded_radius);
  positive("DIMENSION", "WIDTH", t.dimension.width);
  not_negative("DIMENSION", "RIM_RADIUS", t.dimension.rim_radius);
  if (t.dimension.rim_radius >= t.dimension.unloaded_radius)
    throw sections.wrong("DIMENSION", "RIM_RADIUS",
                         fmt::format("is {:g} m, expected less than UNLOADED_RADIUS of {:g} m", t.dimension.rim_radius,
                                     t.dimension.unloaded_radius));
  positive("SCALING_COEFFICIENTS", "LCZ", t.scaling.lcz);
  positive("SCALING_COEFFICIENTS", "LIP", t.scaling.lip);
  not_negative("OPERATING_CONDITIONS", "INFLPRES", t.conditions.inflpres);
  not_negative("OPERATING_CONDITIONS", "NOMPRES", t.conditions.nompres);
  positive("VERTICAL", "VERTICAL_STIFFNESS", t.vertical.vertical_stiffness);
  not_negative("VERTICAL", "VERTICAL_DAMPING", t.vertical.vertical_damping);
  positive("VERTICAL", "FNOMIN", t.vertical.fnomin);
  positive("SCALING_COEFFICIENTS", "LFZO", t.scaling.lfzo);
  positive("SCALING_COEFFICIENTS", "LMUX", t.scaling.lmux);
  positive("SCALING_COEFFICIENTS", "LMUY", t.scaling.lmuy);
  if (t.lateral.pky1 > 0.0)
    throw sections.wrong(
        "LATERAL_COEFFICIENTS", "PKY1",
        fmt::format("is {:g}, expected less than 0: these axes are those of ISO 8855, in which a positive "
                    "slip angle gives a negative force",
                    t.lateral.pky1));
  if (t.lateral.pky4 == 0.0) throw sections.wrong("LATERAL_COEFFICIENTS", "PKY4", "is 0, expected another number");
  not_negative("VERTICAL_FORCE_RANGE", "FZMIN", t.load.least);
  const double rim = t.dimension.unloaded_radius - t.dimension.rim_radius;
  for (const double share : {0.01, 0.5, 1.0})
    if (const double force = spring_force(t, share * rim); !(force > spring_force(t, 0.99 * share * rim)))
      throw sections.wrong(
          "VERTICAL", "Q_FZ2",
          fmt::format("and PFZ1 give a load of {:g} N that falls at a deflection of {:g} m, expected one "
                      "that grows down to the rim",
                      force, share * rim));
}

}  // namespace

MagicFormula parse_tir(const std::string& text, const std::string& name) {
  Sections sections(text, name);
  MagicFormula t;
  read_units(sections);
  read_model(sections, t);
  if (!t.version61 && sections.has("LATERAL_COEFFICIENTS") &&
      SectionReader(sections, "LATERAL_COEFFICIENTS").number_or("PKY6", 0.0) != 0.0) {
    t.version61 = true;
    t.remarks.emplace_back("[MODEL] FITTYP", "is not 61, but PKY6 belongs to Magic Formula 6.1, which is used");
  }
  if (t.version61) t.rolling.qsy7 = 1.0;
  read_section(sections, "DIMENSION", true, t.dimension, {"UNLOADED_RADIUS", "WIDTH"});
  read_section(sections, "VERTICAL", true, t.vertical, {"FNOMIN", "VERTICAL_STIFFNESS"}, t.version61 ? 1.0 : 0.0);
  if (sections.has("INERTIA")) {  // what MF-Swift and others add is passed over
    SectionReader inertia(sections, "INERTIA");
    visit_fields(t.inertia,
                 [&](double& value, const Field& field) { value = inertia.not_negative_or(field.name, value); });
  }
  if (sections.has("STRUCTURAL")) {
    SectionReader structural(sections, "STRUCTURAL");
    visit_fields(t.structural,
                 [&](double& value, const Field& field) { value = structural.number_or(field.name, value); });
  }
  for (const char* section : {"OPERATING_CONDITIONS", "TIRE_CONDITIONS"})
    read_section(sections, section, false, t.conditions);
  t.slip = read_slips(sections, "LONG_SLIP_RANGE", "KPU", 0.0, t);
  t.slip_angle = read_slips(sections, "SLIP_ANGLE_RANGE", "ALP", kQuarter, t);
  t.camber = read_slips(sections, "INCLINATION_ANGLE_RANGE", "CAM", kQuarter, t);
  t.load = read_range(sections, "VERTICAL_FORCE_RANGE", "FZ", 0.0);
  read_section(sections, "SCALING_COEFFICIENTS", false, t.scaling, {}, 1.0);
  read_section(sections, "LONGITUDINAL_COEFFICIENTS", true, t.longitudinal, {"PCX1", "PDX1", "PKX1"});
  read_section(sections, "OVERTURNING_COEFFICIENTS", false, t.overturning);
  read_section(sections, "LATERAL_COEFFICIENTS", true, t.lateral, {"PCY1", "PDY1", "PKY1", "PKY2"});
  read_section(sections, "ROLLING_COEFFICIENTS", false, t.rolling);
  read_section(sections, "ALIGNING_COEFFICIENTS", false, t.aligning);
  for (const auto& [section, what] :
       {std::pair{"ROLLING_COEFFICIENTS", "the rolling resistance"}, {"ALIGNING_COEFFICIENTS", "the aligning moment"}})
    if (!sections.has(section))
      t.remarks.emplace_back(fmt::format("[{}]", section), fmt::format("is missing: {} is 0", what));
  if (t.reference_speed == 0.0 && (t.rolling.qsy3 != 0.0 || t.rolling.qsy4 != 0.0))
    t.remarks.emplace_back("[MODEL] LONGVL", "is missing: QSY3 and QSY4, of the rolling resistance, have no effect");
  if (sections.has("TURNSLIP_COEFFICIENTS")) SectionReader(sections, "TURNSLIP_COEFFICIENTS").finish();
  sections.refuse_missing();
  t.load_curve = read_curve(sections);
  check(sections, t);
  for (const auto& [section, other] : sections.misspelt())
    t.remarks.emplace_back(fmt::format("[{}]", section), fmt::format("is not used: did you mean [{}]?", other));
  if (sections.has("BOTTOMING_CURVE")) sections.leave("BOTTOMING_CURVE", "");
  if (const std::string unused = sections.unused(); !unused.empty())
    t.remarks.emplace_back(unused, "is not used: unknown, or without a place in this model");
  return t;
}

MagicFormula read_tir(const std::filesystem::path& file) {
  return parse_tir(read_text_file(file, "a tire property file (.tir)", false), file.string());
}

std::string tir_text(const MagicFormula& t, const std::vector<std::string>& comments) {
  std::string out = "[MDI_HEADER]\nFILE_TYPE = 'tir'\nFILE_VERSION = 3.0\nFILE_FORMAT = 'ASCII'\n";
  for (const std::string& line : comments) out += "! " + line + "\n";
  const auto section = [&](const char* name) { out += fmt::format("[{}]\n", name); };
  const auto line = [&](const char* name, double value, const char* unit = "") {
    out += fmt::format("{:<19}= {}{}\n", name, value, *unit != '\0' ? fmt::format("  $ {}", unit) : "");
  };
  const auto all = [&](const char* name, const auto& coefficients) {
    section(name);
    const std::decay_t<decltype(coefficients)> none;
    std::vector<double> usual;
    visit_fields(none, [&](double value, const Field&) { usual.push_back(value); });
    int at = 0;
    visit_fields(coefficients, [&](double value, const Field& field) {
      const int k = at++;
      if constexpr (requires { none.kLater; })
        if (!t.version61 && k >= none.kLater && value == usual[static_cast<std::size_t>(k)]) return;
      line(field.name, value, std::string_view(field.unit) == "-" ? "" : field.unit);
    });
  };
  const auto range = [&](const char* name, const std::string& prefix, const Range& r, const char* unit) {
    section(name);
    line((prefix + "MIN").c_str(), r.least, unit);
    line((prefix + "MAX").c_str(), r.most, unit);
  };
  out += "[UNITS]\nLENGTH = 'meter'\nFORCE = 'newton'\nANGLE = 'radians'\nMASS = 'kg'\nTIME = 'second'\n";
  out += "[MODEL]\nPROPERTY_FILE_FORMAT = 'MF-TYRE'\nTYPE = 'CAR'\n";
  if (t.version61)
    line("FITTYP", kLater, "Magic Formula 6.1");
  else
    line("FITTYP", kWritten, "Magic Formula of MF-Tyre 5.2");
  line("USE_MODE", 14, "combined slip, with relaxation");
  if (t.friction_ellipse) out += "FE_METHOD = 'YES'\n";
  line("VXLOW", t.low_speed, "m/s");
  if (t.reference_speed > 0.0) line("LONGVL", t.reference_speed, "m/s");
  out += "TYRESIDE = 'LEFT'\n";
  all("DIMENSION", t.dimension);
  out += "[SHAPE]\n{radial width}\n 1.0 0.0\n 1.0 1.0\n";
  if (t.inertia.mass > 0.0) all("INERTIA", t.inertia);
  all("VERTICAL", t.vertical);
  if (t.conditions.nompres > 0.0) all("OPERATING_CONDITIONS", t.conditions);
  if (t.structural.longitudinal_stiffness > 0.0) all("STRUCTURAL", t.structural);
  if (!t.load_curve.empty()) {
    section(kCurve);
    out += "{pen fz}\n";
    for (const auto& [deflection, load] : t.load_curve) out += fmt::format("{} {}\n", deflection, load);
  }
  range("LONG_SLIP_RANGE", "KPU", t.slip, "");
  range("SLIP_ANGLE_RANGE", "ALP", t.slip_angle, "rad");
  range("INCLINATION_ANGLE_RANGE", "CAM", t.camber, "rad");
  range("VERTICAL_FORCE_RANGE", "FZ", t.load, "N");
  all("SCALING_COEFFICIENTS", t.scaling);
  all("LONGITUDINAL_COEFFICIENTS", t.longitudinal);
  all("OVERTURNING_COEFFICIENTS", t.overturning);
  all("LATERAL_COEFFICIENTS", t.lateral);
  all("ROLLING_COEFFICIENTS", t.rolling);
  all("ALIGNING_COEFFICIENTS", t.aligning);
  return out;
}

}  // namespace furrow::tire::handling
