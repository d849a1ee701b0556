// The ranks of mpi_test.cpp: one program, one scene per first argument. Every rank prints its observations to stdout
// and ends with the exit code of a node in a real run.
#include <dlfcn.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "protocol/abandon_mpi.hpp"
#include "protocol/mpi_transport.hpp"
#include "protocol/transport.hpp"

namespace {

using namespace furrow;

constexpr Address kRig{Role::rig, 0}, kTire{Role::tire, 0}, kTerrain{Role::terrain, 0};

double wall_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
double cpu_s() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}
void compute_for(double seconds) {
  for (const double end = wall_s() + seconds; wall_s() < end;) {
  }
}
void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

template <class... Values>
void say(const char* format, Values... values) {
  std::printf(format, values...);
  std::fflush(stdout);
}

void require(bool ok, const std::string& what) {
  if (!ok) throw Error(ExitCode::physics, "test: " + what);
}

SurfaceMotion motion_of(std::int64_t step, std::size_t vertices) {
  SurfaceMotion motion;
  motion.header = {step, 1e-4 * static_cast<double>(step)};
  for (std::size_t i = 0; i < vertices; ++i) {
    motion.surface.position.emplace_back(static_cast<double>(step), static_cast<double>(i), 0.5);
    motion.surface.velocity.emplace_back(-1.0, static_cast<double>(i * step), 2.5);
  }
  return motion;
}

/// The exchange of a run at every synchronization: all send, all receive, all flush.
void exchange(Transport& t, std::int64_t step, std::size_t vertices) {
  const StepHeader header{step, 1e-4 * static_cast<double>(step)};
  if (t.self() == kRig) {
    send(t, kTire, RimMotion{header, {}, Order::go_on});
    require(receive_step<SpindleReport>(t, kTire, step).header.time == header.time, "spindle report");
    receive_step<TerrainReport>(t, kTerrain, step);
  } else if (t.self() == kTire) {
    SpindleReport report;
    report.header = header;
    send(t, kRig, report);
    send(t, kTerrain, motion_of(step, vertices));
    receive_step<RimMotion>(t, kRig, step);
    const auto forces = receive_step<TerrainForces>(t, kTerrain, step).forces;
    require(forces.vertex.size() == vertices / 4 && forces.vertex.back() == static_cast<int>(vertices / 4 - 1) &&
                forces.force.back() == Vec3(1.0, static_cast<double>(step), 3.0),
            "nodal forces");
  } else {
    TerrainForces message;
    message.header = header;
    for (int i = 0; i < static_cast<int>(vertices / 4); ++i) {
      message.forces.vertex.push_back(i);
      message.forces.force.emplace_back(1.0, static_cast<double>(step), 3.0);
    }
    send(t, kTire, message);
    TerrainReport report;
    report.header = header;
    report.contact.resize(1);
    send(t, kRig, report);
    const auto surface = receive_step<SurfaceMotion>(t, kTire, step).surface;
    const SurfaceMotion expected = motion_of(step, vertices);
    require(surface.position == expected.surface.position && surface.velocity == expected.surface.velocity,
            "surface motion");
  }
  t.flush();
}

void ping(Transport& t) {
  const double start = wall_s();
  for (int step = 0; step < 1000; ++step) exchange(t, step, 4000);
  const double each = (wall_s() - start) / 1000;
  for (const HostNode& node : t.host_nodes()) require(!node.cores.empty(), "cores");
  require(t.host_nodes().size() == 3, "host nodes");
  say("%s: 1000 steps, %.0f us each, role communicator %s\n", to_string(t.self()).c_str(), 1e6 * each,
      t.role_communicator().value_or(0) > 0 ? "made" : "missing");
}

/// Prints Open MPI's setting at the start, and its setting in steps.
void yielding(Transport& t) {
  exchange(t, 0, 400);
  const auto* now = static_cast<const bool*>(dlsym(RTLD_DEFAULT, "opal_progress_yield_when_idle"));
  const char* begun = std::getenv("OMPI_MCA_mpi_yield_when_idle");
  say("%s: begun with %s, yields in steps: %s\n", to_string(t.self()).c_str(), begun ? begun : "nothing",
      now ? *now ? "yes" : "no" : "unknown");
}

/// The terrain computes; the others wait for it all the time.
void waiting(Transport& t, double step_length, int steps) {
  exchange(t, 0, 400);
  const double wall = wall_s(), cpu = cpu_s(), waited = t.wait_clock().waited_s;
  for (int step = 1; step <= steps; ++step) {
    if (t.self() == kTerrain) compute_for(step_length);
    exchange(t, step, 400);
  }
  const double length = wall_s() - wall;
  say("%s: wall %.4f cpu_share %.4f wait_share %.4f lost_share %.4f\n", to_string(t.self()).c_str(), length,
      (cpu_s() - cpu) / length, (t.wait_clock().waited_s - waited) / length, length / (steps * step_length) - 1.0);
}

