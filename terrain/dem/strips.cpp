#include "terrain/dem/strips.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr int padded(int n) { return (n + kFloatLanes - 1) / kFloatLanes * kFloatLanes; }

/// Cells of at least `size` along a side; three where the side is periodic, so that no two neighbours are the same.
int cells_along(double length, double size, bool periodic, const char* side) {
  const int n = std::max(1, static_cast<int>(length / size));
  if (periodic && n < 3)
    throw Error(ExitCode::bad_input, std::string("a bin periodic along ") + side + " must be " +
                                         std::to_string(3.0 * size) + " m or longer for these grains");
  return n;
}

/// The cell that a point stands in, the first or last if it stands beyond or is not a number.
int cell_at(double at, int count) { return at > 0.0 ? static_cast<int>(std::min(at, count - 0.5)) : 0; }

/// values[first + k] = values[order[k]].
template <class T>
void permute(std::vector<T>& values, const Resorted& range, std::vector<T>& spare, int threads) {
  FURROW_ASSERT(values.size() >= range.order.size() + range.first, values.size(), range.first,
                range.order.size());
  FURROW_ASSERT(threads > 0, threads);
  const int n = static_cast<int>(range.order.size());
  spare.resize(std::max<std::size_t>(spare.size(), n));
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int k = 0; k < n; ++k) spare[k] = values[range.order[k]];
  std::copy_n(spare.begin(), n, values.begin() + range.first);
}

}  // namespace

Strips::Strips(const Options& options) : options_(options) {
  FURROW_ASSERT(options.reach > 0.0 && options.skin >= 0.0, options.reach, options.skin);
  FURROW_ASSERT(options.bin.length > 0.0 && options.bin.width > 0.0, options.bin.length, options.bin.width);
  const Bin& bin = options_.bin;
  const double size = options_.reach + options_.skin;
  const int nx = cells_along(bin.length, size, bin.periodic_x, "x");
  ny_ = cells_along(bin.width, size, bin.periodic_y, "y");
  inverse_x_ = nx / bin.length;
  inverse_y_ = ny_ / bin.width;
  inverse_z_ = 1.0 / size;
  across_ = options.cut ? parcels_across(ny_) : 1;
  strips_.resize(nx);
  for (Strip& strip : strips_) strip.parcels.resize(across_);
}

bool Strips::parcel_between(int p, double y_min, double y_max) const {
  FURROW_ASSERT(in_range(p, across_), p, across_);
  const double side = -0.5 * options_.bin.width;
  return (p == 0 || side + column_of(p) / inverse_y_ < y_max) &&
         (p + 1 == across_ || side + column_of(p + 1) / inverse_y_ > y_min);
}

void Strips::sum_parcels(int k) {
  FURROW_ASSERT(in_range(k, count()), k, count());
  Strip& strip = strips_[k];
  strip.motion = strip.parcels.front().motion;
  strip.asleep = strip.parcels.front().asleep;
  for (int p = 1; p < across_; ++p) {
    add(strip.motion, strip.parcels[p].motion);
    strip.asleep &= strip.parcels[p].asleep;
  }
}

void Strips::find_parts(Strip& strip) const {
  FURROW_ASSERT(static_cast<int>(strip.parcels.size()) == across_, strip.parcels.size(), across_);
  FURROW_ASSERT(strip.cell_start.size() == static_cast<std::size_t>(ny_ * nz_ + 1), strip.cell_start.size(),
                ny_, nz_);
  StripPart at;
  for (int p = 0; p < across_; ++p) {
    at.last = strip.cell_start[column_of(p + 1) * nz_];
    if (p + 1 == across_) {
      at.pair_last = strip.pairs;
      at.wall_last = static_cast<std::int32_t>(strip.walls.size());
    } else {
      const auto pairs_end = strip.i.begin() + strip.pairs;
      at.pair_last = static_cast<std::int32_t>(std::lower_bound(strip.i.begin() + at.pair_first, pairs_end,
                                                                static_cast<std::uint32_t>(kQuad * at.last)) -
                                               strip.i.begin());
      at.wall_last = static_cast<std::int32_t>(
          std::lower_bound(strip.walls.begin() + at.wall_first, strip.walls.end(), at.last,
                           [](const WallContact& contact, int grain) { return contact.grain < grain; }) -
          strip.walls.begin());
    }
    strip.parcels[p].part = at;
    at.first = at.last, at.pair_first = at.pair_last, at.wall_first = at.wall_last;
  }
}

