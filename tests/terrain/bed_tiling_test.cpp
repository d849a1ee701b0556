// Beds assembled from copies of a settled piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "protocol/core/archive_hash.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_compaction.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_layers.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_seams.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/beds/bed_tiling.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/bed_fixture.hpp"

namespace furrow::terrain::dem {
namespace {

/// The most grains that may stand together, by trying all.
int most_by_trying(const Conflicts& conflicts, int second) {
  const int first = static_cast<int>(conflicts.size());
  int most = 0;
  for (unsigned set = 0; set < 1u << first; ++set) {
    std::vector<bool> barred(second, false);
    for (int a = 0; a < first; ++a)
      if (set >> a & 1u)
        for (const int b : conflicts[a]) barred[b] = true;
    most = std::max<int>(most, std::popcount(set) + static_cast<int>(std::count(barred.begin(), barred.end(), false)));
  }
  return most;
}

TEST(BedSeams, keep_as_many_as_trying_all_finds_and_none_in_conflict) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const int first = 1 + static_cast<int>(random() % 9), second = 1 + static_cast<int>(random() % 9);
    Conflicts conflicts(first);
    for (auto& of_a : conflicts)
      for (int b = 0; b < second; ++b)
        if (random() % 4 == 0) of_a.push_back(b);
    const SeamChoice stays = most_compatible(conflicts, second);
    for (int a = 0; a < first; ++a)
      for (const int b : conflicts[a]) EXPECT_FALSE(stays.first[a] && stays.second[b]) << trial;
    EXPECT_EQ(std::count(stays.first.begin(), stays.first.end(), true) +
                  std::count(stays.second.begin(), stays.second.end(), true),
              most_by_trying(conflicts, second))
        << trial;
  }
}

TEST(BedSeams, a_long_chain_needs_no_deep_stack) {
  const int n = 200000;
  Conflicts chain(n);
  for (int a = 0; a < n; ++a) {
    chain[a].push_back(a);
    if (a > 0) chain[a].push_back(a - 1);
  }
  const SeamChoice stays = most_compatible(chain, n);
  EXPECT_EQ(std::count(stays.first.begin(), stays.first.end(), true) +
                std::count(stays.second.begin(), stays.second.end(), true),
            n);
}

TEST(BedLayers, layers_that_go_around_keep_their_distance_across_the_sides) {
  const Bin bin{0.5, 0.3, true, true};
  const double r = 0.006;
  const std::vector<Quad> s = poisson_layer(bin, r, 7, {}, true);
  bool at_side = false;
  for (std::size_t i = 0; i < s.size(); ++i) {
    at_side = at_side || s[i].x < r;
    for (std::size_t j = 0; j < i; ++j) {
      const Quad d = shortest(bin, s[i], s[j]);
      EXPECT_GE(std::hypot(d.x, d.y), kSpacing * r * (1.0 - 1e-12));
    }
  }
  EXPECT_TRUE(at_side);
  EXPECT_NEAR(static_cast<double>(s.size()), expected_layer_count(bin, r, true), 0.02 * static_cast<double>(s.size()));
}

class Tiled : public SmallBeds {
 protected:
  Tiled() {
    options_.length = 0.9;
    options_.width = 0.42;
    options_.cohesion = 40e3;
    options_.tile = 0.45;
  }
  std::vector<Quad> positions(const PreparedBed& bed, const DemOptions& o) const {
    GrainSolver solver(solver_params(o));
    solver.restore(bed.bed);
    return positions_by_id(solver);
  }
  /// Grains of the piece from which the bed is assembled.
  std::vector<Quad> piece() const { return positions(prepare_bed(piece_of(options_), {}), piece_of(options_)); }
  BedStatistics statistics(const std::vector<Quad>& grains, const DemOptions& o) const {
    return bed_statistics(grains, solver_params(o).bin, o.radius);
  }
};

TEST_F(Tiled, bed_rests_and_is_as_dense_as_one_settled_whole) {
  const PreparedBed tiled = prepare_bed(options_, {});
  EXPECT_TRUE(tiled.settled.settled);
  DemOptions whole = options_;
  whole.tile = 0.0;
  const std::vector<Quad> grains = positions(tiled, options_);
  const BedStatistics a = statistics(grains, options_), b = statistics(positions(prepare_bed(whole, {}), whole), whole);
  EXPECT_NEAR(static_cast<double>(a.grains), static_cast<double>(b.grains), 0.04 * static_cast<double>(b.grains));
  EXPECT_NEAR(static_cast<double>(a.grains), expected_grains(options_), 0.03 * static_cast<double>(a.grains));
  EXPECT_NEAR(a.grain_volume, static_cast<double>(a.grains) * volume_below(0.01, 0.0, 0.02), 1e-9);
  EXPECT_NEAR(a.solid_fraction_bulk, b.solid_fraction_bulk, 0.03 * b.solid_fraction_bulk);
  EXPECT_NEAR(a.coordination, b.coordination, 0.05 * b.coordination);
  EXPECT_LE(a.max_overlap, 1.1 * b.max_overlap);
  // There are as many grains around the seam as elsewhere.
  const auto within = [&](double from, double to) {
    return static_cast<double>(
        std::count_if(grains.begin(), grains.end(), [&](const Quad& p) { return p.x >= from && p.x < to; }));
  };
  EXPECT_NEAR(within(0.40, 0.50), 0.5 * (within(0.2, 0.3) + within(0.6, 0.7)), 0.06 * within(0.40, 0.50));
}

