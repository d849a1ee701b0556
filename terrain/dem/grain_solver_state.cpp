// Saved state of the solver: everything that decides the next bits — grains in their order, the pair lists as they
// stand, histories of touching pairs, and the accounts. Slots of outer pairs are rewritten by every step before they
// are read, so they are not kept.
#include <algorithm>

#include "terrain/dem/grain_solver.hpp"

namespace furrow::dem {
namespace {

void put_quads(Archive& archive, const std::string& name, const Quad* quads, std::size_t count) {
  archive.put(name, std::span<const double>(reinterpret_cast<const double*>(quads), 4 * count));
}

void get_quads(const Archive& archive, const std::string& name, Quad* quads, std::size_t count) {
  const auto& values = archive.get<double>(name, 4 * count);
  std::copy(values.begin(), values.end(), reinterpret_cast<double*>(quads));
}

std::vector<double> flat(const Accounts& a) {
  return {a.contact_work,
          a.elastic,
          a.elastic_start,
          a.wall_impulse.x(),
          a.wall_impulse.y(),
          a.wall_impulse.z(),
          a.surface_impulse.x(),
          a.surface_impulse.y(),
          a.surface_impulse.z(),
          a.floor_force,
          a.kinetic,
          a.height,
          a.velocity.x(),
          a.velocity.y(),
          a.velocity.z(),
          static_cast<double>(a.contacts),
          a.max_overlap,
          a.contact_force,
          a.net_force};
}

Accounts accounts_from(const std::vector<double>& v) {
  Accounts a;
  a.contact_work = v[0], a.elastic = v[1], a.elastic_start = v[2];
  a.wall_impulse = {v[3], v[4], v[5]};
  a.surface_impulse = {v[6], v[7], v[8]};
  a.floor_force = v[9], a.kinetic = v[10], a.height = v[11];
  a.velocity = {v[12], v[13], v[14]};
  a.contacts = static_cast<std::int64_t>(v[15]);
  a.max_overlap = v[16], a.contact_force = v[17], a.net_force = v[18];
  return a;
}

}  // namespace

void GrainSolver::save(Archive& archive) const {
  const std::size_t n = grains_.count;
  archive.put("count", static_cast<std::int64_t>(n));
  put_quads(archive, "position", grains_.position.data(), n);
  put_quads(archive, "velocity", grains_.velocity.data(), n);
  put_quads(archive, "spin", grains_.spin.data(), n);
  put_quads(archive, "listed_at", grains_.listed_at.data(), n);
  archive.put("id", grains_.id);
  archive.put("accounts", flat(accounts_));
  archive.put("rebuilds", pairs_.rebuilds());

  std::vector<std::int32_t> sizes, i, j, wall_grain, wall;
  std::vector<std::uint8_t> touching;
  std::vector<Quad> tangential, rolling, wall_history;
  for (const PairBlock& block : pairs_.blocks()) {
    sizes.insert(sizes.end(),
                 {block.first, block.last, block.inner, block.pairs, std::int32_t(block.walls.size())});
    i.insert(i.end(), block.i.begin(), block.i.end());
    j.insert(j.end(), block.j.begin(), block.j.end());
    touching.insert(touching.end(), block.touching.begin(), block.touching.end());
    for (int p = 0; p < block.pairs; ++p) {
      if (!(block.touching[p / kLanes] >> p % kLanes & 1)) continue;
      if (!block.tangential.empty()) tangential.push_back(block.tangential[p]);
      if (!block.rolling.empty()) rolling.push_back(block.rolling[p]);
    }
    for (const WallContact& contact : block.walls) {
      wall_grain.push_back(contact.grain);
      wall.push_back(contact.wall);
      wall_history.push_back(contact.tangential);
      wall_history.push_back(contact.rolling);
    }
  }
  archive.put("pairs/sizes", sizes);
  archive.put("pairs/i", i);
  archive.put("pairs/j", j);
  archive.put("pairs/touching", touching);
  put_quads(archive, "pairs/tangential", tangential.data(), tangential.size());
  put_quads(archive, "pairs/rolling", rolling.data(), rolling.size());
  archive.put("walls/grain", wall_grain);
  archive.put("walls/wall", wall);
  put_quads(archive, "walls/history", wall_history.data(), wall_history.size());
  surfaces_.save(archive);
}

void GrainSolver::restore(const Archive& archive) {
  const auto n = static_cast<std::size_t>(archive.get_int("count"));
  grains_.resize(static_cast<int>(n));
  get_quads(archive, "position", grains_.position.data(), n);
  get_quads(archive, "velocity", grains_.velocity.data(), n);
  get_quads(archive, "spin", grains_.spin.data(), n);
  get_quads(archive, "listed_at", grains_.listed_at.data(), n);
  grains_.id = archive.get<std::int32_t>("id", n);
  accounts_ = accounts_from(archive.get<double>("accounts", 19));
  pairs_.set_rebuilds(archive.get_int("rebuilds"));

  const auto& sizes = archive.get<std::int32_t>("pairs/sizes");
  const auto& i = archive.get<std::int32_t>("pairs/i");
  const auto& j = archive.get<std::int32_t>("pairs/j", i.size());
  const auto& touching = archive.get<std::uint8_t>("pairs/touching", i.size() / kLanes);
  const auto& tangential = archive.get<double>("pairs/tangential");
  const auto& rolling = archive.get<double>("pairs/rolling");
  const auto& wall_grain = archive.get<std::int32_t>("walls/grain");
  const auto& wall = archive.get<std::int32_t>("walls/wall", wall_grain.size());
  const auto& wall_history = archive.get<double>("walls/history", 8 * wall_grain.size());
  const auto quad = [](const std::vector<double>& v, std::size_t k) {
    return Quad{v[4 * k], v[4 * k + 1], v[4 * k + 2], v[4 * k + 3]};
  };

  std::vector<PairBlock>& blocks = pairs_.blocks();
  blocks.assign(sizes.size() / 5, {});
  std::size_t pair = 0, t = 0, r = 0, w = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    PairBlock& block = blocks[b];
    const std::int32_t* s = &sizes[5 * b];
    block.first = s[0], block.last = s[1], block.inner = s[2], block.pairs = s[3];
    pairs_.size_block(block);
    std::copy_n(i.begin() + pair, block.pairs, block.i.begin());
    std::copy_n(j.begin() + pair, block.pairs, block.j.begin());
    std::copy_n(touching.begin() + pair / kLanes, block.pairs / kLanes, block.touching.begin());
    for (int p = 0; p < block.pairs; ++p) {
      if (!(block.touching[p / kLanes] >> p % kLanes & 1)) continue;
      if (!block.tangential.empty()) block.tangential[p] = quad(tangential, t++);
      if (!block.rolling.empty()) block.rolling[p] = quad(rolling, r++);
    }
    for (int k = 0; k < s[4]; ++k, ++w)
      block.walls.push_back(
          {wall_grain[w], wall[w], quad(wall_history, 2 * w), quad(wall_history, 2 * w + 1)});
    pair += block.pairs;
  }
  pairs_.finish(grains_);
  surfaces_.resize(static_cast<int>(blocks.size()));
  surfaces_.restore(archive);
}

}  // namespace furrow::dem
