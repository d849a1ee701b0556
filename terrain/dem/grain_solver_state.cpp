// Saved state of the solver: everything that decides the next bits — grains in their order, the strips with their pair
// lists as they stand, histories of touching pairs, and the accounts.
#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::size_t kStripValues = 14;

void put_quads(Archive& archive, const std::string& name, const Quad* quads, std::size_t count) {
  archive.put(name, std::span<const double>(reinterpret_cast<const double*>(quads), 4 * count));
}

void get_quads(const Archive& archive, const std::string& name, Quad* quads, std::size_t count) {
  const auto& values = archive.get<double>(name, 4 * count);
  std::copy(values.begin(), values.end(), reinterpret_cast<double*>(quads));
}

std::vector<double> flat(const Accounts& a) {
  return {a.contact_work,
          a.elastic,
          a.elastic_start,
          a.wall_impulse.x(),
          a.wall_impulse.y(),
          a.wall_impulse.z(),
          a.surface_impulse.x(),
          a.surface_impulse.y(),
          a.surface_impulse.z(),
          a.floor_force,
          a.kinetic,
          a.height,
          a.velocity.x(),
          a.velocity.y(),
          a.velocity.z(),
          static_cast<double>(a.contacts),
          a.max_overlap,
          a.contact_force,
          a.net_force,
          a.slept,
          static_cast<double>(a.active)};
}

Accounts accounts_from(const std::vector<double>& v) {
  FURROW_ASSERT(v.size() == 21, v.size());
  Accounts a;
  a.contact_work = v[0], a.elastic = v[1], a.elastic_start = v[2];
  a.wall_impulse = {v[3], v[4], v[5]};
  a.surface_impulse = {v[6], v[7], v[8]};
  a.floor_force = v[9], a.kinetic = v[10], a.height = v[11];
  a.velocity = {v[12], v[13], v[14]};
  a.contacts = static_cast<std::int64_t>(v[15]);
  a.max_overlap = v[16], a.contact_force = v[17], a.net_force = v[18];
  a.slept = v[19], a.active = static_cast<std::int64_t>(v[20]);
  return a;
}

/// Calls f(strip, p) for every pair that touches, in order.
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

}  // namespace

void GrainSolver::save(Archive& archive) const {
  const std::size_t n = grains_.count;
  archive.put("count", static_cast<std::int64_t>(n));
  put_quads(archive, "position", grains_.position.data(), n);
  put_quads(archive, "velocity", grains_.velocity.data(), n);
  put_quads(archive, "spin", grains_.spin.data(), n);
  archive.put("id", grains_.id);
  archive.put("accounts", flat(accounts_));
  archive.put("mean_contact_force", mean_contact_force_);
  archive.put("strips/resorted", strips_.resorted());
  archive.put("strips/cells_z", static_cast<std::int64_t>(strips_.cells_z()));

  std::vector<std::int32_t> sizes, cells, wall_grain, wall;
  std::vector<std::uint64_t> partners;
  std::vector<std::uint8_t> touching;
  std::vector<double> values, tangential, rolling;
  std::vector<Quad> wall_history;
  for (int k = 0; k < strips_.count(); ++k) {
    const Strip& strip = strips_[k];
    sizes.insert(sizes.end(), {strip.first, strip.last, strip.pairs, std::int32_t(strip.walls.size())});
    // Sums too: those of strips that sleep stay.
    const ContactTotals& c = strip.contact;
    const MotionTotals& m = strip.motion;
    values.insert(values.end(),
                  {strip.travel, strip.x_min, strip.x_max, strip.z_max, strip.asleep ? 1.0 : 0.0,
                   double(strip.calm), c.elastic, c.max_overlap, c.wall_force.x, c.wall_force.y,
                   c.wall_force.z, c.floor_force, double(c.contacts), m.height});
    cells.insert(cells.end(), strip.cell_start.begin(), strip.cell_start.end());
    for (int p = 0; p < strip.pairs; ++p) partners.push_back(std::uint64_t{strip.i[p]} << 32 | strip.j[p]);
    touching.insert(touching.end(), strip.touching.begin(), strip.touching.end());
    put_rows(tangential, strip, strip.single.tangential);
    put_rows(tangential, strip, strip.full.tangential);
    put_rows(rolling, strip, strip.single.rolling);
    put_rows(rolling, strip, strip.full.rolling);
    for (const WallContact& contact : strip.walls) {
      wall_grain.push_back(contact.grain);
      wall.push_back(contact.wall);
      wall_history.push_back(contact.tangential);
      wall_history.push_back(contact.rolling);
    }
  }
  archive.put("strips/sizes", sizes);
  archive.put("strips/values", values);
  archive.put("strips/cells", cells);
  archive.put("pairs/partners", partners);
  archive.put("pairs/touching", touching);
  archive.put("pairs/tangential", tangential);
  archive.put("pairs/rolling", rolling);
  archive.put("walls/grain", wall_grain);
  archive.put("walls/wall", wall);
  put_quads(archive, "walls/history", wall_history.data(), wall_history.size());
  surfaces_.save(archive);
}