TEST_F(Tiled, nobody_is_squeezed_in_where_pieces_are_joined_or_cut) {
  for (const double width : {0.42, 0.84}) {
    options_.width = width;
    const std::vector<Quad> settled_piece = piece();
    const BedStatistics settled = statistics(settled_piece, piece_of(options_));
    const std::vector<Quad> grains = tiled_positions(settled_piece, options_);
    EXPECT_GT(settled.max_overlap, 0.0);
    EXPECT_LE(statistics(grains, options_).max_overlap, settled.max_overlap * (1.0 + 1e-9));
    // The side walls between which a piece was settled press on it; all other walls are new.
    for (const Quad& p : grains)
      for (int wall = 0; wall < kFloor; ++wall)
        EXPECT_GE(solver_params(options_).bin.distance(wall, p), (width < 0.5 && wall >= 2 ? 0.9 : 1.0) * p.w);
  }
}

/// A wheel must not meet copies of one column again; only in the band of a seam may a column continue. Between walls
/// columns are mirrored or turned; otherwise they are also moved across.
TEST_F(Tiled, no_column_is_one_before_it_again) {
  options_.length = 1.8;
  for (const char* sides : {"walls", "periodic"}) {
    options_.sides = sides;
    EXPECT_EQ(piece_of(options_).sides, sides);  // one piece fills the width
    const std::vector<Quad> grains = tiled_positions(piece(), options_);
    int again = 0;
    for (const Quad& p : grains)
      for (const Quad& q : grains) {
        const int columns = static_cast<int>(std::lround((q.x - p.x) / 0.45));
        const double into = q.x - 0.45 * std::floor(q.x / 0.45);  // its column
        again += columns > 0 && into > 0.11 && into < 0.34 && p.z == q.z &&
                 std::abs(q.x - p.x - 0.45 * columns) < 1e-6 && std::abs(q.y - p.y) < 1e-6;
      }
    EXPECT_EQ(again, 0) << sides;
  }
}

TEST_F(Tiled, periodic_sides_and_pieces_across_leave_no_joint_across) {
  options_.sides = "periodic";
  options_.width = 0.84;
  const std::vector<Quad> one = piece(), grains = tiled_positions(one, options_);
  EXPECT_EQ(tiling_of(options_).across, 2);
  // Away from the seam and the end walls, the bed contains each grain of the piece twice.
  const auto middle = [](const std::vector<Quad>& all, double from, double to) {
    return std::count_if(all.begin(), all.end(), [&](const Quad& p) { return p.x > from && p.x < to; });
  };
  EXPECT_EQ(middle(grains, 0.05, 0.3), 2 * middle(one, 0.05, 0.3));
}

TEST_F(Tiled, same_bits_for_any_threads_and_from_the_cache) {
  options_.settle_threads = 1;
  const PreparedBed made = prepare_bed(options_, {});
  EXPECT_FALSE(made.from_cache);
  const PreparedBed kept = prepare_bed(options_, {});
  EXPECT_TRUE(kept.from_cache);
  EXPECT_EQ(archive_hash(made.bed).value(), archive_hash(kept.bed).value());
  DemOptions threads = options_;
  threads.settle_threads = 2;
  threads.cache = false;
  EXPECT_EQ(archive_hash(prepare_bed(threads, {}).bed).value(), archive_hash(made.bed).value());
}

TEST_F(Tiled, a_tile_as_large_as_the_bin_is_the_bed_settled_whole) {
  options_.cache = false;
  options_.length = 0.42;
  options_.tile = 5.0;
  EXPECT_FALSE(is_tiled(options_));
  DemOptions whole = options_;
  whole.tile = 0.0;
  EXPECT_EQ(archive_hash(prepare_bed(options_, {}).bed).value(), archive_hash(prepare_bed(whole, {}).bed).value());
}

TEST_F(Tiled, too_small_pieces_are_refused_by_key) {
  options_.tile = 0.3;
  EXPECT_EQ(refusal(ExitCode::bad_input, [&] { prepare_bed(options_, {}); }),
            "scenario: key 'terrain.tile': is 0.3 m and gives 3 × 1 pieces of 0.3 × 0.42 m, expected "
            "pieces of at "
            "least 0.4 × 0.4 m for these grains");
}

TEST_F(Tiled, a_signal_stops_every_part_of_the_work) {
  options_.cache = false;
  std::vector<std::string> phases;
  const auto note = [&](const std::string& what, double) {
    if (phases.empty() || phases.back() != what) phases.push_back(what);
  };
  prepare_bed(options_, note);
  const auto told = [&](const char* what) { return std::find(phases.begin(), phases.end(), what) != phases.end(); };
  EXPECT_TRUE(told("a piece of the bed: settling the bed"));
  EXPECT_TRUE(told("joining the pieces of the bed"));
  EXPECT_TRUE(told("joints of the bed: settling the bed"));
  for (const std::string& phase :
       {std::string("joining the pieces of the bed"), std::string("joints of the bed: settling the bed")})
    EXPECT_THROW(prepare_bed(options_,
                             [&](const std::string& what, double) {
                               if (what == phase) throw Error(ExitCode::stopped, "stopped");
                             }),
                 Error)
        << phase;
}

}  // namespace
}  // namespace furrow::terrain::dem
