// Tables of results. Means, files, saved state and reading follow from one list of columns. The rig adds columns and
// subjects without changes to these.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "nodes/checkpoint/segment.hpp"
#include "nodes/output/column_labels.hpp"
#include "nodes/output/results.hpp"
#include "nodes/output/subject_series.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rig_row.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/refusal.hpp"
#include "tests/rigs/reference_options.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {

/// Measurements of these tests' rig, of its wheel and of itself.
struct SpringRow {
  double spring_force = 0.0;  // N
  double heave = 0.0;         // m
  double spring_work = 0.0;   // J
  double double_heave = 0.0;  // m
};
void visit_fields(FieldsOf<SpringRow> auto& r, auto&& visit) {
  visit(r.spring_force, column::mean("spring_force_N", "N").following("slip").negative());
  visit(r.heave, column::instant("heave_m", "m"));
  visit(r.spring_work, column::cumulative("spring_work_J", "J").following("slip"));
  visit(r.double_heave, column::derived("double_heave_m", "m"));
}

namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

/// One wheel, and the vehicle as a second subject; both measure the same.
class SpringRig final : public rigs::Rig {
 public:
  SpringRow row;
  double sign = 1.0;

  std::string kind() const override { return "spring"; }
  int wheel_count() const override { return 1; }
  Vec3 heading(int) const override { return sign * Vec3::UnitX(); }
  std::vector<rigs::Subject> subjects() const override {
    return {{"wheel0", columns_of<SpringRow>()}, {"vehicle", columns_of<SpringRow>()}};
  }
  void measure(int, std::span<double> values) const override { get_values(row, values); }
  void derive(int, const LineView& line, std::span<double> values) const override {
    SpringRow derived;
    derived.double_heave = 2.0 * line["heave_m"];
    get_values(derived, values);
  }

 private:
  void do_place(std::span<const double>) override {}
  RimState do_rim(int) const override { return {}; }
  Outcome do_advance(std::span<const Wrench>, double, int) override { return {}; }
  rigs::WheelReport do_report(int) const override { return {}; }
  rigs::RigAccounts do_accounts() const override { return rigs::RigAccounts::none(); }
  void do_save(Archive&) const override {}
  void do_restore(const Archive&) override {}
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The last line of a CSV file by the names of its columns.
std::map<std::string, double> last_line(const fs::path& file) {
  std::stringstream stream(read_whole_file(file));
  std::string header, line, last;
  std::getline(stream, header);
  while (std::getline(stream, line)) last = line;
  const auto names = split(header), cells = split(last);
  EXPECT_EQ(names.size(), cells.size());
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < cells.size(); ++i) values[names[i]] = std::strtod(cells[i].c_str(), nullptr);
  return values;
}

output::Table wheel_table() { return {"wheel0", columns_of<output::WheelRow>(), {}}; }

std::vector<double> line_of(const output::Table& table, double first) {
  std::vector<double> line(table.columns.size());
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = first + static_cast<double>(i) / 3.0;
  return line;
}

TEST(WheelRow, every_number_of_the_row_is_a_column) {
  EXPECT_EQ(columns_of<output::WheelRow>().size() * sizeof(double), sizeof(output::WheelRow));
}

/// A unit as names of columns end in it: "N m" as "_Nm", "kg m²/s" as "_kg_m2_per_s", none as "".
std::string suffix_of(const std::string& unit) {
  if (unit == "-") return "";
  std::string suffix = "_";
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::string rest = unit.substr(i);
    if (rest.starts_with("²") || rest.starts_with("³"))
      suffix += rest.starts_with("²") ? "2" : "3", ++i;  // two bytes
    else if (unit[i] == '/')
      suffix += "_per_";
    else if (unit[i] != ' ')
      suffix += unit[i];
    else if (unit[i - 1] != 'N')
      suffix += "_";
  }
  return suffix;
}

