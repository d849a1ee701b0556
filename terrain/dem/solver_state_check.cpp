#include "terrain/dem/solver_state_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::int64_t kMaxGrains = std::numeric_limits<std::int32_t>::max() / 4;

/// @param what is called for the text only if something is wrong, as most checks run for every pair of grains
template <class What>
void require(bool ok, const char* array, const What& what) {
  if (!ok) throw Error(ExitCode::io, fmt::format("saved state '{}' {}: it is damaged", array, what()));
}

std::size_t lanes(std::int64_t pairs) { return (static_cast<std::size_t>(pairs) + kFloatLanes - 1) / kFloatLanes; }

/// Checks one strip after another, and keeps the offsets of the present one in the lists of all.
class Check {
 public:
  Check(const Archive& archive, const Strips& strips, double smallest, double largest)
      : archive_(archive),
        strips_(strips),
        smallest_(smallest),
        largest_(largest),
        count_(static_cast<std::size_t>(strips.count())) {}

  void run() {
    grains();
    samples();
    ranges();
    cells();
    pairs();
    walls();
  }

 private:
  std::int64_t grains_of(std::size_t k) const { return last_[k] - first_[k]; }

  void grains() {
    n_ = archive_.get_int("count");
    require(n_ >= 0 && n_ <= kMaxGrains, "count", [&] { return fmt::format("is {}", n_); });
    const auto n = static_cast<std::size_t>(n_);
    const auto& positions = archive_.get<double>("position", 4 * n);
    for (const double x : positions)
      require(std::abs(x) < Bin::kHigh, "position", [&] { return "holds a value that is not a position"; });
    for (std::size_t w = 3; w < positions.size(); w += 4)
      require(positions[w] >= smallest_ && positions[w] <= largest_, "position", [&] {
        return fmt::format("holds a grain of radius {:g} m, expected {:g} to {:g} m", positions[w], smallest_,
                           largest_);
      });
    for (const std::int32_t id : archive_.get<std::int32_t>("id", n))
      require(id >= 0 && id < n_, "id", [&] { return fmt::format("names grain {} of {}", id, n_); });
  }

  static void force(const char* array, double sum) {
    require(sum >= 0.0 && std::isfinite(sum), array,
            [&] { return fmt::format("holds {:g} N, expected 0 or more", sum); });
  }

  /// The limits of sleep and waking follow from the mean of these samples, so a negative mean would reverse them.
  void samples() {
    force("mean_contact_force", archive_.get_double("mean_contact_force"));
    if (archive_.has("parcels/measured_force"))
      for (const double sum : archive_.get<double>("parcels/measured_force")) force("parcels/measured_force", sum);
    const auto& samples = archive_.get<double>("samples/strips");
    require(samples.empty() || samples.size() == 2 * count_, "samples/strips",
            [&] { return fmt::format("has {} numbers, expected {}", samples.size(), 2 * count_); });
    for (std::size_t k = 0; k + 1 < samples.size(); k += 2) {
      force("samples/strips", samples[k]);
      require(samples[k + 1] >= 0.0 && samples[k + 1] < 1e15, "samples/strips",
              [&] { return "holds a value that is not a number of contacts"; });
    }
  }

