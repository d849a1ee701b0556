#include "tire/ancf/shell_mass.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {
constexpr int kColumn[4] = {0, 1, 1, 0}, kRow[4] = {0, 0, 1, 1};  // of a corner in its element
}

ShellMass::ShellMass(const ShellMesh& mesh, std::vector<ElementMass> elements)
    : layout_{mesh.columns, mesh.rows}, elements_(std::move(elements)), rows_(mesh.rows) {
  FURROW_ASSERT(elements_.size() == static_cast<std::size_t>(mesh.elements_width()), elements_.size(),
                mesh.elements_width());
  for (int e = 0; e < mesh.elements_width(); ++e)
    for (int n = 0; n < 4; ++n)
      for (int m = 0; m < 4; ++m)
        for (int s = 0; s < 2; ++s)
          for (int t = 0; t < 2; ++t)
            rows_[e + kRow[n]].c[s][kRow[m] - kRow[n] + 1][kColumn[m] - kColumn[n] + 1][t] +=
                elements_[e](2 * n + s, 2 * m + t);
}

void ShellMass::apply(const Field& field, double factor, Field& out) const {
  FURROW_ASSERT(out.size() == layout_.size(), out.size(), layout_.size());
  for (int j = 0; j < layout_.rows; ++j)
    for (int c = 0; c < 6; ++c) {
      double* to = out.data() + layout_.offset(j, c);
      std::fill(to, to + layout_.columns, 0.0);
    }
  add(field, factor, out);
}

void ShellMass::add(const Field& field, double factor, Field& out) const {
  FURROW_ASSERT(field.size() == layout_.size() && out.size() == layout_.size(), field.size(), out.size(),
                layout_.size());
  FURROW_ASSERT(&field != &out, field.size());
  for (int j = 0; j < layout_.rows; ++j)
    for (int c = 0; c < 6; ++c) {
      double* to = out.data() + layout_.offset(j, c);
      for (int dj = -1; dj <= 1; ++dj) {
        if (j + dj < 0 || j + dj >= layout_.rows) continue;
        for (int t = 0; t < 2; ++t) {
          const double* from = field.data() + layout_.offset(j + dj, 3 * t + c % 3);
          const auto& k = rows_[j].c[c / 3][dj + 1];
          const double before = factor * k[0][t], here = factor * k[1][t], after = factor * k[2][t];
          for (int i = 0; i < layout_.columns; ++i)
            to[i] += before * from[i - 1] + here * from[i] + after * from[i + 1];
        }
      }
    }
}

void ShellMass::weigh(const Vec3& gravity, Field& out) const {
  Field acceleration(layout_.size(), 0.0);
  for (int j = 0; j < layout_.rows; ++j)
    for (int i = 0; i < layout_.columns; ++i) layout_.set(acceleration, i, j, 0, gravity);
  layout_.fill_padding(acceleration);
  out.assign(layout_.size(), 0.0);
  apply(acceleration, 1.0, out);
}

}  // namespace furrow::tire
