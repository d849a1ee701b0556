#include "terrain/dem/beds/bed_seams.hpp"

#include <cstddef>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr int kNone = -1, kFar = std::numeric_limits<int>::max();

/// A largest matching, found in rounds of shortest augmenting paths that do not meet.
class Matching {
 public:
  Matching(const Conflicts& edges, int second)
      : edges_(edges), mate_of_first_(edges.size(), kNone), mate_of_second_(second, kNone) {
    while (layers())
      for (int a = 0; a < static_cast<int>(edges_.size()); ++a)
        if (mate_of_first_[a] == kNone) augment(a);
  }
  int mate_of_first(int a) const { return mate_of_first_[a]; }
  int mate_of_second(int b) const { return mate_of_second_[b]; }

 private:
  /// Numbers the first grains by their distance from those without a mate. Returns false if no path leads to a second
  /// grain without one.
  bool layers() {
    depth_.assign(edges_.size(), kFar);
    next_.assign(edges_.size(), 0);
    std::vector<int> queue;
    for (std::size_t a = 0; a < edges_.size(); ++a)
      if (mate_of_first_[a] == kNone) depth_[a] = 0, queue.push_back(static_cast<int>(a));
    bool found = false;
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const int b : edges_[queue[k]]) {
        const int a = mate_of_second_[b];
        if (a == kNone) {
          found = true;
        } else if (depth_[a] == kFar) {
          depth_[a] = depth_[queue[k]] + 1;
          queue.push_back(a);
        }
      }
    return found;
  }

  /// Follows the layers from `start`, using an edge of each grain at most once in a round. If the path ends at a second
  /// grain without a mate, its edges are exchanged.
  void augment(int start) {
    std::vector<int> path{start};  // first grains; next_[a] − 1 is the edge by which a is left
    while (!path.empty()) {
      const int a = path.back();
      if (next_[a] == edges_[a].size()) {
        depth_[a] = kFar;
        path.pop_back();
        continue;
      }
      const int b = edges_[a][next_[a]++], other = mate_of_second_[b];
      if (other != kNone) {
        if (depth_[other] == depth_[a] + 1) path.push_back(other);
        continue;
      }
      for (const int on_path : path) {
        const int taken = edges_[on_path][next_[on_path] - 1];
        mate_of_first_[on_path] = taken;
        mate_of_second_[taken] = on_path;
        depth_[on_path] = kFar;  // no other path of this round uses it
      }
      return;
    }
  }

  const Conflicts& edges_;
  std::vector<int> mate_of_first_, mate_of_second_;
  std::vector<int> depth_;
  std::vector<std::size_t> next_;
};

}  // namespace

SeamChoice most_compatible(const Conflicts& conflicts, int second) {
  for (const std::vector<int>& of_a : conflicts)
    for (const int b : of_a) FURROW_ASSERT(in_range(b, second), b, second);
  const Matching matching(conflicts, second);
  // Finds all grains on paths that leave first grains by any edge and second grains by their mate. The smallest cover
  // consists of the first grains that are not reached and the second grains that are.
  SeamChoice stays;
  stays.first.assign(conflicts.size(), false);
  stays.second.assign(second, true);
  std::vector<int> queue;
  for (int a = 0; a < static_cast<int>(conflicts.size()); ++a)
    if (matching.mate_of_first(a) == kNone) stays.first[a] = true, queue.push_back(a);
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const int b : conflicts[queue[k]]) {
      stays.second[b] = false;
      const int a = matching.mate_of_second(b);
      if (a == kNone || stays.first[a]) continue;
      stays.first[a] = true;
      queue.push_back(a);
    }
  return stays;
}

}  // namespace furrow::terrain::dem
