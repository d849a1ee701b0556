// The state of the grains between device and host: motion, and histories of contacts.
#include <algorithm>

#include "terrain/gpu/plugin/grain_engine.hpp"

namespace furrow::terrain::gpu {
namespace {

/// The places of the grains, by their numbers.
std::vector<u32> places_of(const std::vector<Low>& low) {
  std::vector<u32> place(low.size());
  for (std::size_t g = 0; g < low.size(); ++g) place[low[g].id] = static_cast<u32>(g);
  return place;
}

}  // namespace

void GrainEngine::place(i32 count, const double (*position)[3], const double (*velocity)[3], const double (*spin)[3]) {
  count_ = count;
  listed_ = false;
  near_walls_.count = 0;
  for (const auto& s : surfaces_) s->near.count = 0;
  const auto n = static_cast<std::size_t>(count);
  std::vector<Low> low(n);
  std::vector<High> high(n);
  std::vector<Motion> motion(n);
  std::vector<MotionRow> row(n);
  for (std::size_t g = 0; g < n; ++g) {
    i64 p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = nearest(position[g][k] * per_unit_);
      motion[g].v[k] = velocity ? velocity[g][k] : 0.0;
      motion[g].w[k] = spin ? spin[g][k] : 0.0;
      row[g].v[k] = static_cast<float>(motion[g].v[k]), row[g].w[k] = static_cast<float>(motion[g].w[k]);
    }
    low[g] = {static_cast<u32>(p[0]), static_cast<u32>(p[1]), static_cast<u32>(p[2]), static_cast<u32>(g)};
    high[g] = {static_cast<i32>(p[0] >> 32), static_cast<i32>(p[1] >> 32), static_cast<i32>(p[2] >> 32), 0};
  }
  reserve(state_, count), reserve(spare_, count);
  device_.upload(state_.low.data(), low.data(), n * sizeof low[0]);
  device_.upload(state_.high.data(), high.data(), n * sizeof high[0]);
  device_.upload(state_.motion.data(), motion.data(), n * sizeof motion[0]);
  device_.upload(state_.row.data(), row.data(), n * sizeof row[0]);
  device_.clear(state_.load.data(), n * sizeof(Load));
  device_.clear(state_.listed.data(), n * sizeof(u32));
  device_.clear(state_.touching.data(), n * sizeof(u32));
  control_ = {};
  control_.lost = ~0U;
  write_control();
  build();
}

void GrainEngine::motion(double (*position)[3], double (*velocity)[3], double (*spin)[3]) {
  const auto n = static_cast<std::size_t>(count_);
  const std::vector<Low> low = state_.low.get(device_, n);
  const std::vector<High> high = state_.high.get(device_, n);
  std::vector<Motion> motion;
  if (velocity || spin) motion = state_.motion.get(device_, n);
  for (std::size_t g = 0; g < n; ++g) {
    const u32 id = low[g].id;
    const i64 p[3] = {Pointers::join(low[g].x, high[g].x), Pointers::join(low[g].y, high[g].y),
                      Pointers::join(low[g].z, high[g].z)};
    for (int k = 0; k < 3; ++k) {
      position[id][k] = unit_ * static_cast<double>(p[k]);
      if (velocity) velocity[id][k] = motion[g].v[k] + 0.0;
      if (spin) spin[id][k] = motion[g].w[k] + 0.0;
    }
  }
}

