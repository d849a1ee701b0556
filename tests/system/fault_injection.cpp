// Makes a rank of furrow_faults fail at a named point:
//   FURROW_FAULT=point:rank:count:action   the count-th time that this rank comes to the point
//   FURROW_FAULT_FIRED=file                made when it happens
// Actions: kill (SIGKILL), stop (SIGSTOP), wait (until the file is removed, a minute at most), throw (an exception that
// no code expects), misuse (a precondition that does not hold), say TEXT (fault_text).
// The rank * is every rank.
#include <fcntl.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>

#include <sstream>
#include <stdexcept>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/mpi_transport.hpp"

namespace furrow {
namespace {

struct Fault {
  std::string point, action;
  int rank = -1, count = 0;

  Fault() {
    const char* text = std::getenv("FURROW_FAULT");
    if (!text || !launched_by_mpi()) return;
    std::istringstream in(text);
    std::string number;
    std::getline(in, point, ':');
    std::string number_of_rank;
    std::getline(in, number_of_rank, ':');
    rank = std::atoi(number_of_rank.c_str());
    std::getline(in, number, ':');
    count = std::atoi(number.c_str());
    std::getline(in, action, ':');
    if (number_of_rank != "*" && rank != launched_rank()) point.clear();
  }
};

void fire(const std::string& action) {
  const char* mark = std::getenv("FURROW_FAULT_FIRED");
  if (!mark) return;
  const int file = open(mark, O_WRONLY | O_CREAT, 0666);
  if (file >= 0) close(file);
  if (action == "kill") raise(SIGKILL);
  if (action == "stop") raise(SIGSTOP);
  if (action == "throw") throw std::logic_error("thrown by a test");
  FURROW_ASSERT(action != "misuse", action);
  for (int i = 0; action == "wait" && i < 6000 && access(mark, F_OK) == 0; ++i) usleep(10000);
}

/// Performs the action that is due now, if there is one.
std::string come_to(const char* name) {
  static Fault fault;
  if (!(fault.count > 0 && fault.point == name && --fault.count == 0)) return {};
  fire(fault.action);
  return fault.action;
}

}  // namespace

void fault_point(const char* name) { come_to(name); }

std::string fault_text(const char* name) {
  constexpr char kSay[] = "say ";
  const std::string action = come_to(name);
  return action.rfind(kSay, 0) == 0 ? action.substr(sizeof kSay - 1) : "";
}

}  // namespace furrow