TEST(WheelRow, names_end_in_their_units_and_are_unique) {
  EXPECT_EQ(suffix_of("N m"), "_Nm");
  EXPECT_EQ(suffix_of("kg m²/s"), "_kg_m2_per_s");
  std::set<std::string> names;
  for (const Column& column : columns_of<output::WheelRow>()) {
    EXPECT_TRUE(names.insert(column.name).second) << column.name;
    EXPECT_TRUE(std::string(column.name).ends_with(suffix_of(column.unit))) << column.name;
  }
}

TEST(ColumnLabels, are_units_and_words_for_readers_of_netcdf) {
  EXPECT_EQ(output::long_name(column::mean("vertical_momentum_kg_m_per_s", "kg m/s")), "vertical momentum");
  EXPECT_EQ(output::long_name(column::mean("spindle_torque_Nm", "N m")), "spindle torque");
  EXPECT_EQ(output::long_name(column::mean("lateral_acceleration_m_per_s2", "m/s²")), "lateral acceleration");
  EXPECT_EQ(output::long_name(column::mean("slip")), "slip");
  EXPECT_EQ(output::units_label("m/s²"), "m/s2");
  EXPECT_EQ(output::units_label("-"), "1");
  EXPECT_EQ(output::cell_methods(column::cumulative("rim_work_J", "J")), "time_s: sum");
  EXPECT_EQ(output::cell_methods(column::derived("heave_m", "m")), "");
}

/// For reports in which no number is zero, every column of a line must be a number other than zero: a column that
/// SeriesBuilder forgets is NaN or zero.
TEST(WheelRow, every_column_is_measured_in_every_interval) {
  output::SeriesBuilder builder(0.5, 0.0, 1e-3);
  for (int n = 1; n <= 2; ++n) {
    output::StepReports reports;
    int next = 100 * n;
    testing::fill(reports.wheel, next);
    testing::fill(reports.tire, next);
    testing::fill(reports.contact, next);
    testing::fill(reports.terrain, next);
    reports.tire.contact_tangent = false;
    reports.tire.lowest_point = -0.1 * n;
    reports.time = n;
    reports.grains = 7;
    reports.rim.position = Vec3(0.1, 0.2, 0.4 + 0.1 * n);
    reports.rim.orientation = Quat(Eigen::AngleAxisd(0.1, Vec3(1.0, 2.0, 3.0).normalized()));
    reports.rim.velocity = Vec3(1.0, 2.0, 3.0);
    reports.rim.angular_velocity = Vec3(4.0, 5.0, 6.0);
    reports.heading = Vec3(0.6, 0.8, 0.0);
    builder.add(reports);
  }
  const output::WheelRow line = builder.take();
  visit_fields(line, [](const double& value, const Column& column) {
    EXPECT_FALSE(std::isnan(value)) << column.name;
    EXPECT_NE(value, 0.0) << column.name;
  });
}

TEST(Table, a_drawbar_rigs_columns_that_users_script_against_come_first) {
  const auto rig = rigs::make_drawbar_rig(testing::reference_options());
  const output::SubjectSeries series(rig->subjects().front(), output::SeriesBuilder(0.5, 0.0, 1e-3));
  std::string header;
  for (const Column& column : series.columns()) header += std::string(column.name) + ",";
  EXPECT_TRUE(header.starts_with(
      "time_s,slip,drawbar_pull_N,sinkage_m,vertical_force_N,force_x_N,force_y_N,force_z_N,spindle_torque_Nm,"
      "impulse_sent_Ns,impulse_received_Ns,energy_error_J,drawbar_pull_raw_N,speed_m_per_s,"))
      << header;
  EXPECT_TRUE(header.ends_with("tractive_efficiency,motion_resistance_coefficient,")) << header;
}

TEST(Table, numbers_come_back_bit_for_bit) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "timeseries.csv";
  const output::Table table = wheel_table();
  std::vector<double> line = line_of(table, 0.1 + 0.2);
  line[2] = 1e-300, line[3] = -0.0, line[4] = 5e-324;
  {
    output::TableWriter writer(file, table);
    writer.add(line);
    writer.flush();
  }
  const auto values = last_line(file);
  for (std::size_t i = 0; i < line.size(); ++i)
    EXPECT_EQ(values.at(table.columns[i].name), line[i]) << table.columns[i].name;
}