void GrainEngine::read_histories() {
  pairs.clear(), walls.clear(), facets.clear();
  const auto n = static_cast<std::size_t>(count_), places = n * static_cast<std::size_t>(slots_);
  const std::vector<Low> low = state_.low.get(device_, n);
  const std::vector<u32> listed = state_.listed.get(device_, n), touching = state_.touching.get(device_, n),
                         list = state_.list.get(device_, places);
  const bool history = has_springs(), rolling = has_rolls();
  const std::vector<SpringRow> spring = state_.spring.get(device_, history ? places : 0);
  const std::vector<SpringRow> roll = state_.roll.get(device_, rolling ? places : 0);
  const std::vector<u32> place_of = places_of(low);
  for (const u32 g : place_of)
    for (u32 k = 0; k < listed[g]; ++k) {
      if (!(touching[g] >> k & 1U)) continue;
      const std::size_t at = k * n + g;
      const u32 other = low[list[at] & kPlaceMask].id;
      if (other < low[g].id) continue;
      Pair p{};
      p.i = static_cast<i32>(low[g].id), p.j = static_cast<i32>(other);
      if (history) {
        const float t[3] = {spring[at].x, spring[at].y, spring[at].z};
        for (int a = 0; a < 3; ++a) p.tangential[a] = t[a] + 0.0F;
        p.root_overlap = spring[at].w;
      }
      if (rolling) {
        const float r[3] = {roll[at].x, roll[at].y, roll[at].z};
        for (int a = 0; a < 3; ++a) p.rolling[a] = r[a] + 0.0F;
      }
      pairs.push_back(p);
    }
  const auto near = static_cast<std::size_t>(near_walls_.count);
  const std::vector<u32> entries = near_walls_.entry_of.get(device_, near > 0 ? n : 0);
  const std::vector<WallSpring> wall_spring = near_walls_.spring.get(device_, near * dem::kWalls);
  if (near > 0)
    for (const u32 g : place_of) {
      if (entries[g] == ~0U) continue;
      for (int wall = 0; wall < dem::kWalls; ++wall) {
        const WallSpring& s = wall_spring[entries[g] * dem::kWalls + wall];
        if (!(s.root > 0.0)) continue;
        WallTouch w{};
        w.grain = static_cast<i32>(low[g].id), w.wall = wall;
        for (int a = 0; a < 3; ++a) w.tangential[a] = s.t[a] + 0.0, w.rolling[a] = s.r[a] + 0.0;
        w.root_overlap = s.root;
        walls.push_back(w);
      }
    }
  if (!history) return;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const NearSurface& s = surfaces_[k]->near;
    if (s.count == 0) continue;
    const auto m = static_cast<std::size_t>(s.count);
    const std::vector<u32> entry_of = s.entry_of.get(device_, n), touched = s.touched.get(device_, m);
    const std::vector<FacetSpring> springs = s.spring.get(device_, m * kMaxSurfaceHits);
    for (const u32 g : place_of) {
      const u32 e = entry_of[g];
      if (e == ~0U) continue;
      for (u32 h = 0; h < (touched[e] & 0xffffU); ++h) {
        const FacetSpring& from = springs[static_cast<std::size_t>(e) * kMaxSurfaceHits + h];
        FacetTouch f{};
        f.grain = static_cast<i32>(low[g].id), f.surface = static_cast<i32>(k);
        for (int a = 0; a < 3; ++a)
          f.normal[a] = from.normal[a] + 0.0, f.tangential[a] = from.t[a] + 0.0, f.rolling[a] = from.r[a] + 0.0;
        f.root_overlap = from.root;
        facets.push_back(f);
      }
    }
  }
}

