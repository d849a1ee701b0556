#include "protocol/files/digits.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace furrow {
namespace {

constexpr double kSmallest = 1e-4, kLargest = 1e7;  // range of numbers written without an exponent
constexpr double kNothing = 1e-12;                  // round-off of zero
constexpr int kMostDecimals = 6;

/// Number of decimals that show `count` significant digits of x; none if these lie before the point.
int decimals_of(double x, int count) {
  return std::clamp(count - 1 - static_cast<int>(std::floor(std::log10(std::abs(x)))), 0, kMostDecimals);
}

bool plain(double x) { return std::abs(x) >= kSmallest && std::abs(x) < kLargest; }

/// Writes a value that is rounded to zero without its sign.
std::string fixed(double x, int decimals) {
  std::string text = fmt::format("{:.{}f}", x, decimals);
  if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
  return text;
}

}  // namespace

std::string digits(double x) {
  if (std::abs(x) < kNothing) return "0";
  if (!plain(x)) return fmt::format("{:.3g}", x);
  return fixed(x, decimals_of(x, 3));
}

std::string with_error(double value, double error) {
  if (!std::isfinite(error)) return digits(value) + " ± unknown";
  const bool small = std::abs(value) < kLargest;
  if (!plain(error) || !small) return digits(value) + " ± " + digits(error);
  const int decimals = decimals_of(error, 2);
  return fixed(value, decimals) + " ± " + fixed(error, decimals);
}

}  // namespace furrow
