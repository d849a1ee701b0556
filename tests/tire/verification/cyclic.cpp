#include "tests/tire/verification/cyclic.hpp"

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"

namespace furrow::test {
namespace {

using namespace simd;
using Complex = std::complex<double>;
using Tie = Eigen::Matrix<Complex, 24, 12>;

/// Corners 1 and 2 of an element lie one column on: turned, and ahead in phase.
Tie tie_columns(const tire::ShellMesh& mesh, int order) {
  Tie t = Tie::Zero();
  const Complex phase = std::polar(1.0, order * mesh.pitch());
  for (int n = 0; n < 4; ++n)
    for (const int s : {0, 3}) {
      const bool next = n == 1 || n == 2;
      const Mat3 turn = next ? mesh.turn(1) : Mat3::Identity();
      t.block<3, 3>(6 * n + s, (n < 2 ? 0 : 6) + s) = (next ? phase : Complex(1.0)) * turn.cast<Complex>();
    }
  return t;
}

Eigen::MatrixXcd between_beads(const Eigen::MatrixXcd& all) {
  return all.block(6, 6, all.rows() - 12, all.cols() - 12);
}

}  // namespace

Eigen::MatrixXcd InflatedCarcass::stiffness(int order) const {
  const Tie tie = tie_columns(mesh, order);
  Eigen::MatrixXcd k = Eigen::MatrixXcd::Zero(6 * mesh.rows, 6 * mesh.rows);
  const auto element = std::make_unique<tire::BatchTangent>();
  const tire::Field at_rest(shell.strains_size(), 0.0);
  for (int j = 0; j + 1 < mesh.rows; ++j) {
    Double4 stress[tire::kStrains];
    shell.batch_stress_at(q, at_rest, 1.0, j, 0, stress);
    tire::BatchNodes nodes;
    nodes.read(shell.layout(), q.data(), 0, j);
    element->compute(shell.stiffness(j), nodes, stress, 1.0, 1.0, shell.pressure());
    Eigen::Matrix<double, 24, 24> e;
    for (int a = 0; a < 24; ++a)
      for (int b = 0; b <= a; ++b) e(a, b) = e(b, a) = element->k[a][b][0];
    k.block<12, 12>(6 * j, 6 * j) += tie.adjoint() * e.cast<Complex>() * tie;
  }
  return between_beads(k);
}

Eigen::MatrixXcd InflatedCarcass::mass(int order) const {
  const Tie tie = tie_columns(mesh, order);
  const std::vector<tire::ElementMass> masses = tire::element_masses(file, mesh);
  Eigen::MatrixXcd m = Eigen::MatrixXcd::Zero(6 * mesh.rows, 6 * mesh.rows);
  for (int j = 0; j + 1 < mesh.rows; ++j) {
    Eigen::Matrix<Complex, 24, 24> e = Eigen::Matrix<Complex, 24, 24>::Zero();
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        for (int x = 0; x < 3; ++x) e(3 * a + x, 3 * b + x) = masses[j](a, b);
    m.block<12, 12>(6 * j, 6 * j) += tie.adjoint() * e * tie;
  }
  return between_beads(m);
}

Vector InflatedCarcass::frequencies(int order, int count) const {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(stiffness(order), mass(order),
                                                                          Eigen::EigenvaluesOnly);
  const Vector squares = solver.eigenvalues().head(count);
  return squares.cwiseSign().cwiseProduct(squares.cwiseAbs().cwiseSqrt()) / (2 * std::numbers::pi);
}

double InflatedCarcass::smallest_eigenvalue(int order) const {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd>(stiffness(order), mass(order),
                                                                    Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

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