void Strips::restore_shape(int cells_z, std::int64_t resorted) {
  FURROW_ASSERT(cells_z >= 1 && resorted >= 0, cells_z, resorted);
  nz_ = cells_z;
  resorted_ = resorted;
  ++changes_;
}

std::size_t Strips::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof v[0]; };
  std::size_t sum = of(scratch_.cell) + of(scratch_.start) + of(scratch_.ids) + of(scratch_.quads);
  for (const auto* strips : {&strips_, &old_})
    for (const Strip& s : *strips)
      sum += sizeof s + of(s.cell_start) + of(s.i) + of(s.j) + of(s.touching) + of(s.walls) +
             of(s.single.tangential) + of(s.single.rolling) + of(s.full.tangential) + of(s.full.rolling) +
             of(s.parcels);
  return sum;
}

int Strips::strip_at(double x) const { return cell_at(x * inverse_x_, count()); }

void Strips::sort(Grains& grains, Resorted& range, int threads) {
  FURROW_ASSERT(range.from < range.to && range.from >= 0 && range.to <= count(), range.from, range.to,
                count());
  const int first = strips_[range.from].first, last = strips_[range.to - 1].last, n = last - first;
  const int per_strip = ny_ * nz_, cells = (range.to - range.from) * per_strip;
  const double y0 = -0.5 * options_.bin.width;
  std::vector<std::int32_t>&cell = scratch_.cell, &start = scratch_.start;
  cell.resize(std::max<std::size_t>(cell.size(), n));
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int k = 0; k < n; ++k) {
    Quad& p = grains.position[first + k];
    options_.bin.wrap(p);
    const int strip = std::clamp(strip_at(p.x), range.from, range.to - 1);
    cell[k] = ((strip - range.from) * ny_ + cell_at((p.y - y0) * inverse_y_, ny_)) * nz_ +
              cell_at(p.z * inverse_z_, nz_);
  }
  start.assign(cells + 1, 0);
  for (int k = 0; k < n; ++k) ++start[cell[k] + 1];
  for (int c = 0; c < cells; ++c) start[c + 1] += start[c];
  for (int s = range.from; s < range.to; ++s) {
    Strip& strip = strips_[s];
    const auto begin = start.begin() + (s - range.from) * per_strip;
    strip.first = first + begin[0];
    strip.last = first + begin[per_strip];
    strip.cell_start.resize(per_strip + 1);
    for (int c = 0; c <= per_strip; ++c) strip.cell_start[c] = begin[c] - begin[0];
  }
  range.first = first;
  range.order.resize(n);
  for (int k = 0; k < n; ++k) range.order[start[cell[k]]++] = first + k;

  for (auto* array : {&grains.position, &grains.velocity, &grains.spin})
    permute(*array, range, scratch_.quads, threads);
  permute(grains.id, range, scratch_.ids, threads);
}

void Strips::size_lists(Strip& strip, int pairs) const {
  FURROW_ASSERT(pairs >= 0, pairs);
  strip.pairs = pairs;
  const int room = padded(pairs);
  strip.i.resize(room);
  strip.j.resize(room);
  std::fill(strip.i.begin() + pairs, strip.i.end(), 0);
  std::fill(strip.j.begin() + pairs, strip.j.end(), 0);
  strip.touching.assign(room / kFloatLanes, 0);
  const int histories = options_.history ? room : 0,
            rolling = options_.history && options_.rolling ? room : 0;
  if (options_.single) {
    strip.single.tangential.assign(histories, {});
    strip.single.rolling.assign(rolling, {});
  } else {
    strip.full.tangential.assign(histories, {});
    strip.full.rolling.assign(rolling, {});
  }
}

