// Finds pairs of grains that may touch: the bin is cut into strips across x, each with the list of its pairs.
//
// Grains are sorted by strip, and within a strip by cell (y, then z). A strip is at least as wide as the reach of a
// list, so a grain's partners are in its own strip or in the two next to it. A pair (i, j) is listed once, by the strip
// of the lower index: j is in the same strip or in the next.
//
// Lists are rebuilt only where grains have moved. Every strip adds up the distance of its fastest grain per step
// (`travel`). When this exceeds half the skin since the strip was sorted, the strip and its two neighbours are sorted
// again among themselves, and the lists that contain their grains are rebuilt. Cells are a skin wider than the reach of
// a list, so grains that drifted by half a skin still find each other in neighbouring cells. Neither the choice of
// rebuilt strips nor the order of lists depends on threads.
//
// If grains may sleep, wide strips are cut across into parcels (parcel.hpp), all in the same way. A grain's partners
// are in its own parcel or in the eight around it.
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
  Quad tangential;  // history: spring force, N; w = √δ of the previous step, 0 when apart
  Quad rolling;     // history: rolling spring, N m
};
void visit_fields(FieldsOf<WallContact> auto& s, auto&& visit) {
  visit(s.grain, Field{"grain"});
  visit(s.wall, Field{"wall"});
  visit(s.tangential, Field{"tangential", "N"});
  visit(s.rolling, Field{"rolling", "N m"});
}

/// History of one pair: x y z of the spring on i; w = √δ of the previous step (tangential only).
template <class Real>
struct alignas(4 * sizeof(Real)) HistoryRow {
  Real x = 0, y = 0, z = 0, w = 0;
};

/// History of all listed pairs; all zero while a pair does not touch.
template <class Real>
struct PairHistory {
  std::vector<HistoryRow<Real>> tangential;  // N
  std::vector<HistoryRow<Real>> rolling;     // N m; empty without rolling resistance
};

struct Strip {
  std::int32_t first = 0, last = 0;      // grains
  std::vector<std::int32_t> cell_start;  // of each cell (y, z fastest), counted from `first`
  std::int32_t pairs = 0;
  // Per pair, kQuad times the grain counted from `first`; j may continue into the next strip.
  std::vector<std::uint32_t> i, j;
  // Bit p % 8 of entry p / 8: pair p touched in the last step. Without history it is lost when the list is made again.
  std::vector<std::uint8_t> touching;
  PairHistory<float> single;  // used with precision mixed
  PairHistory<double> full;   // used with precision double
  std::vector<WallContact> walls;
  double travel = 0.0;                           // bound on the displacement of its grains since it was sorted, m
  double x_min = 0.0, x_max = 0.0, z_max = 0.0;  // of the centres when sorted, m
  bool asleep = false;                           // all its parcels are asleep
  bool stale = false;                            // one of its parcels is stale
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
/// The saved state of a strip besides its lists, with sums, which sleeping strips keep. If strips are cut, Parcel's
/// fields are added.
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
    double reach = 0.0;    // closer pairs are listed, m: largest diameter + skin
    double skin = 0.0;     // m
    bool history = true;   // keep tangential history
    bool rolling = false;  // keep rolling history
    bool single = true;    // histories in single precision
    bool cut = false;      // cut wide strips into parcels
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
  /// The strip after k; after the last comes the first if the ends are periodic, else −1.
  int next(int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return k + 1 < count() ? k + 1 : options_.bin.periodic_x ? 0 : -1;
  }

  /// The strip d strips (−1, 0, 1) after k; −1 if there is none.
  int beside(int k, int d) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    const int n = count(), near = k + d;
    return near >= 0 && near < n ? near : options_.bin.periodic_x ? (near + n) % n : -1;
  }
  /// The parcel d parcels (−1, 0, 1) after p in any strip; −1 if there is none.
  int parcel_beside(int p, int d) const {
    FURROW_ASSERT(in_range(p, across_), p, across_);
    const int near = p + d;
    return near >= 0 && near < across_ ? near : options_.bin.periodic_y ? (near + across_) % across_ : -1;
  }
  /// Number of parcels into which each strip is cut.
  int across() const { return across_; }
  /// Whether any of a parcel's columns are between these y, m. The outer ones extend beyond the sides.
  bool parcel_between(int p, double y_min, double y_max) const;
  /// Updates `asleep` and the sums of motion after parcels of strip k have changed.
  void sum_parcels(int k);
  /// Call it after parcels of strip k fell asleep or woke.
  void sleep_changed(int k) {
    sum_parcels(k);
    ++changes_;
  }
  /// A number that changes after any parcel falls asleep, wakes or becomes stale.
  std::int64_t changes() const { return changes_; }

  /// Sorts all grains and makes all lists. Returns the order. @pre threads > 0
  Resorted rebuild_all(Grains& grains, int threads);
  /// Rebuilds lists where a grain may move too far before the end of another step of `dt`.
  /// @pre rebuild_all was called; threads > 0
  std::vector<Resorted> rebuild_moved(Grains& grains, double dt, int threads);

  /// Sum over grains of how often each was sorted; divided by their number, the rebuilds of the whole list.
  std::int64_t resorted() const { return resorted_; }
  void set_resorted(std::int64_t n) {
    FURROW_ASSERT(n >= 0, n);
    resorted_ = n;
  }

  std::size_t bytes() const;

  static constexpr int kMaxCellsZ = 512;  // higher grains share the top cell

  void size_lists(Strip& strip, int pairs) const;
  /// Finds the parts of a strip after its grains, cells, pairs and walls were read.
  void find_parts(Strip& strip) const;
  int cells_y() const { return ny_; }
  int cells_z() const { return nz_; }
  /// Sets the cells along z and the sum of resorted() from a saved state.
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
  int column_of(int p) const { return p * ny_ / across_; }

  Options options_;
  int ny_ = 1, nz_ = 1;
  int across_ = 1;
  double inverse_x_ = 0.0, inverse_y_ = 0.0, inverse_z_ = 0.0;  // cells per metre
  std::vector<Strip> strips_;
  std::int64_t resorted_ = 0, changes_ = 0;
  // Memory that is reused for every rebuild.
  std::vector<Strip> old_;
  struct Scratch {
    std::vector<std::int32_t> cell, start, ids;
    std::vector<Quad> quads;
    std::vector<Drift> drifts;
  } scratch_;
};

}  // namespace furrow::terrain::dem
