// The rig's rank: moves the wheels, gathers all reports, and writes the results.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "nodes/checkpoint/wall_schedule.hpp"
#include "nodes/launch/run_list.hpp"
#include "nodes/output/accounts.hpp"
#include "nodes/output/lag_watch.hpp"
#include "nodes/output/profile.hpp"
#include "nodes/output/results.hpp"
#include "nodes/output/subject_series.hpp"
#include "nodes/ranks/early_end.hpp"
#include "nodes/ranks/node.hpp"
#include "nodes/ranks/wall_watch.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::ranks {
namespace {

// Gap between the highest grain and the inflated tire: of its radius, and at most, m.
constexpr double kPlacementShare = 1.0 / 400.0, kMostPlacementGap = 1e-3;
constexpr double kProgressInterval = 0.25;  // s of wall time
constexpr double kFolderInterval = 1.0;     // s of wall time between checks whether the folder was moved

class RigNode : public Node {
 public:
  explicit RigNode(const scenario::Scenario& scenario) : scenario_(scenario), rig_(scenario.rig->make()) {}

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, kSelf);
    card.node_kind = rig_->kind();
    card.substeps = scenario_.rig_substeps;
    card.wheel_count = rig_->wheel_count();
    card.tire_count = static_cast<int>(scenario_.tires.size());
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) override {
    FURROW_ASSERT(cards.size() >= static_cast<std::size_t>(rig_->wheel_count()) + 2, cards.size(), rig_->wheel_count());
    context_ = context;
    cards_.assign(cards.begin(), cards.end());
    const int wheels = rig_->wheel_count();
    for (int k = 0; k < wheels; ++k) rig_->add_tire_mass(k, cards[1 + k].tire_mass, cards[1 + k].tire_radius);
    rig_->place(std::vector<double>(wheels, 0.0));
    for (int k = 0; k < wheels; ++k) send(transport, kTerrain, RimMotion{{kPlacement, 0.0}, rig_->rim(k)});
    setup_ = receive<TerrainSetup>(transport, kTerrain);
    std::vector<double> height(wheels);
    for (int k = 0; k < wheels; ++k)
      height[k] = setup_.top_height[k] + cards[1 + k].tire_reach +
                  std::min(kPlacementShare * cards[1 + k].tire_radius, kMostPlacementGap) + scenario_.drop_height;
    rig_->place(height);
    const std::optional<terrain::TerrainBounds> bin = scenario_.terrain->describe().bounds;
    if (bin && scenario_.rig->stop_before_wall() > 0.0)
      walls_.emplace(*bin, scenario_.rig->stop_before_wall(), wheel_places());
    make_tables();
    check_folder();
    // Done first, because the others begin to write frames once they are placed.
    if (!context.directory.empty()) {
      std::vector<output::Table> tables;
      for (const output::SubjectSeries& series : series_) tables.push_back(series.empty_table());
      tables.push_back(output::Accounts::empty_table());
      results_ = std::make_unique<output::Results>(scenario_, cards_, setup_, context.directory, std::move(tables),
                                                   context.resume);
    }
    for (int k = 0; k < wheels; ++k)
      send(transport, Address{Role::tire, k}, RimMotion{{kPlacement, 0.0}, rig_->rim(k)});
    wrenches_.resize(wheels);
    series_steps_ = scenario_.run.steps_in(scenario_.output.series_interval);
    if (context.saved) restore(*context.saved), restore_setup(*context.saved);
    wall_start_ = wall_clock();
    checkpoints_ = {scenario_.checkpoint.wall_interval, wall_start_};
    if (context.resume) time_start_ = time_ = context.resume->manifest.time;
  }

  void synchronize(Transport& transport, const StepHeader& header) override {
    due_ = next_;
    next_ = order(header.step + 2);
    watch_end(header.step + 2);
    if (wall_clock() - checked_ > kFolderInterval) check_folder();
    const int wheels = rig_->wheel_count();
    for (int k = 0; k < wheels; ++k)
      send(transport, Address{Role::tire, k}, RimMotion{header, rig_->rim(k), next_, ends_at_});
    tires_.resize(wheels);
    for (int k = 0; k < wheels; ++k) {
      tires_[k] = receive_step<SpindleReport>(transport, {Role::tire, k}, header.step);
      wrenches_[k] = tires_[k].wrench;
    }
    const auto terrain = receive_step<TerrainReport>(transport, kTerrain, header.step);
    terrain_ = terrain.state;
    time_ = header.time;
    keep_accounts(header, terrain);
    if (header.step > 0) {
      for (int k = 0; k < wheels; ++k) rig_->observe(k, tires_[k].lowest_point, setup_.mean_height[k]);
      measure(header, terrain);
    }
    if (header.step > 0) watch_depth(header);
    if (header.step > 0) watch_lag(terrain);
    if (header.step == 1 && results_) results_->begun();
    const bool line = header.step > 0 && series_steps_ > 0 && header.step % series_steps_ == 0;
    if (line) record();
    show_progress(header);
  }

  void answer(Transport& transport, const StepHeader& header) override {
    for (std::size_t k = 0; k < tires_.size(); ++k)
      if (tires_[k].prompt)
        wrenches_[k] = receive_step<PromptWrench>(transport, {Role::tire, static_cast<int>(k)}, header.step).wrench;
  }

  void advance(const StepHeader& header) override {
    FURROW_ASSERT(wrenches_.size() == static_cast<std::size_t>(rig_->wheel_count()), wrenches_.size(),
                  rig_->wheel_count());
    const Outcome outcome = rig_->advance(wrenches_, scenario_.run.step, scenario_.rig_substeps);
    if (!outcome.ok) throw physics_error(outcome, to_string(kSelf), when(header));
  }

  Order due() const override { return due_; }
  std::int64_t ends_at() const override { return ends_at_; }

  std::vector<checkpoint::SeriesMark> mark_series() override {
    if (!results_) return {};
    flush();
    return results_->mark_series();
  }

  void finish(Transport& transport, FinalReport own, bool stopped) override {
    std::vector<FinalReport> reports{own};
    for (std::size_t i = 1; i < cards_.size(); ++i) reports.push_back(receive<FinalReport>(transport, cards_[i].self));
    if (!results_) return;
    check_folder();
    if (context_.profile) launch::add_to_run_list(context_.directory, {"profile.json"});
    if (context_.profile) output::write_profile(context_.directory / "profile.json", reports);
    const std::vector<output::WheelEnd> wheels = wheel_ends();
    flush();
    const std::string lost_frames = results_->finish(
        {reports, wheels, terrain_, *accounts_, time_, wall_clock() - wall_start_, end_reason_, rig_->findings()},
        stopped);
    if (!lost_frames.empty() && context_.note)
      context_.note(fmt::format("warning: {}/{}", context_.directory.string(), lost_frames));
  }

  void fail(ExitCode code, const std::string& text) noexcept override {
    try {
      if (!results_) return;
      check_folder();  // by now the folder may be another run's
      std::vector<output::WheelEnd> wheels;
      if (time_ > time_start_) wheels = wheel_ends();
      flush();
      results_->fail({{},
                      wheels,
                      terrain_,
                      *accounts_,
                      time_,
                      wall_start_ > 0.0 ? wall_clock() - wall_start_ : 0.0,  // 0: the run has not begun to step
                      end_reason_,
                      rig_->findings()},
                     {code, text});
    } catch (...) {
      // The failure itself is reported; a further error of the disk must not hide it.
    }
  }

  void save(Archive& archive) const override {
    rig_->save(archive);
    for (const output::SubjectSeries& series : series_) series.save(archive);
    accounts_->save(archive);
    for (std::size_t k = 0; k < lag_.size(); ++k) save_fields(archive, lag_name(k), lag_[k]);
  }

  void save_setup(Archive& archive) const override {
    rig_->save_findings(archive);
    save_end(archive, ends_at_);
    if (ends_at_ != kNotYet) archive.put(kEndReason, static_cast<std::int64_t>(end_reason_));
  }

  void restore(const Archive& archive) override {
    rig_->restore(archive);
    for (output::SubjectSeries& series : series_) series.restore(archive);
    accounts_->restore(archive);
    for (std::size_t k = 0; k < lag_.size(); ++k) restore_fields(archive, lag_name(k), lag_[k]);
  }

 private:
  static constexpr Address kSelf{Role::rig, 0};
  static constexpr Address kTerrain{Role::terrain, 0};
  static constexpr char kEndReason[] = "run/end_reason";  // in the saved state

  static std::string lag_name(std::size_t wheel) { return fmt::format("node/lag{}", wheel); }

  void restore_setup(const Archive& archive) {
    rig_->restore_findings(archive);
    ends_at_ = saved_end(archive);
    if (ends_at_ != kNotYet) end_reason_ = static_cast<output::EndReason>(archive.get_int(kEndReason));
  }

  std::vector<WheelPlace> wheel_places() const {
    std::vector<WheelPlace> places;
    for (int k = 0; k < rig_->wheel_count(); ++k)
      places.push_back({rig_->rim(k).position, rig_->heading(k), cards_[1 + k].tire_radius, cards_[1 + k].tire_width});
    return places;
  }

  /// @param step at which all nodes can end if they are informed now
  void watch_end(std::int64_t step) {
    if (ends_at_ != kNotYet) return;
    std::optional<output::EndReason> reason;
    if (walls_) reason = walls_->near(wheel_places());
    if (rig_->overturned()) reason = output::EndReason::overturned;
    if (!reason || step >= scenario_.run.steps()) return;
    ends_at_ = step;
    end_reason_ = *reason;
  }

  std::vector<output::WheelEnd> wheel_ends() const {
    std::vector<output::WheelEnd> wheels;
    for (int k = 0; k < rig_->wheel_count(); ++k)
      wheels.push_back(
          {series_[k].wheel(), tires_[k], rig_->report(k).load(), rig_->heading(k), rig_->rim(k).position});
    return wheels;
  }

  Order order(std::int64_t step) {
    FURROW_ASSERT(step >= 0, step);
    if (next_ == Order::stop) return Order::stop;
    if (context_.stop_requested && context_.stop_requested()) return Order::stop;
    const scenario::CheckpointOptions& o = scenario_.checkpoint;
    const std::int64_t every = scenario_.run.steps_in(o.interval);
    const double now = wall_clock();
    if (!checkpoints_.due(now) && (every == 0 || step % every != 0)) return Order::go_on;
    checkpoints_.written(now);
    return Order::checkpoint;
  }

  void check_folder() {
    if (context_.held) context_.held->check();
    checked_ = wall_clock();
  }

  void make_tables() {
    level_ = scenario_.terrain->describe().uneven_key.empty();
    const std::vector<rigs::Subject> subjects = rig_->subjects();
    for (int k = 0; k < static_cast<int>(subjects.size()); ++k) {
      std::optional<output::SeriesBuilder> wheel;
      if (k < rig_->wheel_count())
        wheel.emplace(cards_[1 + k].tire_radius, setup_.mean_height[k], scenario_.run.step, level_);
      series_.emplace_back(subjects[k], std::move(wheel));
    }
    for (int k = 0; k < rig_->wheel_count(); ++k)
      lag_.emplace_back(cards_[1 + k].tire_radius, rig_->report(k).gravity.norm());
    std::vector<MassProperties> added;
    for (int k = 0; k < rig_->wheel_count(); ++k) added.push_back(cards_[1 + k].tire_mass);
    accounts_.emplace(std::move(added), scenario_.run.step);
  }

  /// @throws Error(physics) naming an account that the rig does not give
  void keep_accounts(const StepHeader& header, const TerrainReport& terrain) {
    const rigs::RigAccounts rig = rig_->accounts();
    if (const char* missing = first_missing(rig))
      throw physics_error("rig: its {} is not finite, or the rig '{}' does not give it", missing, rig_->kind());
    std::vector<RimState> rims;
    for (int k = 0; k < rig_->wheel_count(); ++k) rims.push_back(rig_->rim(k));
    accounts_->add({header.time, tires_, rims, terrain, rig, rig_->report(0).gravity});
  }

  void measure(const StepHeader& header, const TerrainReport& terrain) {
    for (int k = 0; k < static_cast<int>(series_.size()); ++k)
      if (k < rig_->wheel_count())
        series_[k].add({header.time, rig_->report(k), rig_->rim(k), tires_[k], terrain.contact[k], terrain.state,
                        setup_.grains, rig_->heading(k)},
                       *rig_, k);
      else
        series_[k].add(header.time, *rig_, k);
  }

  /// Of level ground; elsewhere its height under the wheel is not known here.
  /// @throws Error(physics) if a tire lies wholly below the ground as it was, where no model of the ground holds
  void watch_depth(const StepHeader& header) const {
    if (!level_) return;
    for (int k = 0; k < rig_->wheel_count(); ++k) {
      const double sinkage = setup_.mean_height[k] - tires_[k].lowest_point, most = 2.0 * cards_[1 + k].tire_radius;
      if (sinkage > most)
        throw physics_error(
            "{} has sunk in by {:.4g} m{}, expected less than its diameter of {:.4g} m: the ground "
            "does not bear its load, or it spins itself in; take less load or slip, or stronger soil",
            scenario::wheel_name(scenario::describe_rig(scenario_), k), sinkage, when(header), most);
    }
  }

  /// @throws Error(physics) if late forces affect the result, unless run.on_lag lets the run continue
  void watch_lag(const TerrainReport& terrain) {
    for (int k = 0; k < rig_->wheel_count(); ++k) {
      const auto window =
          lag_[k].add(series_[k].wheel().last(), rig_->report(k).load(), terrain.contact[k].contacts > 0);
      if (!window || window->share <= output::kMostShare) continue;
      const std::string text = fmt::format(
          "at the interface '{} {}' late forces {} {:.3g} J from {:.4g} to {:.4g} s, {:.0f} % of the work there, "
          "expected "
          "at most {:.0f} %: take a run.step of {} s or less{}",
          scenario::wheel_name(scenario::describe_rig(scenario_), k), window->interface,
          window->made > 0.0 ? "made" : "took", std::abs(window->made), window->from, window->to, 100.0 * window->share,
          100.0 * output::kMostShare,
          number_text(
              output::better_step(scenario_.run.step, window->share, scenario::coupling_steps(scenario_).at(k).step)),
          window->interface == std::string_view("ground") ? scenario::other_help(scenario_) : "");
      if (scenario_.run.on_lag == "end") throw physics_error(text + ", or run.on_lag 'warn' to go on");
      if (!std::exchange(lag_told_, true) && context_.note) context_.note("warning: " + text);
    }
  }

  void record() {
    for (int k = 0; k < static_cast<int>(series_.size()); ++k) {
      const std::span<const double> line = series_[k].take(*rig_, k);
      if (k == 0) last_.assign(line.begin(), line.end());
      if (k < rig_->wheel_count()) {
        const double sinkage = LineView{series_[k].columns(), line}["sinkage_m"];
        worst_sinkage_ = k == 0 ? sinkage : std::max(worst_sinkage_, sinkage);
      }
      if (results_) results_->add(k, line);
    }
    if (results_) results_->add(static_cast<int>(series_.size()), accounts_->line());
  }

  void flush() {
    for (const std::string& name : results_->flush())
      if (context_.note)
        context_.note(
            fmt::format("warning: {} was removed or changed while the run was under way, and is written again",
                        (context_.directory / name).string()));
  }

  void show_progress(const StepHeader& header) {
    const double now = wall_clock();
    if (!context_.progress || last_.empty() || now - shown_ < kProgressInterval) return;
    shown_ = now;
    const LineView line{series_.front().columns(), last_};
    launch::Progress p;
    p.phase = "running";
    p.time = header.time;
    p.end = scenario_.run.end;
    p.share = header.time / scenario_.run.end;
    p.pull = line["drawbar_pull_N"];
    p.sinkage = worst_sinkage_;
    const rigs::LiveNote note = rig_->live();
    p.speed = std::isnan(note.speed) ? line["speed_m_per_s"] : note.speed;
    p.note = note.text;
    p.eta = (now - wall_start_) * (p.end - p.time) / (p.time - time_start_);
    context_.progress(p);
  }

  scenario::Scenario scenario_;
  std::unique_ptr<rigs::Rig> rig_;
  RunContext context_;
  std::vector<NodeCard> cards_;
  TerrainSetup setup_;
  std::vector<Wrench> wrenches_;
  std::vector<SpindleReport> tires_;           // the last ones
  std::vector<output::SubjectSeries> series_;  // in the order of rig_->subjects()
  std::vector<output::LagWatch> lag_;          // of each wheel
  bool lag_told_ = false;
  bool level_ = true;                         // the ground, as it was
  std::optional<output::Accounts> accounts_;  // once the tables are made
  std::unique_ptr<output::Results> results_;
  std::vector<double> last_;    // line of wheel 0
  double worst_sinkage_ = 0.0;  // of the wheels' last lines, m
  std::int64_t series_steps_ = 0;
  checkpoint::WallSchedule checkpoints_;
  double wall_start_ = 0.0, shown_ = 0.0, checked_ = 0.0;  // wall time, s
  double time_start_ = 0.0;                                // simulated, when this segment began, s
  double time_ = 0.0;                                      // simulated, of the last synchronization, s
  TerrainState terrain_;                                   // at the last synchronization
  Order next_ = Order::go_on, due_ = Order::go_on;
  std::optional<WallWatch> walls_;  // of a bin, if the run ends before them
  std::int64_t ends_at_ = kNotYet;
  output::EndReason end_reason_ = output::EndReason::run_end;
};

}  // namespace

std::unique_ptr<Node> make_rig_node(const scenario::Scenario& scenario) { return std::make_unique<RigNode>(scenario); }

}  // namespace furrow::ranks
