// Results of a run, written by the rig's rank: the tables as CSV and in results.h5, results.xdmf, summary.json. A
// failed run has summary_failed.json instead, so summary.json means that the run is complete.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/output/accounts.hpp"
#include "nodes/output/end_reason.hpp"
#include "nodes/output/series_builder.hpp"
#include "nodes/output/table.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/messages.hpp"

namespace furrow::output {

struct WheelEnd {
  const SeriesBuilder& series;   // totals
  const SpindleReport& tire;     // the last one
  double load = 0.0;             // weight on the undisturbed ground of all that the wheel carries, N
  Vec3 heading = Vec3::UnitX();  // unit, W
  Vec3 centre = Vec3::Zero();    // of the rim, W, m
};

/// End of a run, from the rig's rank.
struct RunEnd {
  std::span<const FinalReport> reports;  // rig, tires, terrain; empty: the run has failed
  std::span<const WheelEnd> wheels;      // empty: the run failed before its first step
  const TerrainState& terrain;           // the last one
  const Accounts& accounts;
  double time = 0.0;  // simulated, s
  double wall = 0.0;  // of this segment, s
  EndReason reason = EndReason::run_end;
  rigs::RigFindings findings = {};
};

struct Failure {
  ExitCode code = ExitCode::physics;
  std::string text;
};

struct SummaryInput {
  const scenario::Scenario& scenario;
  std::span<const NodeCard> cards;  // rig, tires, terrain
  const TerrainSetup& setup;
  std::span<const Table> tables;  // the tables of wheels first, the accounts' table last
  const RunEnd& end;
  std::vector<checkpoint::Segment> segments;
  const Failure* failure = nullptr;
};

/// Returns summary.json's text: values of the run, and `wheels` with one entry per wheel. The keys of a single wheel
/// also appear at the top level. Values that could not be measured are null. For a failed run, returns
/// summary_failed.json's text, with the means of the available lines and the reason under `failed`.
std::string summary_text(const SummaryInput& input);

/// Returns "timeseries.csv" for the only wheel of a run, "timeseries_<subject>.csv" for any other table.
std::string table_file(const std::string& subject, int wheels);

class Results {
 public:
  /// Adds all files that the ranks write to the list of the existing run directory, opens the files of all tables and
  /// writes scenario.json. If a run continues, it removes everything written after the checkpoint and rebuilds the
  /// index.
  /// @param tables without lines; the tables of wheels first, the accounts' table last
  /// @param resume null: the run begins
  /// @throws Error(io)
  Results(const scenario::Scenario& scenario, std::vector<NodeCard> cards, const TerrainSetup& setup,
          const std::filesystem::path& directory, std::vector<Table> tables,
          const checkpoint::ResumePoint* resume = nullptr);

  /// Call it when all ranks have taken their first step: the replaced results are not restored from now on. @throws
  /// Error(io)
  void begun() const;

  /// @param line a value for each column of the table, as in the file
  void add(int table, std::span<const double> line);
  std::vector<checkpoint::SeriesMark> mark_series();

  /// Flushes the series. Writes files again that were removed or replaced meanwhile, because lines of another process
  /// are not this run's results. @returns files written again @throws Error(io)
  std::vector<std::string> flush();

  /// Writes results.h5, results.xdmf and, unless the run was stopped early, summary.json. @returns a warning or ""
  /// @throws Error(io)
  std::string finish(const RunEnd& end, bool stopped);
  /// For a failed run: writes results.h5 and summary_failed.json from the available data. @throws Error(io)
  void fail(const RunEnd& end, const Failure& failure);

 private:
  std::filesystem::path file_of(const Table& table) const;
  void list_files() const;
  void continue_from(const checkpoint::ResumePoint& resume);
  void write_hdf5(std::span<const FinalReport> reports) const;
  SummaryInput summary_input(const RunEnd& end) const;

  scenario::Scenario scenario_;
  std::vector<NodeCard> cards_;
  TerrainSetup setup_;
  std::filesystem::path directory_;
  const checkpoint::ResumePoint* resume_;
  std::vector<Table> tables_;
  std::vector<std::unique_ptr<TableWriter>> writers_;  // in the order of tables_
};

}  // namespace furrow::output