TEST(Table, a_full_disk_is_an_input_output_error_naming_the_file) {
  const output::Table table = wheel_table();
  expect_refused(ExitCode::io, {"/dev/full"}, [&] {
    output::TableWriter writer("/dev/full", table);
    writer.add(line_of(table, 0.0));
    writer.flush();
  });
}

/// A limit on the size of files imitates a full disk.
TEST(Table, a_file_that_cannot_be_written_again_stays) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "timeseries.csv";
  output::Table table = wheel_table();
  output::TableWriter writer(file, table);
  table.kept.add(line_of(table, 0.5));
  writer.add(table.line(0));
  const checkpoint::SeriesMark mark = writer.mark();
  const std::string whole = read_whole_file(file);
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit full { whole.size() / 2, before.rlim_max };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  expect_refused(ExitCode::io, {"timeseries.csv"}, [&] { writer.write_again(table); });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_whole_file(file), whole);
  output::Table again = wheel_table();
  output::TableWriter(file, mark, again);
  EXPECT_EQ(again.lines(), 1U);
}

TEST(Table, goes_on_at_its_mark_bit_for_bit) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "timeseries.csv";
  output::Table table = wheel_table();
  std::vector<double> line = line_of(table, 1.0 / 7.0);
  line[1] = -0.0, line[2] = 5e-324, line[3] = 1e300;
  checkpoint::SeriesMark mark;
  {
    output::TableWriter writer(file, table);
    writer.add(line);
    writer.add(line);
    mark = writer.mark();
    writer.add(line);
  }
  EXPECT_EQ(mark.subject, "wheel0");
  const std::string three = read_whole_file(file);
  std::ofstream(file, std::ios::app) << "0.4,cut sho";
  {
    output::TableWriter writer(file, mark, table);
    ASSERT_EQ(table.lines(), 2U);
    EXPECT_TRUE(std::ranges::equal(table.line(1), line));
    writer.add(table.line(1));
  }
  EXPECT_EQ(read_whole_file(file), three);
  checkpoint::SeriesMark other = mark;
  other.bytes -= 1;
  const auto open_files = [] {
    const fs::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
  };
  const auto before = open_files();
  EXPECT_THROW(output::TableWriter(file, other, table), Error);
  EXPECT_EQ(open_files(), before);
}

/// Over several blocks, the last of them incomplete.
TEST(KeptLines, give_back_lines_and_columns_bit_for_bit_and_leave_no_file) {
  const TemporaryFolder folder;
  constexpr std::size_t kLines = 3 * output::KeptLines::kBlock + 5, kColumns = 7;
  output::KeptLines kept;
  kept.keep_in(folder.path());
  std::vector<std::vector<double>> lines;
  for (std::size_t i = 0; i < kLines; ++i) {
    std::vector<double> line(kColumns, -0.0);
    for (std::size_t k = 1; k < kColumns; ++k) line[k] = std::sin(static_cast<double>(i * kColumns + k));
    kept.add(line);
    lines.push_back(line);
  }
  const output::KeptLines moved = std::move(kept);
  ASSERT_EQ(moved.size(), kLines);
  for (std::size_t i = kLines; i-- > 0;) EXPECT_TRUE(std::ranges::equal(moved.line(i), lines[i])) << i;
  for (std::size_t k = 0; k < kColumns; ++k) {
    const std::vector<double> column = moved.column(k);
    for (std::size_t i = 0; i < kLines; ++i) EXPECT_EQ(column[i], lines[i][k]) << i << " " << k;
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  expect_refused(ExitCode::io, {"no such folder"},
                 [&] { output::KeptLines().keep_in(folder.path() / "no such folder"); });
}

TEST(Table, a_mark_beyond_the_end_of_its_file_takes_no_more_memory_than_the_file) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "timeseries.csv";
  output::Table table = wheel_table();
  checkpoint::SeriesMark mark = output::TableWriter(file, table).mark();
  mark.bytes = checkpoint::kMostSteps;
  expect_refused(ExitCode::io, {}, [&] { output::TableWriter(file, mark, table); });
}

