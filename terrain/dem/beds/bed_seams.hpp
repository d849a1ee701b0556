// Where two packings that reach into each other are joined: which grains of either stay.
//
// Grains of one packing never are in each other's way, so the graph of those that are, an edge between two grains that
// would overlap too much, is bipartite. The most grains that may stand together are a largest independent set of it,
// which is what is left without a smallest vertex cover [König 1931], found from a largest matching [Hopcroft & Karp
// 1973, doi:10.1137/0202019]. So no grain is squeezed in, and as few as can be are missing: a joint along a plane, one
// of each two that collide taken away, would lack a layer about 0.6 r thick.
#pragma once

#include <vector>

namespace furrow::terrain::dem {

/// conflicts[a]: the grains b of the other packing that a cannot stand beside, each once.
using Conflicts = std::vector<std::vector<int>>;

/// Who stays: two grains that stay are never in conflict, and no other choice keeps more.
struct SeamChoice {
  std::vector<bool> first, second;
};

/// Where choices are equal the second packing is preferred; the result does not depend on the order of conflicts.
/// @pre all b are in [0, second)
SeamChoice most_compatible(const Conflicts& conflicts, int second);

}  // namespace furrow::terrain::dem
