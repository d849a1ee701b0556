// Pairs that may touch among a rank's grains and the copies of others' (ghosts), and the histories of touching pairs.
//
// A pair of own grains is listed once; a pair with a ghost is listed by this rank and again by the ghost's. The rows of
// the list, one for each own grain, have the order of the grid's cells: neighbours in space are neighbours in memory.
// Lists are rebuilt when a grain has moved too far. Between rebuilds the indices of grains stay the same, and histories
// are carried from the old list to the new one. When indices change, histories are taken out and put back by tags.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "terrain/dem/quad.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

/// With the spring on the first grain of a pair, as that grain sees it. Seen from the other grain, vectors change sign.
struct PairHistory {
  dem::Quad tangential;  // N; w = √δ of the step before, √m
  dem::Quad rolling;     // N m

  PairHistory turned() const {
    const auto turn = [](const dem::Quad& q) { return dem::Quad{-q.x, -q.y, -q.z, q.w}; };
    return {turn(tangential), turn(rolling)};
  }
};

/// History of a pair that a grain keeps while there are no lists, as the grain sees it.
struct PairOf {
  std::int32_t partner = 0;  // its tag
  PairHistory history;
};

class PairLists {
 public:
  struct Setup {
    double skin = 0.0;     // pairs whose surfaces are closer are listed, m
    double largest = 0.0;  // radius, m
    double width = 0.0;    // of the bin, y from −width/2, m
    bool rolling = false;  // pairs keep rolling histories
  };
  /// The grains: own ones first, then ghosts.
  struct Grains {
    const double* const* position;  // m
    const double* radius;           // m
    int own, all;
    double x_min, x_max;  // of the rank's part, m
  };

  void set_up(const Setup& setup) { setup_ = setup; }

  /// Lists the pairs. Histories of the previous list are carried over if that list is still valid.
  void make(const Grains& grains);
  /// Call it when the indices of grains are no longer valid.
  void drop() { valid_ = false; }
  bool valid() const { return valid_; }
  std::int64_t builds() const { return builds_; }

  int rows() const { return static_cast<int>(now_.grain.size()); }
  int grain(int row) const { return now_.grain[row]; }
  std::span<const std::int32_t> grains() const { return now_.grain; }
  int begin(int row) const { return now_.first[row]; }
  int end(int row) const { return now_.first[row + 1]; }
  const std::int32_t* partner() const { return now_.partner.data(); }
  std::uint8_t* touching() { return now_.touching.data(); }
  dem::Quad* tangential() { return now_.tangential.data(); }
  dem::Quad* rolling() { return now_.rolling.data(); }  // null without rolling resistance

  PairHistory history(int entry) const;
  /// Marks the pair of this entry as touching and sets its history.
  void remember(int entry, const PairHistory& history);
  template <class See>
  void for_touching(const See& see) const {
    for (int row = 0; row < rows(); ++row)
      for (int e = begin(row); e < end(row); ++e)
        if (now_.touching[e]) see(grain(row), now_.partner[e], e);
  }

 private:
  /// The grains in the order of cells.
  struct Grid {
    std::vector<std::int32_t> start;  // of each cell (z fastest, then y, then x), and the end
    std::vector<std::int32_t> grain;
    std::vector<dem::Quad> at;  // w: radius
  };
  struct Lists {
    std::vector<std::int32_t> grain;    // of each row
    std::vector<std::int32_t> first;    // of each row, and the end
    std::vector<std::int32_t> partner;  // of each entry
    std::vector<std::uint8_t> touching;
    std::vector<dem::Quad> tangential, rolling;
  };

  void lay_cells(const Grains& grains);
  void sort(const Grains& grains, int from, int to, Grid& grid);
  void list_rows(const Grains& grains);
  void carry(int own);
  int entry_of(int i, int j) const;

  Setup setup_;
  int nx_ = 1, ny_ = 1, nz_ = 1;
  double x_begin_ = 0.0, per_cell_ = 0.0;  // m, 1/m
  Grid own_, ghosts_;
  Lists now_, before_;
  std::vector<std::int32_t> row_of_;  // of each own grain
  std::vector<std::int32_t> cell_;    // while grains are sorted
  bool valid_ = false;
  std::int64_t builds_ = 0;
};

}  // namespace furrow::terrain::liggghts