TEST(Table, a_file_of_other_columns_is_refused) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "timeseries.csv";
  const Column a = column::mean("a"), b = column::instant("b_m", "m"), c = column::mean("c");
  const checkpoint::SeriesMark mark = output::TableWriter(file, {"wheel0", {a, b, c}, {}}).mark();
  for (const std::vector<Column>& other : {std::vector{a, b}, {c, a, b}, {a, b, c, column::mean("d")}}) {
    output::Table table{"wheel0", other, {}};
    expect_refused(ExitCode::io, {"has other columns"}, [&] { output::TableWriter(file, mark, table); });
  }
}

TEST(LineBuilder, restores_by_name_what_another_order_of_columns_has_saved) {
  const Column mean = column::mean("a"), instant = column::instant("b_m", "m"), sum = column::cumulative("c_J", "J");
  output::LineBuilder before({mean, instant, sum}), now({sum, mean, instant});
  before.add(std::vector<double>{1.0, 20.0, 300.0});
  before.add(std::vector<double>{2.0, 30.0, 400.0});
  Archive archive;
  before.save(archive, "x/");
  now.restore(archive, "x/");
  now.add(std::vector<double>{500.0, 6.0, 40.0});
  EXPECT_TRUE(std::ranges::equal(now.take(), std::vector<double>{500.0, 3.0, 40.0}));
  output::LineBuilder more({mean, column::mean("d")});
  EXPECT_THROW(more.restore(archive, "x/"), Error);
}

/// A wheel and a vehicle as in the rig's rank.
struct Series {
  explicit Series(const rigs::Rig& rig)
      : wheel(rig.subjects()[0], output::SeriesBuilder(0.5, 0.0, 1e-3)), vehicle(rig.subjects()[1]) {}

  void add(SpringRig& rig, int n) {
    rig.row = {10.0 * n, 0.1 * n, 1.0 * n, -1.0};
    output::StepReports reports;
    reports.time = 1e-3 * n;
    reports.wheel.slip = 0.3;
    reports.rim.position = Vec3(0.0, 0.0, 0.4);
    wheel.add(reports, rig, 0);
    vehicle.add(reports.time, rig, 1);
  }
  void take(const SpringRig& rig, output::Results& results) {
    results.add(0, wheel.take(rig, 0));
    results.add(1, vehicle.take(rig, 1));
  }
  void save(Archive& archive) const { wheel.save(archive), vehicle.save(archive); }
  void restore(const Archive& archive) { wheel.restore(archive), vehicle.restore(archive); }
  std::vector<output::Table> tables() const {
    std::vector<output::Table> both;
    both.push_back(wheel.empty_table()), both.push_back(vehicle.empty_table());
    return both;
  }

  output::SubjectSeries wheel, vehicle;
};

std::vector<NodeCard> cards_of_one_wheel() {
  std::vector<NodeCard> cards(3);
  cards.front().wheel_count = 1;
  return cards;
}

