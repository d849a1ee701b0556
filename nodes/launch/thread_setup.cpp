#include "nodes/launch/thread_setup.hpp"

#include <dlfcn.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include "nodes/scenario/terrain_threads.hpp"
#include "protocol/core/assert.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace furrow::launch {
namespace {

constexpr int kCoresToBind = 4;  // with fewer, the system balances better than a binding
constexpr int kCoresForOwnRigCore = 8;
constexpr char kSpinCount[] = "2000";  // of libgomp, tries

struct Demand {
  int rig_cores = 0;  // 0: the rig shares the tires' cores
  int tires = 0;
  int terrain_ranks = 0;
  int terrain_threads = 1;  // per rank
  int total() const { return rig_cores + tires + terrain_ranks * terrain_threads; }
};

Demand demand(const HostView& host, int cores, int terrain_threads) {
  FURROW_ASSERT(cores > 0 && terrain_threads >= 0, cores, terrain_threads);
  Demand d;
  bool rig = false;
  for (const HostNode& n : host.nodes) {
    rig = rig || n.node.role == Role::rig;
    d.tires += n.node.role == Role::tire;
    d.terrain_ranks += n.node.role == Role::terrain;
  }
  d.rig_cores = rig && (cores >= kCoresForOwnRigCore || host.nodes.size() == 1) ? 1 : 0;
  if (terrain_threads > 0) {
    d.terrain_threads = terrain_threads;
  } else if (d.terrain_ranks > 0) {
    d.terrain_threads = scenario::auto_terrain_threads(cores, d.rig_cores + d.tires, d.terrain_ranks, host.grains);
  }
  return d;
}

bool all_share_the_same_cores(const HostView& host) {
  return std::all_of(host.nodes.begin(), host.nodes.end(),
                     [&](const HostNode& n) { return n.cores == host.nodes.front().cores; });
}

bool no_core_is_shared(const HostView& host) {
  std::set<int> seen;
  for (const HostNode& n : host.nodes)
    for (const int core : n.cores)
      if (!seen.insert(core).second) return false;
  return true;
}

/// Advice for ranks that the launcher pinned. Several ranks on one core were put there on purpose, for example by a
/// sweep.
std::string pinning_note(const HostView& host, std::size_t node, int wanted) {
  FURROW_ASSERT(in_range(node, host.nodes.size()), node, host.nodes.size());
  const std::vector<int>& cores = host.nodes[node].cores;
  const bool wants_more = wanted > 1 || host.nodes[node].node.role == Role::terrain;
  const bool together = host.nodes.size() > 1 && all_share_the_same_cores(host);
  if (cores.size() > 1 || host.machine_cores < 2 || !wants_more || together) return {};
  return fmt::format(
      "{} is pinned to core {} of {}{}; start mpirun with --bind-to none, or srun with more --cpus-per-task",
      to_string(host.nodes[node].node), cores.front(), host.machine_cores,
      wanted > 1 ? fmt::format(" while {} threads are wanted", wanted) : std::string());
}

/// Plan if the launcher gave each rank its own or overlapping cores: every node stays within its cores.
ThreadPlan plan_within_own_cores(const HostView& host, std::size_t node, int terrain_threads) {
  FURROW_ASSERT(in_range(node, host.nodes.size()), node, host.nodes.size());
  const HostNode& self = host.nodes[node];
  ThreadPlan plan;
  const int own = static_cast<int>(self.cores.size());
  if (self.node.role == Role::terrain)
    plan.threads = terrain_threads > 0 ? terrain_threads : std::min(own, scenario::kMaxAutoThreads);
  plan.disjoint = no_core_is_shared(host) && plan.threads <= own;
  if (plan.disjoint) plan.cores.assign(self.cores.begin(), self.cores.begin() + plan.threads);
  return plan;
}

/// Plan if all nodes may use the same cores: shares them out in the order rig, tires, terrain.
ThreadPlan plan_on_common_cores(const HostView& host, std::size_t node, int terrain_threads) {
  FURROW_ASSERT(!host.nodes[node].cores.empty(), node);
  const HostNode& self = host.nodes[node];
  int cores = static_cast<int>(self.cores.size());
  if (host.cpu_limit > 0.0) cores = std::clamp(static_cast<int>(std::lround(host.cpu_limit)), 1, cores);
  const Demand d = demand(host, cores, terrain_threads);

  ThreadPlan plan;
  plan.threads = self.node.role == Role::terrain ? d.terrain_threads : 1;
  // A second run on this machine would choose the same cores: do not bind with a limit or with load from others.
  const bool free_of_others = host.cpu_limit == 0.0 && host.load + d.total() <= host.machine_cores + 0.5;
  plan.disjoint = cores >= kCoresToBind && d.total() <= cores && free_of_others;
  if (!plan.disjoint && terrain_threads == 0 && self.node.role == Role::terrain && d.terrain_ranks == 1)
    plan.other = scenario::other_terrain_threads(cores, d.rig_cores + d.tires, host.grains, plan.threads);
  if (!plan.disjoint) return plan;

  int before = 0;  // cores of earlier nodes
  for (std::size_t i = 0; i < node; ++i) {
    const Role role = host.nodes[i].node.role;
    before += role == Role::rig ? d.rig_cores : role == Role::tire ? 1 : d.terrain_threads;
  }
  int count = plan.threads;
  if (self.node.role == Role::rig && d.rig_cores == 0) count = std::max(1, d.tires);
  plan.cores.assign(self.cores.begin() + before, self.cores.begin() + before + count);
  return plan;
}

int machine_cores() {
  cpu_set_t before;
  if (sched_getaffinity(0, sizeof before, &before) != 0) return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  // The number of CPUs per core on the allowed cores holds for the whole machine.
  const double per_core = static_cast<double>(CPU_COUNT(&before)) / static_cast<double>(allowed_cores().size());
  return std::max(1, static_cast<int>(std::lround(sysconf(_SC_NPROCESSORS_ONLN) / per_core)));
}

/// CPUs granted by the control group (version 2, then 1), 0 when unlimited.
double cpu_limit() {
  double quota = 0.0, period = 0.0;
  std::ifstream v2("/sys/fs/cgroup/cpu.max");
  if (v2 >> quota >> period && period > 0.0) return quota / period;  // "max 100000" fails to read a number
  std::ifstream v1_quota("/sys/fs/cgroup/cpu/cpu.cfs_quota_us"), v1_period("/sys/fs/cgroup/cpu/cpu.cfs_period_us");
  if (v1_quota >> quota && v1_period >> period && quota > 0.0 && period > 0.0) return quota / period;
  return 0.0;
}

double load_average() {
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : 0.0;
}

bool user_binds() {
  return std::getenv("OMP_PROC_BIND") || std::getenv("OMP_PLACES") || std::getenv("GOMP_CPU_AFFINITY");
}

void bind_this_thread(const int* first, std::size_t count) {
  FURROW_ASSERT(first != nullptr && count > 0, count);
  cpu_set_t set;
  CPU_ZERO(&set);
  for (std::size_t i = 0; i < count; ++i)
    if (first[i] < CPU_SETSIZE) CPU_SET(first[i], &set);
  sched_setaffinity(0, sizeof set, &set);  // if refused the thread stays where it is: slower, not wrong
}

void flush_denormals_to_zero() {
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040U);  // flush to zero | denormals are zero
#elif defined(__aarch64__)
  std::uint64_t fpcr = 0;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  asm volatile("msr fpcr, %0" ::"r"(fpcr | (1ULL << 24)));
#endif
}

}  // namespace

