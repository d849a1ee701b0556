// Messages between ranks. Data and control travel on communicators of their own; a tag is the message's kind.
// Sends own their buffers until MPI is done with them. Receiving waits politely: a few tests with yields, for
// messages that are about to come, then sleeps that grow to 200 µs, so that a waiting rank leaves its core to a
// working one (more ranks than cores is the usual case on a laptop).
#include "protocol/mpi_transport.hpp"

#include <mpi.h>
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <deque>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "protocol/byte_stream.hpp"
#include "protocol/peer_clock.hpp"
#include "protocol/transport.hpp"

namespace furrow {
namespace {

constexpr int kYields = 50;                    // tests with a yield before the first sleep
constexpr long kFirstSleep = 10'000;           // ns
constexpr long kLongestSleep = 200'000;        // ns
constexpr double kHeartbeatInterval = 1.0;     // s
constexpr int kHeartbeat = 0, kFailure = 1;    // first field of a control message

/// MPI from init to finalize.
class MpiSession {
 public:
  MpiSession(int* argc, char*** argv) {
    int provided = 0;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    prctl(PR_SET_TIMERSLACK, 1000UL);  // sleep as long as asked, not 50 µs longer
  }
  ~MpiSession() { MPI_Finalize(); }
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
};

/// A communicator that is freed with its owner.
class Communicator {
 public:
  static Communicator duplicate(MPI_Comm of) {
    MPI_Comm made = MPI_COMM_NULL;
    MPI_Comm_dup(of, &made);
    return Communicator(made);
  }
  static Communicator split(MPI_Comm of, int colour, int key) {
    MPI_Comm made = MPI_COMM_NULL;
    MPI_Comm_split(of, colour, key, &made);
    return Communicator(made);
  }
  Communicator(Communicator&& other) noexcept : comm_(std::exchange(other.comm_, MPI_COMM_NULL)) {}
  Communicator& operator=(Communicator&&) = delete;
  ~Communicator() {
    if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
  }
  MPI_Comm get() const { return comm_; }

 private:
  explicit Communicator(MPI_Comm comm) : comm_(comm) {}
  MPI_Comm comm_;
};

struct PendingSend {
  std::vector<std::byte> payload;
  MPI_Request request = MPI_REQUEST_NULL;
};

int world_size() {
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}
int world_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

class MpiTransport final : public Transport {
 public:
  MpiTransport(std::unique_ptr<MpiSession> session, int tire_count)
      : session_(std::move(session)),
        tire_count_(tire_count),
        self_(address_of(world_rank(), tire_count)),
        data_(Communicator::duplicate(MPI_COMM_WORLD)),
        control_(Communicator::duplicate(MPI_COMM_WORLD)),
        role_(Communicator::split(MPI_COMM_WORLD, static_cast<int>(self_.role), world_rank())),
        ranks_(world_size()),
        heartbeats_(ranks_, 0) {}

  ~MpiTransport() override {
    drain();
    for (auto* sends : {&data_sends_, &control_sends_})
      for (PendingSend& send : *sends) {
        MPI_Cancel(&send.request);
        MPI_Request_free(&send.request);
      }
  }

  Address self() const override { return self_; }
  int tire_count() const override { return tire_count_; }

  void send(Address to, MessageKind kind, std::vector<std::byte> payload) override {
    post(data_sends_, data_.get(), rank_of(to), static_cast<int>(kind), std::move(payload));
  }

  std::vector<std::byte> receive(Address from, MessageKind kind) override {
    const int source = rank_of(from), tag = static_cast<int>(kind);
    PeerClock clock(timeout_);
    std::int64_t heard = heartbeats_[source];
    long sleep_ns = 0;
    for (int polls = 0;; ++polls) {
      int there = 0;
      MPI_Message message;
      MPI_Status status;
      MPI_Improbe(source, tag, data_.get(), &there, &message, &status);
      if (there) {
        clock_.waited_s += polls > 0 ? clock.total() : 0.0;
        return take(message, status);
      }
      check_peers();
      if (heartbeats_[source] != heard) {
        heard = heartbeats_[source];
        clock.heard();
      }
      if (clock.expired()) throw lost_peer(self_, from, kind, timeout_);
      complete(data_sends_);
      sleep_ns = pause(polls, sleep_ns);
    }
  }

  void heartbeat() override {
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (now - last_heartbeat_ < kHeartbeatInterval) return;
    last_heartbeat_ = now;
    ByteWriter writer;
    writer(kHeartbeat);
    to_all_others(writer.take());
  }

