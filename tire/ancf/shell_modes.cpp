#include "tire/ancf/shell_modes.hpp"

#include <cmath>
#include <complex>
#include <memory>

#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"

namespace furrow::tire {
namespace {

using namespace simd;
using Complex = std::complex<double>;
using Tie = Eigen::Matrix<Complex, 24, 12>;

/// Corners 1 and 2 of an element are in the next column: turned, and ahead in phase.
Tie tie_columns(const ShellMesh& mesh, int order) {
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
  const auto element = std::make_unique<BatchTangent>();
  const Field at_rest(shell.strains_size(), 0.0);
  for (int j = 0; j + 1 < mesh.rows; ++j) {
    Double4 stress[kStrains];
    shell.batch_stress_at(q, at_rest, 1.0, j, 0, stress);
    BatchNodes nodes;
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
  const std::vector<ElementMass> masses = element_masses(file, mesh);
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

Eigen::VectorXd InflatedCarcass::frequencies(int order, int count) const {
  return lowest_squares(stiffness(order), mass(order), count).unaryExpr(&signed_frequency);
}

double InflatedCarcass::smallest_eigenvalue(int order) const {
  return lowest_squares(stiffness(order), mass(order), 1)[0];
}

ModesResults ShellModes::modes(const ModesOptions& options, const ProgressCall& progress) const {
  const auto tell = [&](const char* what, double share) {
    if (progress) progress(what, share);
  };
  tell("inflating", 0.0);
  const InflatedCarcass carcass(file_, [&] { tell("inflating", 0.0); });
  const ShellLayout& layout = carcass.shell.layout();
  ModesResults results;
  results.pressure = file_.pressure;
  results.mass = rigid_mass(carcass.mesh, element_masses(file_, carcass.mesh));
  results.around = carcass.mesh.columns;
  for (int j = 0; j < carcass.mesh.rows; ++j) {
    const Vec3 r = layout.get(carcass.q, 0, j, 0);
    results.section.push_back({r.y(), std::hypot(r.x(), r.z())});
    if (j > 0) results.lines.push_back({j - 1, j});
  }
  for (int order = 0; order <= options.orders; ++order) {
    tell("solving", static_cast<double>(order) / (options.orders + 1));
    const LowestModes lowest = lowest_modes(carcass.stiffness(order), carcass.mass(order), options.count);
    for (int k = 0; k < options.count; ++k)
      results.modes.push_back(mode_of(lowest, order, k, carcass.mesh.rows, [&](const auto& vector, int j) {
        std::array<Complex, 3> node{};  // of a bead: none
        if (j > 0 && j + 1 < carcass.mesh.rows)
          for (int x = 0; x < 3; ++x) node[x] = vector[6 * (j - 1) + x];
        return node;
      }));
  }
  return results;
}

}  // namespace furrow::tire
