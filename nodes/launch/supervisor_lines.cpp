#include "nodes/launch/supervisor_lines.hpp"

#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"

namespace furrow::launch {
namespace {

using nlohmann::json;

constexpr std::string_view kMark = "@furrow ";
constexpr std::array<const char*, 7> kKinds{"started", "progress", "note", "error", "begun", "read", "ended"};
constexpr std::size_t kMaxLine = 4096;  // bytes: PIPE_BUF of Linux, which a write keeps together

}  // namespace

std::string encode(const RankLine& line) {
  FURROW_ASSERT(in_range(static_cast<int>(line.kind), kKinds.size()), static_cast<int>(line.kind));
  FURROW_ASSERT(line.rank >= 0, line.rank);
  json j{{"kind", kKinds[static_cast<std::size_t>(line.kind)]}, {"rank", line.rank}};
  if (line.kind == RankLine::Kind::error || line.kind == RankLine::Kind::ended) j["code"] = static_cast<int>(line.code);
  if (line.kind == RankLine::Kind::progress) {
    const Progress& p = line.progress;
    j["phase"] = p.phase;
    if (!p.note.empty()) j["note"] = p.note;
    j["values"] = {p.share, p.time, p.end, p.pull, p.sinkage, p.speed, p.eta};
  }
  std::string text = line.text, encoded;
  do {
    if (!text.empty()) j["text"] = text;
    encoded = std::string(kMark) + j.dump(-1, ' ', true, json::error_handler_t::replace) + "\n";
    text.resize(text.size() * 3 / 4);
  } while (encoded.size() > kMaxLine && !text.empty());
  return encoded;
}

std::optional<RankLine> decode(std::string_view text) {
  if (!text.starts_with(kMark)) return std::nullopt;
  const json j = json::parse(text.substr(kMark.size()), nullptr, false);
  if (!j.is_object()) return std::nullopt;
  RankLine line;
  try {
    std::size_t kind = 0;
    while (kind < kKinds.size() && j.at("kind") != kKinds[kind]) ++kind;
    if (kind == kKinds.size()) return std::nullopt;
    line.kind = static_cast<RankLine::Kind>(kind);
    line.rank = j.at("rank");
    line.text = j.value("text", std::string());
    line.code = static_cast<ExitCode>(j.value("code", 0));
    if (line.kind == RankLine::Kind::progress) {
      Progress& p = line.progress;
      p.phase = j.at("phase");
      p.note = j.value("note", std::string());
      const json& v = j.at("values");
      double* const fields[] = {&p.share, &p.time, &p.end, &p.pull, &p.sinkage, &p.speed, &p.eta};
      for (std::size_t i = 0; i < std::size(fields); ++i)
        *fields[i] = v.at(i).is_number() ? v.at(i).get<double>() : NAN;  // null: not measured
    }
  } catch (const json::exception&) {
    return std::nullopt;
  }
  return line;
}

std::string supervisor_name() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return std::string(host.data()) + ":" + std::to_string(getpid());
}

bool supervisor_lives() {
  const char* value = std::getenv(kSupervisedVariable);
  const std::string name = value ? value : "", self = supervisor_name();
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos || name.substr(0, colon) != self.substr(0, self.rfind(':'))) return true;
  const int process = std::atoi(name.c_str() + colon + 1);
  return process <= 0 || kill(process, 0) == 0 || errno != ESRCH;
}

}  // namespace furrow::launch
