#include "nodes/scenario/scenario.hpp"

#include <cmath>
#include <fstream>
#include <iterator>

#include "protocol/core/hash.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::scenario {
namespace {

std::string file_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<std::string> Scenario::file_hashes() const {
  std::vector<std::string> hashes;
  const auto add = [&](const std::string& bytes) {
    Hash hash;
    hash.add(bytes);
    hashes.push_back(hash.hex());
  };
  for (const auto& tire : tires) add(read_text_file(tire->options().file, "a tire file in JSON"));
  if (!terrain.bed.empty()) add(file_bytes(terrain.bed));
  return hashes;
}

std::int64_t RunOptions::steps() const { return std::llround(end / step); }

}  // namespace furrow::scenario
