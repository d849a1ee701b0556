// Runs a whole co-simulation in one process, one thread per node, and gives tests access to the nodes.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "nodes/ranks/node.hpp"
#include "protocol/transport_group.hpp"

namespace furrow::testing {

class InProcessRun {
 public:
  explicit InProcessRun(const scenario::Scenario& scenario, const ranks::RunContext& context = {})
      : scenario_(scenario),
        transports_(make_in_process_transports(static_cast<int>(scenario.tires.size()), scenario.terrain_ranks)) {
    nodes_.resize(transports_.size());
    on_all([&](std::size_t i) {
      nodes_[i] =
          ranks::make_node(scenario_, transports_[i]->self(), context.threads, {}, make_terrain_group(*transports_[i]));
      const auto cards = handshake(*transports_[i], nodes_[i]->card());
      nodes_[i]->set_up(*transports_[i], cards, context);
    });
  }

  void steps(std::int64_t from, std::int64_t to) {
    on_all([&](std::size_t i) { ranks::run_steps(*nodes_[i], *transports_[i], scenario_.run.step, from, to); });
  }
  void synchronize(std::int64_t n) {
    on_all([&](std::size_t i) {
      nodes_[i]->synchronize(*transports_[i], {n, static_cast<double>(n) * scenario_.run.step});
    });
  }
  std::vector<Archive> save() const {
    std::vector<Archive> saved(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i]->save(saved[i]);
    return saved;
  }
  void restore(const std::vector<Archive>& saved) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i]->restore(saved[i]);
  }
  std::vector<std::uint64_t> hashes() const {
    std::vector<std::uint64_t> values;
    for (const auto& node : nodes_) values.push_back(ranks::state_hash(*node));
    return values;
  }
  ranks::Node& node(std::size_t i) { return *nodes_[i]; }

 private:
  /// Runs `work` on every node in its own thread, and throws the first error of any.
  void on_all(const std::function<void(std::size_t)>& work) {
    std::vector<std::exception_ptr> errors(transports_.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < transports_.size(); ++i)
      threads.emplace_back([&, i] {
        try {
          work(i);
        } catch (const PeerFailure&) {
          errors[i] = nullptr;
        } catch (const Error& error) {
          errors[i] = std::current_exception();
          transports_[i]->announce_failure(error.code(), error.what());
        } catch (...) {
          errors[i] = std::current_exception();
          transports_[i]->announce_failure(ExitCode::physics, "test");
        }
      });
    for (auto& thread : threads) thread.join();
    for (const auto& error : errors)
      if (error) std::rethrow_exception(error);
  }

  scenario::Scenario scenario_;
  std::vector<std::unique_ptr<Transport>> transports_;
  std::vector<std::unique_ptr<ranks::Node>> nodes_;
};

}  // namespace furrow::testing
