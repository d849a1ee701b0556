#include "terrain/liggghts/wall_contacts.hpp"

namespace furrow::terrain::liggghts {

void WallContacts::Listed::clear() {
  count = 0;
  grain.clear();
  place.clear();
  root.clear();
  for (int axis = 0; axis < 3; ++axis) tangential[axis].clear(), rolling[axis].clear();
}

void WallContacts::Listed::add(int g, int at) {
  FURROW_ASSERT(place.empty() || at > place.back(), at);
  grain.push_back(g);
  place.push_back(at);
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
  for (int axis = 0; axis < 3; ++axis) tangential[axis][n] = c.tangential[axis], rolling[axis][n] = c.rolling[axis];
}

std::optional<int> WallContacts::list(const OwnGrains& grains, std::span<const std::int32_t> order, double room) {
  FURROW_ASSERT(room >= 0.0, room);
  FURROW_ASSERT(order.size() == static_cast<std::size_t>(grains.count), order.size(), grains.count);
  std::swap(walls_, before_);
  for (Listed& listed : walls_) listed.clear();
  std::optional<int> lost;
  for (int place = 0; place < grains.count; ++place) {
    const int g = order[place];
    const dem::Quad x = at(grains, g);
    if (bin_.holds_apart(x, x.w + room)) continue;
    if (!lost && !bin_.holds(x)) lost = g;
    for (int wall = 0; wall < dem::kWalls; ++wall)
      if (bin_.has_wall(wall) && !(bin_.distance(wall, x) > x.w + room)) walls_[wall].add(g, place);
  }
  for (Listed& listed : walls_) listed.make_room();
  if (numbered_)
    remember();
  else
    take_carried(grains);
  numbered_ = true;
  return lost;
}

/// Indexes the previous lists by grain.
void WallContacts::remember() {
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    Listed& now = walls_[wall];
    const Listed& before = before_[wall];
    int most = -1;
    for (std::size_t n = 0; n < now.count; ++n) most = std::max(most, now.grain[n]);
    before_at_.assign(most + 1, -1);
    for (std::size_t n = 0; n < before.count; ++n)
      if (before.grain[n] <= most) before_at_[before.grain[n]] = static_cast<int>(n);
    for (std::size_t n = 0; n < now.count; ++n)
      if (const int old = before_at_[now.grain[n]]; old >= 0) now.copy(n, before, old);
  }
}

void WallContacts::take_carried(const OwnGrains& grains) {
  for (int wall = 0; wall < dem::kWalls; ++wall)
    for (std::size_t n = 0; n < walls_[wall].count; ++n)
      for (const Carried& c : grains.carried[walls_[wall].grain[n]])
        if (static_cast<int>(c.partner) == wall) walls_[wall].take(n, c);
  for (int g = 0; g < grains.count; ++g)
    if (!grains.carried[g].empty())
      std::erase_if(grains.carried[g], [](const Carried& c) { return c.partner < dem::kWalls; });
}

void WallContacts::hand_back(const OwnGrains& grains) {
  for_touching([&](int g, const Carried& c) { grains.carried[g].push_back(c); });
  forget();
}

void WallContacts::forget() {
  for (Listed& listed : walls_) listed.clear();
  numbered_ = false;
}

}  // namespace furrow::terrain::liggghts
