#include "terrain/liggghts/rank_frames.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace furrow::terrain::liggghts {
namespace {

dem::Quad place_of(const OwnGrains& own, const dem::Bin& bin, int k) {
  dem::Quad at{own.position[k][0], own.position[k][1], own.position[k][2], own.radius[k]};
  bin.wrap(at);
  return at;
}

}  // namespace

dem::Grains grains_of(const OwnGrains& own, const dem::Bin& bin) {
  dem::Grains grains;
  grains.resize(own.count);
  for (int k = 0; k < own.count; ++k) {
    grains.position[k] = place_of(own, bin, k);
    grains.id[k] = own.id[k] - 1;
  }
  return grains;
}

void gather_frame(RankGroup* group, const OwnGrains& own, const dem::Bin& bin, TerrainFrame& out) {
  struct Row {
    double id;
    float x, y, z, radius, speed;
  };
  std::vector<Row> rows(own.count);
  for (int k = 0; k < own.count; ++k) {
    const dem::Quad at = place_of(own, bin, k);
    const double* const v = own.velocity[k];
    rows[k] = {static_cast<double>(own.id[k]), static_cast<float>(at.x),
               static_cast<float>(at.y),       static_cast<float>(at.z),
               static_cast<float>(at.w),       static_cast<float>(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))};
  }
  if (group) rows = gather_on_all<Row>(*group, rows);
  out.position.clear(), out.speed.clear(), out.radius.clear();
  if (group && group->rank() != 0) return;
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  for (const Row& row : rows) {
    out.position.insert(out.position.end(), {row.x, row.y, row.z});
    out.speed.push_back(row.speed);
    out.radius.push_back(row.radius);
  }
}

}  // namespace furrow::terrain::liggghts
