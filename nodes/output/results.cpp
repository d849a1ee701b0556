#include "nodes/output/results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/launch/run_list.hpp"
#include "nodes/output/column_labels.hpp"
#include "nodes/output/frames.hpp"
#include "nodes/output/xdmf.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

/// @throws Error(io) if the checkpoint does not contain this table
const checkpoint::SeriesMark& mark_of(const checkpoint::ResumePoint& resume, const std::string& subject) {
  for (const checkpoint::SeriesMark& mark : resume.manifest.series)
    if (mark.subject == subject) return mark;
  throw io_error(resume.folder.string(), "knows no table of '" + subject + "'");
}

void label(Hdf5Writer& file, const std::string& dataset, const std::string& units, const std::string& long_name) {
  file.attribute_of(dataset, "units", units);
  file.attribute_of(dataset, "long_name", long_name);
}

void put_cells(Hdf5Writer& file, const std::string& name, double first, double cell, int count,
               const std::string& long_name) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(first + i * cell);
  file.put(name, places, {places.size()});
  label(file, name, "m", long_name);
  file.lay_along(name, {name});
}

/// Writes terrain/x_m, terrain/y_m and terrain/grid, the axes of the surfaces before and after.
void put_height_axes(Hdf5Writer& file, const HeightField& field) {
  if (field.nx == 0) return;
  put_cells(file, "terrain/x_m", field.x0, field.cell, field.nx, "place of the cell's centre, forward");
  put_cells(file, "terrain/y_m", field.y0, field.cell, field.ny, "place of the cell's centre, to the left");
  file.put_axis("terrain/grid", 3);
}

/// @pre their axes were written for a field on the same grid
void put_heights(Hdf5Writer& file, const std::string& when, const HeightField& field) {
  const std::string name = "terrain/height_" + when;
  FURROW_ASSERT(field.height.size() == static_cast<std::size_t>(field.nx) * field.ny, name, field.height.size(),
                field.nx, field.ny);
  if (field.nx == 0) return;
  file.put(name, field.height, {static_cast<hsize_t>(field.nx), static_cast<hsize_t>(field.ny)});
  label(file, name, "m", "height of the surface " + when + " the run");
  file.lay_along(name, {"terrain/x_m", "terrain/y_m"});
  file.put(name + "_grid", std::vector<double>{field.x0, field.y0, field.cell}, {3});
  label(file, name + "_grid", "m", "x and y of the first cell's centre, size of a cell");
  file.lay_along(name + "_grid", {"terrain/grid"});
}

/// Writes series/<subject>/<column>, along the column of the table's time.
void put_table(Hdf5Writer& file, const Table& table) {
  const std::string group = "series/" + table.subject + "/", time = group + "time_s";
  for (const Column& column : table.columns) {
    const std::string name = group + column.name;
    file.put(name, table.column(column.name), {table.lines()});
    label(file, name, units_label(column.unit), long_name(column));
    if (const std::string methods = cell_methods(column); !methods.empty() && name != time)
      file.attribute_of(name, "cell_methods", methods);
  }
  if (!table.find("time_s")) return;
  for (const Column& column : table.columns) file.lay_along(group + column.name, {time});
}

/// Writes the names of wheels. The tables of the wheels are the first ones, in the order of the rig's wheels.
void put_wheel_names(Hdf5Writer& file, std::span<const Table> tables, const rigs::RigDescription& rig) {
  for (std::size_t k = 0; k < rig.wheels.size(); ++k)
    if (!rig.wheels[k].name.empty()) file.attribute_of("series/" + tables[k].subject, "name", rig.wheels[k].name);
}

/// Removes plots and report, which show an end that is no longer the run's.
void remove_plots(const std::filesystem::path& run) {
  std::error_code ignored;
  for (const std::string& name : launch::RunList::read(run).find(run).files)
    if (name.ends_with(".png") || name == "report.html") std::filesystem::remove(run / name, ignored);
}

}  // namespace

std::string table_file(const std::string& subject, int wheels) {
  return wheels == 1 && subject == "wheel0" ? "timeseries.csv" : "timeseries_" + subject + ".csv";
}

Results::Results(const scenario::Scenario& scenario, std::vector<NodeCard> cards, const TerrainSetup& setup,
                 const std::filesystem::path& directory, std::vector<Table> tables,
                 const checkpoint::ResumePoint* resume)
    : scenario_(scenario),
      cards_(std::move(cards)),
      setup_(setup),
      directory_(directory),
      resume_(resume),
      tables_(std::move(tables)) {
  list_files();
  for (Table& table : tables_) table.kept.keep_in(directory_);
  if (resume) {
    continue_from(*resume);
    return;
  }
  write_whole_file(directory_ / "scenario.json", scenario_.completed + "\n");
  for (const Table& table : tables_) writers_.push_back(std::make_unique<TableWriter>(file_of(table), table));
}

std::filesystem::path Results::file_of(const Table& table) const {
  return directory_ / table_file(table.subject, cards_.front().wheel_count);
}

