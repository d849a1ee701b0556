#include "tire/ancf/rim_clearance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {
constexpr double kTorn = 2.0;         // undeformed radii: no part of a tire gets so far from its axle
constexpr double kMaxOfHeight = 0.5;  // of a node's undeformed height that its half thickness may take
}  // namespace

RimClearance::RimClearance(const TireFile& file, const ShellMesh& mesh)
    : radius_(std::max(mesh.position.front().z(), mesh.position.back().z())),
      half_width_(std::max(-mesh.position.front().y(), mesh.position.back().y())),
      limit_(kTorn * file.radius),
      inside_(mesh.rows) {
  for (int j = 1; j + 1 < mesh.rows; ++j) {
    const double thickness = std::max(file.section(j - 1).thickness(), file.section(j).thickness());
    const double height = std::max(0.0, mesh.position[j].z() - radius_);
    inside_[j] = std::min(0.5 * thickness, kMaxOfHeight * height);
  }
}

RimClearance::Nodes RimClearance::measure(const ShellLayout& layout, const Field& q, const RimState& rim) const {
  FURROW_ASSERT(q.size() == layout.size(), q.size(), layout.size());
  FURROW_ASSERT(inside_.size() == static_cast<std::size_t>(layout.rows), inside_.size(), layout.rows);
  const Vec3 axle = rim.orientation * Vec3::UnitY();
  Nodes nodes;
  double far = 0.0;
  for (int j = 1; j + 1 < layout.rows; ++j) {
    const double* x[3];
    for (int c = 0; c < 3; ++c) x[c] = q.data() + layout.offset(j, c);
    double nearest = 1e300;
    for (int i = 0; i < layout.columns; ++i) {
      const double dx = x[0][i] - rim.position.x(), dy = x[1][i] - rim.position.y(), dz = x[2][i] - rim.position.z();
      const double along = dx * axle.x() + dy * axle.y() + dz * axle.z(), square = dx * dx + dy * dy + dz * dz;
      if (!(square <= far)) {
        far = std::isfinite(square) ? square : std::numeric_limits<double>::infinity();
        nodes.far_column = i, nodes.far_row = j;
      }
      if (std::abs(along) > half_width_) continue;
      const double radial = square - along * along;
      if (radial >= nearest) continue;
      nearest = radial;
      const double clearance = std::sqrt(std::max(0.0, radial)) - inside_[j] - radius_;
      if (clearance < nodes.clearance) nodes.clearance = clearance, nodes.column = i, nodes.row = j;
    }
  }
  nodes.farthest = std::sqrt(far);
  return nodes;
}

Outcome RimClearance::outcome(const Nodes& nodes) const {
  if (!(nodes.farthest < limit_))
    return Outcome::failure(
        "lost its shape",
        fmt::format("its node at column {}, row {} is {:.3g} m from the rim's centre, expected below {:.3g} m; try a "
                    "smaller run.step, a lower pressure or less load",
                    nodes.far_column, nodes.far_row, nodes.farthest, limit_));
  if (nodes.clearance < 0.0)
    return Outcome::failure(
        "reached its rim",
        fmt::format("clearance {:.2g} m at the node of column {}, row {} (from the left bead), to the rim's cylinder "
                    "of "
                    "{:.4g} m radius; contact of tire and rim is not modelled: try a higher pressure, less load or a "
                    "smaller drop",
                    nodes.clearance, nodes.column, nodes.row, radius_));
  return {};
}

}  // namespace furrow::tire
