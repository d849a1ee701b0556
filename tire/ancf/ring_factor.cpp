#include "tire/ancf/ring_factor.hpp"

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

RingFactor::RingFactor(const RingLayout& layout, int slots) : layout_(layout), factors_(slots, nullptr) {
  const Serial serial;
  openblas_set_num_threads(1);  // results and timing must not depend on the library's own threads
  cholmod_start(&common_);
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.final_ll = 1;
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_METIS;
  common_.postorder = 1;
  common_.print = 0;
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
  matrix_ = cholmod_allocate_sparse(n, n, start_[nodes], 1, 1, -1, CHOLMOD_REAL, &common_);
  auto* column = static_cast<int*>(matrix_->p);
  auto* row = static_cast<int*>(matrix_->i);
  for (int node = 0; node < nodes; ++node)
    for (int c = 0; c < 6; ++c) {
      std::size_t at = column_start(node, c);
      column[6 * node + c] = static_cast<int>(at);
      for (const int other : neighbours_[node])
        for (int r = other == node ? c : 0; r < 6; ++r) row[at++] = 6 * other + r;
    }
  column[n] = static_cast<int>(start_[nodes]);
  symbolic_ = cholmod_analyze(matrix_, &common_);
  rhs_ = cholmod_zeros(n, 1, CHOLMOD_REAL, &common_);
  if (!symbolic_ || !rhs_)
    throw physics_error("the tire's stiffness matrix could not be analysed: out of memory");
}

RingFactor::~RingFactor() {
  for (cholmod_factor*& factor : factors_) cholmod_free_factor(&factor, &common_);
  cholmod_free_factor(&symbolic_, &common_);
  cholmod_free_sparse(&matrix_, &common_);
  for (cholmod_dense** dense : {&rhs_, &x_, &y_, &e_}) cholmod_free_dense(dense, &common_);
  cholmod_finish(&common_);
}

std::size_t RingFactor::column_start(int node, int c) const {
  const std::size_t below = 6 * (neighbours_[node].size() - 1);
  return start_[node] + static_cast<std::size_t>(c) * below +
         static_cast<std::size_t>(6 * c - c * (c - 1) / 2);
}

void RingFactor::clear() {
  auto* values = static_cast<double*>(matrix_->x);
  std::fill(values, values + start_.back(), 0.0);
}

void RingFactor::add(const BatchTangent& tangent, const ElementMass& mass, double mass_factor, int j,
                     int batch) {
  auto* values = static_cast<double*>(matrix_->x);
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
  cholmod_factor*& factor = factors_[slot];
  if (!factor) factor = cholmod_copy_factor(symbolic_, &common_);
  const bool done = cholmod_factorize(matrix_, factor, &common_) != 0;
  return done && common_.status == CHOLMOD_OK && factor->minor == factor->n;
}

void RingFactor::solve(int slot, const Mat3& turn, int shift, const Field& rhs, Field& x) {
  const int across = layout_.rows - 2, columns = layout_.columns, stride = layout_.stride();
  auto* b = static_cast<double*>(rhs_->x);
  const Mat3 back = turn.transpose();
  for (int i = 0; i < columns; ++i) {
    const int from = ((i + shift) % columns + columns) % columns;
    for (int j = 0; j < across; ++j)
      for (int s = 0; s < 2; ++s) {
        const double* p = rhs.data() + layout_.offset(j + 1, 3 * s) + from;
        Eigen::Map<Vec3>(b + 6 * (i * across + j) + 3 * s) = back * Vec3(p[0], p[stride], p[2 * stride]);
      }
  }
  const Serial serial;
  cholmod_solve2(CHOLMOD_A, factors_[slot], rhs_, nullptr, &x_, nullptr, &y_, &e_, &common_);
  const auto* solution = static_cast<const double*>(x_->x);
  for (int i = 0; i < columns; ++i) {
    const int to = ((i + shift) % columns + columns) % columns;
    for (int j = 0; j < across; ++j)
      for (int s = 0; s < 2; ++s) {
        double* p = x.data() + layout_.offset(j + 1, 3 * s) + to;
        const Vec3 v = turn * Eigen::Map<const Vec3>(solution + 6 * (i * across + j) + 3 * s);
        p[0] = v.x(), p[stride] = v.y(), p[2 * stride] = v.z();
      }
  }
}

}  // namespace furrow
