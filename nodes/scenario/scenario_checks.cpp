#include "nodes/scenario/scenario_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "nodes/scenario/estimate.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/host.hpp"
#include "terrain/dem/beds/bed_packing.hpp"

namespace furrow::scenario {
namespace {

constexpr double kMaxSteps = 1e10;    // beyond it the value is almost certainly a typo
constexpr double kLeastPart = 6.0;    // least length along x of a rank's part of the bed, in radii
constexpr double kMinGrains = 4.0;    // least size of the bin, in radii
constexpr double kCoarseGrain = 0.1;  // of the tire radius
constexpr double kBeyond = 1.5;       // of the load that a tire was fitted to
constexpr double kMostBend = 0.1;     // of ground under a tire that takes it as a plane: R/radius of the ground
constexpr double kMostScanned = 2e5;  // points of it
constexpr double kGigabyte = 1e9;
constexpr double kWallShare = 0.05, kMostWallMargin = 0.02;  // of the tire's radius; m
constexpr double kRounding = 1e-9;                           // relative, of times that are typed as decimals

/// Removes the error of binary rounding: 0.30000000000000004 becomes 0.3.
double short_decimal(double value) { return std::stod(fmt::format("{:.9g}", value)); }

/// "flexible ring tire"
std::string in_words(const tire::TireDescription& tire) {
  return tire.name.ends_with("tire") ? tire.name : tire.name + " tire";
}

class Checks {
 public:
  Checks(Scenario& scenario, rigs::RigSpec& rig)
      : s_(scenario), rig_(rig), file_(scenario.file.string()), terrain_(scenario.terrain->describe()) {}

