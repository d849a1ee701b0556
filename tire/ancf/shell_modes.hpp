// An inflated shell on a fixed rim, order by order (tire/modes.hpp): displacements û e^{i n θ} in axes that turn with
// the columns decouple. For each circumferential order n, stiffness and mass of the whole ring are therefore Hermitian
// matrices of a single column. Positions and directors of the beads are held.
#pragma once

#include <Eigen/Dense>

#include "tire/ancf/inflation.hpp"
#include "tire/modes.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

struct InflatedCarcass {
  TireFile file;
  ShellMesh mesh;
  ShellCarcass shell;
  InflationReport report;
  Field q;  // rim axes

  /// @param each_step as in inflate(). @throws Error(physics) as inflate()
  explicit InflatedCarcass(const TireFile& tire, const std::function<void()>& each_step = {})
      : file(tire), mesh(make_shell_mesh(file)), shell(file, mesh), q(inflate(shell, mesh, report, each_step)) {}

  /// Unknowns: position x, y, z and director x, y, z of each row between the beads, in the axes of column 0.
  Eigen::MatrixXcd stiffness(int order) const;  // per column, N/m
  Eigen::MatrixXcd mass(int order) const;       // kg
  /// The lowest `count` natural frequencies of an order, Hz; negative: growth rate over 2π of an unstable mode.
  Eigen::VectorXd frequencies(int order, int count) const;
  /// Smallest eigenvalue ω², 1/s²; negative if the ring is unstable as a static body.
  double smallest_eigenvalue(int order) const;
};

class ShellModes final : public ModalTest {
 public:
  explicit ShellModes(const TireFile& file) : file_(file) {}
  int sections() const override { return file_.elements_circumference; }
  int unknowns() const override { return 6 * (file_.elements_width() - 1); }
  ModesResults modes(const ModesOptions& options, const ProgressCall& progress) const override;

 private:
  TireFile file_;
};

}  // namespace furrow::tire
