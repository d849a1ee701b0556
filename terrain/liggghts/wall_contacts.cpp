#include "terrain/liggghts/wall_contacts.hpp"

namespace furrow::terrain::liggghts {

void WallContacts::Listed::clear() {
  count = 0;
  grain.clear();
  root.clear();
  for (int axis = 0; axis < 3; ++axis) tangential[axis].clear(), rolling[axis].clear();
}

void WallContacts::Listed::add(int g) {
  FURROW_ASSERT(grain.empty() || g > grain.back(), g);
  grain.push_back(g);
  ++count;
}

void WallContacts::Listed::make_room() {
  if (count == 0) return;
  const std::size_t room = count + kLanes;
  grain.resize(room, grain.back());
  root.assign(room, 0.0);
  for (int axis = 0; axis < 3; ++axis) tangential[axis].assign(room, 0.0), rolling[axis].assign(room, 0.0);
}

void WallContacts::Listed::copy(std::size_t to, const Listed& from, std::size_t n) {
  root[to] = from.root[n];
  for (int axis = 0; axis < 3; ++axis)
    tangential[axis][to] = from.tangential[axis][n], rolling[axis][to] = from.rolling[axis][n];
}

Carried WallContacts::Listed::carried(int wall, std::size_t n) const {
  const dem::Triple<double> normal = dem::Bin::normal(wall);
  return {static_cast<double>(wall),
          {normal.x, normal.y, normal.z},
          {tangential[0][n], tangential[1][n], tangential[2][n]},
          root[n],
          {rolling[0][n], rolling[1][n], rolling[2][n]}};
}

void WallContacts::Listed::take(std::size_t n, const Carried& c) {
  root[n] = c.root_overlap;
  for (int axis = 0; axis < 3; ++axis)
    tangential[axis][n] = c.tangential[axis], rolling[axis][n] = c.rolling[axis];
}

std::optional<int> WallContacts::list(const OwnGrains& grains, double largest_radius, double room) {
  FURROW_ASSERT(largest_radius > 0.0 && room >= 0.0, largest_radius, room);
  std::swap(walls_, before_);
  for (Listed& listed : walls_) listed.clear();
  std::optional<int> lost;
  for (int g = 0; g < grains.count; ++g) {
    const dem::Quad x = at(grains, g);
    bool apart = x.w + room < x.z;
    for (int wall = 0; wall < dem::kFloor && apart; ++wall)
      apart = !bin_.has_wall(wall) || bin_.distance(wall, x) > largest_radius + room;
    if (apart && bin_.holds(x)) continue;
    if (!lost && !bin_.holds(x)) lost = g;
    for (int wall = 0; wall < dem::kWalls; ++wall)
      if (bin_.has_wall(wall) && !(bin_.distance(wall, x) > x.w + room)) walls_[wall].add(g);
  }
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    Listed& now = walls_[wall];
    const Listed& before = before_[wall];
    now.make_room();
    for (std::size_t n = 0, old = 0; n < now.count; ++n) {
      const int g = now.grain[n];
      if (numbered_) {
        while (old < before.count && before.grain[old] < g) ++old;
        if (old < before.count && before.grain[old] == g) now.copy(n, before, old);
        continue;
      }
      for (const Carried& c : grains.carried[g])
        if (static_cast<int>(c.partner) == wall) now.take(n, c);
    }
  }
  if (!numbered_)
    for (int g = 0; g < grains.count; ++g)
      if (!grains.carried[g].empty())
        std::erase_if(grains.carried[g], [](const Carried& c) { return c.partner < dem::kWalls; });
  numbered_ = true;
  return lost;
}

void WallContacts::hand_back(const OwnGrains& grains) {
  for_touching([&](int g, const Carried& c) { grains.carried[g].push_back(c); });
  for (Listed& listed : walls_) listed.clear();
  numbered_ = false;
}

}  // namespace furrow::terrain::liggghts
