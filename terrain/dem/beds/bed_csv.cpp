#include "terrain/dem/beds/bed_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::size_t kCheckEvery = 1024;  // lines

/// Reads one number and the character after it.
bool number(const char*& at, char end, double& value) {
  char* after = nullptr;
  value = std::strtod(at, &after);
  if (after == at || !std::isfinite(value)) return false;
  while (*after == ' ' || *after == '\r') ++after;
  if (*after != end) return false;
  at = after + (end != '\0');
  return true;
}

}  // namespace

std::vector<Quad> read_positions_csv(const std::filesystem::path& file, const ProgressCall& progress) {
  if (std::error_code error; !std::filesystem::exists(file, error))
    throw input_error(file.string(), "", "does not exist, expected a CSV file of positions");
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) throw io_error(file.string(), "the bed cannot be read");
  if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // a byte-order mark, as spreadsheets write it
  std::erase_if(line, [](char c) { return c == '\r' || c == ' '; });
  const bool radii = line == "x_m,y_m,z_m,radius_m";
  if (line != "x_m,y_m,z_m" && !radii)
    throw input_error(
        file.string(), "line 1",
        "'" + line.substr(0, 60) + "', expected the header x_m,y_m,z_m or x_m,y_m,z_m,radius_m");
  std::vector<Quad> positions;
  PacedCall tell(progress);
  for (std::size_t row = 2; std::getline(in, line); ++row) {
    if (row % kCheckEvery == 0) tell("reading the bed", 0.0);
    if (line.empty() || line == "\r") continue;
    Quad p;
    const char* at = line.c_str();
    const bool three = number(at, ',', p.x) && number(at, ',', p.y) && number(at, radii ? ',' : '\0', p.z);
    if (!three || (radii && !number(at, '\0', p.w)))
      throw input_error(
          file.string(), "line " + std::to_string(row),
          "'" + line.substr(0, 60) + "', expected " + (radii ? "four" : "three") + " finite numbers, m");
    positions.push_back(p);
  }
  if (in.bad()) throw io_error(file.string(), "the bed cannot be read to its end");
  if (positions.empty()) throw input_error(file.string(), "", "holds no grain");
  return positions;
}

void write_positions_csv(const std::filesystem::path& file, std::span<const Quad> positions, double y) {
  std::ofstream out(file);
  out.precision(17);
  const bool radii = std::any_of(positions.begin(), positions.end(),
                                 [&](const Quad& p) { return p.w != positions.front().w; });
  out << "x_m,y_m,z_m" << (radii ? ",radius_m\n" : "\n");
  for (const Quad& p : positions) {
    out << p.x << ',' << p.y + y << ',' << p.z;
    if (radii) out << ',' << p.w;
    out << '\n';
  }
  if (!out.flush()) throw io_error(file.string(), "the bed cannot be written");
}

}  // namespace furrow::terrain::dem