/// Lists all files before any rank writes one: the other ranks wait for the rig until they are placed.
void Results::list_files() const {
  std::vector<std::string> names{"scenario.json", "results.h5", "results.xdmf", "summary.json", "summary_failed.json"};
  for (const Table& table : tables_) names.push_back(file_of(table).filename().string());
  for (const auto& forms : {frame_forms(), checkpoint::checkpoint_forms()})
    names.insert(names.end(), forms.begin(), forms.end());
  launch::add_to_run_list(directory_, names);
}

void Results::begun() const { launch::add_to_run_list(directory_, {launch::kBegun}); }

void Results::continue_from(const checkpoint::ResumePoint& resume) {
  const checkpoint::CheckpointManifest& manifest = resume.manifest;
  for (Table& table : tables_)
    writers_.push_back(std::make_unique<TableWriter>(file_of(table), mark_of(resume, table.subject), table));
  std::error_code ignored;
  for (const char* name : {"summary.json", "results.h5"}) std::filesystem::remove(directory_ / name, ignored);
  remove_plots(directory_);
  launch::remove_unfinished(directory_);
  const std::int64_t every = scenario_.run.steps_in(scenario_.output.frame_interval);
  remove_frames_from(directory_, continued_frames(directory_, manifest, every).index(manifest.step));
  checkpoint::remove_checkpoints_after(directory_, manifest.step);
  write_xdmf_index(directory_);
  write_whole_file(directory_ / "scenario.json", scenario_.completed + "\n");
}

std::vector<checkpoint::SeriesMark> Results::mark_series() {
  std::vector<checkpoint::SeriesMark> marks;
  for (auto& writer : writers_) marks.push_back(writer->mark());
  return marks;
}

std::vector<std::string> Results::flush() {
  std::vector<std::string> again;
  for (std::size_t k = 0; k < tables_.size(); ++k) {
    writers_[k]->flush();
    if (writers_[k]->stands()) continue;
    writers_[k]->write_again(tables_[k]);
    again.push_back(file_of(tables_[k]).filename().string());
  }
  std::error_code error;
  if (!std::filesystem::exists(directory_ / "scenario.json", error)) {
    write_whole_file(directory_ / "scenario.json", scenario_.completed + "\n");
    again.emplace_back("scenario.json");
  }
  return again;
}

void Results::add(int table, std::span<const double> line) {
  FURROW_ASSERT(in_range(table, tables_.size()), table, tables_.size());
  tables_[table].kept.add(line);
  writers_[table]->add(line);
}

void Results::write_hdf5(std::span<const FinalReport> reports) const {
  // series/<subject>/<column>: as in the subject's CSV file, same names; attribute `name` of a wheel's group: its name
  // in the vehicle's file. terrain/height_before, height_after: (nx, ny) m, NaN where there is no grain, over
  // terrain/x_m (nx), terrain/y_m (ny); terrain/height_*_grid: x and y of the first cell's centre and the cell's size,
  // m.
  Hdf5Writer file(directory_ / "results.h5");
  file.attribute("scenario", scenario_.name);
  file.attribute("scenario_digest", scenario_.digest);
  for (const Table& table : tables_) put_table(file, table);
  if (!scenario_.tires.empty()) put_wheel_names(file, tables_, scenario::describe_rig(scenario_));
  if (!reports.empty()) {
    const FinalReport& terrain = reports[scenario::terrain_rank(scenario_)];
    put_height_axes(file, terrain.height_after);
    put_heights(file, "before", terrain.height_before);
    put_heights(file, "after", terrain.height_after);
  }
  file.finish();
}

SummaryInput Results::summary_input(const RunEnd& end) const {
  std::int64_t steps = std::llround(end.time / scenario_.run.step);
  if (resume_) steps = std::max(steps, resume_->manifest.step);
  return {scenario_,
          cards_,
          setup_,
          tables_,
          end,
          checkpoint::segments_until(steps, end.wall, cards_[scenario::terrain_rank(scenario_)].threads, resume_)};
}

std::string Results::finish(const RunEnd& end, bool stopped) {
  FURROW_ASSERT(end.reports.size() == cards_.size(), end.reports.size(), cards_.size());
  FURROW_ASSERT((stopped || !end.wheels.empty()) && end.wheels.size() <= tables_.size(), end.wheels.size(),
                tables_.size());
  FURROW_ASSERT(end.wall >= 0.0, end.wall);
  flush();
  write_hdf5(end.reports);
  std::string lost_frames = write_xdmf_index(directory_);
  if (stopped) return lost_frames;
  // Removes rests of a checkpoint or a frame that could not be written while the folder had another name.
  checkpoint::remove_checkpoints_after(directory_, std::numeric_limits<std::int64_t>::max());
  launch::remove_unfinished(directory_);
  // Until now this file of an earlier failure could suggest a smaller step for the run.
  std::error_code ignored;
  std::filesystem::remove(directory_ / "summary_failed.json", ignored);
  write_whole_file(directory_ / "summary.json", summary_text(summary_input(end)));
  return lost_frames;
}

void Results::fail(const RunEnd& end, const Failure& failure) {
  FURROW_ASSERT(end.reports.empty() && end.wheels.size() <= tables_.size(), end.reports.size(), end.wheels.size());
  flush();
  SummaryInput input = summary_input(end);
  input.failure = &failure;
  write_whole_file(directory_ / "summary_failed.json", summary_text(input));
  write_hdf5({});
  write_xdmf_index(directory_);
}

}  // namespace furrow::output
