#include "tire/ancf/ring_factor.hpp"

#include <cholmod.h>
#include <omp.h>

#include <algorithm>
#include <set>

#include "protocol/error.hpp"

extern "C" void openblas_set_num_threads(int);

namespace furrow {
namespace {
constexpr int kColumn[4] = {0, 1, 1, 0}, kRow[4] = {0, 0, 1, 1};

/// While it lives, parallel regions of the libraries below run on the calling thread alone: CHOLMOD otherwise
/// starts four threads, whatever the cores are.
class Serial {
 public:
  Serial() : before_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~Serial() { omp_set_max_active_levels(before_); }
  Serial(const Serial&) = delete;
  Serial& operator=(const Serial&) = delete;

 private:
  int before_;
};
}  // namespace

struct RingFactor::Cholmod {
  cholmod_common common{};
  cholmod_sparse* matrix = nullptr;
  cholmod_factor* factor = nullptr;

  Cholmod() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.postorder = 1;
    common.print = 0;
  }
  ~Cholmod() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_sparse(&matrix, &common);
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
};

RingFactor::RingFactor(const RingLayout& layout, int slots) : layout_(layout), slots_(slots) {
  const Serial serial;
  openblas_set_num_threads(1);  // results and timing must not depend on the library's own threads
  cholmod_ = std::make_unique<Cholmod>();
  const int across = layout.rows - 2, nodes = layout.columns * across;
  neighbours_.resize(nodes);
  start_.resize(nodes + 1, 0);
  for (int node = 0; node < nodes; ++node) {
    std::set<int> near;
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        const int j = node % across + dj, i = (node / across + di + layout.columns) % layout.columns;
        if (j >= 0 && j < across && i * across + j >= node) near.insert(i * across + j);
      }
    neighbours_[node].assign(near.begin(), near.end());
    start_[node + 1] = start_[node] + 36 * (near.size() - 1) + 21;
  }
  const std::size_t n = 6 * static_cast<std::size_t>(nodes);
  cholmod_common* common = &cholmod_->common;
  cholmod_sparse*& matrix = cholmod_->matrix;
  matrix = cholmod_allocate_sparse(n, n, start_[nodes], 1, 1, -1, CHOLMOD_REAL, common);
  auto* column = static_cast<int*>(matrix->p);
  auto* row = static_cast<int*>(matrix->i);
  for (int node = 0; node < nodes; ++node)
    for (int c = 0; c < 6; ++c) {
      std::size_t at = column_start(node, c);
      column[6 * node + c] = static_cast<int>(at);
      for (const int other : neighbours_[node])
        for (int r = other == node ? c : 0; r < 6; ++r) row[at++] = 6 * other + r;
    }
  column[n] = static_cast<int>(start_[nodes]);
  cholmod_->factor = cholmod_analyze(matrix, common);
  const cholmod_factor* factor = cholmod_->factor;
  if (!factor) throw physics_error("the tire's stiffness matrix could not be analysed: out of memory");
  pattern_ = PanelPattern(static_cast<int>(factor->nsuper), static_cast<const int*>(factor->super),
                          static_cast<const int*>(factor->pi), static_cast<const int*>(factor->s));
  place_.resize(n);
  for (std::size_t k = 0; k < n; ++k) place_[static_cast<const int*>(factor->Perm)[k]] = static_cast<int>(k);
  x_.resize(n);
}

RingFactor::~RingFactor() = default;

std::size_t RingFactor::column_start(int node, int c) const {
  const std::size_t below = 6 * (neighbours_[node].size() - 1);
  return start_[node] + static_cast<std::size_t>(c) * below +
         static_cast<std::size_t>(6 * c - c * (c - 1) / 2);
}

void RingFactor::clear() {
  auto* values = static_cast<double*>(cholmod_->matrix->x);
  std::fill(values, values + start_.back(), 0.0);
}

void RingFactor::add(const BatchTangent& tangent, const ElementMass& mass, double mass_factor, int j,
                     int batch) {
  auto* values = static_cast<double*>(cholmod_->matrix->x);
  const int across = layout_.rows - 2;
  for (int lane = 0; lane < kLanes; ++lane) {
    const int i = batch * kLanes + lane;
    if (i >= layout_.columns) return;
    int node[4];
    for (int n = 0; n < 4; ++n) {
      const int free_row = j + kRow[n] - 1;
      node[n] =
          free_row < 0 || free_row >= across ? -1 : (i + kColumn[n]) % layout_.columns * across + free_row;
    }
    for (int n = 0; n < 4; ++n)
      for (int m = 0; m < 4; ++m) {
        if (node[n] < 0 || node[m] < 0 || node[n] < node[m]) continue;
        const auto& near = neighbours_[node[m]];
        const auto rank =
            static_cast<std::size_t>(std::lower_bound(near.begin(), near.end(), node[n]) - near.begin());
        for (int c = 0; c < 6; ++c) {
          const std::size_t base = column_start(node[m], c) + (rank == 0 ? 0 : 6 - c + 6 * (rank - 1));
          for (int r = rank == 0 ? c : 0; r < 6; ++r) {
            const int a = 6 * n + r, b = 6 * m + c;
            double value = a >= b ? tangent.k[a][b][lane] : tangent.k[b][a][lane];
            if (r % 3 == c % 3) value += mass_factor * mass(2 * n + r / 3, 2 * m + c / 3);
            values[base + (rank == 0 ? r - c : r)] += value;
          }
        }
      }
  }
}

bool RingFactor::factorize(int slot) {
  const Serial serial;
  cholmod_factor* factor = cholmod_->factor;
  const bool done = cholmod_factorize(cholmod_->matrix, factor, &cholmod_->common) != 0;
  if (!done || cholmod_->common.status != CHOLMOD_OK || factor->minor != factor->n) return false;
  pattern_.pack(static_cast<const double*>(factor->x), static_cast<const int*>(factor->px), slots_[slot]);
  return true;
}

void RingFactor::solve(int slot, const Mat3& turn, int shift, const Field& rhs, Field& x) {
  const int across = layout_.rows - 2, columns = layout_.columns, stride = layout_.stride();
  const Mat3 back = turn.transpose();
  for (int i = 0; i < columns; ++i) {
    const int from = ((i + shift) % columns + columns) % columns;
    for (int j = 0; j < across; ++j)
      for (int s = 0; s < 2; ++s) {
        const double* p = rhs.data() + layout_.offset(j + 1, 3 * s) + from;
        const Vec3 v = back * Vec3(p[0], p[stride], p[2 * stride]);
        const int* to = place_.data() + 6 * (i * across + j) + 3 * s;
        for (int c = 0; c < 3; ++c) x_[to[c]] = static_cast<float>(v[c]);
      }
  }
  pattern_.solve(slots_[slot], x_.data(), work_);
  for (int i = 0; i < columns; ++i) {
    const int to = ((i + shift) % columns + columns) % columns;
    for (int j = 0; j < across; ++j)
      for (int s = 0; s < 2; ++s) {
        double* p = x.data() + layout_.offset(j + 1, 3 * s) + to;
        const int* from = place_.data() + 6 * (i * across + j) + 3 * s;
        const Vec3 v = turn * Vec3(x_[from[0]], x_[from[1]], x_[from[2]]);
        p[0] = v.x(), p[stride] = v.y(), p[2 * stride] = v.z();
      }
  }
}

}  // namespace furrow
