#include "tests/tire/verification/cyclic.hpp"

namespace furrow::test {

PatchMesh ring_patch_mesh(const tire::ShellMesh& ring, bool one_column) {
  PatchMesh mesh;
  const int columns = one_column ? 2 : ring.columns;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < ring.rows; ++j) {
      mesh.position.push_back(ring.node_position(i, j));
      mesh.director.push_back(ring.turn(i) * ring.director[j]);
    }
  for (int i = 0; i < (one_column ? 1 : columns); ++i)
    for (int j = 0; j + 1 < ring.rows; ++j) {
      const int next = (i + 1) % columns;
      mesh.elements.push_back(
          {ring.node(i, j), ring.node(next, j), ring.node(next, j + 1), ring.node(i, j + 1)});
    }
  return mesh;
}

}  // namespace furrow::test
