#include "terrain/dem/beds/bed_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "protocol/files/printable.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::size_t kMaxLine = 1024;     // bytes
constexpr std::size_t kCheckEvery = 1024;  // lines
constexpr std::size_t kShown = 30;         // of a line in messages: other files should not be printed

/// The lines of a file; a line longer than kMaxLine is an error.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : name_(file.string()), in_(file) {}

  /// The next line, without its end; null at the end of the file. @throws Error(bad_input) if it is not a line of text
  char* next() {
    if (!in_.getline(line_.data(), kMaxLine)) {
      if (in_.bad() || (row_ == 0 && !in_.eof() && in_.gcount() == 0))
        throw io_error(name_, row_ == 0 ? "the bed cannot be read" : "the bed cannot be read to its end");
      if (in_.gcount() == 0) return nullptr;
    }
    ++row_;
    if (in_.fail())
      throw wrong("is longer than " + std::to_string(kMaxLine - 1) + " bytes, expected a CSV file of positions");
    const std::size_t length = static_cast<std::size_t>(in_.gcount()) - (in_.eof() ? 0 : 1);  // without the line's end
    if (std::strlen(line_.data()) != length) throw wrong("holds a zero byte, expected a CSV file of positions");
    return line_.data();
  }
  Error wrong(const std::string& what) const { return input_error(name_, "line " + std::to_string(row_), what); }

 private:
  std::string name_;
  std::ifstream in_;
  std::array<char, kMaxLine> line_{};
  std::size_t row_ = 0;
};

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
  Lines lines(file);
  const char* const first = lines.next();
  if (!first) throw input_error(file.string(), "", "is empty, expected a CSV file of positions");
  std::string header = first;
  if (header.starts_with("\xEF\xBB\xBF")) header.erase(0, 3);  // a byte-order mark, which spreadsheets write
  std::erase_if(header, [](char c) { return c == '\r' || c == ' '; });
  const bool radii = header == "x_m,y_m,z_m,radius_m";
  if (header != "x_m,y_m,z_m" && !radii)
    throw lines.wrong("'" + excerpt(header, kShown) + "', expected the header x_m,y_m,z_m or x_m,y_m,z_m,radius_m");
  std::vector<Quad> positions;
  PacedCall tell(progress);
  for (std::size_t row = 2; const char* const line = lines.next(); ++row) {
    if (row % kCheckEvery == 0) tell("reading the bed", 0.0);
    if (*line == '\0' || std::strcmp(line, "\r") == 0) continue;
    Quad p;
    const char* at = line;
    const bool three = number(at, ',', p.x) && number(at, ',', p.y) && number(at, radii ? ',' : '\0', p.z);
    if (!three || (radii && !number(at, '\0', p.w)))
      throw lines.wrong("'" + excerpt(line, kShown) + "', expected " + (radii ? "four" : "three") +
                        " finite numbers, m");
    positions.push_back(p);
  }
  if (positions.empty()) throw input_error(file.string(), "", "holds no grain");
  return positions;
}

void write_positions_csv(const std::filesystem::path& file, std::span<const Quad> positions, double y) {
  std::ofstream out(file);
  out.precision(17);
  const bool radii =
      std::any_of(positions.begin(), positions.end(), [&](const Quad& p) { return p.w != positions.front().w; });
  out << "x_m,y_m,z_m" << (radii ? ",radius_m\n" : "\n");
  for (const Quad& p : positions) {
    out << p.x << ',' << p.y + y << ',' << p.z;
    if (radii) out << ',' << p.w;
    out << '\n';
  }
  if (!out.flush()) throw io_error(file.string(), "the bed cannot be written");
}

}  // namespace furrow::terrain::dem
