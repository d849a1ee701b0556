#include "nodes/output/subject_series.hpp"

namespace furrow::output {
namespace {

std::vector<Column> base_columns(bool wheel) {
  return wheel ? columns_of<WheelRow>() : std::vector<Column>{column::instant("time_s", "s")};
}

}  // namespace

SubjectSeries::SubjectSeries(const rigs::Subject& subject, std::optional<SeriesBuilder> wheel)
    : name_(subject.name),
      wheel_(std::move(wheel)),
      time_(base_columns(false)),
      added_(subject.columns),
      columns_(merged_columns(base_columns(wheel_.has_value()), subject.columns)),
      base_places_(places_of(base_columns(wheel_.has_value()))),
      added_places_(places_of(subject.columns)),
      measured_(subject.columns.size()),
      row_(base_places_.size()),
      line_(columns_.size()) {}

std::vector<std::size_t> SubjectSeries::places_of(std::span<const Column> columns) const {
  std::vector<std::size_t> places;
  const Table table = empty_table();
  for (const Column& column : columns) places.push_back(table.find(column.name).value());
  return places;
}

void SubjectSeries::measure(const rigs::Rig& rig, int subject) {
  rig.measure(subject, measured_);
  added_.add(measured_);
}

void SubjectSeries::add(const StepReports& reports, const rigs::Rig& rig, int subject) {
  wheel_->add(reports);
  measure(rig, subject);
}

void SubjectSeries::add(double time, const rigs::Rig& rig, int subject) {
  time_.add({&time, 1});
  measure(rig, subject);
}

void SubjectSeries::place(std::span<const double> values, std::span<const std::size_t> places) {
  for (std::size_t i = 0; i < places.size(); ++i) line_[places[i]] = columns_[places[i]].sign * values[i];
}

std::span<const double> SubjectSeries::take(const rigs::Rig& rig, int subject) {
  if (wheel_) {
    get_values(wheel_->take(), row_);
    place(row_, base_places_);
  } else {
    place(time_.take(), base_places_);
  }
  place(added_.take(), added_places_);
  rig.derive(subject, {columns_, line_}, measured_);
  for (std::size_t i = 0; i < added_places_.size(); ++i)
    if (const Column& column = columns_[added_places_[i]]; column.kind == ColumnKind::derived)
      line_[added_places_[i]] = column.sign * measured_[i];
  return line_;
}

void SubjectSeries::save(Archive& archive) const {
  const Archive::Scope scope(archive, name_ + "/");
  if (wheel_)
    wheel_->save(archive);
  else
    time_.save(archive, "series/");
  added_.save(archive, "rig_series/");
}

void SubjectSeries::restore(const Archive& archive) {
  const Archive::Scope scope(archive, name_ + "/");
  if (wheel_)
    wheel_->restore(archive);
  else
    time_.restore(archive, "series/");
  added_.restore(archive, "rig_series/");
}

}  // namespace furrow::output
