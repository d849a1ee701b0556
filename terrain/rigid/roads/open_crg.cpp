#include "terrain/rigid/roads/open_crg.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/rigid/roads/crg_settings.hpp"
#include "terrain/rigid/roads/road_place.hpp"
#include "terrain/rigid/roads/road_text.hpp"

namespace furrow::terrain {
namespace {

constexpr std::uintmax_t kMostCrgBytes = 512u << 20;
constexpr std::size_t kHeaderColumns = 72;                                 // what stands beyond is left out
constexpr std::size_t kRecord = 80, kSingleField = 10, kDoubleField = 20;  // characters
constexpr double kSameCut = 1e-6, kSamePlace = 1e-4;                       // m
constexpr double kLeastIncrement = 1e-6;                                   // m
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum class Channel { cut, slope, banking, heading, left_out };

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()) {
    bytes_ = read_whole_file(file, kMostCrgBytes);
    rest_ = bytes_;
  }

  OpenCrg read() {
    read_header();
    if (channels_.empty()) throw wrong("", "defines no channel, expected $KD_DEFINITION with lines D:…");
    place_cuts();
    const std::vector<double> rows = text_ ? text_rows() : binary_rows();
    return assembled(rows);
  }

 private:
  Error wrong(const std::string& place, const std::string& what) const { return input_error(name_, place, what); }
  Error wrong_line(const std::string& what) const { return wrong(fmt::format("line {}", line_), what); }

  std::optional<std::string_view> next_line() {
    if (rest_.empty()) return std::nullopt;
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return line;
  }

  void read_header() {
    std::string section;
    while (const auto whole = next_line()) {
      const std::string_view line = whole->substr(0, kHeaderColumns);
      if (line.starts_with("$$")) return;
      if (line.starts_with('$')) {
        const std::string name = upper(trimmed(line.substr(1, line.find_first_of(" \t!") - 1)));
        if (!section.empty() && (has_crg_settings(name) || name == "KD_DEFINITION"))
          throw wrong_line(fmt::format("begins ${} within ${}, expected a line $ before it", name, section));
        section = section.empty() ? name : "";
        if (section == "ROAD_CRG_FILE") throw wrong_line("refers to another file, expected the road in one file");
        continue;
      }
      const std::string_view content = trimmed(line.substr(0, line.find('!')));
      if (content.empty() || content.starts_with('*')) continue;
      if (has_crg_settings(section)) take_setting(section, content);
      if (section == "KD_DEFINITION") take_definition(content);
    }
    throw wrong("", "has no road data, expected an OpenCRG file whose header ends with a line $$");
  }

  /// Names are unique over the sections.
  void take_setting(const std::string& section, std::string_view content) {
    const std::size_t equals = content.find('=');
    std::string number(equals == std::string_view::npos ? "" : content.substr(equals + 1));
    if (const std::size_t at = number.find("+e"); at != std::string::npos)
      number.replace(at, 2, "e+");  // 2.0+e00 for 2.0e+00, as an example of ASAM has it
    const auto value = number_of(number);
    if (!value) throw wrong_line("is '" + excerpt(std::string(content)) + "', expected PARAMETER = number");
    const std::string name = upper(trimmed(content.substr(0, equals)));
    if (const std::string fault = crg_setting_fault(section, name, *value); !fault.empty())
      throw wrong_line(excerpt(name) + " " + fault);
    const bool repeats = section == "ROAD_CRG_OPTS" && parameters_.contains(name) && parameters_.at(name) == *value;
    if (!repeats && !parameters_.emplace(name, *value).second)
      throw wrong_line("gives a parameter twice, expected it once");
  }

  void take_definition(std::string_view content) {
    if (content.starts_with("#:")) {
      const std::string format = upper(content.substr(2));
      if (format != "LRFI" && format != "LDFI" && format != "KRBI" && format != "KDBI")
        throw wrong_line("is the data format '" + excerpt(format) + "', expected LRFI, LDFI, KRBI or KDBI");
      text_ = format.front() == 'L', double_ = format[1] == 'D';
    }
    const std::string kind = upper(content.substr(0, 2)), channel = upper(trimmed(content.substr(kind.size())));
    if (kind == "U:") expect_unit(channel, "M");
    if (kind != "D:") return;
    constexpr std::string_view kCut = "LONG SECTION";
    if (channel.starts_with(kCut)) {
      channels_.push_back(Channel::cut);
      take_cut(std::string_view(channel).substr(kCut.size()));
    } else if (channel.starts_with("REFERENCE LINE SLOPE")) {
      expect_unit(channel, "M/M");
      channels_.push_back(Channel::slope);
    } else if (channel.starts_with("REFERENCE LINE BANKING")) {
      expect_unit(channel, "M/M");
      channels_.push_back(Channel::banking);
    } else if (channel.starts_with("REFERENCE LINE PHI")) {
      channels_.push_back(Channel::heading);
    } else {
      channels_.push_back(Channel::left_out);
    }
  }