  template <class... Args>
  Error wrong(const std::string& key, fmt::format_string<Args...> what, Args&&... args) const {
    return input_error(file_, key, fmt::format(what, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warn(const std::string& key, fmt::format_string<Args...> what, Args&&... args) {
    warn_of(wrong(key, what, std::forward<Args>(args)...));
  }
  /// Warns once, because several wheels on the same tire give the same warning.
  void warn_of(const Error& error) {
    const std::string text = error.what();
    if (std::find(s_.warnings.begin(), s_.warnings.end(), text) == s_.warnings.end()) s_.warnings.push_back(text);
  }

  void times() {
    const RunOptions& run = s_.run;
    if (run.end < run.step)
      throw wrong("run.end", "is {} s, expected at least one run.step of {} s", number_text(run.end),
                  number_text(run.step));
    if (run.end / run.step > kMaxSteps)
      throw wrong("run.end", "{} s are {:.2g} steps of {} s, expected at most {:g} steps", number_text(run.end),
                  run.end / run.step, number_text(run.step), kMaxSteps);
    if (run.average_from >= run.end)
      throw wrong("run.average_from", "is {} s, expected a window that begins before the run ends at {} s",
                  number_text(run.average_from), number_text(run.end));
    const double first_line = s_.output.series_interval;
    if (run.end - run.average_from < first_line * (1.0 - kRounding))
      throw wrong("output.series_interval", "is {} s, expected at most the averaging window of {} s",
                  number_text(first_line), number_text(run.end - run.average_from));
    whole_steps("run.end", run.end, run.steps());
    // A default interval is only approximate.
    for (const auto& [key, interval, usual] :
         {std::tuple{"output.series_interval", s_.output.series_interval, OutputOptions().series_interval},
          {"output.frame_interval", s_.output.frame_interval, OutputOptions().frame_interval},
          {"checkpoint.interval", s_.checkpoint.interval, CheckpointOptions().interval}})
      if (interval != usual) whole_steps(key, interval, run.steps_in(interval));
  }

  /// Warns if a time changes by more than the rounding of numbers.
  void whole_steps(const char* key, double given, std::int64_t steps) {
    const double taken = static_cast<double>(steps) * s_.run.step;
    if (std::abs(taken - given) > kRounding * given)
      warn(key, "is {} s, not a whole number of steps of {} s: {} s is used", number_text(given),
           number_text(s_.run.step), number_text(short_decimal(taken)));
  }

  void rig() {
    if (s_.tires.size() != rig_.wheel_count())
      throw wrong("tires", "has {} entries, expected {}: one per wheel of the rig", s_.tires.size(),
                  rig_.wheel_count());
  }

  void tires() {
    for (std::size_t k = 0; k < s_.tires.size(); ++k) {
      const auto same = [&](const auto& tire) { return tire == s_.tires[k]; };
      if (std::any_of(s_.tires.begin(), s_.tires.begin() + static_cast<std::ptrdiff_t>(k), same)) continue;
      for (const auto& [key, what] : s_.tires[k]->unlikely_values())
        warn_of(input_error(s_.tires[k]->options().file.string(), key, what));
      rim_values(*s_.tires[k]);
    }
    tires_ = describe_tires(s_);
    for (std::size_t k = 0; k < tires_.size(); ++k)
      if (k == 0 || s_.tires[k] != s_.tires[k - 1]) tire_options(k);
    rig_.mount(mounted_tires(s_, tires_));
    for (std::size_t k = 0; k < tires_.size(); ++k)
      if (tires_[k].step_share > 0.0 && tires_[k].damping_time == 0.0)
        warn(s_.tire_key(k, "structural_damping"),
             "is 0 s: contact forces come one step late and can feed a tire that damps nothing; expected at "
             "least {} s for a run.step of {} s",
             number_text(short_decimal(2.0 * s_.run.step / tires_[k].step_share)), number_text(s_.run.step));
    coupling();
    const rigs::RigDescription rig = describe();
    if (rig.speeds_up_until > s_.run.average_from + 1e-12)
      warn("run.average_from", "the window begins at {} s, while the wheel still speeds up until {} = {} s",
           number_text(s_.run.average_from), rig.speeds_up_key, number_text(rig.speeds_up_until));
  }

  /// Of the block `rim` of a tire's file: another unit?
  void rim_values(const tire::TireSpec& tire) {
    const tire::RimProperties& rim = tire.rim();
    for (const auto& [key, value, low, high, unit] :
         {std::tuple{"rim.mass", rim.mass, 0.01, 2e3, "kg"},
          {"rim.spin_inertia", rim.spin_inertia, 1e-6, 1e3, "kg m²"},
          {"rim.diametral_inertia", rim.diametral_inertia, 1e-6, 1e3, "kg m²"},
          {"rim.carrier_mass", rim.carrier_mass, 0.1, 2e4, "kg"}})
      if (const std::string odd = value > 0.0 ? unusual_text(value, low, high, unit) : ""; !odd.empty())
        warn_of(input_error(tire.options().file.string(), key, odd));
  }

  /// Steps at which forces at the contact of a wheel decide the result by their timing.
  void coupling() {
    const CouplingStep least = smallest_coupling_step(s_);
    if (s_.run.step > least.step)
      warn("run.step",
           "{} s is more than the {} s that {} allows: the timing of contact forces would decide the result; "
           "expected at most that{}",
           number_text(s_.run.step), digits(least.step), least.because, other_help(s_));
  }

  /// Warns of tires that carry far more than the load for which their file was fitted.
  void tire_loads() {
    const std::vector<double> loads = wheel_loads(s_);
    for (std::size_t k = 0; k < loads.size(); ++k)
      if (const double most = tires_[k].most_load; most > 0.0 && loads[k] > kBeyond * most)
        warn(s_.tire_key(k, "file"),
             "carries {} N, but was fitted up to {} N: its forces go on in proportion to the load", digits(loads[k]),
             digits(most));
  }

  /// Checks that the model of a wheel's tire and the terrain support the options for that tire.
  void tire_options(std::size_t wheel) {
    const tire::TireSpec& tire = *s_.tires[wheel];
    if (tire.options().contact_tangent && !terrain_.gives_tangents)
      throw wrong(s_.tire_key(wheel, "contact_tangent"),
                  "is true, expected false: {} (terrain.engine '{}') gives no contact tangents", terrain_.name,
                  terrain_.engine);
    if (!tires_[wheel].own_contact.empty()) require_hard_ground(wheel);
    for (const std::string& key : tire::idle_keys(tire))
      warn(s_.tire_key(wheel, key), "is ignored: a {} does not use it", in_words(tires_[wheel]));
  }

  /// A tire that states its contact needs a terrain that lets it.
  void require_hard_ground(std::size_t wheel) {
    if (!terrain_.takes_stated_contacts)
      throw wrong("terrain.engine", "is '{}', expected {}: {} is a {}, {}", terrain_.engine,
                  terrain::engines_with_stated_contacts(), s_.tire_key(wheel, "file"), in_words(tires_[wheel]),
                  tires_[wheel].own_contact);
    if (tires_[wheel].own_contact_in_plane && std::isfinite(terrain_.uneven.right))
      throw wrong("terrain.profile_across",
                  "is true and {} has heights that change across, expected false: {} is a {}, {}",
                  "terrain." + terrain_.uneven_key, s_.tire_key(wheel, "file"), in_words(tires_[wheel]),
                  tires_[wheel].own_contact);
  }

  void room() {
    for (const tire::TireDescription& tire : tires_) {
      s_.terrain->check_tire_width(tire.width);
      if (tire.grouser_height > 0.0) s_.terrain->check_grousers(tire.grouser_thickness);
    }
    if (!terrain_.bounds) return;
    const rigs::RigDescription rig = describe();
    for (std::size_t k = 0; k < tires_.size(); ++k) {
      const tire::TireDescription& tire = tires_[k];
      const rigs::WheelDescription& wheel = rig.wheels[k];
      const double off = std::abs(wheel.lateral), margin = wall_margin(tire.radius);
      const double width = 2.0 * (wheel.across + off + margin), length = 2.0 * (wheel.along + margin);
      if (width > terrain_.bounds->width)
        throw wrong("terrain.width", "is {} m, expected at least {:.2f} m: the tire is {:.2f} m wide{}",
                    number_text(terrain_.bounds->width), width, tire.width,
                    off > 0.0 ? fmt::format(", {:.3f} m off the middle", off) : "");
      if (length > terrain_.bounds->length)
        throw wrong("terrain.length", "is {} m, expected at least {:.2f} m: the tire is {:.2f} m long",
                    number_text(terrain_.bounds->length), length, 2.0 * tire.radius);
      if (terrain_.grain_radius > kCoarseGrain * tire.radius)
        warn("terrain.radius", "grains of radius {} m are coarse under a tire of radius {} m",
             number_text(terrain_.grain_radius), number_text(tire.radius));
    }
  }

  void packing() {
    const terrain::dem::DemOptions* const grains = s_.terrain->grains();
    if (grains && grains->solid_fraction > 0.0 && grains->solid_fraction < terrain::dem::kMetastable)
      warn("terrain.solid_fraction", "is {}: beds below {} are metastable, as a shock or more weight makes them denser",
           number_text(grains->solid_fraction), number_text(terrain::dem::kMetastable));
  }

  void ranks() {
    if (terrain_.core_per_rank || !s_.terrain->grains()) {
      if (s_.run.threads > 1)
        warn("run.threads", "is {}: engine '{}' {}", s_.run.threads, terrain_.engine,
             terrain_.core_per_rank ? "uses them to make the bed, then one core on each of its ranks (terrain.ranks)"
                                    : "takes one thread");
      s_.run.threads = 1;
    }
    if (terrain_.core_per_rank)
      if (const auto cores = static_cast<int>(allowed_cores().size()); s_.terrain_ranks > cores)
        warn("terrain.ranks",
             "is {}, this machine has {} core{}: each rank needs one of its own, here or on "
             "other nodes; more ranks than cores are slower",
             s_.terrain_ranks, cores, cores > 1 ? "s" : "");
    if (s_.terrain_ranks <= terrain_.most_ranks) return thin_parts();
    throw wrong("terrain.ranks", "is {}, expected {}: engine '{}' runs on {}", s_.terrain_ranks,
                terrain_.most_ranks > 1 ? fmt::format("1 to {}", terrain_.most_ranks) : "1", terrain_.engine,
                terrain_.most_ranks > 1 ? "no more" : "one rank, on all of its cores");
  }

  /// Checks the parts of the bed, because a rank exchanges grains only with its next neighbours.
  void thin_parts() {
    if (!terrain_.core_per_rank || !terrain_.bounds) return;
    const double length = terrain_.bounds->length, least = kLeastPart * terrain_.grain_radius;
    if (length < s_.terrain_ranks * least && s_.terrain_ranks > 1)
      throw wrong(
          "terrain.ranks",

          "is {}, expected {} or fewer: of a bed of {} m each would have a part thinner than {} m, three grains",
          s_.terrain_ranks, std::max(1, static_cast<int>(length / least)), number_text(length), number_text(least));
  }

  void bin() {
    if (!terrain_.bounds) return;
    const double least = kMinGrains * terrain_.grain_radius;
    for (const auto& [key, size] :
         {std::pair{"terrain.length", terrain_.bounds->length}, {"terrain.width", terrain_.bounds->width}})
      if (size < least)
        throw wrong(key, "is {} m, expected at least {} m, two grains", number_text(size), number_text(least));
  }

  void start() {
    std::vector<double> margins;
    for (const tire::TireDescription& tire : tires_) margins.push_back(wall_margin(tire.radius));
    rig_.fill_starts(wheel_sizes(tires_), s_.run.end,
                     terrain_.bounds ? std::optional(terrain_.bounds->length) : std::nullopt, margins);
    for (const auto& [key, what] : rig_.unlikely_values()) warn(key, "{}", what);
    for (const auto& [key, what] : terrain_.remarks) warn("terrain." + key, "{}", what);
    road();
    bends();
    if (!terrain_.bounds) return;
    const double length = terrain_.bounds->length;
    for (const rigs::WheelDescription& wheel : describe().wheels) {
      const double radius = wheel.along;
      if (wheel.stops_before_wall)
        warn("run.end", "the run will end before {} s, where a tire is {} m from the end wall (rig.stop_before_wall)",
             number_text(s_.run.end), number_text(rig_.stop_before_wall()));
      if (wheel.from - radius < 0.0 || wheel.from + radius > length) throw in_a_wall(wheel);
      if (wheel.to - radius < 0.0 || wheel.to + radius > length) {
        const double behind =
            wheel.to > wheel.from ? wheel.from : radius + wall_margin(radius);  // soil behind it stays
        const double needed = behind + std::abs(wheel.to - wheel.from) + radius + wall_margin(radius);
        throw wrong("terrain.length",
                    "is {} m, but the axle travels from x = {:.3f} to {:.3f} m and the tire's radius is "
                    "{:.3f} m: it would hit the end wall; expected at least {:.2f} m or a shorter run",
                    number_text(length), wheel.from, wheel.to, radius, std::ceil(100.0 * needed) / 100.0);
      }
    }
  }

  /// Warns of a road that no wheel reaches; the distance of a steered vehicle is not known.
  void road() {
    if (terrain_.uneven_key.empty()) return;
    const terrain::UnevenPart& road = terrain_.uneven;
    const std::vector<rigs::WheelDescription> wheels = describe().wheels;
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (const rigs::WheelDescription& wheel : wheels) {
      from = std::min({from, wheel.from - wheel.along, wheel.to - wheel.along});
      to = std::max({to, wheel.from + wheel.along, wheel.to + wheel.along});
    }
    for (const rigs::WheelDescription& wheel : wheels)
      if (wheel.lateral < road.right || wheel.lateral > road.left) {
        warn("terrain." + terrain_.uneven_key,
             "lies from y = {} to {} m, and {} is at {} m: beside it the heights of its edge hold; terrain.profile_v "
             "places it",
             number_text(road.right), number_text(road.left), wheel.name.empty() ? "the wheel" : wheel.name,
             number_text(wheel.lateral));
        break;
      }
    if (to >= road.from && from <= road.to) return;
    const auto moves = [](const rigs::WheelDescription& wheel) { return wheel.from != wheel.to; };
    if (!std::ranges::any_of(wheels, moves)) {
      // Ground of keys may begin ahead of a vehicle.
      if (from > road.to || terrain_.uneven_key == "profile_file")
        warn("terrain." + terrain_.uneven_key,
             "is uneven from x = {} to {} m, and the wheels start from x = {} to {} m, on level ground; {}{} places "
             "them",
             number_text(road.from), number_text(road.to), number_text(from), number_text(to), wheels.front().start_key,
             terrain_.uneven_key == "profile_file" ? " or terrain.profile_from" : "");
      return;
    }
    warn("terrain." + terrain_.uneven_key,
         "is uneven from x = {} to {} m, and no wheel comes there: they are on level ground from x = {} to {} m; "
         "{} places them",
         number_text(road.from), number_text(road.to), number_text(from), number_text(to), wheels.front().start_key);
  }

  /// Ground that bends within the contact of a tire that takes it as a plane (tire/handling/road_plane.hpp).
  void bends() {
    const auto in_planes = [](const tire::TireDescription& tire) { return tire.contact_length > 0.0; };
    if (terrain_.uneven_key.empty() || std::ranges::none_of(tires_, in_planes)) return;
    const GroundHeights heights = s_.terrain->heights(s_.terrain_context());
    const terrain::UnevenPart& road = terrain_.uneven;
    if (!heights || !std::isfinite(road.from) || !std::isfinite(road.to)) return;
    double most = kMostBend, worst_at = 0.0, worst_bend = 0.0, worst_length = 0.0;
    const std::vector<rigs::WheelDescription> wheels = describe().wheels;
    for (std::size_t k = 0; k < wheels.size(); ++k) {
      const double half = 0.5 * tires_[k].contact_length, y = wheels[k].lateral;
      if (!(half > 0.0)) continue;
      double from = road.from - half, to = road.to + half;
      if (const auto [first, last] = std::minmax(wheels[k].from, wheels[k].to); first < last)
        from = std::max(from, first), to = std::min(to, last);
      const double apart = std::max(0.5 * half, (to - from) / kMostScanned);
      for (double x = from; x <= to; x += apart) {
        const double bend = 0.5 * std::abs(heights(x - half, y) - 2.0 * heights(x, y) + heights(x + half, y));
        if (const double share = 2.0 * bend * tires_[k].radius / (half * half); share > most)
          most = share, worst_at = x, worst_bend = bend, worst_length = 2.0 * half;
      }
    }
    if (most > kMostBend)
      warn("terrain." + terrain_.uneven_key,
           "bends by {} mm within the {} mm of a tire's contact at x = {} m: a handling tire takes the mean height and "
           "slope there, and follows only longer waves; rings and shells follow the shape",
           digits(1e3 * worst_bend), digits(1e3 * worst_length), digits(worst_at));
  }

  /// What is wrong with the start of a wheel that stands in a wall of the bin.
  Error in_a_wall(const rigs::WheelDescription& wheel) const {
    const double length = terrain_.bounds->length;
    double ahead = 0.0, behind = 0.0;  // of the ends of the tires from the place that the key sets, m
    for (const rigs::WheelDescription& other : describe().wheels) {
      if (other.start_key != wheel.start_key) continue;
      ahead = std::max(ahead, other.start_offset + other.along);
      behind = std::max(behind, other.along - other.start_offset);
    }
    const double low = behind, high = length - ahead;
    if (low > high)
      return wrong("terrain.length",
                   "is {} m, expected at least {:.2f} m: from the first to the last tire the rig is {:.2f} m long",
                   number_text(length), ahead + behind + 2.0 * wall_margin(wheel.along), ahead + behind);
    return wrong(wheel.start_key,

                 "is {} m, expected {:.3f} to {:.3f} m: the tire of {}radius {:.3f} m would stand in a wall of the bin",
                 number_text(short_decimal(wheel.from - wheel.start_offset)), low, high,
                 wheel.name.empty() ? "" : wheel.name + " with ", wheel.along);
  }

  /// Wheels do not act on each other: one inside another would push the same grains twice.
  void overlaps() {
    const std::vector<rigs::WheelDescription> wheels = describe().wheels;
    for (std::size_t k = 1; k < tires_.size(); ++k)
      for (std::size_t i = 0; i < k; ++i) {
        const auto reach = [&](std::size_t of) { return tires_[of].radius + tires_[of].grouser_height; };
        const double along = reach(i) + reach(k), across = 0.5 * (tires_[i].width + tires_[k].width);
        if (std::abs(wheels[i].lateral - wheels[k].lateral) >= across) continue;
        const double from = wheels[k].from - wheels[i].from, to = wheels[k].to - wheels[i].to;
        if (std::min(std::abs(from), std::abs(to)) >= along && from * to > 0.0) continue;
        if (wheels[k].start_key == wheels[i].start_key && !rig_.files().empty())  // this key places both wheels
          throw wrong("rig." + rig_.files().front().key,
                      "has the wheel {} in the way of {}, expected {:.2f} m between their axles or {:.2f} m "
                      "between their mid-planes",
                      wheels[k].name, wheels[i].name, along, across);
        throw wrong(wheels[k].start_key,
                    "puts this wheel in the way of wheel {}, expected {:.2f} m between "
                    "their axles or {:.2f} m between their mid-planes (lateral)",
                    i, along, across);
      }
  }

  void step() {
    const terrain::TerrainEstimate estimate = s_.terrain->estimate(s_.terrain_context());
    if (s_.terrain_step() <= estimate.stable_step) return;
    const std::string what = fmt::format("{} s is above the stable step of {:.3g} s ({})",
                                         number_text(s_.terrain_step()), estimate.stable_step, estimate.stable_reason);
    if (terrain_.unstable_step_allowed) return warn("run.step", "{}, allowed by terrain.allow_unstable_step", what);
    throw wrong("run.step", "{}, expected a smaller step, more terrain.substeps or softer grains", what);
  }

  void machine() {
    const Estimate estimate = scenario::estimate(s_);
    const MachineState here = machine_state();
    s_.memory = {estimate.memory, estimate.terrain.memory_bytes / s_.terrain_ranks};
    if (here.memory_free > 0.0 && estimate.memory > here.memory_free)
      warn("", "needs about {:.1f} GB of memory, this machine has {:.1f} GB free", estimate.memory / kGigabyte,
           here.memory_free / kGigabyte);
    if (here.disk_free > 0.0 && estimate.disk > here.disk_free)
      warn("output.frame_interval", "results need about {:.1f} GB of disk, there are {:.1f} GB free here",
           estimate.disk / kGigabyte, here.disk_free / kGigabyte);
  }

 private:
  rigs::RigDescription describe() const { return describe_rig(s_, tires_); }

  Scenario& s_;
  rigs::RigSpec& rig_;
  std::string file_;
  terrain::TerrainDescription terrain_;
  std::vector<tire::TireDescription> tires_;
};

}  // namespace

double wall_margin(double tire_radius) { return std::min(kWallShare * tire_radius, kMostWallMargin); }

void check_scenario(Scenario& scenario, rigs::RigSpec& rig, Purpose purpose) {
  Checks checks(scenario, rig);
  checks.times();
  checks.rig();
  checks.ranks();
  checks.bin();
  checks.packing();
  checks.tires();
  checks.room();
  checks.start();
  checks.overlaps();
  if (purpose == Purpose::run || scenario.terrain->describe().unstable_step_allowed) checks.step();
  checks.tire_loads();
  checks.machine();
}

}  // namespace furrow::scenario