void GrainEngine::remember(i64 pair_count, const Pair* pair, i64 wall_count, const WallTouch* wall, i64 facet_count,
                           const FacetTouch* facet) {
  const auto n = static_cast<std::size_t>(count_), places = n * static_cast<std::size_t>(slots_);
  const std::vector<Low> low = state_.low.get(device_, n);
  const std::vector<u32> place_of = places_of(low);
  const std::vector<u32> listed = state_.listed.get(device_, n), list = state_.list.get(device_, places);
  std::vector<u32> touching(n, 0);
  const bool history = has_springs(), rolling = has_rolls();
  std::vector<SpringRow> spring(history ? places : 0), roll(rolling ? places : 0);
  const auto set = [&](i32 own, i32 other, const Pair& p, float sign) {
    const u32 g = place_of.at(own);
    for (u32 k = 0; k < listed[g]; ++k) {
      const std::size_t at = k * n + g;
      if (low[list[at] & kPlaceMask].id != static_cast<u32>(other)) continue;
      touching[g] |= 1U << k;
      if (history)
        spring[at] = {sign * p.tangential[0], sign * p.tangential[1], sign * p.tangential[2], p.root_overlap};
      if (rolling) roll[at] = {sign * p.rolling[0], sign * p.rolling[1], sign * p.rolling[2], 0.0F};
    }
  };
  for (i64 k = 0; k < pair_count; ++k) {
    set(pair[k].i, pair[k].j, pair[k], 1.0F);
    set(pair[k].j, pair[k].i, pair[k], -1.0F);
  }
  device_.upload(state_.touching.data(), touching.data(), n * sizeof(u32));
  if (history) device_.upload(state_.spring.data(), spring.data(), places * sizeof(SpringRow));
  if (rolling) device_.upload(state_.roll.data(), roll.data(), places * sizeof(SpringRow));

  if (near_walls_.count > 0) {
    const auto near = static_cast<std::size_t>(near_walls_.count);
    std::vector<WallSpring> springs(near * dem::kWalls);
    const std::vector<u32> entry_of = near_walls_.entry_of.get(device_, n);
    for (i64 k = 0; k < wall_count; ++k) {
      const u32 e = entry_of[place_of.at(wall[k].grain)];
      if (e == ~0U) continue;
      WallSpring& s = springs[e * dem::kWalls + static_cast<u32>(wall[k].wall)];
      std::copy_n(wall[k].tangential, 3, s.t), std::copy_n(wall[k].rolling, 3, s.r);
      s.root = wall[k].root_overlap;
    }
    device_.upload(near_walls_.spring.data(), springs.data(), springs.size() * sizeof(WallSpring));
  }
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    // All grains that touched, in a list that the next interval replaces.
    TireSurface& s = *surfaces_[k];
    std::vector<u32> flags(n, 0);
    for (i64 f = 0; f < facet_count; ++f)
      if (facet[f].surface == static_cast<i32>(k)) flags[place_of.at(facet[f].grain)] = 1;
    flag_.put(device_, flags.data(), n);
    NearSurface& near = s.near;
    near.count = list_marked(near.grain, near.entry_of);
    const auto m = static_cast<std::size_t>(near.count);
    near.spring.reserve(device_, m * kMaxSurfaceHits), near.touched.reserve(device_, m),
        near.sums.reserve(device_, m * kFacetSums);
    if (m == 0) continue;
    const std::vector<u32> entry_of = near.entry_of.get(device_, n);
    std::vector<FacetSpring> springs(m * kMaxSurfaceHits);
    std::vector<u32> touched(m, 0);
    for (i64 f = 0; f < facet_count; ++f) {
      if (facet[f].surface != static_cast<i32>(k)) continue;
      const u32 e = entry_of[place_of[facet[f].grain]];
      if (touched[e] == static_cast<u32>(kMaxSurfaceHits)) continue;
      FacetSpring& to = springs[static_cast<std::size_t>(e) * kMaxSurfaceHits + touched[e]++];
      std::copy_n(facet[f].normal, 3, to.normal), std::copy_n(facet[f].tangential, 3, to.t);
      std::copy_n(facet[f].rolling, 3, to.r);
      to.root = facet[f].root_overlap;
    }
    device_.upload(near.spring.data(), springs.data(), springs.size() * sizeof(FacetSpring));
    device_.upload(near.touched.data(), touched.data(), m * sizeof(u32));
    device_.clear(near.sums.data(), m * kFacetSums * sizeof(i64));
    s.listed_low[0] = 1.0, s.listed_high[0] = 0.0;
  }
}

}  // namespace furrow::terrain::gpu