void GrainSolver::restore(const Archive& archive) {
  const auto n = static_cast<std::size_t>(archive.get_int("count"));
  grains_.resize(static_cast<int>(n));
  get_quads(archive, "position", grains_.position.data(), n);
  get_quads(archive, "velocity", grains_.velocity.data(), n);
  get_quads(archive, "spin", grains_.spin.data(), n);
  grains_.id = archive.get<std::int32_t>("id", n);
  accounts_ = accounts_from(archive.get<double>("accounts", 21));
  mean_contact_force_ = archive.get_double("mean_contact_force");
  strips_.restore_shape(static_cast<int>(archive.get_int("strips/cells_z")),
                        archive.get_int("strips/resorted"));

  const std::size_t count = strips_.count();
  const auto& sizes = archive.get<std::int32_t>("strips/sizes", 4 * count);
  const auto& values = archive.get<double>("strips/values", kStripValues * count);
  const auto& cells = archive.get<std::int32_t>("strips/cells");
  const auto& partners = archive.get<std::uint64_t>("pairs/partners");
  const auto& touching = archive.get<std::uint8_t>("pairs/touching");
  const auto& wall_grain = archive.get<std::int32_t>("walls/grain");
  const auto& wall = archive.get<std::int32_t>("walls/wall", wall_grain.size());
  const auto& wall_history = archive.get<double>("walls/history", 8 * wall_grain.size());
  const double* tangential = archive.get<double>("pairs/tangential").data();
  const double* rolling = archive.get<double>("pairs/rolling").data();
  const auto quad = [](const std::vector<double>& v, std::size_t k) {
    return Quad{v[4 * k], v[4 * k + 1], v[4 * k + 2], v[4 * k + 3]};
  };

  std::size_t pair = 0, group = 0, w = 0;
  const std::size_t per_strip = cells.size() / count;
  for (std::size_t k = 0; k < count; ++k) {
    Strip& strip = strips_[static_cast<int>(k)];
    strip = {};
    const std::int32_t* s = &sizes[4 * k];
    strip.first = s[0], strip.last = s[1];
    const double* v = &values[kStripValues * k];
    strip.travel = v[0], strip.x_min = v[1], strip.x_max = v[2], strip.z_max = v[3];
    strip.asleep = v[4] != 0.0, strip.calm = static_cast<int>(v[5]);
    strip.contact.elastic = v[6], strip.contact.max_overlap = v[7];
    strip.contact.wall_force = {v[8], v[9], v[10], 0.0}, strip.contact.floor_force = v[11];
    strip.contact.contacts = static_cast<std::int64_t>(v[12]);
    strip.motion.height = v[13];
    strip.cell_start.assign(cells.begin() + k * per_strip, cells.begin() + (k + 1) * per_strip);
    strips_.size_lists(strip, s[2]);
    for (int p = 0; p < strip.pairs; ++p) {
      strip.i[p] = static_cast<std::uint32_t>(partners[pair + p] >> 32);
      strip.j[p] = static_cast<std::uint32_t>(partners[pair + p]);
    }
    std::copy_n(touching.begin() + group, strip.touching.size(), strip.touching.begin());
    tangential = get_rows(tangential, strip, strip.single.tangential);
    tangential = get_rows(tangential, strip, strip.full.tangential);
    rolling = get_rows(rolling, strip, strip.single.rolling);
    rolling = get_rows(rolling, strip, strip.full.rolling);
    for (int m = 0; m < s[3]; ++m, ++w)
      strip.walls.push_back(
          {wall_grain[w], wall[w], quad(wall_history, 2 * w), quad(wall_history, 2 * w + 1)});
    pair += strip.pairs;
    group += strip.touching.size();
  }
  surfaces_.resize(static_cast<int>(count));
  surfaces_.restore(archive, strips_);
}

std::size_t GrainSolver::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof v[0]; };
  std::size_t sum =
      of(grains_.position) + of(grains_.velocity) + of(grains_.spin) + of(grains_.id) + strips_.bytes();
  for (const Chunk& chunk : chunks_)
    for (const LoadBuffer* buffer : {&chunk.own, &chunk.ahead}) sum += of(buffer->force) + of(buffer->torque);
  const auto scratch = [&](const auto& all) {
    for (const auto& s : all) {
      const auto& t = s.touching;
      sum += of(s.motion.v) + of(s.motion.w) + of(s.loads.force) + of(s.loads.torque) + of(s.shifted) +
             4 * of(t.dx) + 3 * of(t.i);
    }
  };
  scratch(single_);
  scratch(full_);
  return sum;
}

}  // namespace furrow::terrain::dem
