#include "terrain/liggghts/starting_bed.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "protocol/core/assert.hpp"
#include "terrain/liggghts/cell_order.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr std::size_t kPiece = 1 << 18;  // entries of one message

template <class T>
void share_all(RankGroup& group, std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto send = [&](const void* from, std::size_t bytes) {
    const auto* const first = static_cast<const std::byte*>(from);
    return group.broadcast(group.rank() == 0 ? RankGroup::Bytes(first, first + bytes) : RankGroup::Bytes{});
  };
  std::uint64_t count = values.size();
  const RankGroup::Bytes announced = send(&count, sizeof count);
  std::memcpy(&count, announced.data(), sizeof count);
  values.resize(count);
  for (std::size_t at = 0; at < count; at += kPiece) {
    const std::size_t bytes = std::min(kPiece, count - at) * sizeof(T);
    const RankGroup::Bytes piece = send(values.data() + at, bytes);
    if (group.rank() != 0) std::memcpy(static_cast<void*>(values.data() + at), piece.data(), bytes);
  }
}

std::array<double, 3> array(const dem::Quad& q) { return {q.x, q.y, q.z}; }
template <class Row>
std::array<double, 3> array_of(const Row& row) {
  return {row.x, row.y, row.z};
}

/// The number of the grain at this index of the list of strip k.
int number_of(const dem::GrainSolver& solver, int k, int place) {
  const dem::Strips& strips = solver.strips();
  const dem::Strip& strip = strips[k];
  const int grain =
      place < strip.grains() ? strip.first + place : strips[strips.next(k)].first + place - strip.grains();
  return solver.grains().id[grain];
}

template <class Real>
void add_pairs(const dem::GrainSolver& solver, int k, StartingBed& bed) {
  const dem::Strip& strip = solver.strips()[k];
  const dem::PairHistory<Real>& history = strip.history<Real>();
  for (int p = 0; p < strip.pairs; ++p) {
    if (!(strip.touching[p / dem::kFloatLanes] >> p % dem::kFloatLanes & 1)) continue;
    PairRecord r;
    r.i = number_of(solver, k, strip.grain_i(p)), r.j = number_of(solver, k, strip.grain_j(p));
    if (!history.tangential.empty()) {
      r.tangential = array_of(history.tangential[p]);
      r.root_overlap = history.tangential[p].w;
    }
    if (!history.rolling.empty()) r.rolling = array_of(history.rolling[p]);
    if (r.i > r.j) {
      std::swap(r.i, r.j);
      for (double& v : r.tangential) v = -v;
      for (double& v : r.rolling) v = -v;
    }
    bed.pairs.push_back(r);
  }
}

template <class Real>
void recall(dem::Strip& strip, int p, const PairRecord& r, bool turned) {
  const double sign = turned ? -1.0 : 1.0;
  const auto row = [&](const std::array<double, 3>& v, double w) {
    return dem::HistoryRow<Real>{static_cast<Real>(sign * v[0]), static_cast<Real>(sign * v[1]),
                                 static_cast<Real>(sign * v[2]), static_cast<Real>(w)};
  };
  strip.touching[p / dem::kFloatLanes] |= static_cast<std::uint8_t>(1U << p % dem::kFloatLanes);
  dem::PairHistory<Real>& history = strip.history<Real>();
  if (!history.tangential.empty()) history.tangential[p] = row(r.tangential, r.root_overlap);
  if (!history.rolling.empty()) history.rolling[p] = row(r.rolling, 0.0);
}

}  // namespace