  void announce_failure(ExitCode code, const std::string& text) noexcept override {
    try {
      ByteWriter writer;
      writer(kFailure);
      writer(code);
      writer(text);
      to_all_others(writer.take());
    } catch (...) {
      // Out of memory while failing: the others will notice the silence.
    }
  }

  void check_peers() override {
    for (;;) {
      int there = 0;
      MPI_Message message;
      MPI_Status status;
      MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, control_.get(), &there, &message, &status);
      if (!there) break;
      const std::vector<std::byte> payload = take(message, status);
      ByteReader reader(payload);
      int what = 0;
      reader(what);
      ++heartbeats_[status.MPI_SOURCE];
      if (what != kFailure) continue;
      ExitCode code{};
      std::string text;
      reader(code);
      reader(text);
      throw PeerFailure(code, address_of(status.MPI_SOURCE, tire_count_), text);
    }
    complete(control_sends_);
  }

  const WaitClock& wait_clock() const override { return clock_; }
  void set_peer_timeout(double seconds) override { timeout_ = seconds; }

 private:
  static Address address_of(int rank, int tires) {
    if (rank == 0) return {Role::rig, 0};
    if (rank <= tires) return {Role::tire, rank - 1};
    return {Role::terrain, 0};
  }
  int rank_of(Address node) const {
    switch (node.role) {
      case Role::rig: return 0;
      case Role::tire: return 1 + node.index;
      case Role::terrain: break;
    }
    return 1 + tire_count_;  // the terrain's leader
  }

  void post(std::deque<PendingSend>& sends, MPI_Comm comm, int rank, int tag, std::vector<std::byte> payload) {
    complete(sends);
    PendingSend& send = sends.emplace_back();
    send.payload = std::move(payload);
    MPI_Isend(send.payload.data(), static_cast<int>(send.payload.size()), MPI_BYTE, rank, tag, comm, &send.request);
  }

  static void complete(std::deque<PendingSend>& sends) {
    while (!sends.empty()) {
      int done = 0;
      MPI_Test(&sends.front().request, &done, MPI_STATUS_IGNORE);
      if (!done) break;
      sends.pop_front();
    }
  }

  static std::vector<std::byte> take(MPI_Message& message, const MPI_Status& status) {
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    std::vector<std::byte> payload(count);
    MPI_Mrecv(payload.data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    return payload;
  }

  static long pause(int polls, long sleep_ns) {
    if (polls < kYields) {
      sched_yield();
      return 0;
    }
    sleep_ns = sleep_ns == 0 ? kFirstSleep : std::min(2 * sleep_ns, kLongestSleep);
    const timespec length{0, sleep_ns};
    nanosleep(&length, nullptr);
    return sleep_ns;
  }

  void to_all_others(const std::vector<std::byte>& payload) {
    for (int rank = 0; rank < ranks_; ++rank)
      if (rank != world_rank()) post(control_sends_, control_.get(), rank, 0, payload);
  }

  /// Gives what is still under way a moment to leave, so that a failure notice is not lost.
  void drain() {
    for (int i = 0; i < 1000 && !(data_sends_.empty() && control_sends_.empty()); ++i) {
      complete(data_sends_);
      complete(control_sends_);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::unique_ptr<MpiSession> session_;
  int tire_count_;
  Address self_;
  Communicator data_, control_, role_;
  int ranks_;
  std::vector<std::int64_t> heartbeats_;  // control messages heard, per world rank
  std::deque<PendingSend> data_sends_, control_sends_;
  double timeout_ = 60.0, last_heartbeat_ = 0.0;
  WaitClock clock_;
};

}  // namespace

std::unique_ptr<Transport> make_mpi_transport(int* argc, char*** argv, int tire_count, int terrain_ranks) {
  auto session = std::make_unique<MpiSession>(argc, argv);
  const int needed = 1 + tire_count + terrain_ranks, given = world_size();
  if (given != needed)
    throw Error(ExitCode::bad_input,
                fmt::format("mpirun started {} rank(s) but this scenario needs {}: 1 rig, {} tire(s), {} terrain",
                            given, needed, tire_count, terrain_ranks));
  return std::make_unique<MpiTransport>(std::move(session), tire_count);
}

void abandon_mpi(int exit_code) { _exit(exit_code); }

bool launched_by_mpi() {
  return std::getenv("OMPI_COMM_WORLD_RANK") || std::getenv("PMIX_RANK") || std::getenv("PMI_RANK");
}

int launched_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* value = std::getenv(name)) return std::atoi(value);
  return 0;
}

}  // namespace furrow
