#include "nodes/ranks/checkpoint_writer.hpp"

#include <utility>

#include <fmt/format.h>

#include "nodes/output/frames.hpp"
#include "nodes/output/profile.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/files/program_id.hpp"

namespace furrow::ranks {

namespace {

constexpr Address kRig{Role::rig, 0};
constexpr char kCost[] = "run/cost";

}  // namespace

CheckpointWriter::CheckpointWriter(const scenario::Scenario& scenario, Node& node, Transport& transport,
                                   const RunContext& context, std::span<const NodeCard> cards,
                                   std::function<NodeCost()> cost)
    : scenario_(scenario),
      node_(node),
      transport_(transport),
      context_(context),
      cards_(cards.begin(), cards.end()),
      cost_(std::move(cost)),
      frames_(frame_clock(scenario, context)),
      begin_(wall_clock()) {
  if (transport.self() == kRig) build_ = build_id();
}

CheckpointPart CheckpointWriter::write_part(std::int64_t step) const {
  CheckpointPart part{step, checkpoint::part_name(transport_.self()), "", ""};
  try {
    Archive archive;
    node_.save(archive);
    node_.save_setup(archive);
    save_cost(archive, cost_());
    const std::filesystem::path folder = checkpoint::unfinished_checkpoint(context_.directory, step);
    // The run's own folder is never created here, because it was moved or removed. The error then names the file in it.
    std::error_code ignored, failed;
    std::filesystem::create_directory(folder.parent_path(), ignored);
    std::filesystem::create_directory(folder, failed);
    if (!std::filesystem::is_directory(std::filesystem::symlink_status(folder, ignored)))
      throw io_error(folder.string(), failed ? fmt::format("cannot be created ({}), expected a folder for the parts of "
                                                           "the checkpoint",
                                                           failed.message())
                                             : "is not a folder, expected one for the parts of the checkpoint");
    fault_point("checkpoint.write");
    write_archive(folder / part.file, archive);
    part.checksum = checkpoint::part_checksum(folder / part.file);
    fault_point("checkpoint.written");
  } catch (const Error& error) {
    part.problem = error.what();
  }
  return part;
}

void CheckpointWriter::write(std::int64_t step, CheckpointNeed need) {
  FURROW_ASSERT(step > 0, step);
  FURROW_ASSERT(step > last_step_, step, last_step_);
  if (context_.directory.empty()) return;
  last_step_ = step;
  write_begin_ = wall_clock();
  transport_.heartbeat();
  if (context_.held) context_.held->check();
  const CheckpointPart own = write_part(step);
  if (transport_.self() == kRig) {
    complete(own, need);
  } else {
    send(transport_, kRig, own);
    transport_.flush();
  }
}

checkpoint::CheckpointManifest CheckpointWriter::manifest(std::int64_t step, std::vector<CheckpointPart> parts) const {
  FURROW_ASSERT(parts.size() == cards_.size(), parts.size(), cards_.size());
  checkpoint::CheckpointManifest m;
  m.version = FURROW_VERSION;
  m.build = build_;
  m.cpu = cpu_model();
  m.arithmetic = arithmetic_id();
  m.name = scenario_.name;
  m.scenario = scenario_.completed;
  m.scenario_digest = scenario_.digest;
  m.file_hashes = scenario_.file_hashes();
  m.step = step;
  m.time = static_cast<double>(step) * scenario_.run.step;
  m.parts = std::move(parts);
  m.series = node_.mark_series();
  std::error_code ignored;
  for (const CheckpointPart& part : m.parts)
    m.bytes += static_cast<std::int64_t>(
        std::filesystem::file_size(checkpoint::unfinished_checkpoint(context_.directory, step) / part.file, ignored));
  m.frames = frames_;
  m.segments = checkpoint::segments_until(step, wall_clock() - begin_,
                                          cards_[scenario::terrain_rank(scenario_)].threads, context_.resume);
  m.write_s = wall_clock() - write_begin_;
  return m;
}

void CheckpointWriter::complete(CheckpointPart own, CheckpointNeed need) {
  FURROW_ASSERT(transport_.self() == kRig, to_string(transport_.self()));
  const std::int64_t step = own.step;
  std::string problem = own.problem;
  std::vector<CheckpointPart> parts{std::move(own)};
  for (std::size_t i = 1; i < cards_.size(); ++i) {
    parts.push_back(receive<CheckpointPart>(transport_, cards_[i].self));
    if (problem.empty()) problem = parts.back().problem;
  }
  if (problem.empty()) {
    try {
      fault_point("checkpoint.manifest");
      output::sync_frames(context_.directory);  // frames before the checkpoint are not made again
      checkpoint::complete_checkpoint(context_.directory, manifest(step, std::move(parts)), scenario_.checkpoint.keep);
      fault_point("checkpoint.done");
      return;
    } catch (const Error& error) {
      problem = error.what();
    }
  }
  checkpoint::drop_unfinished_checkpoint(context_.directory, step);
  const std::string text = fmt::format("the checkpoint at t = {:.6g} s could not be written: {}",
                                       static_cast<double>(step) * scenario_.run.step, problem);
  if (need == CheckpointNeed::needed) throw Error(ExitCode::io, text);
  if (need == CheckpointNeed::last)
    lost_ = text;
  else if (context_.note)
    context_.note("warning: " + text + "; the run continues");
}

void save_cost(Archive& archive, const NodeCost& cost) { save_fields(archive, kCost, cost); }

NodeCost restore_cost(const Archive& archive) {
  NodeCost cost;
  restore_fields(archive, kCost, cost);
  return cost;
}

}  // namespace furrow::ranks