ThreadPlan plan_threads(const HostView& host, std::size_t node, int terrain_threads) {
  FURROW_ASSERT(in_range(node, host.nodes.size()), node, host.nodes.size());
  FURROW_ASSERT(terrain_threads >= 0, terrain_threads);
  ThreadPlan plan = all_share_the_same_cores(host) ? plan_on_common_cores(host, node, terrain_threads)
                                                   : plan_within_own_cores(host, node, terrain_threads);
  const bool terrain = host.nodes[node].node.role == Role::terrain;
  plan.note = pinning_note(host, node, terrain ? terrain_threads : 1);
  const int own = static_cast<int>(host.nodes[node].cores.size());
  if (plan.note.empty() && plan.threads > own)
    plan.note = fmt::format("{} runs {} threads on {} cores; fewer are faster", to_string(host.nodes[node].node),
                            plan.threads, own);
  return plan;
}

ThreadPlan plan_threads(const Transport& transport, int terrain_threads, std::int64_t grains) {
  HostView host;
  host.grains = grains;
  host.nodes = transport.host_nodes();
  host.machine_cores = machine_cores();
  host.cpu_limit = cpu_limit();
  host.load = load_average();
  std::size_t node = 0;
  while (node + 1 < host.nodes.size() && !host.nodes[node].self) ++node;
  return plan_threads(host, node, terrain_threads);
}

void apply(const ThreadPlan& plan) {
  FURROW_ASSERT(plan.threads > 0, plan.threads);
  using SetThreads = void (*)(int);
  for (const char* name : {"openblas_set_num_threads", "MKL_Set_Num_Threads"})
    if (void* found = dlsym(RTLD_DEFAULT, name)) reinterpret_cast<SetThreads>(found)(1);
  omp_set_dynamic(0);
  omp_set_num_threads(plan.threads);
  const bool bind = !plan.cores.empty() && !user_binds();
  const bool one_each = static_cast<int>(plan.cores.size()) == plan.threads;
#pragma omp parallel num_threads(std::max(plan.threads, plan.other))
  {
    flush_denormals_to_zero();
    if (bind && one_each) bind_this_thread(&plan.cores[static_cast<std::size_t>(omp_get_thread_num())], 1);
    if (bind && !one_each) bind_this_thread(plan.cores.data(), plan.cores.size());
  }
}

void set_passive_environment() {
  setenv("OMP_WAIT_POLICY", "passive", 0);
  setenv("GOMP_SPINCOUNT", kSpinCount, 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
}

void wait_passively(char** argv) {
  FURROW_ASSERT(argv != nullptr && argv[0] != nullptr, "argv");
  if (std::getenv("OMP_WAIT_POLICY")) return;
  set_passive_environment();
  execv(this_program().c_str(), argv);  // without /proc the threads spin, which costs time but no result
}

}  // namespace furrow::launch
