// OpenMP threads of a node: how many, on which cores, and how they wait.
//
//   int main(int, char** argv) {
//     wait_passively(argv);                                   // before anything else
//     …
//     auto transport = make_mpi_transport(…);
//     const ThreadPlan plan = plan_threads(*transport, scenario.run.threads, grains);
//     apply(plan);
//     run_node(scenario, *transport, {.threads = plan.threads, …});
//
// Rules. The terrain gets the cores that the others leave; with many grains and few such cores it also gets the others'
// cores. Where they leave at most half it tries both while it steps (nodes/ranks/thread_trial.hpp). A tire computes on
// one thread. The rig hardly computes, so it has a core of its own only if there are many. If there are enough cores,
// each thread is bound to its own. If there are too few, or the machine has other work, nothing is bound and the system
// balances. Results do not depend on any of this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/host.hpp"
#include "protocol/transport.hpp"

namespace furrow::launch {

/// One machine as its nodes see it.
struct HostView {
  std::vector<HostNode> nodes;  // of this run on this machine, in rank order
  int machine_cores = 1;        // physical cores, allowed or not
  double cpu_limit = 0.0;       // CPUs that the control group grants; 0: no limit
  double load = 0.0;            // runnable tasks of others: load average of the last minute
  std::int64_t grains = 0;      // expected in the terrain; 0: not known
};

struct ThreadPlan {
  int threads = 1;
  std::vector<int> cores;  // to bind to; empty: do not bind
  bool disjoint = false;   // every computing thread of this machine's nodes has a core of its own
  std::string note;        // advice for the user, or empty
  int other = 0;           // threads that the terrain may try instead while it steps; 0: none
};

/// @param node             index in host.nodes
/// @param terrain_threads  the user's choice for the terrain; 0: decide here
/// @pre node < host.nodes.size(), terrain_threads ≥ 0
ThreadPlan plan_threads(const HostView& host, std::size_t node, int terrain_threads);

/// Examines this machine and plans for the transport's own node.
/// @param grains  expected in the terrain; 0: not known
ThreadPlan plan_threads(const Transport& transport, int terrain_threads, std::int64_t grains);

/// Sets the thread count, binding, BLAS threads (one) and, in every thread, denormals to zero. Leaves a binding alone
/// that the user chose by OMP_PROC_BIND, OMP_PLACES or GOMP_CPU_AFFINITY.
void apply(const ThreadPlan& plan);

/// Makes OpenMP threads wait passively: threads that spin while they wait take the cores of other ranks. For about
/// 0.1 ms they spin all the same, since most waits are shorter and waking a thread takes as long. OpenMP reads these
/// settings from the environment before main begins. Therefore, unless OMP_WAIT_POLICY is set, this sets them and
/// restarts the program.
void wait_passively(char** argv);

/// Sets the variables of wait_passively that are not set already, for the ranks of a supervisor.
void set_passive_environment();

}  // namespace furrow::launch
