// An axisymmetric tire seen order by order: displacements û e^{i n θ} in axes that turn with the columns decouple, so
// that stiffness and mass of the whole ring are one Hermitian matrix of a single column per circumferential order n.
//   Thomas (1979), Dynamics of rotationally periodic structures, Int. J. Numer. Methods Eng. 14:81.
#pragma once

#include <Eigen/Dense>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {

struct InflatedCarcass {
  tire::TireFile file;
  tire::ShellMesh mesh;
  tire::ShellCarcass shell;
  tire::InflationReport report;
  tire::Field q;  // rim axes

  explicit InflatedCarcass(const tire::TireFile& tire)
      : file(tire),
        mesh(tire::make_shell_mesh(file)),
        shell(file, mesh),
        q(tire::inflate(shell, mesh, report)) {}

  Eigen::MatrixXcd stiffness(int order) const;  // per column, N/m
  Eigen::MatrixXcd mass(int order) const;       // kg
  /// The lowest `count` natural frequencies of an order, Hz; negative: growth rate over 2π of what is unstable.
  Vector frequencies(int order, int count) const;
  /// Smallest eigenvalue ω², 1/s², below zero where the ring is unstable as a static body.
  double smallest_eigenvalue(int order) const;
};

/// The elements of the ring as a patch with the layers of the tread everywhere: all columns, or one.
PatchMesh ring_patch_mesh(const tire::ShellMesh& ring, bool one_column);

}  // namespace furrow::test
