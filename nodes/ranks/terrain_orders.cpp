#include "nodes/ranks/terrain_orders.hpp"

#include <utility>

#include "protocol/core/byte_stream.hpp"
#include "protocol/core/error.hpp"

namespace furrow::ranks {
namespace {

constexpr double kFootprintShare = 0.6;  // of the tire radius ahead and behind: a grain there can touch it at rest

}  // namespace

template <class M>
void share(RankGroup* group, M& order) {
  if (!group) return;
  ByteWriter writer;
  if (group->rank() == 0) writer(order);
  const RankGroup::Bytes bytes = group->broadcast(writer.take());
  if (group->rank() == 0) return;
  ByteReader reader(bytes);
  reader(order);
  reader.finish();
}
template void share(RankGroup*, MeasureOrder&);
template void share(RankGroup*, AttachOrder&);
template void share(RankGroup*, AdvanceOrder&);

ProgressCall watched_progress(const scenario::Scenario& scenario, Transport& transport, const RunContext& context) {
  return [&scenario, &transport, &context](const std::string& what, double share) {
    transport.heartbeat();
    transport.check_peers();
    if (context.stop_requested && context.stop_requested())
      throw Error(ExitCode::stopped, "stopped by a signal while the bed was being prepared");
    if (what.starts_with(kWarning)) {
      if (context.note) context.note(what);
      return;
    }
    launch::Progress progress;
    progress.phase = what;
    progress.share = share;
    progress.end = scenario.run.end;
    if (context.progress && transport.self().index == 0) context.progress(progress);
  };
}

void measure_heights(const scenario::Scenario& scenario, const terrain::Terrain& terrain, std::span<const Vec3> rims,
                     std::span<const NodeCard> tires, TerrainSetup& setup) {
  const terrain::TerrainDescription description = scenario.terrain->describe();
  const double length = description.bounds ? description.bounds->length : 0.0;
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const Vec3& at = rims[k];
    const double reach = kFootprintShare * tires[k].tire_radius, half = 0.5 * tires[k].tire_width;
    setup.top_height.push_back(
        terrain.gather_top_height(at.x() - reach, at.x() + reach, at.y() - 1.5 * half, at.y() + 1.5 * half));
    setup.mean_height.push_back(
        description.undisturbed_height
            ? *description.undisturbed_height
            : terrain.gather_mean_height(0.1 * length, 0.9 * length, at.y() - half, at.y() + half));
  }
}

void join_frames(RankGroup* group, terrain::TerrainFrame& frame) {
  if (!group) return;
  ByteWriter writer;
  for (const std::vector<float>* values : {&frame.position, &frame.speed, &frame.radius}) writer(*values);
  terrain::TerrainFrame whole;
  for (const RankGroup::Bytes& part : group->gather(writer.take())) {
    ByteReader reader(part);
    for (std::vector<float>* values : {&whole.position, &whole.speed, &whole.radius}) {
      std::vector<float> own;
      reader(own);
      values->insert(values->end(), own.begin(), own.end());
    }
    reader.finish();
  }
  frame = std::move(whole);
}

}  // namespace furrow::ranks
