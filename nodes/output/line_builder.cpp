#include "nodes/output/line_builder.hpp"

#include "protocol/core/assert.hpp"

namespace furrow::output {

namespace {

constexpr char kCount[] = "intervals";

}  // namespace

void LineBuilder::add(std::span<const double> measured) {
  FURROW_ASSERT(measured.size() == columns_.size(), measured.size(), columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i)
    values_[i] = columns_[i].kind == ColumnKind::mean ? values_[i] + measured[i] : measured[i];
  count_ += 1.0;
}

std::span<const double> LineBuilder::take() {
  const double share = this->share();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    line_[i] = values_[i];
    if (columns_[i].kind != ColumnKind::mean) continue;
    line_[i] *= share;
    values_[i] = 0.0;
  }
  count_ = 0.0;
  return line_;
}

void LineBuilder::save(Archive& archive, const std::string& folder) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) archive.put(folder + columns_[i].name, values_[i]);
  archive.put(folder + kCount, count_);
}

void LineBuilder::restore(const Archive& archive, const std::string& folder) {
  for (std::size_t i = 0; i < columns_.size(); ++i) values_[i] = archive.get_double(folder + columns_[i].name);
  count_ = archive.get_double(folder + kCount);
}

}  // namespace furrow::output
