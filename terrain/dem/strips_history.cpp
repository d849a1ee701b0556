// Carries contact histories from the lists before sorting to the lists after it.
#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {
namespace {

/// Finds the history of a pair of grains in the lists before sorting.
class OldPairs {
 public:
  OldPairs(std::span<const Strip> old, bool periodic) : old_(old), periodic_(periodic) {
    FURROW_ASSERT(!old.empty(), old.size());
    base_ = old.front().first;
    row_.assign(old.back().last - base_ + 1, 0);
    strip_of_.resize(old.back().last - base_);
    for (int s = 0; s < static_cast<int>(old.size()); ++s) {
      const Strip& strip = old[s];
      int p = 0;
      for (int g = 0; g < strip.grains(); ++g) {
        while (p < strip.pairs && strip.grain_i(p) < g) ++p;
        row_[strip.first - base_ + g] = p;
        strip_of_[strip.first - base_ + g] = s;
      }
    }
  }

  struct Found {
    const Strip* strip = nullptr;
    int pair = 0;
    bool reversed = false;
  };
  /// The pair of the grains with the old indices a and b.
  Found find(int a, int b) const {
    Found found = of(std::min(a, b), std::max(a, b));
    found.reversed = a > b;
    if (found.strip || !periodic_) return found;
    found = of(std::max(a, b), std::min(a, b));
    found.reversed = a < b;
    return found;
  }

 private:
  Found of(int owner, int partner) const {
    if (owner < base_ || owner - base_ >= static_cast<int>(strip_of_.size())) return {};
    const Strip& strip = old_[strip_of_[owner - base_]];
    const int i = owner - strip.first;
    // Across periodic sides the owner may come after its partner, in one strip (y) or from the last to the first (x).
    const int j = partner >= strip.first ? partner - strip.first : strip.grains() + partner - old_.front().first;
    for (int p = row_[owner - base_]; p < strip.pairs && strip.grain_i(p) == i; ++p)
      if (strip.grain_j(p) == j && (strip.touching[p / kFloatLanes] >> p % kFloatLanes & 1)) return {&strip, p, false};
    return {};
  }

  std::span<const Strip> old_;
  bool periodic_;
  std::int32_t base_ = 0;
  std::vector<std::int32_t> row_, strip_of_;  // per grain of the old strips: its first pair, its strip
};

template <class Real>
HistoryRow<Real> turned(const HistoryRow<Real>& h, bool reversed) {
  return reversed ? HistoryRow<Real>{-h.x, -h.y, -h.z, h.w} : h;
}

}  // namespace

template <class Real>
void Strips::carry_history(std::span<const Strip> old, int old_from, const Resorted& range, int threads) {
  FURROW_ASSERT(static_cast<int>(old.size()) == range.to - old_from, old.size(), old_from, range.to);
  const OldPairs pairs(old, options_.bin.periodic_x || options_.bin.periodic_y);
  const auto before = [&](int g) {
    const int k = g - range.first;
    return k >= 0 && k < static_cast<int>(range.order.size()) ? range.order[k] : g;
  };
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (int s = old_from; s < range.to; ++s) {
    Strip& strip = strips_[s];
    const int after = next(s), wrap = after >= 0 && after < s ? strips_[after].first : strip.last;
    PairHistory<Real>& now = strip.history<Real>();
    for (int p = 0; p < strip.pairs; ++p) {
      const int i = strip.first + strip.grain_i(p), partner = strip.grain_j(p);
      const int j = partner < strip.grains() ? strip.first + partner : wrap + partner - strip.grains();
      const auto found = pairs.find(before(i), before(j));
      if (!found.strip) continue;
      strip.touching[p / kFloatLanes] |= static_cast<std::uint8_t>(1 << p % kFloatLanes);
      const PairHistory<Real>& then = found.strip->template history<Real>();
      now.tangential[p] = turned(then.tangential[found.pair], found.reversed);
      if (!now.rolling.empty()) now.rolling[p] = turned(then.rolling[found.pair], found.reversed);
    }
  }
}

void Strips::carry_walls(std::span<const Strip> old, int old_from, const Resorted& range) {
  FURROW_ASSERT(old_from <= range.from && static_cast<int>(old.size()) == range.to - old_from, old.size(), old_from,
                range.from);
  std::vector<std::int32_t> start(range.order.size() + 1, 0);  // first old wall contact of each old grain of the range
  std::vector<const WallContact*> contacts;
  for (int s = range.from; s < range.to; ++s) {
    const Strip& strip = old[s - old_from];
    std::size_t at = 0;
    for (int g = 0; g < strip.grains(); ++g) {
      start[strip.first + g - range.first] = static_cast<std::int32_t>(contacts.size());
      for (; at < strip.walls.size() && strip.walls[at].grain == g; ++at) contacts.push_back(&strip.walls[at]);
    }
  }
  start.back() = static_cast<std::int32_t>(contacts.size());
  for (int s = range.from; s < range.to; ++s)
    for (WallContact& contact : strips_[s].walls) {
      const int old_grain = range.order[strips_[s].first + contact.grain - range.first] - range.first;
      for (int k = start[old_grain]; k < start[old_grain + 1]; ++k)
        if (contacts[k]->wall == contact.wall) {
          contact.tangential = contacts[k]->tangential;
          contact.rolling = contacts[k]->rolling;
        }
    }
}

/// The sums of a sleeping parcel are those of its last evaluation. If a grain that drifted before it fell asleep is
/// sorted into another parcel, the sums no longer fit their parcels and must be computed again.
void Strips::mark_stale(std::span<const Strip> old, int old_from, const Resorted& range) {
  FURROW_ASSERT(static_cast<int>(old.size()) == range.to - old_from, old.size(), old_from, range.to);
  if (across_ == 1) return;  // every sleeping strip that is sorted has an awake neighbour
  const auto changed = [&](int s, int p) {
    const Strip &now = strips_[s], &then = old[s - old_from];
    const StripPart &part = now.parcels[p].part, &was = then.parcels[p].part;
    const auto order = range.order.begin() + (now.first - range.first);
    return part.grains() != was.grains() || std::any_of(order + part.first, order + part.last, [&](std::int32_t g) {
             return g < then.first + was.first || g >= then.first + was.last;
           });
  };
  for (int s = range.from; s < range.to; ++s)
    for (int p = 0; p < across_; ++p) {
      if (!strips_[s].parcels[p].asleep || !changed(s, p)) continue;
      for (int ds = -1; ds <= 1; ++ds)
        for (int dp = -1; dp <= 1; ++dp) {
          const int strip = beside(s, ds), parcel = parcel_beside(p, dp);
          if (strip < 0 || parcel < 0 || !strips_[strip].parcels[parcel].asleep) continue;
          strips_[strip].stale = strips_[strip].parcels[parcel].stale = true;
          ++changes_;
        }
    }
}

template void Strips::carry_history<float>(std::span<const Strip>, int, const Resorted&, int);
template void Strips::carry_history<double>(std::span<const Strip>, int, const Resorted&, int);

}  // namespace furrow::terrain::dem
