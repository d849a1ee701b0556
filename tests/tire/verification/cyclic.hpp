// The ring of an inflated tire, order by order (tire/ancf/shell_modes.hpp), and as a patch of elements.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tire/ancf/shell_modes.hpp"

namespace furrow::test {

using tire::InflatedCarcass;

/// The elements of the ring as a patch with the layers of the tread everywhere: all columns, or one.
PatchMesh ring_patch_mesh(const tire::ShellMesh& ring, bool one_column);

/// Displacements of chosen coordinates of a column by unit forces on those of another, `d` columns away, for each d
/// from 0 to `columns` − 1, in the columns' own axes, m/N. @param size how many are chosen. @param place which
/// coordinate the k-th is
std::vector<Eigen::MatrixXd> compliance_by_distance(const InflatedCarcass& ring, int columns, int size,
                                                    const std::function<int(int)>& place);

}  // namespace furrow::test