TEST(Subjects, columns_and_tables_of_the_rig_are_written_resumed_and_cut) {
  const TemporaryFolder folder;
  scenario::Scenario scenario;
  scenario.completed = "{}";
  SpringRig rig;
  checkpoint::ResumePoint resume;
  Archive saved;
  const std::vector<FinalReport> reports(3);
  const fs::path wheel_file = folder.path() / "timeseries.csv", vehicle_file = folder.path() / "timeseries_vehicle.csv";
  {
    Series series(rig);
    output::Results results(scenario, cards_of_one_wheel(), {}, folder.path(), series.tables());
    for (int n = 1; n <= 4; ++n) {
      series.add(rig, n);
      if (n % 2 == 0) series.take(rig, results);
      if (n == 2) resume.manifest.series = results.mark_series();
      if (n == 3) series.save(saved);  // in the middle of a line
    }
    results.finish({reports, {}, TerrainState(), output::Accounts({}, 1.0), 0.0, 0.0}, true);
  }
  EXPECT_TRUE(read_whole_file(wheel_file).starts_with("time_s,slip,spring_force_N,spring_work_J,sinkage_m,"));
  EXPECT_TRUE(
      read_whole_file(vehicle_file).starts_with("time_s,spring_force_N,heave_m,spring_work_J,double_heave_m\n"));
  for (const fs::path& file : {wheel_file, vehicle_file}) {
    const auto line = last_line(file);
    EXPECT_EQ(line.at("time_s"), 4e-3);
    EXPECT_EQ(line.at("spring_force_N"), -35.0) << "mean of the 3rd and 4th interval, with its sign";
    EXPECT_EQ(line.at("heave_m"), 0.4);
    EXPECT_EQ(line.at("spring_work_J"), 4.0);
    EXPECT_EQ(line.at("double_heave_m"), 0.8);
  }
  {
    const Hdf5Reader file(folder.path() / "results.h5");
    for (const char* subject : {"wheel0", "vehicle"})
      EXPECT_EQ(file.get<double>(std::string("series/") + subject + "/spring_force_N"),
                (std::vector<double>{-15.0, -35.0}));
  }

  const std::string wheel_whole = read_whole_file(wheel_file), vehicle_whole = read_whole_file(vehicle_file);
  std::ofstream(vehicle_file, std::ios::app) << "9,9,9,9,9\n";
  write_archive(folder.path() / "rig.h5", saved);
  Series series(rig);
  series.restore(read_archive(folder.path() / "rig.h5"));
  output::Results results(scenario, cards_of_one_wheel(), {}, folder.path(), series.tables(), &resume);
  EXPECT_EQ(std::ranges::count(read_whole_file(vehicle_file), '\n'), 2) << "header and one line are left";
  series.add(rig, 4);
  series.take(rig, results);
  results.finish({reports, {}, TerrainState(), output::Accounts({}, 1.0), 0.0, 0.0}, true);
  EXPECT_EQ(read_whole_file(wheel_file), wheel_whole);
  EXPECT_EQ(read_whole_file(vehicle_file), vehicle_whole);
  EXPECT_EQ(Hdf5Reader(folder.path() / "results.h5").get<double>("series/vehicle/heave_m").size(), 2U);
}

TEST(Subjects, a_checkpoint_without_the_table_is_refused_by_its_name) {
  const TemporaryFolder folder;
  scenario::Scenario scenario;
  const SpringRig rig;
  const Series series(rig);
  checkpoint::ResumePoint resume;
  {
    output::Results results(scenario, cards_of_one_wheel(), {}, folder.path(), series.tables());
    resume.manifest.series = results.mark_series();
  }
  resume.manifest.series.pop_back();
  expect_refused(ExitCode::io, {"'vehicle'"},
                 [&] { output::Results(scenario, cards_of_one_wheel(), {}, folder.path(), series.tables(), &resume); });
}

TEST(Subjects, a_row_of_rigs_numbers_wheels_through_and_keeps_each_heading) {
  std::vector<std::unique_ptr<rigs::Rig>> rigs;
  for (const double sign : {1.0, -1.0}) {
    auto rig = std::make_unique<SpringRig>();
    rig->sign = sign;
    rig->row.heave = sign;
    rigs.push_back(std::move(rig));
  }
  const auto row = rigs::make_rig_row(std::move(rigs));
  EXPECT_EQ(row->heading(0), Vec3(1, 0, 0));
  EXPECT_EQ(row->heading(1), Vec3(-1, 0, 0));
  const auto subjects = row->subjects();
  ASSERT_EQ(subjects.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(subjects[k].name, "wheel" + std::to_string(k));
    std::vector<double> values(subjects[k].columns.size());
    row->measure(k, values);
    EXPECT_EQ((LineView{subjects[k].columns, values}["heave_m"]), k == 0 ? 1.0 : -1.0);
  }
}

TEST(Subjects, files_are_named_after_them_and_that_of_a_single_wheel_is_the_time_series) {
  EXPECT_EQ(output::table_file("wheel0", 1), "timeseries.csv");
  EXPECT_EQ(output::table_file("wheel0", 4), "timeseries_wheel0.csv");
  EXPECT_EQ(output::table_file("vehicle", 1), "timeseries_vehicle.csv");
}

}  // namespace
}  // namespace furrow
