#include "tests/tire/verification/cyclic.hpp"

#include <complex>

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
      mesh.elements.push_back({ring.node(i, j), ring.node(next, j), ring.node(next, j + 1), ring.node(i, j + 1)});
    }
  return mesh;
}

std::vector<Eigen::MatrixXd> compliance_by_distance(const InflatedCarcass& ring, int columns, int size,
                                                    const std::function<int(int)>& place) {
  const int all = ring.mesh.columns;
  std::vector<Eigen::MatrixXd> between(columns, Eigen::MatrixXd::Zero(size, size));
  for (int order = 0; order <= all / 2; ++order) {
    const Eigen::MatrixXcd k = ring.stiffness(order);
    Eigen::MatrixXcd unit = Eigen::MatrixXcd::Zero(k.rows(), size), answer(size, size);
    for (int c = 0; c < size; ++c) unit(place(c), c) = 1.0;
    const Eigen::MatrixXcd u = k.partialPivLu().solve(unit);
    for (int r = 0; r < size; ++r) answer.row(r) = u.row(place(r));
    const double share = (order == 0 || 2 * order == all ? 1.0 : 2.0) / all;
    for (int d = 0; d < columns; ++d)
      between[d] += share * (std::polar(1.0, order * d * ring.mesh.pitch()) * answer).real();
  }
  return between;
}

}  // namespace furrow::test
