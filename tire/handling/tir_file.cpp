#include "tire/handling/tir_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::tire::handling {
namespace {

// [MODEL] FITTYP of this version of the formula, as various programs write it.
constexpr std::array<double, 4> kVersions{5.0, 6.0, 21.0, 52.0};
constexpr double kWritten = 5.0;
constexpr double kMostAngle = 1.57;  // rad, of slip angle and camber

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
  bool quoted = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == '\'') quoted = !quoted;
    if (!quoted && (line[at] == '$' || line[at] == '!')) return line.substr(0, at);
  }
  return line;
}

using Section = std::map<std::string, std::string>;  // NAME to VALUE, without quotes

/// The sections of a file, as text.
class Sections {
 public:
  Sections(const std::string& text, std::string file) : file_(std::move(file)) {
    std::size_t begin = 0;
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
  const std::string& file() const { return file_; }

 private:
  void take(std::string_view line, int number) {
    line = trimmed(without_comment(line));
    if (line.empty()) return;
    const auto wrong_line = [&](const char* expected) {
      return input_error(file_, "",
                         fmt::format("line {}: '{}', expected {}", number, excerpt(std::string(line)), expected));
    };
    if (line.front() == '[') {
      if (line.back() != ']') throw wrong_line("a section [NAME]");
      open_ = upper(trimmed(line.substr(1, line.size() - 2)));
      table_ = false;
      if (!sections_.try_emplace(open_).second)
        throw input_error(file_, "[" + printable(open_) + "]", fmt::format("is given twice, again in line {}", number));
      return;
    }
    if (line.front() == '{') table_ = true;
    if (table_) return;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || open_.empty()) throw wrong_line("a section [NAME] or a line NAME = VALUE");
    std::string_view value = trimmed(line.substr(equals + 1));
    if (value.size() >= 2 && value.front() == '\'' && value.back() == '\'')
      value = trimmed(value.substr(1, value.size() - 2));
    const std::string key = upper(trimmed(line.substr(0, equals)));
    if (!sections_[open_].emplace(key, std::string(value)).second)
      throw wrong(printable(open_), printable(key), fmt::format("is given twice, again in line {}", number));
  }

  std::string file_, open_;
  bool table_ = false;
  std::map<std::string, Section> sections_;
};

/// Takes the numbers of one section by their names.
class SectionReader {
 public:
  SectionReader(const Sections& sections, std::string name)
      : sections_(sections), name_(std::move(name)), section_(sections.at(name_)) {}

  bool has(const std::string& key) const { return section_.contains(key); }
  double number(const std::string& key) {
    used_.insert(key);
    const auto found = section_.find(key);
    if (found == section_.end()) throw wrong(key, "is missing, expected a number");
    const std::optional<double> value = number_of(found->second);
    if (!value || !std::isfinite(*value))
      throw wrong(key, fmt::format("is '{}', expected a finite number", excerpt(found->second)));
    return *value;
  }
  double positive(const std::string& key) {
    const double value = number(key);
    if (!(value > 0.0)) throw wrong(key, fmt::format("is {:g}, expected a number above 0", value));
    return value;
  }
  double number_or(const std::string& key, double otherwise) {
    used_.insert(key);
    return has(key) ? number(key) : otherwise;
  }
  double not_negative_or(const std::string& key, double otherwise) {
    const double value = number_or(key, otherwise);
    if (value < 0.0) throw wrong(key, fmt::format("is {:g}, expected 0 or more", value));
    return value;
  }
  std::string text(const std::string& key) {
    used_.insert(key);
    const auto found = section_.find(key);
    if (found == section_.end()) throw wrong(key, "is missing, expected a text in quotes");
    return found->second;
  }
  void finish() const {
    const std::vector<std::string> known(used_.begin(), used_.end());
    for (const auto& [key, value] : section_)
      if (!used_.contains(key)) throw wrong(printable(key), unknown_text(nearest_words(key, known), known));
  }
  Error wrong(const std::string& key, const std::string& what) const { return sections_.wrong(name_, key, what); }

 private:
  const Sections& sections_;
  std::string name_;
  const Section& section_;
  std::set<std::string> used_;
};

void read_units(const Sections& sections) {
  SectionReader units(sections, "UNITS");
  for (const auto& [key, unit] :
       {std::pair{"LENGTH", "METER"}, {"FORCE", "NEWTON"}, {"ANGLE", "RADIANS"}, {"MASS", "KG"}, {"TIME", "SECOND"}}) {
    const std::string given = units.text(key);
    const std::string name = upper(given);
    if (name != unit && name + "S" != unit && name != std::string(unit) + "S")
      throw units.wrong(key, fmt::format("is '{}', expected '{}'", excerpt(given), unit));
  }
  units.finish();
}

