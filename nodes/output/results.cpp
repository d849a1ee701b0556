#include "nodes/output/results.hpp"

#include <cmath>

#include <fmt/format.h>

#include "nodes/output/frames.hpp"
#include "nodes/output/xdmf.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

std::string numbered(const std::string& stem, std::size_t wheel, const std::string& extension) {
  return wheel == 0 ? stem + extension : fmt::format("{}_wheel{}{}", stem, wheel, extension);
}

void put_heights(Hdf5Writer& file, const std::string& name, const HeightField& field) {
  FURROW_ASSERT(field.height.size() == static_cast<std::size_t>(field.nx) * field.ny, name,
                field.height.size(), field.nx, field.ny);
  if (field.nx == 0) return;
  file.put(name, field.height, {static_cast<hsize_t>(field.nx), static_cast<hsize_t>(field.ny)});
  file.put(name + "_grid", std::vector<double>{field.x0, field.y0, field.cell}, {3});
}

}  // namespace

Results::Results(const scenario::Scenario& scenario, std::vector<NodeCard> cards, const TerrainSetup& setup,
                 const std::filesystem::path& directory, const checkpoint::ResumePoint* resume)
    : scenario_(scenario), cards_(std::move(cards)), setup_(setup), directory_(directory), resume_(resume) {
  const std::size_t wheels = scenario_.tires.size();
  rows_.resize(wheels);
  if (resume) {
    continue_from(*resume);
    return;
  }
  write_whole_file(directory_ / "scenario.json", scenario_.completed + "\n");
  for (std::size_t k = 0; k < wheels; ++k)
    writers_.push_back(std::make_unique<SeriesWriter>(directory_ / numbered("timeseries", k, ".csv")));
}

void Results::continue_from(const checkpoint::ResumePoint& resume) {
  FURROW_ASSERT(resume.manifest.series.size() == rows_.size(), resume.manifest.series.size(), rows_.size());
  const checkpoint::CheckpointManifest& manifest = resume.manifest;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    writers_.push_back(std::make_unique<SeriesWriter>(directory_ / numbered("timeseries", k, ".csv"),
                                                      manifest.series.at(k), rows_[k]));
  std::error_code ignored;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    std::filesystem::remove(directory_ / numbered("summary", k, ".json"), ignored);
  std::filesystem::remove(directory_ / "results.h5", ignored);
  remove_frames_from(directory_, manifest.frames.index(manifest.step));
  checkpoint::remove_checkpoints_after(directory_, manifest.step);
  write_xdmf_index(directory_);
  write_whole_file(directory_ / "scenario.json", scenario_.completed + "\n");
}

std::vector<checkpoint::SeriesMark> Results::mark_series() {
  std::vector<checkpoint::SeriesMark> marks;
  for (auto& writer : writers_) marks.push_back(writer->mark());
  return marks;
}

void Results::add(int wheel, const SeriesRow& row) {
  FURROW_ASSERT(in_range(wheel, rows_.size()), wheel, rows_.size());
  rows_[wheel].push_back(row);
  writers_[wheel]->add(row);
}

void Results::write_hdf5(std::span<const FinalReport> reports) const {
  // series/wheel<k>/<column>: as timeseries.csv, same names. terrain/height_before, height_after: (nx, ny) m, NaN where
  // no grain is; terrain/height_*_grid: x and y of the first cell's centre and the cell's size, m.
  Hdf5Writer file(directory_ / "results.h5");
  file.attribute("scenario", scenario_.name);
  file.attribute("scenario_digest", scenario_.digest);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    std::vector<double> values(rows_[k].size());
    for (const SeriesColumn& column : series_columns()) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = column.value(rows_[k][i]);
      file.put(fmt::format("series/wheel{}/{}", k, column.name), values, {values.size()});
    }
  }
  put_heights(file, "terrain/height_before", reports.back().height_before);
  put_heights(file, "terrain/height_after", reports.back().height_after);
  file.finish();
}

void Results::finish(std::span<const FinalReport> reports, std::span<const SeriesBuilder> builders,
                     std::span<const SpindleReport> tires, std::span<const double> carried_mass, double wall,
                     bool stopped) {
  FURROW_ASSERT(reports.size() == cards_.size(), reports.size(), cards_.size());
  FURROW_ASSERT(builders.size() == rows_.size(), builders.size(), rows_.size());
  FURROW_ASSERT(carried_mass.size() == rows_.size(), carried_mass.size(), rows_.size());
  FURROW_ASSERT(wall >= 0.0, wall);
  for (auto& writer : writers_) writer->flush();
  write_hdf5(reports);
  write_xdmf_index(directory_);
  if (stopped) return;
  const auto steps =
      static_cast<std::int64_t>(std::llround(builders.front().now().time / scenario_.run.step));
  const std::vector<checkpoint::Segment> segments =
      checkpoint::segments_until(steps, wall, reports.back().threads, resume_);
  for (std::size_t k = builders.size(); k-- > 0;) {
    const SummaryInput input{scenario_,   cards_,   setup_,          reports,  rows_[k],
                             builders[k], tires[k], carried_mass[k], segments, static_cast<int>(k)};
    write_whole_file(directory_ / numbered("summary", k, ".json"), summary_text(input));
  }
}

}  // namespace furrow::output