  /// The second of the words between commas.
  void expect_unit(const std::string& channel, const char* expected) const {
    const std::size_t comma = std::min(channel.find(','), channel.size());
    const std::string_view rest = std::string_view(channel).substr(std::min(comma + 1, channel.size()));
    const std::string unit(trimmed(rest.substr(0, rest.find(','))));
    if (!unit.empty() && unit != expected)
      throw wrong_line(fmt::format("has the unit '{}', expected {}", excerpt(unit), expected));
  }

  /// "at v = -1.5,m" or "3,m".
  void take_cut(std::string_view text) {
    const std::size_t comma = text.find(','), equals = text.find('=');
    const bool placed = equals != std::string_view::npos;
    const auto value = comma == std::string_view::npos
                           ? std::nullopt
                           : number_of(text.substr(placed ? equals + 1 : 0, comma - (placed ? equals + 1 : 0)));
    if (!value || trimmed(text.substr(comma + 1)) != "M")
      throw wrong_line("is not a cut, expected 'D:long section at v = X,m' or 'D:long section N,m'");
    if (!cuts_.empty() && placed != placed_) throw wrong_line("mixes cuts by number with cuts at v, expected one kind");
    placed_ = placed;
    cuts_.push_back(*value);
  }

  double parameter(const std::string& name, double otherwise) const {
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? otherwise : found->second;
  }
  double needed(const std::string& name) const {
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) throw wrong(name, "is missing, expected it in $ROAD_CRG");
    return found->second;
  }

  /// Numbers of cuts become their v.
  void place_cuts() {
    if (cuts_.empty()) throw wrong("", "has no cut along the road, expected lines D:long section …");
    if (!placed_) {
      const double apart = cuts_.size() > 1 ? needed("LONG_SECTION_V_INCREMENT") : 0.0;
      const double across = static_cast<double>(cuts_.size() - 1) * apart;
      // Without either end the cuts lie evenly about the reference line, as in ASAM's minimalist examples.
      const double right = parameter("LONG_SECTION_V_RIGHT", parameter("LONG_SECTION_V_LEFT", 0.5 * across) - across);
      for (double& cut : cuts_) cut = right + (cut - 1.0) * apart;
    }
    const auto [right, left] = std::minmax_element(cuts_.begin(), cuts_.end());
    for (const auto& [name, v] : {std::pair("LONG_SECTION_V_RIGHT", *right), {"LONG_SECTION_V_LEFT", *left}})
      if (std::abs(parameter(name, v) - v) > kSamePlace)
        throw wrong(name, fmt::format("is {:g} m, but the last cut on that side is at v = {:g} m, expected as many "
                                      "lines D:long section … as the road has cuts",
                                      parameter(name, v), v));
  }

  /// Of cross-sections, after the header; none: the header is silent.
  std::optional<double> stated_count() const {
    if (!parameters_.contains("REFERENCE_LINE_END_U")) return std::nullopt;
    return 1.0 + std::round((parameter("REFERENCE_LINE_END_U", 0.0) - parameter("REFERENCE_LINE_START_U", 0.0)) /
                            needed("REFERENCE_LINE_INCREMENT"));
  }

  std::vector<double> text_rows() {
    const std::size_t width = double_ ? kDoubleField : kSingleField, most = kRecord / width;
    std::vector<double> rows;
    while (const auto first = next_line()) {
      std::string_view line = *first;
      if (trimmed(line).empty()) continue;
      for (std::size_t k = 0; k < channels_.size(); ++k) {
        if (k > 0 && k % most == 0) {
          const auto more = next_line();
          if (!more) throw wrong_line(fmt::format("is the last, expected {} values", channels_.size()));
          line = *more;
        }
        rows.push_back(field(line, k % most * width, width, k));
      }
    }
    return rows;
  }

  double field(std::string_view line, std::size_t at, std::size_t width, std::size_t channel) const {
    const std::string_view text = at < line.size() ? trimmed(line.substr(at, width)) : std::string_view();
    if (text.starts_with('*')) return kNaN;
    const auto value = number_of(text);
    if (!value)
      throw wrong_line(fmt::format("is '{}' for channel {}, expected a number of {} characters",
                                   excerpt(std::string(text)), channel + 1, width));
    return *value;
  }

  std::vector<double> binary_rows() const {
    const std::size_t size = double_ ? 8 : 4, held = rest_.size() / size, row = channels_.size();
    if (const auto stated = stated_count()) {
      const double wanted = *stated * static_cast<double>(row);
      if (!(wanted >= 1.0) || wanted > static_cast<double>(held))
        throw wrong("", fmt::format("holds {} numbers, expected {:g}: the file is cut short or damaged in transfer, or "
                                    "its header is of another road",
                                    held, wanted));
      const std::size_t bytes = static_cast<std::size_t>(wanted) * size;
      require_whole(bytes);
      return numbers(bytes / size);
    }
    require_whole(std::nullopt);
    std::vector<double> rows = numbers(held - held % row);
    // The last record is filled up with what is no number.
    const auto empty = [&](std::size_t end) {
      return std::all_of(rows.begin() + static_cast<std::ptrdiff_t>(end - row),
                         rows.begin() + static_cast<std::ptrdiff_t>(end), [](double z) { return std::isnan(z); });
    };
    while (rows.size() > row && (rows.size() - row) * size > rest_.size() - kRecord && empty(rows.size()))
      rows.resize(rows.size() - row);
    return rows;
  }

  /// Data is written in records of 80 bytes, of which some writers do not fill the last: any other length has lost or
  /// won bytes on its way, and the numbers behind them are others. @param bytes of the numbers, where they are stated
  void require_whole(std::optional<std::size_t> bytes) const {
    const std::size_t row = channels_.size() * (double_ ? 8 : 4), held = rest_.size();
    const std::size_t padded = bytes ? (*bytes + kRecord - 1) / kRecord * kRecord : 0;
    if (bytes ? held == *bytes || held == padded : held % kRecord == 0 || held % row == 0) return;
    if (held % kRecord != 0)
      throw wrong("", fmt::format("has {} bytes of road data, expected {} records of {} bytes: it was damaged in "
                                  "transfer, as bytes were lost or added",
                                  held, bytes ? fmt::format("{}", padded / kRecord) : "whole", kRecord));
    throw wrong("REFERENCE_LINE_END_U",
                fmt::format("is {:g} m, which needs {} records of road data, but the file holds {}: its header is of "
                            "another road",
                            parameter("REFERENCE_LINE_END_U", 0.0), padded / kRecord, held / kRecord));
  }

  std::vector<double> numbers(std::size_t count) const {
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = binary(rest_.data() + k * (double_ ? 8 : 4));
    return values;
  }

  double binary(const char* at) const {
    if (double_) {
      std::uint64_t bits = 0;
      for (int b = 0; b < 8; ++b) bits = bits << 8 | static_cast<unsigned char>(at[b]);
      return std::bit_cast<double>(bits);
    }
    std::uint32_t bits = 0;
    for (int b = 0; b < 4; ++b) bits = bits << 8 | static_cast<unsigned char>(at[b]);
    return std::bit_cast<float>(bits);
  }

  OpenCrg assembled(const std::vector<double>& rows) const {
    OpenCrg road;
    road.start = parameter("REFERENCE_LINE_START_U", 0.0);
    road.increment = needed("REFERENCE_LINE_INCREMENT");
    if (!(road.increment >= kLeastIncrement && road.increment <= kFarthest))
      throw wrong("REFERENCE_LINE_INCREMENT",
                  fmt::format("is {:g}, expected {:g} to {:g} m", road.increment, kLeastIncrement, kFarthest));
    const double end = road.start + static_cast<double>(rows.size() / channels_.size()) * road.increment;
    if (!(std::abs(road.start) <= kFarthest && end <= kFarthest))
      throw wrong("REFERENCE_LINE_START_U",
                  fmt::format("leads the road from u = {:g} to {:g} m, expected {:g} to {:g} m", road.start, end,
                              -kFarthest, kFarthest));
    std::vector<std::size_t> order(cuts_.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cuts_[a] < cuts_[b]; });
    for (const std::size_t k : order) road.v.push_back(cuts_[k]);
    for (std::size_t k = 1; k < road.v.size(); ++k)
      if (road.v[k] - road.v[k - 1] < kSameCut)
        throw wrong("", fmt::format("has two cuts at v = {:g} m, expected one", road.v[k]));
    const std::size_t count = rows.size() / channels_.size();
    if (const auto stated = stated_count(); stated && *stated != static_cast<double>(count))
      throw wrong("REFERENCE_LINE_END_U",
                  fmt::format("is {:g} m, where the road has {:g} cross-sections, but the file holds {}: it is cut "
                              "short or damaged in transfer, or its header is of another road",
                              parameter("REFERENCE_LINE_END_U", 0.0), *stated, count));

    const double slope_before = constant("S", Channel::slope), banking_before = constant("B", Channel::banking);
    if (!has(Channel::slope) && parameters_.contains("REFERENCE_LINE_END_Z") && slope_before == 0.0 &&
        parameter("REFERENCE_LINE_END_Z", 0.0) != parameter("REFERENCE_LINE_START_Z", 0.0))
      throw wrong("REFERENCE_LINE_END_Z", "differs from the start without a slope, expected the slope of the road");
    double line = parameter("REFERENCE_LINE_START_Z", 0.0) + parameter("REFERENCE_LINE_OFFSET_Z", 0.0) +
                  parameter("REFLINE_OFFSET_Z", 0.0);
    const double steeper = parameter("SCALE_SLOPE", 1.0), banked = parameter("SCALE_BANKING", 1.0);
    const std::size_t width = channels_.size();
    const double bend = parameter("SCALE_CURVATURE", 1.0);
    double before = kNaN, heading = 0.0;
    for (std::size_t row = 0; row + width <= rows.size(); row += width) {
      double slope = slope_before, banking = banking_before;
      std::vector<double> cuts;
      for (std::size_t k = 0; k < width; ++k) {
        const double value = rows[row + k];
        if (channels_[k] == Channel::cut) cuts.push_back(value * parameter("SCALE_Z_GRID", 1.0));
        if (channels_[k] == Channel::slope) slope = value;
        if (channels_[k] == Channel::banking) banking = value;
        if (channels_[k] != Channel::heading || row == 0 || std::isnan(value)) continue;
        if (!std::isnan(before)) heading += bend * std::remainder(value - before, 2.0 * std::numbers::pi);
        before = value;
      }
      // The heading and the slope of a row are those from the row before to it; the first has none.
      if (row > 0) line += steeper * slope * road.increment, road.headings.push_back(heading);
      std::vector<double> across;
      for (const std::size_t k : order) across.push_back(cuts[k]);
      fill_gaps(across);
      for (std::size_t k = 0; k < across.size(); ++k)
        road.heights.push_back(across[k] + line + banked * banking * road.v[k]);
    }
    if (road.count() < 2) throw wrong("", fmt::format("has {} cross-sections, expected two at least", road.count()));
    const auto [least, most] = std::ranges::minmax(road.headings);
    road.turn = most - least;
    if (std::ranges::any_of(parameters_, [](const auto& one) { return one.first.starts_with("REFPOINT_"); }))
      lift(road);
    return road;
  }

  /// To the height of its point of reference; where that lies in the plane is left out.
  void lift(OpenCrg& road) const {
    const double last = road.start + static_cast<double>(road.count() - 1) * road.increment;
    const double u = reference("REFPOINT_U", road.start, last, road.start),
                 v = reference("REFPOINT_V", road.v.front(), road.v.back(), 0.0);
    const double z = height_at(road, u, v);
    if (!std::isfinite(z))
      throw wrong("REFPOINT_Z", fmt::format("is the height at u = {:g} m, v = {:g} m, where the road has none", u, v));
    for (double& height : road.heights) height += parameter("REFPOINT_Z", 0.0) - z;
  }

  /// u or v of the point of reference, m.
  double reference(const std::string& name, double first, double last, double otherwise) const {
    if (!parameters_.contains(name + "_FRACTION")) return parameter(name, otherwise);
    if (parameters_.contains(name)) throw wrong(name, "is given beside " + name + "_FRACTION, expected one of them");
    return first + parameter(name + "_FRACTION", 0.0) * (last - first) + parameter(name + "_OFFSET", 0.0);
  }

  /// Straight along u and v between the cross-sections, beyond the grid that of its border, m.
  static double height_at(const OpenCrg& road, double u, double v) {
    const std::size_t cuts = road.v.size();
    const auto cut = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(road.v, v) - road.v.begin(), 1,
                                                std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(cuts) - 1));
    const std::size_t left = std::min(static_cast<std::size_t>(cut), cuts - 1),
                      right = static_cast<std::size_t>(cut) - 1;
    const double across =
        left == right ? 0.0 : std::clamp((v - road.v[right]) / (road.v[left] - road.v[right]), 0.0, 1.0);
    const double place = std::clamp((u - road.start) / road.increment, 0.0, static_cast<double>(road.count() - 1));
    const auto row = std::min(static_cast<std::size_t>(place), road.count() - 2);
    const double along = place - static_cast<double>(row);
    const auto between = [](double share, double a, double b) {  // NaN counts where it has a share alone
      return share == 0.0 ? a : share == 1.0 ? b : a + share * (b - a);
    };
    const auto z = [&](std::size_t k) {
      return between(across, road.heights[k * cuts + right], road.heights[k * cuts + left]);
    };
    return between(along, z(row), z(row + 1));
  }

  /// What GRID_NAN_MODE puts where a cross-section has no height: 0, or at its ends the last height that there is.
  void fill_gaps(std::vector<double>& across) const {
    const double mode = parameter("GRID_NAN_MODE", 0.0), offset = parameter("GRID_NAN_OFFSET", 0.0);
    const auto there = [](double z) { return !std::isnan(z); };
    if (mode == 1.0)
      for (double& z : across) z = there(z) ? z : offset;
    const auto first = std::find_if(across.begin(), across.end(), there);
    if (mode != 2.0 || first == across.end()) return;
    const auto last = std::find_if(across.rbegin(), across.rend(), there);
    std::fill(across.begin(), first, *first + offset);
    std::fill(across.rbegin(), last, *last + offset);
  }

  bool has(Channel channel) const { return std::find(channels_.begin(), channels_.end(), channel) != channels_.end(); }

  /// Slope (S) or banking (B) of the whole line, where there is no channel for it.
  double constant(const std::string& letter, Channel channel) const {
    if (has(channel)) return 0.0;
    const std::string start = "REFERENCE_LINE_START_" + letter, end = "REFERENCE_LINE_END_" + letter;
    const double value = parameter(start, 0.0);
    if (parameters_.contains(end) && parameter(end, 0.0) != value)
      throw wrong(end, fmt::format("is {:g} and {} {:g}, expected a channel for what changes along the line",
                                   parameter(end, 0.0), start, value));
    return value;
  }

  std::string name_, bytes_;
  std::string_view rest_;
  int line_ = 0;
  std::map<std::string, double> parameters_;
  std::vector<Channel> channels_;
  std::vector<double> cuts_;            // v in m, or numbers from 1
  bool placed_ = false;                 // cuts_ are v
  bool text_ = false, double_ = false;  // KRBI where nothing is said
};

}  // namespace

