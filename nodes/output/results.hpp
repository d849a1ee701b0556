// What a run leaves behind, written by the rig's rank: the tables of results as CSV and in results.h5, results.xdmf,
// summary.json; summary_failed.json if it failed, so that summary.json means done.
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

/// What is known of a wheel at the end of a run.
struct WheelEnd {
  const SeriesBuilder& series;   // totals
  const SpindleReport& tire;     // the last one
  double load = 0.0;             // weight on the undisturbed ground of all that it carries, N
  Vec3 heading = Vec3::UnitX();  // unit, W
};

/// How a run ended, as the rig's rank knows it.
struct RunEnd {
  std::span<const FinalReport> reports;  // rig, tires, terrain; empty: the run has failed
  std::span<const WheelEnd> wheels;      // empty: it failed before its first step
  const TerrainState& terrain;           // the last one
  const Accounts& accounts;
  double time = 0.0;  // simulated, s
  double wall = 0.0;  // of this segment, s
  EndReason reason = EndReason::run_end;
  rigs::RigFindings findings = {};
};

/// Why a run failed.
struct Failure {
  ExitCode code = ExitCode::physics;
  std::string text;
};

/// Everything the summary is computed from.
struct SummaryInput {
  const scenario::Scenario& scenario;
  std::span<const NodeCard> cards;  // rig, tires, terrain
  const TerrainSetup& setup;
  std::span<const Table> tables;  // those of the wheels come first, that of the accounts last
  const RunEnd& end;
  std::vector<checkpoint::Segment> segments;
  const Failure* failure = nullptr;
};

/// summary.json's text: what holds for the run, and `wheels`, one entry per wheel. Where there is one wheel, its keys
/// stand beside those of the run as well. Values that could not be measured are null. Of a run that has failed:
/// summary_failed.json's text, with the means of what there is, and why under `failed`.
std::string summary_text(const SummaryInput& input);

/// "timeseries.csv" for the only wheel of a run, "timeseries_<subject>.csv" for any other table.
std::string table_file(const std::string& subject, int wheels);

class Results {
 public:
  /// Adds all that the ranks write to the existing run directory's list; opens the files of all tables there; writes
  /// scenario.json. Where a run continues, what was
  /// written after its checkpoint is removed, and the index made again.
  /// @param tables without lines; those of the wheels come first, that of the accounts last
  /// @param resume null: the run begins
  /// @throws Error(io)
  Results(const scenario::Scenario& scenario, std::vector<NodeCard> cards, const TerrainSetup& setup,
          const std::filesystem::path& directory, std::vector<Table> tables,
          const checkpoint::ResumePoint* resume = nullptr);

  /// All ranks have taken their first step: what the run replaces is not put back from now on. @throws Error(io)
  void begun() const;

  /// @param line a value for each column of the table, as it is written
  void add(int table, std::span<const double> line);
  std::vector<checkpoint::SeriesMark> mark_series();

  /// Flushes the series, and writes again what somebody has removed or replaced meanwhile: lines that this process does
  /// not write are not its results. @returns what was written again @throws Error(io)
  std::vector<std::string> flush();

  /// Writes results.h5, results.xdmf and, unless the run was stopped early, summary.json. @returns what to warn of
  /// @throws Error(io)
  std::string finish(const RunEnd& end, bool stopped);
  /// The run has failed: writes results.h5 and summary_failed.json of what there is. @throws Error(io)
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
  std::vector<std::unique_ptr<TableWriter>> writers_;  // as tables_
};

}  // namespace furrow::output
