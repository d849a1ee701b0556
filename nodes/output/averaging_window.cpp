#include "nodes/output/averaging_window.hpp"

#include <algorithm>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::output {
namespace {

// At the beginning of the window, lines may be left out to reach a whole number of facets. At most this many lines are
// left out, or the lines of one facet if they are more, but at most a quarter of the window.
constexpr std::size_t kLinesLeftOut = 50, kPartLeftOut = 4;

}  // namespace

WheelRows::WheelRows(const Table& table, std::size_t first) : table_(&table), first_(first) {
  for (const Column& column : columns_of<WheelRow>()) {
    places_.push_back(table.find(column.name).value());
    signs_.push_back(column.sign);
  }
}

WheelRow WheelRows::operator[](std::size_t i) const {
  FURROW_ASSERT(i < size(), i, size());
  const std::span<const double> line = table_->line(first_ + i);
  WheelRow row;
  std::size_t c = 0;
  visit_fields(row, [&](double& value, const Column&) { value = signs_[c] * line[places_[c]], ++c; });
  return row;
}

std::vector<double> Window::samples(std::string_view column) const {
  if (rows.empty()) return {};
  std::vector<double> all = table->column(column);
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(first, all.size())));
  return all;
}

double Window::mean_of(std::string_view column) const {
  const std::vector<double> values = samples(column);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

Window averaging_window(const Table& table, double from, int facets) {
  FURROW_ASSERT(facets >= 0, facets);
  const WheelRows rows(table);
  std::size_t first = 1;
  while (first < rows.size() && rows[first].time < from) ++first;
  if (first >= rows.size()) return {};
  const double facet = 2.0 * std::numbers::pi / facets;
  const double turn_last = std::abs(rows.back().spin) * (rows.back().time - rows[rows.size() - 2].time);
  const std::size_t part = (rows.size() - first) / kPartLeftOut;
  const std::size_t of_facet =
      facet < turn_last * static_cast<double>(part) ? static_cast<std::size_t>(std::ceil(facet / turn_last)) : part;
  const std::size_t left_out = std::max(kLinesLeftOut, of_facet);
  double turned = 0.0, least = INFINITY;
  std::size_t chosen = first;
  bool whole = false;
  for (std::size_t start = rows.size() - 1; start >= first; --start) {
    const double turn = std::abs(rows[start].spin) * (rows[start].time - rows[start - 1].time);
    turned += turn;
    const double off = std::abs(std::remainder(turned, facet));
    if (start >= first + left_out || turned < 0.5 * facet || off >= least) continue;
    least = off;
    chosen = start;
    whole = off <= turn;
  }
  return {WheelRows(table, chosen), rows[chosen - 1], whole, &table, chosen};
}

}  // namespace furrow::output
