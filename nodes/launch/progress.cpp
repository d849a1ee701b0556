#include "nodes/launch/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "protocol/core/clock.hpp"
#include "protocol/files/digits.hpp"

namespace furrow::launch {
namespace {

constexpr double kTerminalInterval = 0.2;  // s between redrawings
constexpr double kPlainInterval = 5.0;     // s between lines
constexpr double kShareForGuess = 0.005;   // of the run, before which the time left is anyone's guess
constexpr std::size_t kPlainWidth = 80;    // of a terminal that does not say

std::string duration_text(double seconds) {
  const long s = std::lround(std::min(seconds, 1e7));
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kPlainWidth;
}

}  // namespace

std::string progress_text(const Progress& p) {
  if (p.phase != "running") {
    if (p.share <= 0.0 || p.share >= 1.0) return p.phase;
    const std::string left =
        p.eta >= 0.0 && p.share >= kShareForGuess ? fmt::format("   {} left", duration_text(p.eta)) : "";
    return fmt::format("{} {:.0f} %{}", p.phase, 100.0 * p.share, left);
  }
  std::string text = fmt::format("t {:.3f} of {:g} s", p.time, p.end);
  if (!std::isnan(p.pull)) text += fmt::format("   pull {} N", digits(p.pull));
  text += fmt::format("   sinkage {} mm   {} m/s", digits(1e3 * p.sinkage), digits(p.speed));
  if (!p.note.empty()) text += "   " + p.note;
  if (p.eta >= 0.0 && p.share >= kShareForGuess) text += fmt::format("   {} left", duration_text(p.eta));
  return text;
}

ProgressDisplay::ProgressDisplay() {
  const char* terminal = std::getenv("TERM");
  terminal_ = isatty(STDERR_FILENO) == 1 && terminal && std::strcmp(terminal, "dumb") != 0;
}

void ProgressDisplay::show(const Progress& progress) {
  const double now = wall_clock();
  const bool new_phase = progress.phase != phase_;
  if (!new_phase && now - last_ < (terminal_ ? kTerminalInterval : kPlainInterval)) return;
  last_ = now;
  phase_ = progress.phase;
  std::string text = "furrow: " + progress_text(progress);
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  const std::size_t width = terminal_width();
  if (text.size() >= width) text.resize(width - 1);
  std::fprintf(stderr, "\r%s\033[K", text.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressDisplay::say(const std::string& text) {
  clear();
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

void ProgressDisplay::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace furrow::launch
