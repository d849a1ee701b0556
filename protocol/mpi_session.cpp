#include "protocol/mpi_session.hpp"

#include <sys/prctl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "protocol/abandon_mpi.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow {
namespace {

constexpr char kSingleCopy[] = "OMPI_MCA_btl_vader_single_copy_mechanism";

/// Open MPI moves large messages by reading the other process's memory, and fails if a container forbids that call. If
/// the call is refused on this process itself, Open MPI is set to copy through shared memory instead.
/// @returns whether the memory of other processes can be read
bool choose_copy_mechanism() {
  char from = 1, to = 0;
  const iovec local{&to, 1}, remote{&from, 1};
  if (process_vm_readv(getpid(), &local, 1, &remote, 1, 0) != 1) {
    setenv(kSingleCopy, "none", 0);
    return false;
  }
  int scope = 0;  // Yama: 0 lets processes of one user read each other; Open MPI does not try otherwise
  std::ifstream("/proc/sys/kernel/yama/ptrace_scope") >> scope;
  const char* chosen = std::getenv(kSingleCopy);
  return scope == 0 && (!chosen || std::string(chosen) == "cma");
}

bool one_machine() {
  const Communicator machine = Communicator::machine(MPI_COMM_WORLD);
  return machine.size() == world_size();
}

/// Ends the process if this object lives longer than `patience` seconds of the process's own running time.
class Deadline {
 public:
  Deadline(double patience, int exit_code) : thread_([this, patience, exit_code] { watch(patience, exit_code); }) {}
  ~Deadline() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

 private:
  void watch(double patience, int exit_code) {
    PeerClock clock(patience);
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::milliseconds(50), [this] { return over_; }))
      if (clock.expired()) abandon_mpi(exit_code);
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace

MpiSession::MpiSession(int* argc, char*** argv) {
  [[maybe_unused]] const bool readable = choose_copy_mechanism();
  int provided = 0;
  MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
#if defined(OPEN_MPI)
  receivers_pull_ = readable && one_machine();
#endif
  prctl(PR_SET_TIMERSLACK, 1000UL);  // ns: sleep as long as asked, not up to 50 µs longer
}

MpiSession::~MpiSession() {
  yield_.set(true);
  if (patience_ > 0.0) {
    Deadline deadline(patience_, exit_code_);
    MPI_Finalize();
  } else {
    MPI_Finalize();
  }
}

void MpiSession::ranks_are_set_up() noexcept { yield_.set(false); }

void MpiSession::expect_losses(double patience, int exit_code) noexcept {
  patience_ = patience;
  exit_code_ = exit_code;
}

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

Communicator Communicator::duplicate(MPI_Comm of) {
  MPI_Comm made = MPI_COMM_NULL;
  MPI_Comm_dup(of, &made);
  return Communicator(made);
}

Communicator Communicator::split(MPI_Comm of, int colour) {
  MPI_Comm made = MPI_COMM_NULL;
  MPI_Comm_split(of, colour, world_rank(), &made);
  return Communicator(made);
}

Communicator Communicator::machine(MPI_Comm of) {
  MPI_Comm made = MPI_COMM_NULL;
  MPI_Comm_split_type(of, MPI_COMM_TYPE_SHARED, world_rank(), MPI_INFO_NULL, &made);
  return Communicator(made);
}

Communicator::Communicator(Communicator&& other) noexcept : comm_(std::exchange(other.comm_, MPI_COMM_NULL)) {}

Communicator::~Communicator() {
  if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
}

int Communicator::size() const {
  int size = 0;
  MPI_Comm_size(comm_, &size);
  return size;
}

}  // namespace furrow
