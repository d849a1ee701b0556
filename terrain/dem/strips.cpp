#include "terrain/dem/strips.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr int padded(int n) { return (n + kFloatLanes - 1) / kFloatLanes * kFloatLanes; }

/// Number of cells of at least `size` along a side; at least three if it is periodic, so that neighbours differ.
int cells_along(double length, double size, bool periodic, const char* side) {
  const int n = std::max(1, static_cast<int>(length / size));
  if (periodic && n < 3)
    throw Error(ExitCode::bad_input, std::string("a bin periodic along ") + side + " must be " +
                                         std::to_string(3.0 * size) + " m or longer for these grains");
  return n;
}

/// The cell that contains a point; the first or last if the point is outside or not a number.
int cell_at(double at, int count) { return at > 0.0 ? static_cast<int>(std::min(at, count - 0.5)) : 0; }

/// values[first + k] = values[order[k]].
template <class T>
void permute(std::vector<T>& values, const Resorted& range, std::vector<T>& spare, int threads) {
  FURROW_ASSERT(values.size() >= range.order.size() + range.first, values.size(), range.first, range.order.size());
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
  FURROW_ASSERT(strip.cell_start.size() == static_cast<std::size_t>(ny_ * nz_ + 1), strip.cell_start.size(), ny_, nz_);
  StripPart at;
  for (int p = 0; p < across_; ++p) {
    at.last = strip.cell_start[column_of(p + 1) * nz_];
    if (p + 1 == across_) {
      at.pair_last = strip.pairs;
      at.wall_last = static_cast<std::int32_t>(strip.walls.size());
    } else {
      const auto pairs_end = strip.i.begin() + strip.pairs;
      at.pair_last = static_cast<std::int32_t>(
          std::lower_bound(strip.i.begin() + at.pair_first, pairs_end, static_cast<std::uint32_t>(kQuad * at.last)) -
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
  std::size_t sum =
      of(scratch_.cell) + of(scratch_.start) + of(scratch_.ids) + of(scratch_.quads) + of(scratch_.drifts);
  for (const auto* strips : {&strips_, &old_})
    for (const Strip& s : *strips)
      sum += sizeof s + of(s.cell_start) + of(s.i) + of(s.j) + of(s.touching) + of(s.walls) + of(s.single.tangential) +
             of(s.single.rolling) + of(s.full.tangential) + of(s.full.rolling) + of(s.parcels);
  return sum;
}

int Strips::strip_at(double x) const { return cell_at(x * inverse_x_, count()); }

void Strips::sort(Grains& grains, Resorted& range, int threads) {
  FURROW_ASSERT(range.from < range.to && range.from >= 0 && range.to <= count(), range.from, range.to, count());
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
    cell[k] =
        ((strip - range.from) * ny_ + cell_at((p.y - y0) * inverse_y_, ny_)) * nz_ + cell_at(p.z * inverse_z_, nz_);
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
  if (!grains.drift.empty()) permute(grains.drift, range, scratch_.drifts, threads);
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
  const int histories = options_.history ? room : 0, rolling = options_.history && options_.rolling ? room : 0;
  if (options_.single) {
    strip.single.tangential.assign(histories, {});
    strip.single.rolling.assign(rolling, {});
  } else {
    strip.full.tangential.assign(histories, {});
    strip.full.rolling.assign(rolling, {});
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
    strip.parcels = old.parcels;  // the same parcels sleep as before
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
  if (options_.history) {
    if (options_.single) {
      carry_history<float>(old, lists_from, range, threads);
    } else {
      carry_history<double>(old, lists_from, range, threads);
    }
    carry_walls(old, lists_from, range);
  }
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
  if (strips_.back().last != grains.count) {  // grains were placed again: all go into the first strip
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
  old_ = {}, scratch_ = {};  // as large as all lists; what later rebuilds need is less
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
    // The strips at both edges of a range may contain grains that belong outside it, so they keep their travel.
    const int from = range.from == 0 ? 0 : range.from + 1, to = range.to == n ? n : range.to - 1;
    for (int k = from; k < to; ++k) strips_[k].travel = 0.0;
  }
  return ranges;
}

}  // namespace furrow::terrain::dem
