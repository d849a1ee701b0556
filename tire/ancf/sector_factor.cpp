#include "tire/ancf/sector_factor.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"
#include "tire/ancf/stopwatch.hpp"

namespace furrow::tire {
namespace {

constexpr double kDirectorWeight = 0.5;  // the age of a director counts less: it turns softer parts
constexpr double kAlso = 0.4;            // of the age of renewal: sectors as old as this are renewed with others

}  // namespace

SectorFactor::SectorFactor(const ShellLayout& layout, const ShellCarcass& shell, const ShellMass& mass,
                           const SectorFactorParams& params)
    : params_(params),
      layout_(layout),
      shell_(shell),
      mass_(mass),
      factor_(layout),
      made_layout_{2 * kDoubleLanes * layout.batches(), layout.rows},
      made_old_(made_layout_.size()),
      made_new_(made_layout_.size()),
      geometric_(layout.batches(), 1),
      made_pressure_(layout.batches(), 0.0),
      age_(layout.batches()),
      which_(layout.batches()) {
  Field weight;
  mass_.weigh(standard_gravity(), weight);
  for (int i = 0; i < layout_.columns; ++i)
    for (int j = 0; j < layout_.rows; ++j) weight_.push_back(-weight[layout_.offset(j, 2) + i]);
}

void SectorFactor::start() {
  renewals_ = 0;
  work_ = 0.0;
  valid_ = false;
}

void SectorFactor::note_iterations(int count) {
  FURROW_ASSERT(count >= 0, count);
  excess_ += std::max(0, count - 1);
}

/// Keeps the shape of a sector over the step, in rim axes.
void SectorFactor::note_shape(int sector, const Step& step) {
  FURROW_ASSERT(in_range(sector, layout_.batches()), sector, layout_.batches());
  FURROW_ASSERT(step.q.size() == layout_.size() && step.q_new.size() == layout_.size(), step.q.size(),
                step.q_new.size(), layout_.size());
  const RimState& rim = step.rim;
  const Mat3 back = rim.orientation.toRotationMatrix().transpose();
  made_pressure_[sector] = shell_.pressure();
  for (int j = 0; j < layout_.rows; ++j)
    for (int k = 0; k <= kDoubleLanes; ++k) {
      const int i = sector * kDoubleLanes + k, to = 2 * sector * kDoubleLanes + k;
      made_layout_.set(made_old_, to, j, 0, back * (layout_.get(step.q, i, j, 0) - rim.position));
      made_layout_.set(made_new_, to, j, 0, back * (layout_.get(step.q_new, i, j, 0) - rim.position));
      made_layout_.set(made_old_, to, j, 3, back * layout_.get(step.q, i, j, 3));
      made_layout_.set(made_new_, to, j, 3, back * layout_.get(step.q_new, i, j, 3));
    }
  if (contact_made_.empty()) return;
  const int nodes = layout_.rows * std::min(kDoubleLanes, layout_.columns - sector * kDoubleLanes);
  const std::size_t first = static_cast<std::size_t>(sector) * kDoubleLanes * layout_.rows;
  std::copy_n(contact_now_.begin() + first, nodes, contact_made_.begin() + first);
}

/// Stores the nodes' contact tangents in a step, once there is or was one.
void SectorFactor::note_contact(const Step& step, const Mat3& turn) {
  if (step.contact.empty() && contact_made_.empty()) return;
  step.contact.stiffness(layout_, step.h, turn, contact_now_);
  if (contact_made_.empty()) contact_made_.assign(contact_now_.size(), Mat3::Zero());
}

void SectorFactor::build(const std::vector<char>& which) {
  FURROW_ASSERT(which.size() == static_cast<std::size_t>(factor_.sectors()), which.size(), factor_.sectors());
  const Stopwatch watch(times_.jacobian);
  const int count = factor_.sectors();
  if (params_.threads > 1) {
#pragma omp parallel for schedule(dynamic) num_threads(params_.threads)
    for (int b = 0; b < count; ++b)
      if (which[b]) build_sector(b);
  } else {
    for (int b = 0; b < count; ++b)
      if (which[b]) build_sector(b);
  }
}

/// Builds the tangent of a sector's elements in the shape that was kept.
void SectorFactor::build_sector(int sector) {
  const double c = params_.coefficient(h_) + shell_.branch_gain(h_), inertia = 1.0 / (h_ * h_);
  BatchTangent tangent;
  factor_.clear(sector);
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    BatchNodes before, now, middle;
    before.read(made_layout_, made_old_.data(), 2 * sector * kDoubleLanes, j);
    now.read(made_layout_, made_new_.data(), 2 * sector * kDoubleLanes, j);
    for (int n = 0; n < 4; ++n) {
      middle.r[n] = 0.5 * (before.r[n] + now.r[n]);
      middle.d[n] = 0.5 * (before.d[n] + now.d[n]);
    }
    Double4 stress[kStrains];
    shell_.batch_stress_between(before, now, c, j, stress);
    tangent.compute(shell_.stiffness(j), middle, stress, c, geometric_[sector] ? 0.5 : 0.0, made_pressure_[sector]);
    factor_.add(tangent, mass_.element(j), inertia, j, sector);
  }
  if (contact_made_.empty()) return;
  for (int lane = 0; lane < kDoubleLanes && sector * kDoubleLanes + lane < layout_.columns; ++lane)
    for (int j = 1; j + 1 < layout_.rows; ++j)
      factor_.add_node(contact_made_[(sector * kDoubleLanes + lane) * layout_.rows + j], sector, lane, j);
}

