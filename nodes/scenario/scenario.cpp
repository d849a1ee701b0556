#include "nodes/scenario/scenario.hpp"

#include <cmath>

#include "protocol/files/text_file.hpp"

namespace furrow::scenario {

std::vector<std::string> Scenario::file_hashes() const {
  std::vector<std::string> hashes;
  for (const tire::TireOptions& tire : tires)
    hashes.push_back(text_hash(read_text_file(tire.file, "a tire file in JSON")));
  if (!terrain.bed.empty()) hashes.push_back(file_hash(terrain.bed));
  return hashes;
}

std::int64_t RunOptions::steps() const { return std::llround(end / step); }

}  // namespace furrow::scenario
