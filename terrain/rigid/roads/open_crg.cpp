#include "terrain/rigid/roads/open_crg.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::terrain {
namespace {

constexpr std::uintmax_t kMostBytes = 512u << 20;
constexpr std::size_t kHeaderColumns = 72;                                     // what stands beyond is left out
constexpr std::size_t kTextRecord = 80, kSingleField = 10, kDoubleField = 20;  // characters
constexpr double kSameCut = 1e-6;                                              // m
constexpr double kLeastIncrement = 1e-6, kFarthest = 1e6;                      // m; the latter as of terrain.profile
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

enum class Channel { cut, slope, banking, left_out };

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()) {
    bytes_ = read_whole_file(file, kMostBytes);
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
        section = section.empty() ? upper(trimmed(line.substr(1, line.find_first_of(" \t!") - 1))) : "";
        if (section == "ROAD_CRG_FILE") throw wrong_line("refers to another file, expected the road in one file");
        continue;
      }
      const std::string_view content = trimmed(line.substr(0, line.find('!')));
      if (content.empty() || content.starts_with('*')) continue;
      if (section == "ROAD_CRG") take_parameter(content);
      if (section == "KD_DEFINITION") take_definition(content);
      if (section == "ROAD_CRG_MODS") throw wrong_line("modifies the road, expected no $ROAD_CRG_MODS with entries");
    }
    throw wrong("", "has no road data, expected an OpenCRG file whose header ends with a line $$");
  }

  void take_parameter(std::string_view content) {
    const std::size_t equals = content.find('=');
    const auto value = equals == std::string_view::npos ? std::nullopt : number_of(content.substr(equals + 1));
    if (!value) throw wrong_line("is '" + excerpt(std::string(content)) + "', expected PARAMETER = number");
    if (!parameters_.emplace(upper(trimmed(content.substr(0, equals))), *value).second)
      throw wrong_line("gives a parameter twice, expected it once");
  }

  void take_definition(std::string_view content) {
    if (content.starts_with("#:")) {
      const std::string format = upper(content.substr(2));
      if (format != "LRFI" && format != "LDFI" && format != "KRBI" && format != "KDBI")
        throw wrong_line("is the data format '" + excerpt(format) + "', expected LRFI, LDFI, KRBI or KDBI");
      text_ = format.front() == 'L', double_ = format[1] == 'D';
    }
    if (!content.starts_with("D:") && !content.starts_with("d:")) return;
    const std::string channel = upper(trimmed(content.substr(2)));
    constexpr std::string_view kCut = "LONG SECTION";
    if (channel.starts_with(kCut)) {
      channels_.push_back(Channel::cut);
      take_cut(std::string_view(channel).substr(kCut.size()));
    } else if (channel.starts_with("REFERENCE LINE SLOPE")) {
      channels_.push_back(Channel::slope);
    } else if (channel.starts_with("REFERENCE LINE BANKING")) {
      channels_.push_back(Channel::banking);
    } else {
      channels_.push_back(Channel::left_out);
    }
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
    if (placed_) return;
    const double right = needed("LONG_SECTION_V_RIGHT");
    const double apart = cuts_.size() > 1 ? needed("LONG_SECTION_V_INCREMENT") : 0.0;
    for (double& cut : cuts_) cut = right + (cut - 1.0) * apart;
  }

  std::vector<double> text_rows() {
    const std::size_t width = double_ ? kDoubleField : kSingleField, most = kTextRecord / width;
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
    const std::size_t size = double_ ? 8 : 4;
    std::size_t count = rest_.size() / size;
    const double steps = (parameter("REFERENCE_LINE_END_U", kNaN) - parameter("REFERENCE_LINE_START_U", 0.0)) /
                         needed("REFERENCE_LINE_INCREMENT");
    if (std::isfinite(steps)) {
      const double wanted = (std::floor(steps + 0.5) + 1.0) * static_cast<double>(channels_.size());
      if (!(wanted >= 1.0) || wanted > static_cast<double>(count))
        throw wrong("", fmt::format("holds {} numbers, expected {:g}: the file is cut short, or its header is of "
                                    "another road",
                                    count, wanted));
      count = static_cast<std::size_t>(wanted);
    } else {
      count -= count % channels_.size();
    }
    std::vector<double> rows(count);
    for (std::size_t k = 0; k < count; ++k) rows[k] = binary(rest_.data() + k * size);
    return rows;
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

    const double slope_before = constant("S", Channel::slope), banking_before = constant("B", Channel::banking);
    if (!has(Channel::slope) && parameters_.contains("REFERENCE_LINE_END_Z") && slope_before == 0.0 &&
        parameter("REFERENCE_LINE_END_Z", 0.0) != parameter("REFERENCE_LINE_START_Z", 0.0))
      throw wrong("REFERENCE_LINE_END_Z", "differs from the start without a slope, expected the slope of the road");
    double line = parameter("REFERENCE_LINE_START_Z", 0.0) + parameter("REFERENCE_LINE_OFFSET_Z", 0.0);
    const std::size_t width = channels_.size();
    for (std::size_t row = 0; row + width <= rows.size(); row += width) {
      double slope = slope_before, banking = banking_before;
      std::vector<double> cuts;
      for (std::size_t k = 0; k < width; ++k) {
        const double value = rows[row + k];
        if (channels_[k] == Channel::cut) cuts.push_back(value);
        if (channels_[k] == Channel::slope) slope = value;
        if (channels_[k] == Channel::banking) banking = value;
      }
      // As the heading, the slope of a row is that from the row before to it; the first has none.
      if (row > 0) line += slope * road.increment;
      for (std::size_t k = 0; k < order.size(); ++k)
        road.heights.push_back(cuts[order[k]] + line + banking * road.v[k]);
    }
    if (road.count() < 2) throw wrong("", fmt::format("has {} cross-sections, expected two at least", road.count()));
    return road;
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
