#include "terrain/liggghts/rank_reports.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/byte_stream.hpp"

namespace furrow::terrain::liggghts {
namespace {

/// Adds the forces of another rank's tires, vertex by vertex; both lists rise.
void merge(NodalForces& into, const NodalForces& more) {
  NodalForces all;
  std::size_t a = 0, b = 0;
  const auto take = [&](const NodalForces& from, std::size_t k) {
    all.vertex.push_back(from.vertex[k]);
    all.force.push_back(from.force[k]);
    if (!from.tangent.empty()) all.tangent.push_back(from.tangent[k]);
  };
  while (a < into.vertex.size() || b < more.vertex.size()) {
    const bool left = b == more.vertex.size() || (a < into.vertex.size() && into.vertex[a] <= more.vertex[b]);
    const bool both = left && b < more.vertex.size() && into.vertex[a] == more.vertex[b];
    left ? take(into, a++) : take(more, b++);
    if (!both) continue;
    all.force.back() += more.force[b];
    if (!more.tangent.empty()) {  // position and velocity of the vertex are the same on all ranks
      all.tangent.back().stiffness += more.tangent[b].stiffness;
      all.tangent.back().damping += more.tangent[b].damping;
    }
    ++b;
  }
  into = std::move(all);
}

void add(ContactSums& to, const ContactSums& more) {
  to.force += more.force;
  to.normal += more.normal;
  to.tangential += more.tangential;
  to.transfer_force_residual = std::max(to.transfer_force_residual, more.transfer_force_residual);
  to.transfer_moment_residual = std::max(to.transfer_moment_residual, more.transfer_moment_residual);
  to.work += more.work;
  to.contacts += more.contacts;
}

}  // namespace

SharedReports share_reports(RankGroup* group, const IntervalReport& interval, const StateReport& state,
                            std::span<NodalForces> forces, std::span<ContactSums> sums) {
  FURROW_ASSERT(forces.size() == sums.size(), forces.size(), sums.size());
  SharedReports all{{interval}, {state}};
  if (!group) return all;
  ByteWriter writer;
  if (group->rank() > 0) {
    writer(interval), writer(state);
    for (std::size_t k = 0; k < forces.size(); ++k) writer(forces[k]), writer(sums[k]);
  }
  const std::vector<RankGroup::Bytes> parts = group->gather(writer.take());
  for (std::size_t rank = 1; rank < parts.size(); ++rank) {
    ByteReader reader(parts[rank]);
    reader(all.intervals.emplace_back()), reader(all.states.emplace_back());
    for (std::size_t k = 0; k < forces.size(); ++k) {
      NodalForces more;
      ContactSums more_sums;
      reader(more), reader(more_sums);
      merge(forces[k], more);
      add(sums[k], more_sums);
    }
    reader.finish();
  }
  ByteWriter back;
  if (group->rank() == 0) back(all.intervals);
  const RankGroup::Bytes bytes = group->broadcast(back.take());
  if (group->rank() > 0) {
    ByteReader reader(bytes);
    reader(all.intervals);
    reader.finish();
  }
  return all;
}

void merge_heights(RankGroup* group, HeightField& field) {
  if (!group) return;
  const std::vector<double> all = gather_on_all<double>(*group, field.height);
  const std::size_t cells = field.height.size();
  FURROW_ASSERT(cells > 0 && all.size() % cells == 0, all.size(), cells);
  for (std::size_t k = 0; k < all.size(); ++k) {
    double& height = field.height[k % cells];
    if (!(height >= all[k]) && !std::isnan(all[k])) height = all[k];
  }
}

std::vector<StateReport> gather_states(RankGroup* group, const StateReport& own) {
  if (!group) return {own};
  ByteWriter writer;
  writer(own);
  std::vector<StateReport> all;
  for (const RankGroup::Bytes& part : group->gather(writer.take())) {
    ByteReader reader(part);
    reader(all.emplace_back());
    reader.finish();
  }
  if (all.empty()) all.push_back(own);
  return all;
}

}  // namespace furrow::terrain::liggghts
