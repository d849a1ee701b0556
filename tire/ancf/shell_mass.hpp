// Consistent mass of the ring as a stencil. By rotational symmetry, each node row has one set of coefficients for all
// columns and Cartesian components.
#pragma once

#include "protocol/core/assert.hpp"
#include "tire/ancf/shell_layout.hpp"
#include "tire/shell_mesh.hpp"

namespace furrow::tire {

class ShellMass {
 public:
  ShellMass(const ShellMesh& mesh, std::vector<ElementMass> elements);

  /// out = factor × M field; the padding of `field` must be filled, the padding of `out` is not changed.
  /// @pre both have the layout's size and are different fields
  void apply(const Field& field, double factor, Field& out) const;
  /// out += factor × M field.
  void add(const Field& field, double factor, Field& out) const;
  /// out = M g, the weights of the nodes under this gravity (m/s²), N; padding zero.
  void weigh(const Vec3& gravity, Field& out) const;
  const ElementMass& element(int j) const {
    FURROW_ASSERT(in_range(j, elements_.size()), j, elements_.size());
    return elements_[j];
  }

 private:
  struct Row {
    double c[2][3][3][2] = {};  // [s of the target][dj + 1][di + 1][s of the source]
  };
  ShellLayout layout_;
  std::vector<ElementMass> elements_;
  std::vector<Row> rows_;
};

}  // namespace furrow::tire