  /// The ranges of the strips cover all grains without a gap.
  void ranges() {
    first_ = archive_.get<std::int32_t>("strips/first", count_);
    last_ = archive_.get<std::int32_t>("strips/last", count_);
    std::int64_t next = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      require(first_[k] == next && last_[k] >= first_[k], "strips/first",
              [&] { return fmt::format("begins strip {} with grain {}, expected {}", k, first_[k], next); });
      next = last_[k];
    }
    require(next == n_, "strips/last", [&] { return fmt::format("ends with grain {}, expected {}", next, n_); });
  }

  void cells() {
    const std::int64_t along_z = archive_.get_int("strips/cells_z");
    require(along_z >= 1 && along_z <= Strips::kMaxCellsZ, "strips/cells_z",
            [&] { return fmt::format("is {}", along_z); });
    require(archive_.get_int("strips/resorted") >= 0, "strips/resorted", [&] { return "is negative"; });
    const auto each = static_cast<std::size_t>(strips_.cells_y() * along_z + 1);
    const auto& cells = archive_.get<std::int32_t>("strips/cells", each * count_);
    for (std::size_t k = 0; k < count_; ++k) {
      const auto from = cells.begin() + static_cast<std::ptrdiff_t>(k * each),
                 to = from + static_cast<std::ptrdiff_t>(each);
      require(*from == 0 && *(to - 1) == grains_of(k) && std::is_sorted(from, to), "strips/cells",
              [&] { return fmt::format("does not share out the grains of strip {}", k); });
    }
  }

  /// Parcels are found by searching, so the lists of strips that are cut must be in order.
  template <class Number>
  void in_order(bool ok, const char* array, Number k) const {
    require(ok || strips_.across() == 1, array,
            [&] { return fmt::format("lists the grains of strip {} out of their order", k); });
  }

  void pairs() {
    const auto& pairs = archive_.get<std::int32_t>("strips/pairs", count_);
    std::size_t all = 0, groups = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      require(pairs[k] >= 0, "strips/pairs", [&] { return fmt::format("has {} pairs for strip {}", pairs[k], k); });
      all += static_cast<std::size_t>(pairs[k]), groups += lanes(pairs[k]);
    }
    const auto& partners = archive_.get<std::uint64_t>("pairs/partners", all);
    const auto& touching = archive_.get<std::uint8_t>("pairs/touching", groups);
    std::size_t pair = 0, group = 0, touches = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const int next = strips_.next(static_cast<int>(k));
      const std::int64_t own = grains_of(k), reach = own + (next < 0 ? 0 : grains_of(static_cast<std::size_t>(next)));
      std::uint64_t before = 0;
      for (std::int32_t p = 0; p < pairs[k]; ++p) {
        const std::uint64_t i = partners[pair + static_cast<std::size_t>(p)] >> 32,
                            j = partners[pair + static_cast<std::size_t>(p)] & 0xFFFFFFFFU;
        require(i % kQuad == 0 && j % kQuad == 0 && i / kQuad < static_cast<std::uint64_t>(own) &&
                    j / kQuad < static_cast<std::uint64_t>(reach),
                "pairs/partners", [&] { return fmt::format("names a grain that strip {} has not", k); });
        in_order(p == 0 || i >= before, "pairs/partners", k);
        before = i;
        touches += touching[group + static_cast<std::size_t>(p) / kFloatLanes] >> p % kFloatLanes & 1;
      }
      pair += static_cast<std::size_t>(pairs[k]), group += lanes(pairs[k]);
    }
    // Beds may contain histories that a run does not use.
    const Strips::Options& options = strips_.options();
    require(!options.history || archive_.get<double>("pairs/tangential").size() >= 4 * touches, "pairs/tangential",
            [&] { return fmt::format("is too short for {} contacts", touches); });
    const bool rolling = options.history && options.rolling;
    require(archive_.get<double>("pairs/rolling").size() >= (rolling ? 4 * touches : 0), "pairs/rolling",
            [&] { return fmt::format("is too short for {} contacts", touches); });
  }

  void walls() {
    const auto& walls = archive_.get<std::int32_t>("strips/walls", count_);
    std::size_t all = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      require(walls[k] >= 0, "strips/walls", [&] { return fmt::format("has {} contacts for strip {}", walls[k], k); });
      all += static_cast<std::size_t>(walls[k]);
    }
    const auto& grain = archive_.get<std::int32_t>("walls/grain", all);
    const auto& wall = archive_.get<std::int32_t>("walls/wall", all);
    std::size_t contact = 0;
    for (std::size_t k = 0; k < count_; ++k)
      for (std::int32_t c = 0; c < walls[k]; ++c, ++contact) {
        require(grain[contact] >= 0 && grain[contact] < grains_of(k), "walls/grain",
                [&] { return fmt::format("names a grain that strip {} has not", k); });
        in_order(c == 0 || grain[contact] >= grain[contact - 1], "walls/grain", k);
        require(wall[contact] >= 0 && wall[contact] < kWalls, "walls/wall",
                [&] { return fmt::format("names wall {}", wall[contact]); });
      }
  }

  const Archive& archive_;
  const Strips& strips_;
  double smallest_, largest_;  // radii of grains, m
  std::size_t count_;
  std::int64_t n_ = 0;
  std::vector<std::int32_t> first_, last_;
};

}  // namespace

void check_solver_state(const Archive& archive, const Strips& strips, double smallest, double largest) {
  Check(archive, strips, smallest, largest).run();
}

std::int64_t saved_across(const Archive& archive) { return archive.has(kAcross) ? archive.get_int(kAcross) : 1; }

void require_same_parcels(const Archive& archive, const Strips& strips) {
  const std::int64_t across = saved_across(archive);
  if (across != strips.across())
    throw Error(ExitCode::io,
                fmt::format("saved state '{}' is {}, expected {}: another version of the program cut the strips "
                            "of the bed otherwise, and what sleeps with them",
                            kAcross, across, strips.across()));
}

}  // namespace furrow::terrain::dem