namespace {

/// Pairs as they are found; memory is kept from call to call.
struct FoundPairs {
  std::vector<std::uint32_t> i, j;
  std::size_t count = 0;

  void make_room(std::size_t more) {
    if (count + more <= i.size()) return;
    i.resize(2 * (count + more));
    j.resize(2 * (count + more));
  }
};

/// Bits of the four grains at x, x + 1, … (the first `valid` of them) whose surface is closer to that of the grain at
/// `at` than `skin`.
inline unsigned near_four(const Quad* x, int valid, Double4 at, double skin, double width) {
  const auto d = [&](int k) { return load(x[k]) - at; };
  Double4 r[4] = {d(0), d(1), d(2), d(3)};
  transpose(r);
  if (width > 0.0)
    for (int k = 0; k < 4; ++k) r[1][k] -= width * std::round(r[1][k] / width);
  const Double4 reach = r[3] + (2.0 * at[3] + skin);
  const Double4 room = reach * reach - (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  return positive(room) & ((1u << std::min(valid, 4)) - 1u);
}

}  // namespace

void Strips::list_pairs(const Grains& grains, int k) {
  FURROW_ASSERT(in_range(k, count()), k, count());
  FURROW_ASSERT(strips_[k].cell_start.size() == static_cast<std::size_t>(ny_ * nz_ + 1), k,
                strips_[k].cell_start.size(), ny_, nz_);
  Strip& strip = strips_[k];
  const int after = next(k);
  const Strip* const beside = after < 0 ? nullptr : &strips_[after];
  const double width = options_.bin.periodic_y ? options_.bin.width : 0.0;
  static thread_local FoundPairs found;
  found.count = 0;

  // Lists (i, j) for the grains j in [from, to) of `other`; `base` counts its grains in this strip's terms.
  const auto scan = [&](int i, Double4 at, const Strip& other, int base, int from, int to) {
    found.make_room(to - from + 4);
    const Quad* const x = grains.position.data() + other.first;
    for (int j = from; j < to; j += 4) {
      const unsigned hit = near_four(x + j, to - j, at, options_.skin, width);
      for (int m = 0; m < 4; ++m) {  // without a branch: who is near cannot be foreseen
        found.i[found.count] = kQuad * i;
        found.j[found.count] = kQuad * (base + j + m);
        found.count += hit >> m & 1;
      }
    }
  };
  for (int y = 0; y < ny_; ++y)
    for (int z = 0; z < nz_; ++z) {
      const int cell = y * nz_ + z;
      const int below = std::max(z - 1, 0), above = std::min(z + 1, nz_ - 1) + 1;
      for (int i = strip.cell_start[cell]; i < strip.cell_start[cell + 1]; ++i) {
        const Double4 at = load(grains.position[strip.first + i]);
        const auto row = [&](const Strip& other, int base, Double4 from, int wanted) {
          int other_y = wanted;
          if (width > 0.0) {
            other_y = (wanted + ny_) % ny_;
          } else if (wanted < 0 || wanted >= ny_) {
            return;
          }
          scan(i, from, other, base, other.cell_start[other_y * nz_ + below],
               other.cell_start[other_y * nz_ + above]);
        };
        scan(i, at, strip, 0, i + 1, strip.cell_start[y * nz_ + above]);
        row(strip, 0, at, y + 1);
        if (!beside) continue;
        // Seen from grains of the first strip, the last one stands a length before them.
        Double4 seen = at;
        if (after < k) seen[0] -= options_.bin.length;
        for (int dy = -1; dy <= 1; ++dy) row(*beside, strip.grains(), seen, y + dy);
      }
    }
  const auto n = static_cast<std::ptrdiff_t>(found.count);
  strip.i.assign(found.i.begin(), found.i.begin() + n);
  strip.j.assign(found.j.begin(), found.j.begin() + n);
  size_lists(strip, static_cast<int>(n));
}

void Strips::list_walls(const Grains& grains, Strip& strip) const {
  FURROW_ASSERT(strip.first >= 0 && strip.first <= strip.last && strip.last <= grains.count, strip.first,
                strip.last, grains.count);
  strip.walls.clear();
  strip.x_min = 1e300, strip.x_max = strip.z_max = -1e300;
  for (int g = strip.last - 1; g >= strip.first; --g)
    if (!options_.bin.holds(grains.position[g])) strip.lost = g - strip.first;
  for (int g = strip.first; g < strip.last; ++g) {
    strip.x_min = std::min(strip.x_min, grains.position[g].x);
    strip.x_max = std::max(strip.x_max, grains.position[g].x);
    strip.z_max = std::max(strip.z_max, grains.position[g].z);
    for (int wall = 0; wall < kWalls; ++wall)
      if (options_.bin.has_wall(wall) &&
          options_.bin.distance(wall, grains.position[g]) < grains.position[g].w + options_.skin)
        strip.walls.push_back({g - strip.first, wall, {}, {}});
  }
}

namespace {

/// Finds in the lists before sorting what a pair of grains had.
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
  /// Of the grains that had the old indices a and b.
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
    const int j =
        partner >= strip.first ? partner - strip.first : strip.grains() + partner - old_.front().first;
    for (int p = row_[owner - base_]; p < strip.pairs && strip.grain_i(p) == i; ++p)
      if (strip.grain_j(p) == j && (strip.touching[p / kFloatLanes] >> p % kFloatLanes & 1))
        return {&strip, p, false};
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
      if (options_.history) now.tangential[p] = turned(then.tangential[found.pair], found.reversed);
      if (!now.rolling.empty()) now.rolling[p] = turned(then.rolling[found.pair], found.reversed);
    }
  }
}

