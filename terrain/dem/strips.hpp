// Who may touch whom: the bin cut into strips across x, each with the list of its pairs.
//
// Grains are sorted by strip, within a strip by cell (y, then z). A strip is at least as wide as two grains may be
// apart to be listed, so that a grain's partners are in its own strip or in the two beside it. The pair (i, j) is
// listed once, by the strip of the lower index: j is in the same strip or in the next.
//
// Lists are made again only where grains moved. Every strip adds up how far its fastest grain went per step
// (`travel`); when that exceeds half the skin since the strip was sorted, the strip and its two neighbours are sorted
// again among themselves and the lists that name their grains are rebuilt. The rest of the bed keeps its lists.
// Cells are a skin wider than the reach of a list, so that grains which drifted by half a skin still find each other
// in neighbouring cells. Which strips are rebuilt, and the order of every list, does not depend on threads.
//
// Where grains may sleep, strips that are wide enough are cut across into parcels (parcel.hpp), alike in all strips. A
// grain's partners are in its own parcel or in the eight around it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/grains.hpp"
#include "terrain/dem/parcel.hpp"

namespace furrow::terrain::dem {

/// A grain near a wall of the bin.
struct WallContact {
  std::int32_t grain = 0;  // counted from the strip's first
  std::int32_t wall = 0;
  Quad tangential;  // history: spring force, N; w = √δ of the step before, 0 when apart
  Quad rolling;     // history: rolling spring, N m
};
void visit_fields(FieldsOf<WallContact> auto& s, auto&& visit) {
  visit(s.grain, Field{"grain"});
  visit(s.wall, Field{"wall"});
  visit(s.tangential, Field{"tangential", "N"});
  visit(s.rolling, Field{"rolling", "N m"});
}

/// History of one pair: x y z of the spring on i; w = √δ of the step before (tangential only).
template <class Real>
struct alignas(4 * sizeof(Real)) HistoryRow {
  Real x = 0, y = 0, z = 0, w = 0;
};

/// Per listed pair; all zero while the pair does not touch.
template <class Real>
struct PairHistory {
  std::vector<HistoryRow<Real>> tangential;  // N
  std::vector<HistoryRow<Real>> rolling;     // N m; empty without rolling resistance
};

struct Strip {
  std::int32_t first = 0, last = 0;      // grains
  std::vector<std::int32_t> cell_start;  // of each cell (y, z fastest), counted from `first`
  std::int32_t pairs = 0;
  // Per pair, kQuad times the grain counted from `first`; j runs on into the next strip.
  std::vector<std::uint32_t> i, j;
  std::vector<std::uint8_t> touching;  // bit k of entry p/8: pair p touched in the last step
  PairHistory<float> single;           // used with precision mixed
  PairHistory<double> full;            // used with precision double
  std::vector<WallContact> walls;
  double travel = 0.0;                           // bound on the way of any of its grains since it was sorted, m
  double x_min = 0.0, x_max = 0.0, z_max = 0.0;  // of the centres when sorted, m
  bool asleep = false;                           // all its parcels are
  bool stale = false;                            // one of its parcels is
  std::int32_t lost = -1;                        // a grain outside the bin or not finite, counted from `first`
  std::vector<Parcel> parcels = std::vector<Parcel>(1);
  ContactTotals contact;  // of all parcels
  MotionTotals motion;

  int grains() const { return last - first; }
  int grain_i(int pair) const {
    FURROW_ASSERT(in_range(pair, pairs), pair, pairs);
    return static_cast<int>(i[pair] / kQuad);
  }
  int grain_j(int pair) const {
    FURROW_ASSERT(in_range(pair, pairs), pair, pairs);
    return static_cast<int>(j[pair] / kQuad);
  }
  template <class Real>
  PairHistory<Real>& history() {
    if constexpr (std::is_same_v<Real, float>) {
      return single;
    } else {
      return full;
    }
  }
  template <class Real>
  const PairHistory<Real>& history() const {
    return const_cast<Strip*>(this)->history<Real>();
  }
};
/// What a saved state keeps of a strip besides its lists. Sums too: those of strips that sleep stay. Where strips are
/// cut, Parcel's fields stand beside these.
void visit_fields(FieldsOf<Strip> auto& s, auto&& visit) {
  visit(s.first, Field{"first"});
  visit(s.last, Field{"last"});
  visit(s.pairs, Field{"pairs"});
  visit(s.travel, Field{"travel", "m"});
  visit(s.x_min, Field{"x_min", "m"});
  visit(s.x_max, Field{"x_max", "m"});
  visit(s.z_max, Field{"z_max", "m"});
  visit(s.asleep, Field{"asleep", ""});
  visit(s.parcels.front().calm, Field{"calm"});
  visit(s.parcels.front().sways, Field{"sways", ""});
  visit(s.parcels.front().window, Field{"window"});
  visit(s.contact.elastic, Field{"elastic", "J"});
  visit(s.contact.max_overlap, Field{"max_overlap", "m"});
  visit(s.contact.wall_force, Field{"wall_force", "N"});
  visit(s.contact.floor_force, Field{"floor_force", "N"});
  visit(s.contact.contacts, Field{"contacts"});
  visit(s.motion.height, Field{"height", "m"});
  visit(s.motion.held, Field{"held", "N"});
}

/// A range of strips that was sorted again: order[k] is the old index of grain first + k.
struct Resorted {
  int from = 0, to = 0;  // strips [from, to)
  std::int32_t first = 0;
  std::vector<std::int32_t> order;
};

class Strips {
 public:
  struct Options {
    double reach = 0.0;    // pairs closer than that are listed, m: largest diameter + skin
    double skin = 0.0;     // m
    bool history = true;   // keep tangential history
    bool rolling = false;  // keep rolling history
    bool single = true;    // histories in single precision
    bool cut = false;      // wide strips into parcels
    Bin bin;
  };