bool is_stopped(int process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("State:", 0) == 0) return line.find('T') != std::string::npos;
  throw Error(ExitCode::rank_lost, "test: process " + std::to_string(process) + " is gone");
}

/// After each exchange the tire stops, and the terrain wakes it once it has received the whole exchange. If the tire's
/// message moved only while the tire is in MPI, the terrain would wait for it until the time-out.
void sender_leaves(Transport& t) {
  t.set_peer_timeout(10.0);
  NodeCard card;
  card.pid = getpid();
  if (t.self() == kTire) send(t, kTerrain, card);
  const int tire = t.self() == kTerrain ? receive<NodeCard>(t, kTire).pid : 0;
  for (int step = 0; step < 50; ++step) {
    if (t.self() == kTerrain) sleep_for(0.002);
    exchange(t, step, 4000);
    if (t.self() == kTire) raise(SIGSTOP);
    if (t.self() == kTerrain) {
      while (!is_stopped(tire)) sleep_for(0.001);
      kill(tire, SIGCONT);
    }
  }
  say("%s: nobody waited for one that computes\n", to_string(t.self()).c_str());
}

void one_fails(Transport& t) {
  for (int step = 0; step < 10; ++step) exchange(t, step, 4000);
  if (t.self() == kTire) throw Error(ExitCode::physics, "tire 0: no convergence at step 10");
  exchange(t, 10, 4000);
}

/// The tire stops without a message.
void one_stops(Transport& t) {
  t.set_peer_timeout(2.0);
  exchange(t, 0, 4000);
  if (t.self() == kTire) raise(SIGSTOP);
  exchange(t, 1, 4000);
}

/// The tire stops, and the terrain fails: the rig must not wait for the tire when it ends.
void one_fails_one_stops(Transport& t) {
  t.set_peer_timeout(3.0);
  exchange(t, 0, 400);
  if (t.self() == kTire) raise(SIGSTOP);
  if (t.self() == kTerrain) throw Error(ExitCode::physics, "terrain: a grain was lost");
  exchange(t, 1, 400);
}

/// The terrain settles for longer than the time-out; the rig waits for it, and the tire for the rig.
void settling(Transport& t) {
  t.set_peer_timeout(2.0);
  if (t.self() == kTerrain) {
    for (int i = 0; i < 50; ++i) {
      sleep_for(0.1);
      t.heartbeat();
      t.check_peers();
    }
    send(t, kRig, TerrainSetup{});
  } else if (t.self() == kRig) {
    receive<TerrainSetup>(t, kTerrain);
    send(t, kTire, RimMotion{});
  } else {
    receive<RimMotion>(t, kRig);
  }
  say("%s: settled\n", to_string(t.self()).c_str());
}

/// The rig itself is stopped while it waits, for longer than its time-out, and continues waiting afterwards.
void waiting_one_is_stopped(Transport& t) {
  if (t.self() == kRig) {
    t.set_peer_timeout(2.0);
    NodeCard card;
    card.pid = getpid();
    send(t, kTerrain, card);
    receive<TerrainSetup>(t, kTerrain);
  } else if (t.self() == kTerrain) {
    const int rig = receive<NodeCard>(t, kRig).pid;
    sleep_for(0.3);
    kill(rig, SIGSTOP);
    sleep_for(3.0);
    kill(rig, SIGCONT);
    sleep_for(0.3);
    send(t, kRig, TerrainSetup{});
  }
  say("%s: patient\n", to_string(t.self()).c_str());
}

int play(const std::string& scene, int argc, char** argv) {
  std::unique_ptr<Transport> transport;
  try {
    transport = make_mpi_transport(&argc, &argv, 1, 1);
    if (scene == "ping") ping(*transport);
    if (scene == "yielding") yielding(*transport);
    if (scene == "waiting") waiting(*transport, 4e-3, 500);
    if (scene == "waiting_long") waiting(*transport, 0.2, 10);
    if (scene == "sender_leaves") sender_leaves(*transport);
    if (scene == "one_fails") one_fails(*transport);
    if (scene == "one_stops") one_stops(*transport);
    if (scene == "one_fails_one_stops") one_fails_one_stops(*transport);
    if (scene == "waiting_one_is_stopped") waiting_one_is_stopped(*transport);
    if (scene == "settling") settling(*transport);
    return 0;
  } catch (const PeerFailure& failure) {
    say("%s left: %s failed\n", to_string(transport->self()).c_str(), to_string(failure.who()).c_str());
    if (failure.code() == ExitCode::rank_lost) abandon_mpi(static_cast<int>(failure.code()));
    return static_cast<int>(failure.code());
  } catch (const Error& error) {
    say("error: %s\n", error.what());
    if (transport) transport->announce_failure(error.code(), error.what());
    if (error.code() == ExitCode::rank_lost) abandon_mpi(static_cast<int>(error.code()));
    return static_cast<int>(error.code());
  }
}

}  // namespace

int main(int argc, char** argv) { return play(argc > 1 ? argv[1] : "", argc, argv); }
