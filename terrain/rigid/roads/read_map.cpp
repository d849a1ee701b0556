#include "terrain/rigid/roads/read_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/files/csv_file.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/road_line.hpp"
#include "terrain/rigid/roads/open_crg.hpp"
#include "terrain/rigid/roads/road_text.hpp"

namespace furrow::terrain {
namespace {

constexpr std::uintmax_t kMostMapBytes = 1u << 30;

HeightMap map_of(const OpenCrg& road, const std::filesystem::path& file) {
  HeightMap map;
  map.y = road.v;
  map.z = road.heights;
  map.turn = road.turn;
  const std::size_t cuts = road.v.size();
  for (std::size_t k = 0; k < road.count(); ++k) {
    map.x.push_back(road.start + static_cast<double>(k) * road.increment);
    const auto there = [](double z) { return !std::isnan(z); };
    const auto row = map.z.begin() + static_cast<std::ptrdiff_t>(k * cuts),
               end = row + static_cast<std::ptrdiff_t>(cuts);
    const auto first = std::find_if(row, end, there);
    if (first == end)
      throw input_error(file.string(), "", fmt::format("has no height at u = {:g} m, expected one", map.x.back()));
    auto last = end - 1;
    while (std::isnan(*last)) --last;
    std::fill(row, first, *first);
    std::fill(last, end, *last);
  }
  return map;
}

/// @pre the map is placed along x
std::shared_ptr<const RoadLine> line_of(const HeightMap& map, const std::vector<double>& headings,
                                        const RoadPlace& place, const std::filesystem::path& file) {
  const double first = map.x.front(), increment = map.x[1] - first;
  auto line = std::make_shared<const RoadLine>(RoadLine::Vec2(first, -place.v), first, increment, headings);
  for (std::size_t k = 0; k < headings.size(); ++k)
    for (const double v : {map.y.front(), map.y.back()})
      if (const double room = line->room(k, v < 0.0 ? -1.0 : 1.0); std::abs(v) >= room)
        throw input_error(file.string(), "",
                          fmt::format("turns at u = {:g} m so sharply that its cross-sections meet {:.3g} m beside the "
                                      "reference line, but has heights at v = {:g} m: expected terrain.profile_line "
                                      "straight",
                                      map.x[k], room, v));
  return line;
}

/// Refuses meshes and pictures, in which other programs keep terrains. @throws Error(bad_input)
void refuse_meshes_and_pictures(const std::filesystem::path& file) {
  for (const auto& [ending, kind] : {std::pair{".obj", "mesh"},
                                     {".stl", "mesh"},
                                     {".ply", "mesh"},
                                     {".bmp", "picture"},
                                     {".png", "picture"},
                                     {".tif", "picture"},
                                     {".tiff", "picture"}})
    if (has_ending(file, ending))
      throw input_error(file.string(), "",
                        fmt::format("is a {}, expected heights in CSV, a grid in ASCII after ESRI (.asc) or a road in "
                                    "OpenCRG (.crg)",
                                    kind));
}

/// Rows of a CSV file as the nodes of a grid; none if it is a profile.
std::optional<HeightMap> read_csv_map(const std::filesystem::path& file) {
  refuse_meshes_and_pictures(file);
  const CsvFile csv(file, "heights in CSV with the columns x_m, z_m and, of a grid, y_m", {"x_m", "z_m", "y_m"});
  if (!csv.has("y_m")) return std::nullopt;
  std::map<double, std::size_t> x, y;  // number of each, in order
  for (std::size_t row = 0; row < csv.row_count(); ++row) x[csv.number(row, "x_m")], y[csv.number(row, "y_m")];
  HeightMap map;
  for (auto& [value, number] : x) number = map.x.size(), map.x.push_back(value);
  for (auto& [value, number] : y) number = map.y.size(), map.y.push_back(value);
  const std::size_t nodes = map.x.size() * map.y.size();
  if (nodes != csv.row_count())
    throw input_error(file.string(), "",
                      fmt::format("has {} rows for {} x and {} y, expected {}: one for each node of the grid",
                                  csv.row_count(), map.x.size(), map.y.size(), nodes));
  map.z.assign(nodes, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t row = 0; row < csv.row_count(); ++row) {
    double& z = map.z[x[csv.number(row, "x_m")] * map.y.size() + y[csv.number(row, "y_m")]];
    if (!std::isnan(z)) throw csv.wrong(row, "is a node of the grid once more, expected another");
    z = csv.number(row, "z_m");
  }
  return map;
}

/// A grid in ASCII: words between blanks.
class AsciiGrid {
 public:
  explicit AsciiGrid(const std::filesystem::path& file)
      : name_(file.string()), text_(read_whole_file(file, kMostMapBytes)), rest_(text_) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);  // a byte-order mark, which editors write
  }

