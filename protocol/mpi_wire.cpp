#include "protocol/mpi_wire.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <ctime>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow {
namespace {

constexpr int kLooks = 2;                   // looks for messages in each call of progress()
constexpr int kTests = 4;                   // polls before the first sleep
constexpr double kRungSleep = 50e-3;        // s; longest sleep where every message rings
constexpr double kFirstSleep = 20e-6;       // s
constexpr double kSleepGrowth = 1.5;        // from one sleep to the next
constexpr double kShortWaitSleep = 200e-6;  // s; longest sleep while the wait is short
constexpr double kShareOfWait = 1.0 / 40;   // part of a long wait that may be lost by sleeping too long
constexpr double kMaxSleep = 2e-3;          // s

bool receive_any(const Communicator& comm, int& from, int& tag, Bytes& payload) {
  int there = 0;
  MPI_Message message;
  MPI_Status status;
  MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm.get(), &there, &message, &status);
  if (!there) return false;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  payload.resize(static_cast<std::size_t>(count));
  MPI_Mrecv(payload.data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
  from = status.MPI_SOURCE;
  tag = status.MPI_TAG;
  return true;
}

void sleep_for(double seconds) {
  FURROW_ASSERT(seconds >= 0.0 && seconds < 1.0, seconds);
  const timespec length{0, static_cast<long>(seconds * 1e9)};
  nanosleep(&length, nullptr);
}

/// At most the time already waited: a message that comes without a ring then takes at most twice its time.
double rung_sleep(double waited) { return std::clamp(waited, kShortWaitSleep, kRungSleep); }

/// The n-th sleep of a wait that has lasted `waited` s.
double short_sleep(int n, double waited) {
  const double longest = std::clamp(kShareOfWait * waited, kShortWaitSleep, kMaxSleep);
  return std::min(kFirstSleep * std::pow(kSleepGrowth, std::min(n, 20)), longest);
}

}  // namespace

MpiWire::MpiWire(MpiSession& session, int role)
    : session_(session),
      data_(Communicator::duplicate(MPI_COMM_WORLD)),
      control_(Communicator::duplicate(MPI_COMM_WORLD)),
      role_(Communicator::split(MPI_COMM_WORLD, role)),
      doorbells_(MPI_COMM_WORLD),
      self_(world_rank()),
      nodes_(world_size()) {
  session_.ranks_are_set_up();
}

MpiWire::~MpiWire() {
  drain(1.0);
  // A node that failed never took these messages. Their memory must outlive MPI, which may still access it.
  for (auto* sends : {&sends_, &control_sends_})
    if (!sends->empty()) new std::deque<PendingSend>(std::move(*sends));
}

void MpiWire::send(int to, MessageKind kind, Bytes payload) {
  FURROW_ASSERT(in_range(to, nodes_), to, nodes_);
  post(sends_, data_, to, static_cast<int>(kind), std::move(payload));
}

void MpiWire::send_control(int to, Bytes payload) {
  FURROW_ASSERT(in_range(to, nodes_), to, nodes_);
  post(control_sends_, control_, to, 0, std::move(payload));
}

void MpiWire::post(std::deque<PendingSend>& sends, const Communicator& comm, int to, int tag, Bytes payload) {
  if (payload.size() > static_cast<std::size_t>(INT_MAX))
    throw Error(ExitCode::rank_lost, "a message of more than 2 GiB cannot be sent");
  complete(sends);
  PendingSend& send = sends.emplace_back();
  send.to = to;
  send.payload = std::move(payload);
  MPI_Isend(send.payload.data(), static_cast<int>(send.payload.size()), MPI_BYTE, to, tag, comm.get(), &send.request);
  doorbells_.ring(to);
}

void MpiWire::complete(std::deque<PendingSend>& sends) {
  while (!sends.empty()) {
    int done = 0;
    MPI_Test(&sends.front().request, &done, MPI_STATUS_IGNORE);
    if (!done) break;
    sends.pop_front();
  }
}

void MpiWire::progress() {
  rung_ = doorbells_.own_count();
  // Open MPI's probe first looks at the messages it has taken in, and only then takes in new ones: a new message is
  // found by the second look. After a single look the receiver would go to sleep although a message is there.
  for (int look = 0; look < kLooks; ++look) {
    int from = 0, tag = 0;
    Bytes payload;
    while (receive_any(data_, from, tag, payload)) arrived_[{from, tag}].push_back(std::move(payload));
    while (receive_any(control_, from, tag, payload)) control_arrived_.push_back({from, std::move(payload)});
  }
  complete(sends_);
  complete(control_sends_);
}

int MpiWire::unsent_to() const {
  if (sends_.empty() || session_.receivers_pull()) return -1;
  return sends_.front().to;
}

std::optional<Bytes> MpiWire::take(int from, MessageKind kind) {
  FURROW_ASSERT(in_range(from, nodes_), from, nodes_);
  return pop(arrived_[{from, static_cast<int>(kind)}]);
}

std::optional<ControlBytes> MpiWire::take_control() { return pop(control_arrived_); }

void MpiWire::idle(int polls, double waited) {
  FURROW_ASSERT(polls >= 0 && waited >= 0.0, polls, waited);
  if (polls < kTests) return;
  doorbells_.sleep(rung_, every_message_rings() ? rung_sleep(waited) : short_sleep(polls - kTests, waited));
}

/// A message from this rank may need it to come back to MPI, unless the receivers fetch it.
bool MpiWire::every_message_rings() const {
  return doorbells_.everyone() && (session_.receivers_pull() || (sends_.empty() && control_sends_.empty()));
}

void MpiWire::expect_losses(double patience, int exit_code) noexcept { session_.expect_losses(patience, exit_code); }

/// Gives messages that are still under way a moment to leave, so that a failure notice is not lost.
void MpiWire::drain(double longest) {
  PeerClock clock(longest);
  while (!(sends_.empty() && control_sends_.empty()) && !clock.expired()) {
    progress();
    sleep_for(kShortWaitSleep);
  }
}

}  // namespace furrow
