#include "terrain/gpu/bed_transfer.hpp"

#include <algorithm>
#include <array>

#include "protocol/core/assert.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain::gpu {
namespace {

Vec3 vec(const dem::Quad& q) { return {q.x, q.y, q.z}; }
std::array<double, 3> array(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
template <class To>
void copy(const std::array<double, 3>& from, To (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<To>(from[k]);
}
template <class From>
std::array<double, 3> array(const From (&v)[3]) {
  return {v[0], v[1], v[2]};
}

}  // namespace

void send_bed(const dem::GrainSolver& solver, GpuGrains& to) {
  const dem::Grains& grains = solver.grains();
  GrainMotion motion;
  for (auto* of : {&motion.position, &motion.velocity, &motion.spin}) of->resize(grains.count);
  for (int g = 0; g < grains.count; ++g) {
    const std::int32_t id = grains.id[g];
    motion.position[id] = vec(grains.position[g]);
    motion.velocity[id] = vec(grains.velocity[g]);
    motion.spin[id] = vec(grains.spin[g]);
  }
  to.place(motion);
  const liggghts::StartingBed bed = liggghts::starting_bed(solver);
  Histories histories;
  for (const liggghts::PairRecord& r : bed.pairs) {
    Pair& p = histories.pairs.emplace_back();
    p.i = r.i, p.j = r.j;
    copy(r.tangential, p.tangential), copy(r.rolling, p.rolling);
    p.root_overlap = static_cast<float>(r.root_overlap);
  }
  for (const liggghts::CarriedBy& one : bed.walls) {
    WallTouch& w = histories.walls.emplace_back();
    w.grain = one.grain, w.wall = static_cast<std::int32_t>(one.contact.partner);
    copy(one.contact.tangential, w.tangential), copy(one.contact.rolling, w.rolling);
    w.root_overlap = one.contact.root_overlap;
  }
  to.remember(histories);
}

void set_bed(const GrainMotion& grains, const Histories& histories, dem::GrainSolver& solver) {
  liggghts::StartingBed bed;
  for (std::size_t k = 0; k < grains.position.size(); ++k) {
    liggghts::NewGrain& g = bed.grains.emplace_back();
    g.id = static_cast<int>(k);
    g.radius = solver.params().grain.radius;
    g.position = array(grains.position[k]);
    g.velocity = array(grains.velocity[k]), g.spin = array(grains.spin[k]);
  }
  for (const Pair& p : histories.pairs)
    bed.pairs.push_back({p.i, p.j, array(p.tangential), p.root_overlap, array(p.rolling)});
  for (const WallTouch& w : histories.walls) {
    liggghts::CarriedBy& one = bed.walls.emplace_back();
    one.grain = w.grain;
    one.contact.partner = w.wall;
    one.contact.tangential = array(w.tangential), one.contact.rolling = array(w.rolling);
    one.contact.root_overlap = w.root_overlap;
  }
  liggghts::begin_from(solver, bed);
}

void fetch_bed(const GpuGrains& from, dem::GrainSolver& solver) {
  set_bed(from.motion(true), from.histories(), solver);
}

}  // namespace furrow::terrain::gpu