void Strips::carry_walls(std::span<const Strip> old, int old_from, const Resorted& range) {
  FURROW_ASSERT(old_from <= range.from && static_cast<int>(old.size()) == range.to - old_from, old.size(),
                old_from, range.from);
  std::vector<std::int32_t> start(range.order.size() + 1, 0);  // old wall contacts per old grain of the range
  std::vector<const WallContact*> contacts;
  for (int s = range.from; s < range.to; ++s) {
    const Strip& strip = old[s - old_from];
    std::size_t at = 0;
    for (int g = 0; g < strip.grains(); ++g) {
      start[strip.first + g - range.first] = static_cast<std::int32_t>(contacts.size());
      for (; at < strip.walls.size() && strip.walls[at].grain == g; ++at)
        contacts.push_back(&strip.walls[at]);
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

/// The sums of a sleeping parcel are those of its last evaluation. Where a grain that had drifted before it fell asleep
/// is sorted into another parcel, sums about it belong elsewhere and are taken again.
void Strips::mark_stale(std::span<const Strip> old, int old_from, const Resorted& range) {
  FURROW_ASSERT(static_cast<int>(old.size()) == range.to - old_from, old.size(), old_from, range.to);
  if (across_ == 1) return;  // every sleeping strip that is sorted lies beside one that is awake
  const auto changed = [&](int s, int p) {
    const Strip &now = strips_[s], &then = old[s - old_from];
    const StripPart &part = now.parcels[p].part, &was = then.parcels[p].part;
    const auto order = range.order.begin() + (now.first - range.first);
    return part.grains() != was.grains() ||
           std::any_of(order + part.first, order + part.last, [&](std::int32_t g) {
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

Resorted Strips::rebuild(Grains& grains, int from, int to, int threads) {
  FURROW_ASSERT(from >= 0 && from < to && to <= count(), from, to, count());
  FURROW_ASSERT(threads > 0, threads);
  const int lists_from = std::max(from - 1, 0), lists = to - lists_from;
  old_.resize(std::max<std::size_t>(old_.size(), lists));
  for (int k = 0; k < lists; ++k) {
    Strip &old = old_[k], &strip = strips_[lists_from + k];
    std::swap(old, strip);
    strip.first = old.first, strip.last = old.last;
    strip.x_min = old.x_min, strip.x_max = old.x_max, strip.z_max = old.z_max;
    strip.travel = old.travel;
    strip.asleep = old.asleep, strip.stale = old.stale;
    strip.parcels = old.parcels;  // who sleeps is as before
    strip.lost = old.lost;
    strip.contact = old.contact, strip.motion = old.motion;
    if (lists_from + k < from) strip.cell_start = old.cell_start, strip.walls = old.walls;
  }
  Resorted range;
  range.from = from, range.to = to;
  sort(grains, range, threads);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (int s = lists_from; s < to; ++s) {
    list_pairs(grains, s);
    if (s >= from) list_walls(grains, strips_[s]);
    find_parts(strips_[s]);
  }
  const std::span<const Strip> old(old_.data(), lists);
  if (options_.single) {
    carry_history<float>(old, lists_from, range, threads);
  } else {
    carry_history<double>(old, lists_from, range, threads);
  }
  carry_walls(old, lists_from, range);
  mark_stale(old, lists_from, range);
  resorted_ += static_cast<std::int64_t>(range.order.size());
  return range;
}

Resorted Strips::rebuild_all(Grains& grains, int threads) {
  FURROW_ASSERT(grains.position.size() >= static_cast<std::size_t>(grains.count + Grains::kBeyond),
                grains.position.size(), grains.count);
  double top = 0.0;
  for (int g = 0; g < grains.count; ++g) top = std::max(top, grains.position[g].z);
  nz_ = static_cast<int>(std::clamp(top * inverse_z_, 0.0, kMaxCellsZ - 1.0)) + 1;
  if (strips_.back().last != grains.count) {  // grains were placed anew: all in the first strip
    ++changes_;
    for (Strip& strip : strips_) {
      strip = {};
      strip.parcels.resize(across_);
      strip.first = strip.last = grains.count;
    }
    strips_.front().first = 0;
  }
  Resorted range = rebuild(grains, 0, count(), threads);
  for (Strip& strip : strips_) strip.travel = 0.0;
  return range;
}

std::vector<Resorted> Strips::rebuild_moved(Grains& grains, double dt, int threads) {
  FURROW_ASSERT(dt >= 0.0, dt);
  FURROW_ASSERT(strips_.back().last == grains.count, strips_.back().last, grains.count);
  const int n = count();
  const auto moved = [&](int s) {
    return s >= 0 && s < n && !(strips_[s].travel + dt * strips_[s].motion.max_speed <= 0.5 * options_.skin);
  };
  const auto near_moved = [&](int s) { return moved(s - 1) || moved(s) || moved(s + 1); };
  std::vector<Resorted> ranges;
  for (int s = 0; s < n; ++s) {
    if (!near_moved(s)) continue;
    Resorted range;
    range.from = s;
    while (s < n && near_moved(s)) ++s;
    range.to = s;
    ranges.push_back(std::move(range));
  }
  if (ranges.empty()) return ranges;
  const bool ends = ranges.front().from == 0 || ranges.back().to == n;
  if ((options_.bin.periodic_x && ends) || (ranges.front().from == 0 && ranges.front().to == n)) {
    ranges.clear();
    ranges.push_back(rebuild_all(grains, threads));
    return ranges;
  }
  for (Resorted& range : ranges) {
    range = rebuild(grains, range.from, range.to, threads);
    // The strips at both edges of a range may hold grains that belong beyond it: they keep their travel.
    const int from = range.from == 0 ? 0 : range.from + 1, to = range.to == n ? n : range.to - 1;
    for (int k = from; k < to; ++k) strips_[k].travel = 0.0;
  }
  return ranges;
}

}  // namespace furrow::terrain::dem
