// Writes checkpoints while a run steps: every rank writes its part, and the rig's rank completes the checkpoint.
#pragma once

#include "nodes/ranks/node.hpp"
#include "protocol/core/fields.hpp"

namespace furrow::ranks {

/// Resources that a node has used, summed over the segments of its run.
struct NodeCost {
  double cpu_s = 0.0, compute_s = 0.0, communicate_s = 0.0, wait_s = 0.0;
};
void visit_fields(FieldsOf<NodeCost> auto& s, auto&& visit) {
  visit(s.cpu_s, Field{"cpu_s", "s"});
  visit(s.compute_s, Field{"compute_s", "s"});
  visit(s.communicate_s, Field{"communicate_s", "s"});
  visit(s.wait_s, Field{"wait_s", "s"});
}

enum class CheckpointNeed {
  wished,  // if it cannot be written, earlier ones stay: the user is warned and the run continues
  last,    // the run is complete with it: lost() gives the reason if it could not be written, after the results are
  needed,  // the run stops with it: Error(io)
};

class CheckpointWriter {
 public:
  /// @param cost returns the cost of this node so far
  CheckpointWriter(const scenario::Scenario& scenario, Node& node, Transport& transport, const RunContext& context,
                   std::span<const NodeCard> cards, std::function<NodeCost()> cost);

  /// Writes a checkpoint; all ranks call it at the same step.
  void write(std::int64_t step, CheckpointNeed need);

  std::int64_t last_step() const { return last_step_; }
  /// The reason why the last checkpoint of a complete run is missing; empty if it is written, and on ranks other than
  /// the rig's.
  const std::string& lost() const { return lost_; }

 private:
  CheckpointPart write_part(std::int64_t step) const;
  checkpoint::CheckpointManifest manifest(std::int64_t step, std::vector<CheckpointPart> parts) const;
  void complete(CheckpointPart own, CheckpointNeed need);

  const scenario::Scenario& scenario_;
  Node& node_;
  Transport& transport_;
  const RunContext& context_;
  std::vector<NodeCard> cards_;
  std::function<NodeCost()> cost_;
  checkpoint::FrameClock frames_;
  std::string build_, lost_;
  double begin_;              // wall time, s
  double write_begin_ = 0.0;  // of the last checkpoint, wall time, s
  std::int64_t last_step_ = -1;
};

void save_cost(Archive& archive, const NodeCost& cost);
NodeCost restore_cost(const Archive& archive);

}  // namespace furrow::ranks
