#include "nodes/launch/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "nodes/launch/messages.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/printable.hpp"

namespace furrow::launch {
namespace {

constexpr double kTerminalInterval = 0.2;  // s between redrawings
constexpr double kPlainInterval = 5.0;     // s between lines
constexpr double kShareForGuess = 0.005;   // of the run, before which the time left cannot be estimated
constexpr std::size_t kPlainWidth = 80;    // of a terminal that does not report its width
constexpr unsigned short kLeastWidth = 8;  // least width that a terminal may report

std::string duration_text(double seconds) {
  const long s = std::lround(std::min(seconds, 1e7));
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= kLeastWidth ? size.ws_col : kPlainWidth;
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
  if (p.eta >= 0.0 && p.share >= kShareForGuess)  // first, because narrow terminals cut the end
    text += fmt::format("   {} left", duration_text(p.eta));
  if (!std::isnan(p.pull)) text += fmt::format("   pull {} N", digits(p.pull));
  text += fmt::format("   sinkage {} mm   {} m/s", digits(1e3 * p.sinkage), digits(p.speed));
  if (!p.note.empty()) text += "   " + p.note;
  return text;
}

double share_in(std::string_view line) {
  double time = 0.0, end = 0.0;
  const bool read = std::sscanf(std::string(line).c_str(), "furrow: t %lf of %lf s", &time, &end) == 2;
  return read && end > 0.0 ? std::clamp(time / end, 0.0, 1.0) : NAN;
}

double PhaseClock::time_left(const std::string& phase, double share, double now) {
  if (phase != phase_) phase_ = phase, begin_ = now, begin_share_ = share;
  const double done = share - begin_share_;
  return done > 0.0 ? (now - begin_) * (1.0 - share) / done : -1.0;
}

ProgressDisplay::ProgressDisplay() {
  const char* terminal = std::getenv("TERM");
  terminal_ = isatty(STDERR_FILENO) == 1 && terminal && std::strcmp(terminal, "dumb") != 0;
}

void ProgressDisplay::show(const Progress& progress) {
  if (messages_are_silenced()) return;
  const double now = wall_clock();
  const double left = clock_.time_left(progress.phase, progress.share, now);
  const bool new_phase = progress.phase != phase_;
  if (!new_phase && now - last_ < (terminal_ ? kTerminalInterval : kPlainInterval)) return;
  last_ = now;
  phase_ = progress.phase;
  Progress shown = progress;
  if (shown.eta < 0.0 && shown.phase != "running") shown.eta = left;
  const std::string text = "furrow: " + progress_text(shown);
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  std::fprintf(stderr, "\r%s\033[K", excerpt(text, terminal_width() - 1).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressDisplay::say(const std::string& text) {
  if (!messages_are_silenced()) say_error(text);
}

void ProgressDisplay::say_error(const std::string& text) {
  clear();
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

void ProgressDisplay::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

ProgressCall shown_on(ProgressDisplay& display, const std::string& when) {
  return [&display, when](const std::string& what, double share) {
    if (stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal" + fmt::format(fmt::runtime(when), what));
    if (what.starts_with(kWarning))
      display.say_error("furrow: " + what);
    else
      display.show({.phase = what, .share = share});
  };
}

}  // namespace furrow::launch
