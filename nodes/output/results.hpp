// What a run leaves behind, written by the rig's rank: timeseries.csv, results.h5, results.xdmf, summary.json.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/output/series.hpp"
#include "nodes/output/series_builder.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/messages.hpp"

namespace furrow::output {

/// Everything the summary of one wheel is computed from.
struct SummaryInput {
  const scenario::Scenario& scenario;
  std::span<const NodeCard> cards;  // rig, tires, terrain
  const TerrainSetup& setup;
  std::span<const FinalReport> reports;  // as cards
  std::span<const SeriesRow> rows;
  const SeriesBuilder& builder;  // totals at the end
  const SpindleReport& tire;     // the last one
  double carried_mass = 0.0;     // kg
  std::vector<checkpoint::Segment> segments;
  int wheel = 0;
};

/// summary.json's text. Values that could not be measured are null.
std::string summary_text(const SummaryInput& input);

class Results {
 public:
  /// Opens the series files of all wheels in the existing run directory; writes scenario.json. Where a run goes on, what
  /// was written after its checkpoint is removed, and the index made anew.
  /// @param resume null: the run begins
  /// @throws Error(io)
  Results(const scenario::Scenario& scenario, std::vector<NodeCard> cards, const TerrainSetup& setup,
          const std::filesystem::path& directory, const checkpoint::ResumePoint* resume = nullptr);

  void add(int wheel, const SeriesRow& row);
  std::vector<checkpoint::SeriesMark> mark_series();

  /// Writes results.h5, results.xdmf and, unless the run was stopped early, summary.json. @throws Error(io)
  void finish(std::span<const FinalReport> reports, std::span<const SeriesBuilder> builders,
              std::span<const SpindleReport> tires, std::span<const double> carried_mass, double wall,
              bool stopped);

 private:
  void continue_from(const checkpoint::ResumePoint& resume);
  void write_hdf5(std::span<const FinalReport> reports) const;

  scenario::Scenario scenario_;
  std::vector<NodeCard> cards_;
  TerrainSetup setup_;
  std::filesystem::path directory_;
  const checkpoint::ResumePoint* resume_;
  std::vector<std::unique_ptr<SeriesWriter>> writers_;
  std::vector<std::vector<SeriesRow>> rows_;  // per wheel
};

}  // namespace furrow::output
