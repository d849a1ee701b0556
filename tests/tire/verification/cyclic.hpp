// The ring of an inflated tire, order by order (tire/ancf/shell_modes.hpp), and as a patch of elements.
#pragma once

#include <Eigen/Dense>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tire/ancf/shell_modes.hpp"

namespace furrow::test {

using tire::InflatedCarcass;

/// The elements of the ring as a patch with the layers of the tread everywhere: all columns, or one.
PatchMesh ring_patch_mesh(const tire::ShellMesh& ring, bool one_column);

}  // namespace furrow::test
