#include "protocol/files/nearest_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/files/json_text.hpp"

namespace furrow {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto letter = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::array<std::vector<std::size_t>, 3> rows;  // of a's letter before the previous one, the previous one, this one
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[2][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    rows[2][0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = letter(a[i - 1]) == letter(b[j - 1]);
      rows[2][j] = std::min({rows[1][j] + 1, rows[2][j - 1] + 1, rows[1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && letter(a[i - 1]) == letter(b[j - 2]) && letter(a[i - 2]) == letter(b[j - 1]))
        rows[2][j] = std::min(rows[2][j], rows[0][j - 2] + 1);
    }
  }
  return rows[2].back();
}

std::vector<std::string> nearest_words(const std::string& word, const std::vector<std::string>& known) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance <= std::max<std::size_t>(2, word.size() / 4)) ranked.emplace_back(distance, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ranked.size() && i < 3; ++i) names.push_back(ranked[i].second);
  return names;
}

std::string unknown_text(const std::vector<std::string>& similar, const std::vector<std::string>& known) {
  return similar.empty() ? fmt::format("is unknown, expected one of: {}", fmt::join(known, ", "))
                         : fmt::format("is unknown, expected '{}'?", similar.front());
}

namespace {

constexpr double kMostPressure = 1e7;  // Pa: larger values are moduli, which nobody states in bar or psi
constexpr double kPerPsi = 6894.757;   // Pa

struct OtherUnit {
  const char* name;  // "" if the name depends on the quantity
  double factor;     // to SI
};

std::vector<OtherUnit> other_units(const std::string& unit, double high) {
  if (unit == "Pa" && high <= kMostPressure) return {{"kPa", 1e3}, {"bar", 1e5}, {"psi", kPerPsi}, {"MPa", 1e6}};
  if (unit == "Pa") return {{"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}};
  if (unit == "m") return {{"mm", 1e-3}, {"cm", 1e-2}};
  if (unit == "s") return {{"ms", 1e-3}, {"µs", 1e-6}};
  if (unit == "kg/m³") return {{"g/cm³", 1e3}};
  if (unit == "kg") return {{"t", 1e3}, {"g", 1e-3}};
  if (unit == "m/s") return {{"km/h", 1.0 / 3.6}, {"mm/s", 1e-3}};
  if (unit == "rad") return {{"degrees", std::numbers::pi / 180.0}};
  if (unit == "deg") return {{"rad", 180.0 / std::numbers::pi}};
  if (unit == "-") return {{"per cent", 1e-2}};
  return {{"", 1e3}, {"", 1e-3}, {"", 1e6}, {"", 1e-6}};
}

/// Rounded to four digits, as a guess is not more accurate.
double rounded(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }

}  // namespace

std::string unusual_text(double value, double low, double high, const std::string& unit) {
  const double size = std::abs(value);
  const bool small = low >= 0.0 ? size < low : value < low;
  if (value == 0.0 || (!small && value <= high)) return {};
  std::string guesses;
  for (const auto& [name, factor] : other_units(unit, high)) {
    if (!(low > 0.0 && size * factor >= low && size * factor <= high)) continue;
    const std::string guess = number_text(rounded(value * factor));
    if (!*name) {
      guesses = guess;  // only the likeliest guess
      break;
    }
    guesses += fmt::format("{}{} ({})", guesses.empty() ? "" : " or ", guess, name);
  }
  const std::string shown = unit == "-" || unit.empty() ? "" : " " + unit;
  return fmt::format("{}{} is unusually {}, usual is {} to {}{}{}", number_text(value), shown,
                     small ? "small" : "large", number_text(low), number_text(high), shown,
                     guesses.empty() ? "" : fmt::format(": did you mean {}?", guesses));
}

}  // namespace furrow
