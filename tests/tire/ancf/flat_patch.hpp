// A handful of shell elements on any quadrilateral mesh, assembled densely: what the element tests need.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <vector>

#include "tire/ancf/shell_matrices.hpp"

namespace furrow::test {

inline ShellLayer isotropic_layer(double thickness, double young, double poisson) {
  LayerMaterial m;
  m.name = "isotropic";
  m.young_modulus = Vec3::Constant(young);
  m.poisson_ratio = Vec3::Constant(poisson);
  m.shear_modulus = Vec3::Constant(0.5 * young / (1 + poisson));
  return {thickness, 0.0, stiffness(m, "test")};
}

class FlatPatch {
 public:
  /// Nodes in the plane z = 0 with directors along z.
  FlatPatch(std::vector<Vec3> nodes, std::vector<std::array<int, 4>> elements,
            const std::vector<ShellLayer>& layers)
      : elements_(std::move(elements)) {
    reference_.resize(6 * nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) reference_.segment<6>(6 * n) << nodes[n], Vec3::UnitZ();
    for (const auto& e : elements_) {
      stiffness_.push_back(shell_stiffness(gather(reference_, e), layers));
      raw_.push_back(raw_strains(gather(reference_, e)));
    }
  }

  /// 5 elements around a distorted inner quadrilateral of a 2 × 1 rectangle, nodes 0–3 outside, 4–7 inside.
  static FlatPatch distorted(const std::vector<ShellLayer>& layers) {
    return FlatPatch({{0, 0, 0},
                      {2, 0, 0},
                      {2, 1, 0},
                      {0, 1, 0},
                      {0.4, 0.2, 0},
                      {1.5, 0.3, 0},
                      {1.3, 0.8, 0},
                      {0.6, 0.7, 0}},
                     {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}, layers);
  }

  const Eigen::VectorXd& reference() const { return reference_; }
  int nodes() const { return static_cast<int>(reference_.size() / 6); }

  double energy(const Eigen::VectorXd& q) const {
    double total = 0.0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const StrainVector strain = raw_strains(gather(q, elements_[e])) - raw_[e];
      total += 0.5 * strain.dot(stiffness_[e] * strain);
    }
    return total;
  }

  /// Newton's method on the free coordinates; the others keep their value in q.
  void solve(Eigen::VectorXd& q, const std::vector<int>& free, const Eigen::VectorXd& load) const {
    for (int iteration = 0; iteration < 30; ++iteration) {
      Eigen::VectorXd force = -load;
      Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(q.size(), q.size());
      assemble(q, force, tangent);
      Eigen::MatrixXd k(free.size(), free.size());
      Eigen::VectorXd r(free.size());
      for (std::size_t a = 0; a < free.size(); ++a) {
        r[a] = force[free[a]];
        for (std::size_t b = 0; b < free.size(); ++b) k(a, b) = tangent(free[a], free[b]);
      }
      const Eigen::VectorXd change = k.ldlt().solve(r);
      for (std::size_t a = 0; a < free.size(); ++a) q[free[a]] -= change[a];
      if (change.norm() < 1e-14) return;
    }
  }

 private:
  static ElementNodes gather(const Eigen::VectorXd& q, const std::array<int, 4>& e) {
    ElementNodes nodes;
    for (int n = 0; n < 4; ++n) {
      nodes.row(2 * n) = q.segment<3>(6 * e[n]);
      nodes.row(2 * n + 1) = q.segment<3>(6 * e[n] + 3);
    }
    return nodes;
  }
  void assemble(const Eigen::VectorXd& q, Eigen::VectorXd& force, Eigen::MatrixXd& tangent) const {
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const ElementNodes nodes = gather(q, elements_[e]);
      const StrainVector stress = stiffness_[e] * (raw_strains(nodes) - raw_[e]);
      Eigen::Matrix<double, kStrains, 24> b;
      NodeMatrix geometric = NodeMatrix::Zero();
      for (int k = 0; k < kStrains; ++k) {
        const ElementNodes gradient = strain_forms()[k] * nodes;
        for (int a = 0; a < 8; ++a) b.block<1, 3>(k, 3 * a) = gradient.row(a);
        geometric += stress[k] * strain_forms()[k];
      }
      const Eigen::Matrix<double, 24, 1> f = b.transpose() * stress;
      Eigen::Matrix<double, 24, 24> kt = b.transpose() * stiffness_[e] * b;
      for (int a = 0; a < 8; ++a)
        for (int c = 0; c < 8; ++c) kt.block<3, 3>(3 * a, 3 * c) += geometric(a, c) * Mat3::Identity();
      for (int n = 0; n < 4; ++n) {
        force.segment<6>(6 * elements_[e][n]) += f.segment<6>(6 * n);
        for (int m = 0; m < 4; ++m)
          tangent.block<6, 6>(6 * elements_[e][n], 6 * elements_[e][m]) += kt.block<6, 6>(6 * n, 6 * m);
      }
    }
  }

  std::vector<std::array<int, 4>> elements_;
  Eigen::VectorXd reference_;
  std::vector<StrainMatrix> stiffness_;
  std::vector<StrainVector> raw_;
};

}  // namespace furrow::test