/// Makes the factor again in the sectors marked. Without its geometric part the tangent is positive definite.
bool SectorFactor::renew(const std::vector<char>& which, const Step& step) {
  ++renewals_;
  excess_ = 0;
  const auto rebuild = [&](const std::vector<char>& these, char geometric) {
    for (int b = 0; b < factor_.sectors(); ++b)
      if (these[b]) geometric_[b] = geometric;
    build(these);
    const Stopwatch watch(times_.factorize);
    valid_ = factor_.factorize(params_.threads);
    work_ += factor_.work();
    return valid_;
  };
  for (int b = 0; b < factor_.sectors(); ++b)
    if (which[b]) note_shape(b, step);
  return rebuild(which, 1) || rebuild(which, 0) || rebuild(std::vector<char>(which.size(), 1), 0);
}

/// Largest relative change of an edge or a director of a sector since the factor was made, in rim axes.
double SectorFactor::age(int sector, const Field& q_new, const Mat3& turn) const {
  FURROW_ASSERT(in_range(sector, layout_.batches()) && q_new.size() == layout_.size(), sector, q_new.size());
  Double4 most = {};
  const auto compare = [&](const Triple<Double4>& now, const Triple<Double4>& made, double weight) {
    const Triple<Double4> change{turn(0, 0) * now.x + turn(1, 0) * now.y + turn(2, 0) * now.z - made.x,
                                 turn(0, 1) * now.x + turn(1, 1) * now.y + turn(2, 1) * now.z - made.y,
                                 turn(0, 2) * now.x + turn(1, 2) * now.y + turn(2, 2) * now.z - made.z};
    const Double4 relative = weight * weight * dot(change, change) / dot(made, made);
    most = relative > most ? relative : most;
  };
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    BatchNodes now, made;
    now.read(layout_, q_new.data(), sector * kDoubleLanes, j);
    made.read(made_layout_, made_new_.data(), 2 * sector * kDoubleLanes, j);
    compare(now.r[1] - now.r[0], made.r[1] - made.r[0], 1.0);
    compare(now.r[3] - now.r[0], made.r[3] - made.r[0], 1.0);
    compare(now.d[0], made.d[0], kDirectorWeight);
  }
  return std::sqrt(std::max(std::max(most[0], most[1]), std::max(most[2], most[3])));
}

/// Largest change of a contact tangent of a sector since the factor was made, relative to the node's part of the
/// factor: that tangent and the node's inertia.
double SectorFactor::contact_age(int sector, double h) const {
  FURROW_ASSERT(contact_made_.empty() || contact_now_.size() == contact_made_.size(), contact_now_.size(),
                contact_made_.size());
  if (contact_made_.empty()) return 0.0;
  double most = 0.0;
  for (int i = sector * kDoubleLanes; i < std::min((sector + 1) * kDoubleLanes, layout_.columns); ++i)
    for (int j = 1; j + 1 < layout_.rows; ++j) {
      const std::size_t node = static_cast<std::size_t>(i) * layout_.rows + j;
      const double change = (contact_now_[node] - contact_made_[node]).norm();
      if (change == 0.0) continue;
      const double inertia = weight_[node] / (kStandardGravity * h * h);
      most = std::max(most, change / (contact_made_[node].norm() + inertia));
    }
  return most;
}

bool SectorFactor::prepare(const Step& step, int attempt) {
  FURROW_ASSERT(step.h > 0.0 && attempt >= 0, step.h, attempt);
  const double h = step.h;
  const Mat3 turn = step.rim.orientation.toRotationMatrix();
  const bool all = !valid_ || h_ != h || attempt > 1;
  h_ = h;
  double oldest = 0.0;
  note_contact(step, turn);
  for (int b = 0; b < factor_.sectors() && !all; ++b) {
    age_[b] = std::max(age(b, step.q_new, turn), params_.age / params_.contact_age * contact_age(b, h));
    oldest = std::max(oldest, age_[b]);
  }
  const bool slow = excess_ > params_.worth, due = oldest > params_.age || slow;
  if (!all && !due && attempt == 0) return true;
  const double limit = attempt > 0 ? 0.1 * params_.age : std::min(kAlso * params_.age, 0.5 * oldest);
  for (int b = 0; b < factor_.sectors(); ++b) which_[b] = all || age_[b] > limit;
  return renew(which_, step);
}

void SectorFactor::save(Archive& archive) const {
  save_fields(archive, "factor", *this);
  archive.put("factor/old", made_old_);
  archive.put("factor/new", made_new_);
  archive.put("factor/pressure", made_pressure_);
  if (!contact_made_.empty()) save_value(archive, "factor/contact", contact_made_);
  archive.put("factor/geometric", std::vector<std::int32_t>(geometric_.begin(), geometric_.end()));
}

void SectorFactor::restore(const Archive& archive) {
  restore_fields(archive, "factor", *this);
  made_old_ = archive.get<double>("factor/old", made_layout_.size());
  made_new_ = archive.get<double>("factor/new", made_layout_.size());
  made_pressure_ = archive.get<double>("factor/pressure", made_pressure_.size());
  const auto& geometric = archive.get<std::int32_t>("factor/geometric", geometric_.size());
  geometric_.assign(geometric.begin(), geometric.end());
  contact_made_.clear();
  if (archive.has("factor/contact")) restore_value(archive, "factor/contact", contact_made_, weight_.size());
  if (!valid_) return;
  build(std::vector<char>(factor_.sectors(), 1));
  valid_ = factor_.factorize(params_.threads);
}

}  // namespace furrow::tire
