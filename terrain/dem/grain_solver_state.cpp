// Saved state of the solver: everything that determines the next bits. It has the grains in their order, the strips
// with their present pair lists, histories of touching pairs, and the accounts.
#include <algorithm>
#include <numeric>
#include <optional>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "terrain/dem/grain_solver.hpp"
#include "terrain/dem/solver_state_check.hpp"

namespace furrow::terrain::dem {
namespace {

void put_quads(Archive& archive, const std::string& name, const Quad* quads, std::size_t count) {
  archive.put(name, std::span<const double>(reinterpret_cast<const double*>(quads), 4 * count));
}

void get_quads(const Archive& archive, const std::string& name, Quad* quads, std::size_t count) {
  const auto& values = archive.get<double>(name, 4 * count);
  std::copy(values.begin(), values.end(), reinterpret_cast<double*>(quads));
}

/// Calls f(p) for every touching pair of the strip, in order.
template <class StripT, class F>
void each_touching(StripT& strip, F&& f) {
  for (int p = 0; p < strip.pairs; ++p)
    if (strip.touching[p / kFloatLanes] >> p % kFloatLanes & 1) f(p);
}

template <class Real>
void put_rows(std::vector<double>& out, const Strip& strip, const std::vector<HistoryRow<Real>>& rows) {
  if (rows.empty()) return;
  each_touching(strip, [&](int p) { out.insert(out.end(), {rows[p].x, rows[p].y, rows[p].z, rows[p].w}); });
}

template <class Real>
const double* get_rows(const double* from, const Strip& strip, std::vector<HistoryRow<Real>>& rows) {
  if (rows.empty()) return from;
  each_touching(strip, [&](int p) {
    const auto next = [&] { return static_cast<Real>(*from++); };
    rows[p].x = next(), rows[p].y = next(), rows[p].z = next(), rows[p].w = next();
  });
  return from;
}

/// Divides a strip that was read into its parcels, without their parts. @param saved null: the strip is a single parcel
void take_parcels(Strip& strip, int across, std::optional<ColumnReader<Parcel>>& saved) {
  Parcel& only = strip.parcels.front();
  only.asleep = strip.asleep;
  only.contact = strip.contact;
  only.motion = strip.motion;
  strip.parcels.resize(across);
  if (!saved) return;
  strip.asleep = true;
  for (Parcel& parcel : strip.parcels) {
    parcel = {};
    saved->take(parcel);
    strip.asleep &= parcel.asleep;
    strip.stale |= parcel.stale;
    strip.motion.max_net_force = std::max(strip.motion.max_net_force, parcel.motion.max_net_force);
  }
}

constexpr int kLongestWindow = 1'000'000'000;

/// Limits counts of steps to the range in which they matter.
void bound_calm(Strip& strip) {
  for (Parcel& parcel : strip.parcels) {
    parcel.calm = std::clamp(parcel.calm, 0, kCalmSteps);
    parcel.window = std::clamp(parcel.window, 0, kLongestWindow);
  }
}

/// Calls f(drift) for the grains of a parcel whose window has already added velocities to the drift.
template <class GrainsT, class F>
void each_drift(GrainsT& grains, const Strip& strip, const Parcel& parcel, F&& f) {
  if (parcel.window <= kDriftEvery / 2 || grains.drift.empty()) return;
  for (int g = parcel.part.first; g < parcel.part.last; ++g) f(grains.drift[strip.first + g]);
}

}  // namespace

void GrainSolver::save(Archive& archive) const {
  const std::size_t n = grains_.count;
  archive.put("count", static_cast<std::int64_t>(n));
  put_quads(archive, "position", grains_.position.data(), n);
  put_quads(archive, "velocity", grains_.velocity.data(), n);
  put_quads(archive, "spin", grains_.spin.data(), n);
  archive.put("id", grains_.id);
  save_fields(archive, "accounts", accounts_);
  energies_.save(archive);
  archive.put("mean_contact_force", mean_contact_force_);
  std::vector<double> samples;
  for (const ForceSample& s : samples_) samples.insert(samples.end(), {s.force, double(s.contacts)});
  archive.put("samples/strips", samples);
  archive.put("samples/until", until_sample_);
  if (strips_.across() > 1) archive.put(kAcross, std::int64_t{strips_.across()});
  // A sleeping strip among sleeping strips is not evaluated. The last force on it may still wake it when the mean
  // contact force falls.
  std::vector<double> pressed(strips_.count(), 0.0);
  for (int k = 0; k < strips_.count(); ++k)
    if (strips_[k].asleep) pressed[k] = strips_[k].motion.max_net_force;
  if (std::any_of(pressed.begin(), pressed.end(), [](double force) { return force != 0.0; }))
    archive.put("strips/pressed", pressed);
  archive.put("strips/resorted", strips_.resorted());
  archive.put("strips/cells_z", static_cast<std::int64_t>(strips_.cells_z()));

  std::vector<std::int32_t> walls, cells;
  std::vector<std::uint64_t> partners;
  std::vector<std::uint8_t> touching;
  std::vector<double> tangential, rolling, drifts;
  ColumnWriter<Strip> strips;
  ColumnWriter<Parcel> parcels;
  ColumnWriter<WallContact> wall_contacts;
  for (int k = 0; k < strips_.count(); ++k) {
    const Strip& strip = strips_[k];
    strips.add(strip);
    for (const Parcel& parcel : strip.parcels) {
      parcels.add(parcel);
      each_drift(grains_, strip, parcel, [&](const Drift& d) { drifts.insert(drifts.end(), {d.x, d.y, d.z}); });
    }
    walls.push_back(static_cast<std::int32_t>(strip.walls.size()));
    cells.insert(cells.end(), strip.cell_start.begin(), strip.cell_start.end());
    for (int p = 0; p < strip.pairs; ++p) partners.push_back(std::uint64_t{strip.i[p]} << 32 | strip.j[p]);
    touching.insert(touching.end(), strip.touching.begin(), strip.touching.end());
    put_rows(tangential, strip, strip.single.tangential);
    put_rows(tangential, strip, strip.full.tangential);
    put_rows(rolling, strip, strip.single.rolling);
    put_rows(rolling, strip, strip.full.rolling);
    for (const WallContact& contact : strip.walls) wall_contacts.add(contact);
  }
  strips.put(archive, "strips");
  if (strips_.across() > 1) parcels.put(archive, "parcels");
  archive.put("strips/walls", walls);
  archive.put("strips/cells", cells);
  archive.put("pairs/partners", partners);
  archive.put("pairs/touching", touching);
  archive.put("pairs/tangential", tangential);
  archive.put("pairs/rolling", rolling);
  wall_contacts.put(archive, "walls");
  if (!drifts.empty()) archive.put("drift", drifts);
  surfaces_.save(archive);
}

void GrainSolver::restore(const Archive& archive) {
  check_solver_state(archive, strips_, params_.smallest_radius(), params_.largest_radius());
  const auto n = static_cast<std::size_t>(archive.get_int("count"));
  grains_.resize(static_cast<int>(n), params_.activity);
  get_quads(archive, "position", grains_.position.data(), n);
  get_quads(archive, "velocity", grains_.velocity.data(), n);
  get_quads(archive, "spin", grains_.spin.data(), n);
  grains_.id = archive.get<std::int32_t>("id", n);
  restore_fields(archive, "accounts", accounts_);
  energies_.restore(archive, strips_.count());
  relative_mass_ = relative_mass();
  mean_contact_force_ = archive.get_double("mean_contact_force");
  overlap_bound_.clear();
  samples_.clear();
  until_sample_ = archive.get_int("samples/until");
  const auto& samples = archive.get<double>("samples/strips");
  for (std::size_t k = 0; k + 1 < samples.size(); k += 2)
    samples_.push_back({samples[k], static_cast<std::int64_t>(samples[k + 1])});
  strips_.restore_shape(static_cast<int>(archive.get_int("strips/cells_z")), archive.get_int("strips/resorted"));

  const std::size_t count = strips_.count();
  const bool same_parcels = saved_across(archive) == strips_.across();
  std::optional<ColumnReader<Parcel>> parcels;
  if (same_parcels && strips_.across() > 1) parcels.emplace(archive, "parcels", count * strips_.across());
  ColumnReader<Strip> strips(archive, "strips", count);
  const auto* const pressed = archive.has("strips/pressed") ? &archive.get<double>("strips/pressed", count) : nullptr;
  const auto& walls = archive.get<std::int32_t>("strips/walls", count);
  const auto& cells = archive.get<std::int32_t>("strips/cells");
  const auto& partners = archive.get<std::uint64_t>("pairs/partners");
  const auto& touching = archive.get<std::uint8_t>("pairs/touching");
  ColumnReader<WallContact> wall_contacts(archive, "walls",
                                          static_cast<std::size_t>(std::accumulate(walls.begin(), walls.end(), 0)));
  const double* tangential = archive.get<double>("pairs/tangential").data();
  const double* rolling = archive.get<double>("pairs/rolling").data();

  std::size_t pair = 0, group = 0;
  const std::size_t per_strip = cells.size() / count;
  for (std::size_t k = 0; k < count; ++k) {
    Strip& strip = strips_[static_cast<int>(k)];
    strip = {};
    strips.take(strip);
    if (pressed) strip.motion.max_net_force = (*pressed)[k];
    take_parcels(strip, strips_.across(), parcels);
    bound_calm(strip);
    strip.cell_start.assign(cells.begin() + k * per_strip, cells.begin() + (k + 1) * per_strip);
    strips_.size_lists(strip, strip.pairs);
    for (int p = 0; p < strip.pairs; ++p) {
      strip.i[p] = static_cast<std::uint32_t>(partners[pair + p] >> 32);
      strip.j[p] = static_cast<std::uint32_t>(partners[pair + p]);
    }
    std::copy_n(touching.begin() + group, strip.touching.size(), strip.touching.begin());
    tangential = get_rows(tangential, strip, strip.single.tangential);
    tangential = get_rows(tangential, strip, strip.full.tangential);
    rolling = get_rows(rolling, strip, strip.single.rolling);
    rolling = get_rows(rolling, strip, strip.full.rolling);
    strip.walls.resize(walls[k]);
    for (WallContact& contact : strip.walls) wall_contacts.take(contact);
    strips_.find_parts(strip);
    pair += strip.pairs;
    group += strip.touching.size();
  }
  if (!same_parcels || !params_.activity) wake_all();
  restore_drift(archive);
  surfaces_.resize(static_cast<int>(count));
  surfaces_.restore(archive, strips_);
}

void GrainSolver::restore_drift(const Archive& archive) {
  std::vector<Drift*> swaying;
  for (int k = 0; k < strips_.count(); ++k)
    for (const Parcel& parcel : strips_[k].parcels)
      each_drift(grains_, strips_[k], parcel, [&](Drift& drift) { swaying.push_back(&drift); });
  if (swaying.empty()) return;
  const double* from = archive.get<double>("drift", 3 * swaying.size()).data();
  const auto next = [&] { return static_cast<float>(*from++); };
  for (Drift* const drift : swaying) drift->x = next(), drift->y = next(), drift->z = next();
}

std::size_t GrainSolver::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof v[0]; };
  std::size_t sum = of(grains_.position) + of(grains_.velocity) + of(grains_.spin) + of(grains_.id) +
                    of(grains_.drift) + strips_.bytes();
  for (const Chunk& chunk : chunks_)
    for (const LoadBuffer* buffer : {&chunk.own, &chunk.ahead}) sum += of(buffer->force) + of(buffer->torque);
  const auto scratch = [&](const auto& all) {
    for (const auto& s : all) {
      const auto& t = s.touching;
      sum += of(s.motion.v) + of(s.motion.w) + of(s.loads.force) + of(s.loads.torque) + of(s.shifted) + 4 * of(t.dx) +
             3 * of(t.i);
    }
  };
  scratch(single_);
  scratch(full_);
  return sum;
}

}  // namespace furrow::terrain::dem
