#include "nodes/ranks/node.hpp"

#include <unistd.h>

#include <utility>

#include <fmt/format.h>

#include "nodes/output/frames.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::ranks {

NodeCard common_card(const scenario::Scenario& scenario, Address self) {
  NodeCard card;
  card.self = self;
  card.scenario_digest = scenario.digest;
  card.step = scenario.run.step;
  card.steps = scenario.run.steps();
  card.pid = static_cast<std::int32_t>(getpid());
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  card.host = host;
  return card;
}

std::string when(const StepHeader& header) {
  return fmt::format(" at t = {:.6g} s, step {}", header.time, header.step);
}

checkpoint::FrameClock frame_clock(const scenario::Scenario& scenario, const RunContext& context) {
  const std::int64_t every = context.directory.empty() ? 0 : scenario.run.steps_in(scenario.output.frame_interval);
  if (!context.resume) return {every, 0, 0};
  const checkpoint::CheckpointManifest& manifest = context.resume->manifest;
  return output::continued_frames(context.directory, manifest, every);
}

std::unique_ptr<Node> make_node(const scenario::Scenario& scenario, Address self, int threads,
                                std::function<void()> alive, std::shared_ptr<RankGroup> group) {
  switch (self.role) {
    case Role::rig:
      return make_rig_node(scenario);
    case Role::tire:
      return make_tire_node(scenario, self.index, std::move(alive));
    case Role::terrain:
      return self.index == 0 ? make_terrain_node(scenario, threads, std::move(group))
                             : make_terrain_follower(scenario, threads, std::move(group));
  }
  throw Error(ExitCode::rank_lost, "unknown role");
}

}  // namespace furrow::ranks
