// Joins two packings that extend into each other: decides which grains of either stay.
//
// Grains of one packing never collide with each other. So the graph of collisions, with an edge between two grains that
// would overlap too much, is bipartite. The most grains that fit together are a largest independent set of this graph.
// It is the complement of a smallest vertex cover [König 1931], found from a largest matching [Hopcroft & Karp 1973,
// doi:10.1137/0202019]. So no grain is squeezed in, and as few as possible are missing. A joint along a plane, where
// one of each two colliding grains is removed, would lack a layer about 0.6 r thick.
#pragma once

#include <vector>

namespace furrow::terrain::dem {

/// conflicts[a]: the grains b of the other packing with which a collides, each once.
using Conflicts = std::vector<std::vector<int>>;

/// The grains that stay: no two of them are in conflict, and no other choice keeps more.
struct SeamChoice {
  std::vector<bool> first, second;
};

/// Among equal choices the second packing is preferred; the result does not depend on the order of conflicts.
/// @pre all b are in [0, second)
SeamChoice most_compatible(const Conflicts& conflicts, int second);

}  // namespace furrow::terrain::dem