StartingBed starting_bed(const dem::GrainSolver& solver) {
  StartingBed bed;
  const dem::Grains& grains = solver.grains();
  bed.grains.resize(grains.count);
  for (int g = 0; g < grains.count; ++g) {
    NewGrain& to = bed.grains.at(grains.id[g]);
    to.id = grains.id[g];
    to.radius = grains.position[g].w;
    to.position = to.list_position = to.exchange_position = array(grains.position[g]);
    to.velocity = array(grains.velocity[g]);
    to.spin = array(grains.spin[g]);
  }
  for (int k = 0; k < solver.strips().count(); ++k) {
    solver.params().precision == dem::Precision::mixed ? add_pairs<float>(solver, k, bed)
                                                       : add_pairs<double>(solver, k, bed);
    const dem::Strip& strip = solver.strips()[k];
    for (const dem::WallContact& contact : strip.walls) {
      if (!(contact.tangential.w > 0.0)) continue;
      Carried c;
      c.partner = contact.wall;
      c.normal = array_of(dem::Bin::normal(contact.wall));
      c.tangential = array(contact.tangential);
      c.root_overlap = contact.tangential.w;
      c.rolling = array(contact.rolling);
      bed.walls.push_back({grains.id[strip.first + contact.grain], c});
    }
  }
  bed.top = solver.top();
  const auto place = [largest = solver.params().largest_radius()](const NewGrain& g) {
    return place_in_order(g.position.data(), g.id, largest);
  };
  std::sort(bed.grains.begin(), bed.grains.end(),
            [&](const NewGrain& a, const NewGrain& b) { return place(a) < place(b); });
  return bed;
}

void begin_from(dem::GrainSolver& solver, const StartingBed& bed) {
  std::vector<dem::Quad> positions;
  for (const NewGrain& g : bed.grains) {
    positions.push_back({g.position[0], g.position[1], g.position[2], g.radius});
    solver.params().bin.wrap(positions.back());
  }
  solver.place(positions);
  dem::Grains& grains = solver.grains();
  const auto quad = [](const std::array<double, 3>& v) { return dem::Quad{v[0], v[1], v[2], 0.0}; };
  for (int g = 0; g < grains.count; ++g) {
    const NewGrain& from = bed.grains.at(grains.id[g]);
    grains.velocity[g] = quad(from.velocity);
    grains.spin[g] = quad(from.spin);
  }
  std::unordered_map<std::uint64_t, const PairRecord*> pairs;
  for (const PairRecord& r : bed.pairs) pairs.emplace(pair_key(r.i, r.j), &r);
  std::unordered_map<std::uint64_t, const Carried*> walls;
  for (const CarriedBy& one : bed.walls)
    walls.emplace(pair_key(one.grain, static_cast<int>(one.contact.partner)), &one.contact);
  for (int k = 0; k < solver.strips().count(); ++k) {
    dem::Strip& strip = solver.strips()[k];
    for (int p = 0; p < strip.pairs; ++p) {
      const int i = number_of(solver, k, strip.grain_i(p)), j = number_of(solver, k, strip.grain_j(p));
      const auto found = pairs.find(pair_key(std::min(i, j), std::max(i, j)));
      if (found == pairs.end()) continue;
      solver.params().precision == dem::Precision::mixed ? recall<float>(strip, p, *found->second, i > j)
                                                         : recall<double>(strip, p, *found->second, i > j);
    }
    for (dem::WallContact& contact : strip.walls)
      if (const auto found = walls.find(pair_key(grains.id[strip.first + contact.grain], contact.wall));
          found != walls.end()) {
        contact.tangential = quad(found->second->tangential);
        contact.tangential.w = found->second->root_overlap;
        contact.rolling = quad(found->second->rolling);
      }
  }
  solver.reset_accounts();
}

void hand_out(std::span<const CarriedBy> carried, const OwnGrains& own) {
  std::unordered_map<int, int> place;
  for (int g = 0; g < own.count; ++g) place[own.id[g] - 1] = g;
  for (const CarriedBy& one : carried)
    if (const auto found = place.find(one.grain); found != place.end())
      own.carried[found->second].push_back(one.contact);
}

void share(RankGroup* group, StartingBed& bed) {
  if (!group) return;
  share_all(*group, bed.grains);
  share_all(*group, bed.pairs);
  share_all(*group, bed.walls);
  std::vector<double> top{bed.top};
  share_all(*group, top);
  bed.top = top.front();
}

}  // namespace furrow::terrain::liggghts