void read_model(const Sections& sections, MagicFormula& tire) {
  SectionReader model(sections, "MODEL");
  if (model.has("FITTYP")) {
    const double version = model.number("FITTYP");
    if (std::find(kVersions.begin(), kVersions.end(), version) == kVersions.end())
      throw model.wrong("FITTYP", fmt::format("is {:g}, expected one of {}: the Magic Formula of MF-Tyre 5.2", version,
                                              fmt::join(kVersions, ", ")));
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
  tire.low_speed = model.has("VXLOW") ? model.positive("VXLOW") : tire.low_speed;
  tire.reference_speed = model.has("LONGVL") ? model.positive("LONGVL") : 0.0;
}

/// @param limit of both ends' sizes; 0: none
Range read_range(const Sections& sections, const std::string& name, const std::string& prefix, double limit) {
  SectionReader reader(sections, name);
  const Range range{reader.number(prefix + "MIN"), reader.number(prefix + "MAX")};
  if (!(range.least < range.most))
    throw reader.wrong(prefix + "MIN",
                       fmt::format("is {:g}, expected less than {}MAX of {:g}", range.least, prefix, range.most));
  if (limit > 0.0 && (range.least < -limit || range.most > limit))
    throw reader.wrong(range.least < -limit ? prefix + "MIN" : prefix + "MAX",
                       fmt::format("is {:g}, expected between {:g} and {:g} rad",
                                   range.least < -limit ? range.least : range.most, -limit, limit));
  reader.finish();
  return range;
}

template <class Coefficients>
void read_section(const Sections& sections, const std::string& name, bool required, Coefficients& into,
                  const std::vector<std::string>& must = {}) {
  if (!required && !sections.has(name)) return;
  SectionReader reader(sections, name);
  for (const std::string& key : must)
    if (reader.number(key) == 0.0) throw reader.wrong(key, "is 0, expected another number");
  visit_fields(into, [&](double& value, const Field& field) { value = reader.number_or(field.name, value); });
  reader.finish();
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
  not_negative("VERTICAL_FORCE_RANGE", "FZMIN", t.load.least);
}

}  // namespace

MagicFormula parse_tir(const std::string& text, const std::string& name) {
  const Sections sections(text, name);
  MagicFormula t;
  read_units(sections);
  read_model(sections, t);
  read_section(sections, "DIMENSION", true, t.dimension, {"UNLOADED_RADIUS", "WIDTH"});
  {  // what MF-Swift and others add is passed over
    SectionReader vertical(sections, "VERTICAL");
    for (const char* key : {"VERTICAL_STIFFNESS", "FNOMIN"}) vertical.number(key);
    visit_fields(t.vertical, [&](double& value, const Field& field) { value = vertical.number_or(field.name, value); });
  }
  if (sections.has("INERTIA")) {
    SectionReader inertia(sections, "INERTIA");
    visit_fields(t.inertia,
                 [&](double& value, const Field& field) { value = inertia.not_negative_or(field.name, value); });
  }
  t.slip = read_range(sections, "LONG_SLIP_RANGE", "KPU", 0.0);
  t.slip_angle = read_range(sections, "SLIP_ANGLE_RANGE", "ALP", kMostAngle);
  t.camber = read_range(sections, "INCLINATION_ANGLE_RANGE", "CAM", kMostAngle);
  t.load = read_range(sections, "VERTICAL_FORCE_RANGE", "FZ", 0.0);
  read_section(sections, "SCALING_COEFFICIENTS", false, t.scaling);
  read_section(sections, "LONGITUDINAL_COEFFICIENTS", true, t.longitudinal, {"PCX1", "PDX1", "PKX1"});
  read_section(sections, "OVERTURNING_COEFFICIENTS", false, t.overturning);
  read_section(sections, "LATERAL_COEFFICIENTS", true, t.lateral, {"PCY1", "PDY1", "PKY1", "PKY2"});
  read_section(sections, "ROLLING_COEFFICIENTS", false, t.rolling);
  read_section(sections, "ALIGNING_COEFFICIENTS", false, t.aligning);
  check(sections, t);
  return t;
}

MagicFormula read_tir(const std::filesystem::path& file) {
  return parse_tir(read_text_file(file, "a tire property file (.tir)"), file.string());
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
    visit_fields(coefficients, [&](double value, const Field& field) {
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
  line("FITTYP", kWritten, "Magic Formula of MF-Tyre 5.2");
  line("USE_MODE", 14, "combined slip, with relaxation");
  line("VXLOW", t.low_speed, "m/s");
  if (t.reference_speed > 0.0) line("LONGVL", t.reference_speed, "m/s");
  out += "TYRESIDE = 'LEFT'\n";
  all("DIMENSION", t.dimension);
  out += "[SHAPE]\n{radial width}\n 1.0 0.0\n 1.0 1.0\n";
  if (t.inertia.mass > 0.0) all("INERTIA", t.inertia);
  all("VERTICAL", t.vertical);
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