OpenCrg read_open_crg(const std::filesystem::path& file) { return Reader(file).read(); }

ProfilePoints profile_of(const OpenCrg& road, double v, const std::filesystem::path& file) {
  if (v < road.v.front() - kSameCut || v > road.v.back() + kSameCut)
    throw input_error(file.string(), "",
                      fmt::format("has no height at v = {:g} m, expected terrain.profile_v from {:g} to {:g} m", v,
                                  road.v.front(), road.v.back()));
  const std::size_t cuts = road.v.size();
  std::size_t right = 0;
  while (right + 2 < cuts && road.v[right + 1] <= v) ++right;
  const std::size_t left = std::min(right + 1, cuts - 1);
  const double share = left == right ? 0.0 : std::clamp((v - road.v[right]) / (road.v[left] - road.v[right]), 0.0, 1.0);
  ProfilePoints points;
  for (std::size_t k = 0; k < road.count(); ++k) {
    const double *row = &road.heights[k * cuts], u = road.start + static_cast<double>(k) * road.increment;
    const double z = share == 0.0   ? row[right]
                     : share == 1.0 ? row[left]
                                    : row[right] + share * (row[left] - row[right]);
    if (std::abs(z) > kFarthest)
      throw input_error(file.string(), "",
                        fmt::format("has the height {:g} m at u = {:g} m, v = {:g} m, expected {:g} to {:g} m", z, u, v,
                                    -kFarthest, kFarthest));
    if (!std::isfinite(z))
      throw input_error(file.string(), "",
                        fmt::format("has no height at u = {:g} m, v = {:g} m, expected a cut that lies on the road "
                                    "(terrain.profile_v)",
                                    u, v));
    points.push_back({u, z});
  }
  return points;
}

}  // namespace furrow::terrain