  HeightMap read() {
    read_header();
    const auto columns = count("NCOLS"), rows = count("NROWS");
    const double cell = needed("CELLSIZE"), none = value("NODATA_VALUE").value_or(-9999.0);
    if (!(cell > 0.0)) throw input_error(name_, "cellsize", fmt::format("is {:g}, expected more than 0 m", cell));
    if (columns * rows > kMostMapNodes)
      throw input_error(name_, "", fmt::format("has {} heights, expected at most {}", columns * rows, kMostMapNodes));
    HeightMap map;
    const double x = first("XLL", cell), y = first("YLL", cell);
    for (std::size_t k = 0; k < columns; ++k) map.x.push_back(x + static_cast<double>(k) * cell);
    for (std::size_t k = 0; k < rows; ++k) map.y.push_back(y + static_cast<double>(k) * cell);
    map.z.resize(columns * rows);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column)
        map.z[column * rows + (rows - 1 - row)] = height(row, column, none);
    if (!next_word().empty())
      throw input_error(name_, "", fmt::format("has more than {} heights, expected ncols × nrows", columns * rows));
    return map;
  }

 private:
  std::string_view next_word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

  /// NAME number, until a word is a number itself.
  void read_header() {
    while (true) {
      const std::string_view before = rest_;
      const std::string name = upper(next_word());
      if (name.empty() || number_of(name)) {
        rest_ = before;
        return;
      }
      constexpr std::array kNames{"NCOLS",     "NROWS",     "XLLCORNER", "XLLCENTER",
                                  "YLLCORNER", "YLLCENTER", "CELLSIZE",  "NODATA_VALUE"};
      const std::string_view word = next_word();
      const auto number = number_of(word);
      if (std::ranges::find(kNames, name) == kNames.end())
        throw input_error(name_, excerpt(name),
                          "is unknown, expected ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize "
                          "and NODATA_value of a grid in ASCII after ESRI, then its heights");
      if (!number) throw input_error(name_, name, "is '" + excerpt(std::string(word)) + "', expected a number");
      if (!header_.emplace(name, *number).second) throw input_error(name_, name, "is given twice, expected it once");
    }
  }

  std::optional<double> value(const std::string& name) const {
    const auto found = header_.find(name);
    return found == header_.end() ? std::nullopt : std::optional(found->second);
  }
  double needed(const std::string& name) const {
    if (const auto found = value(name)) return *found;
    throw input_error(name_, name, "is missing, expected it in the header");
  }
  std::size_t count(const std::string& name) const {
    const double number = needed(name);
    if (!(number >= 2.0 && number <= static_cast<double>(kMostMapNodes) && number == std::floor(number)))
      throw input_error(name_, name,
                        fmt::format("is {:g}, expected a whole number from 2 to {}", number, kMostMapNodes));
    return static_cast<std::size_t>(number);
  }
  /// Of the first cell's centre.
  double first(const std::string& axis, double cell) const {
    if (const auto center = value(axis + "CENTER")) return *center;
    return needed(axis + "CORNER") + 0.5 * cell;
  }
  double height(std::size_t row, std::size_t column, double none) {
    const std::string_view word = next_word();
    const auto number = number_of(word);
    const auto place = [&] { return fmt::format("row {}, column {}", row + 1, column + 1); };
    if (word.empty()) throw input_error(name_, place(), "is missing, expected ncols × nrows heights");
    if (!number) throw input_error(name_, place(), "is '" + excerpt(std::string(word)) + "', expected a number");
    if (*number == none)
      throw input_error(
          name_, place(),
          fmt::format("has no height (NODATA_value {:g}), expected a grid that was cropped or filled", none));
    return *number;
  }

  std::string name_, text_;
  std::string_view rest_;
  std::map<std::string, double> header_;
};

}  // namespace

bool has_ending(const std::filesystem::path& file, std::string_view ending) {
  return upper(file.extension().string()) == upper(ending);
}

std::shared_ptr<const HeightMap> read_map(const std::filesystem::path& file, const RoadPlace& place) {
  HeightMap map;
  std::vector<double> headings;
  if (has_ending(file, ".crg")) {
    OpenCrg road = read_open_crg(file);
    if (road.v.size() < 2 && !place.curved) return nullptr;
    map = map_of(road, file);
    headings = std::move(road.headings);
  } else if (has_ending(file, ".asc")) {
    map = AsciiGrid(file).read();
  } else if (auto grid = read_csv_map(file)) {
    map = std::move(*grid);
  } else {
    return nullptr;
  }
  if (place.curved && headings.empty())
    throw input_error(file.string(), "", "has no reference line, expected OpenCRG with terrain.profile_line curved");
  const double shift = place.shift(map.x.front());
  for (double& x : map.x) x += shift;
  if (place.curved)
    map.line = line_of(map, headings, place, file), map.turn = 0.0;
  else
    for (double& y : map.y) y -= place.v;
  for (const auto& [name, values] : {std::pair("x", &map.x), {"y", &map.y}}) {
    if (values->size() < 2)
      throw input_error(file.string(), "", fmt::format("has one {} alone, expected a grid of two at least", name));
    if (values->front() < -kFarthest || values->back() > kFarthest)
      throw input_error(file.string(), "",
                        fmt::format("lies from {} = {:g} to {:g} m, expected {:g} to {:g} m: terrain.profile_from and "
                                    "terrain.profile_v place it",
                                    name, values->front(), values->back(), -kFarthest, kFarthest));
  }
  const std::size_t across = map.y.size();
  const auto place_of = [&](std::size_t k) {
    return fmt::format("{} = {:g} m, {} = {:g} m", map.line ? "u" : "x", map.x[k / across], map.line ? "v" : "y",
                       map.y[k % across] + (map.line ? 0.0 : place.v));
  };
  for (std::size_t k = 0; k < map.z.size(); ++k) {
    if (std::isnan(map.z[k]))
      throw input_error(file.string(), "",
                        fmt::format("has no height at {}, expected a road without gaps", place_of(k)));
    if (!(std::abs(map.z[k]) <= kFarthest))
      throw input_error(file.string(), "",
                        fmt::format("has the height {:g} m at {}, expected {:g} to {:g} m", map.z[k], place_of(k),
                                    -kFarthest, kFarthest));
  }
  return std::make_shared<const HeightMap>(std::move(map));
}

}  // namespace furrow::terrain