  explicit Strips(const Options& options);

  const Options& options() const { return options_; }
  int count() const { return static_cast<int>(strips_.size()); }
  Strip& operator[](int k) {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return strips_[k];
  }
  const Strip& operator[](int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return strips_[k];
  }
  /// The strip after k; with periodic ends the first follows the last, else −1 follows.
  int next(int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return k + 1 < count() ? k + 1 : options_.bin.periodic_x ? 0 : -1;
  }

  /// The strip that lies d strips (−1, 0, 1) after k, −1: none.
  int beside(int k, int d) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    const int n = count(), near = k + d;
    return near >= 0 && near < n ? near : options_.bin.periodic_x ? (near + n) % n : -1;
  }
  /// The parcel that lies d parcels (−1, 0, 1) after p in any strip, −1: none.
  int parcel_beside(int p, int d) const {
    FURROW_ASSERT(in_range(p, across_), p, across_);
    const int near = p + d;
    return near >= 0 && near < across_ ? near : options_.bin.periodic_y ? (near + across_) % across_ : -1;
  }
  /// Into how many parcels each strip is cut.
  int across() const { return across_; }
  /// Whether any of a parcel's columns stand between these y, m. The outer ones reach beyond the sides.
  bool parcel_between(int p, double y_min, double y_max) const;
  /// After parcels of strip k were moved, or changed otherwise: `asleep` and the sums of motion.
  void sum_parcels(int k);
  /// After parcels of strip k fell asleep or woke.
  void sleep_changed(int k) {
    sum_parcels(k);
    ++changes_;
  }
  /// Another number after any parcel fell asleep, woke or became stale.
  std::int64_t changes() const { return changes_; }

  /// Sorts all grains and makes all lists. Returns the order. @pre threads > 0
  Resorted rebuild_all(Grains& grains, int threads);
  /// Rebuilds where a grain may have moved too far before the end of another step of `dt`.
  /// @pre rebuild_all was called; threads > 0
  std::vector<Resorted> rebuild_moved(Grains& grains, double dt, int threads);

  /// How often a grain was sorted, summed over grains: divided by their number, the rebuilds of the whole list.
  std::int64_t resorted() const { return resorted_; }
  void set_resorted(std::int64_t n) {
    FURROW_ASSERT(n >= 0, n);
    resorted_ = n;
  }

  /// What the lists hold in memory, with what a rebuild needs.
  std::size_t bytes() const;

  static constexpr int kMaxCellsZ = 512;  // higher grains share the top cell

  /// Gives a strip its arrays for `pairs` pairs.
  void size_lists(Strip& strip, int pairs) const;
  /// After a strip was read from a saved state with its grains, cells, pairs and walls.
  void find_parts(Strip& strip) const;
  /// After strips were read from a saved state: cells along z, and what follows from the grains.
  int cells_y() const { return ny_; }
  int cells_z() const { return nz_; }
  void restore_shape(int cells_z, std::int64_t resorted);

 private:
  Resorted rebuild(Grains& grains, int from, int to, int threads);
  void sort(Grains& grains, Resorted& range, int threads);
  void list_pairs(const Grains& grains, int k);
  void list_walls(const Grains& grains, Strip& strip) const;
  template <class Real>
  void carry_history(std::span<const Strip> old, int old_from, const Resorted& range, int threads);
  void carry_walls(std::span<const Strip> old, int old_from, const Resorted& range);
  void mark_stale(std::span<const Strip> old, int old_from, const Resorted& range);
  int strip_at(double x) const;
  /// The first of the columns of parcel p.
  int column_of(int p) const { return p * ny_ / across_; }

  Options options_;
  int ny_ = 1, nz_ = 1;
  int across_ = 1;
  double inverse_x_ = 0.0, inverse_y_ = 0.0, inverse_z_ = 0.0;  // cells per metre
  std::vector<Strip> strips_;
  std::int64_t resorted_ = 0, changes_ = 0;
  // Memory that is kept from rebuild to rebuild.
  std::vector<Strip> old_;
  struct Scratch {
    std::vector<std::int32_t> cell, start, ids;
    std::vector<Quad> quads;
    std::vector<Drift> drifts;
  } scratch_;
};

}  // namespace furrow::terrain::dem
