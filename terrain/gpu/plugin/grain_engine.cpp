#include "terrain/gpu/plugin/grain_engine.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::terrain::gpu {
namespace {

constexpr i32 kMoreSlots = 4;
constexpr i32 kBatch = 64;           // steps that are launched before the host waits
constexpr double kListMargin = 1.0;  // radii by which the box of grains near a surface is larger than it must be
constexpr double kMostCells = 2147483000.0;

dem::Bin bin_of(const Setup& s) {
  dem::Bin bin;
  bin.length = s.length, bin.width = s.width;
  bin.periodic_x = s.periodic_x != 0, bin.periodic_y = s.periodic_y != 0;
  return bin;
}

/// The smallest power of two with which two listed grains differ by less than 2^31 along each axis, m.
double unit_for(const Setup& s) { return std::exp2(std::ceil(std::log2(2.0 * s.radius + 2.0 * s.skin)) - 31.0); }

i32 cells_along(double length, double size, bool periodic) {
  return std::max(periodic ? 3 : 1, static_cast<i32>(length / size));
}

int bits_for(i64 values) {
  int bits = 1;
  while ((i64{1} << bits) < values) ++bits;
  return bits;
}

}  // namespace

GrainEngine::GrainEngine(const Setup& setup)
    : setup_(setup), bin_(bin_of(setup)), device_(setup.order), unit_(unit_for(setup)), per_unit_(1.0 / unit_) {
  control_at_.reserve(device_, 1);
  most_.reserve(device_, 1);
  top_.reserve(device_, 1);
  hard_.reserve(device_, 1);
}

// ---- pointers and parameters ----------------------------------------------------------------------------------

Pointers GrainEngine::pointers(const State& s) const {
  Pointers p{};
  p.count = count_;
  p.stride = count_;
  p.unit = unit_, p.per_unit = per_unit_;
  p.low = s.low.data(), p.high = s.high.data();
  p.motion = s.motion.data(), p.row = s.row.data(), p.load = s.load.data();
  p.built = s.built.data();
  p.list = s.list.data(), p.listed = s.listed.data(), p.touching = s.touching.data();
  p.spring = s.spring.data(), p.roll = s.roll.data();
  p.control = control_at_.data();
  return p;
}

Images GrainEngine::images() const {
  Images m{};
  if (bin_.periodic_x) m.length = nearest(bin_.length * per_unit_);
  if (bin_.periodic_y) m.width = nearest(bin_.width * per_unit_);
  m.x[1] = static_cast<u32>(m.length), m.x[2] = 0U - m.x[1];
  m.y[1] = static_cast<u32>(m.width), m.y[2] = 0U - m.y[1];
  return m;
}

template <class Law>
PairParams<Law> GrainEngine::pair_params(double dt) const {
  PairParams<Law> p;
  p.coefficients = pair_.of<Law, float>();
  const auto diameter = static_cast<u64>(nearest(2.0 * setup_.radius * per_unit_));
  p.diameter2 = diameter * diameter;
  p.diameter = static_cast<float>(static_cast<double>(diameter) * unit_);
  p.unit = static_cast<float>(unit_);
  p.unit2 = static_cast<float>(unit_ * unit_);
  p.dt = static_cast<float>(dt);
  p.images = images();
  return p;
}
template <class Law>
WallParams<Law> GrainEngine::wall_params(double dt, double kick) const {
  return {floor_.of<Law, double>(), side_.of<Law, double>(), bin_, setup_.radius, dt, kick};
}
template <class Law>
FacetParams<Law> GrainEngine::facet_params(const TireSurface& s, double dt, double kick) const {
  return {s.coefficients.of<Law, double>(), setup_.radius, dt, kick};
}

SurfaceView GrainEngine::TireSurface::view() const {
  SurfaceView v{};
  v.facets = {*triangle.data(), *neighbour.data(),   boundary.data(), around_first.data(),
              around.data(),    &position.data()->x, plane.data()};
  v.patches = {patch_first.data(), patch_vertex.data(), &position.data()->x, &velocity.data()->x};
  v.position = position.data(), v.velocity = velocity.data();
  v.start = start.data(), v.end = end.data();
  v.plane = plane.data(), v.patch = patch.data();
  v.grid = grid;
  v.impulse = impulse.data();
  v.grain = near.grain.data(), v.spring = near.spring.data(), v.touched = near.touched.data();
  v.sums = near.sums.data();
  return v;
}

void GrainEngine::set_coefficients(const dem::ContactCoefficients& pair, const dem::ContactCoefficients& floor,
                                   const dem::ContactCoefficients& side) {
  pair_ = pair, floor_ = floor, side_ = side;
}

Control GrainEngine::read_control() {
  device_.download(&control_, control_at_.data(), sizeof control_);
  return control_;
}
void GrainEngine::write_control() { device_.upload(control_at_.data(), &control_, sizeof control_); }

// ---- grains and lists -------------------------------------------------------------------------------------------

void GrainEngine::reserve(State& s, i64 n) {
  const auto count = static_cast<std::size_t>(n), places = count * static_cast<std::size_t>(slots_);
  s.low.reserve(device_, count), s.built.reserve(device_, count), s.high.reserve(device_, count);
  s.motion.reserve(device_, count), s.row.reserve(device_, count), s.load.reserve(device_, count);
  s.listed.reserve(device_, count), s.touching.reserve(device_, count);
  s.list.reserve(device_, places);
  if (has_springs()) s.spring.reserve(device_, places);
  if (has_rolls()) s.roll.reserve(device_, places);
}

void GrainEngine::build() {
  flush_walls();
  for (const auto& s : surfaces_) flush_surface(*s);
  const auto n = static_cast<std::size_t>(count_);
  Cells cells{};
  const double size = 2.0 * setup_.radius + setup_.skin;
  cells.nx = cells_along(bin_.length, size, bin_.periodic_x);
  cells.ny = cells_along(bin_.width, size, bin_.periodic_y);
  cells.per_x = cells.nx / bin_.length, cells.per_y = cells.ny / bin_.width, cells.per_z = 1.0 / size;
  cells.y0 = -0.5 * bin_.width;
  cells.periodic_x = bin_.periodic_x, cells.periodic_y = bin_.periodic_y;
  device_.clear(top_.data(), sizeof(u64));
  device_.launch(count_, TopKernel{pointers(state_), top_.data()});
  u64 bits = 0;
  device_.download(&bits, top_.data(), sizeof bits);
  double top = 0.0;
  std::memcpy(&top, &bits, sizeof top);
  top_height_ = top + setup_.radius;
  const double layers = std::min(kMostCells / (static_cast<double>(cells.nx) * cells.ny), 512.0);
  cells.nz = static_cast<i32>(std::clamp(top * cells.per_z, 0.0, std::max(layers - 1.0, 0.0))) + 1;
  const i32 all = cells.nx * cells.ny * cells.nz;

  key_.reserve(device_, n), place_.reserve(device_, n), sorted_key_.reserve(device_, n), order_.reserve(device_, n);
  start_.reserve(device_, static_cast<std::size_t>(all) + 1);
  device_.launch(count_, CellKernel{pointers(state_), cells, images(), bin_, key_.data(), place_.data()});
  device_.sort(key_.data(), sorted_key_.data(), place_.data(), order_.data(), count_, bits_for(all));
  reserve(spare_, count_);
  device_.launch(count_, PermuteKernel{pointers(state_), pointers(spare_), order_.data()});
  device_.launch(count_ + 1, CellStartKernel{sorted_key_.data(), count_, all, start_.data()});
  std::swap(state_, spare_);  // spare_ has the old order and the old lists until the end
  while (!list_neighbours(cells)) {
    slots_ = std::min(kMostSlots, std::max(slots_ + kMoreSlots, static_cast<i32>(max_slots_)));
    // Only the lists grow; what they held is in spare_.
    reserve(state_, count_);
  }
  if (listed_) {
    device_.launch(count_, CarryKernel{pointers(spare_), pointers(state_), order_.data(), has_springs(), has_rolls()});
  } else {
    device_.clear(state_.touching.data(), n * sizeof(u32));
  }
  find_near_walls(listed_);
  for (const auto& s : surfaces_) find_near_surface(*s, order_.data());
  listed_ = true;
  ++rebuilds_;
  read_control();
  control_.travel2 = 0;
  control_.stop &= ~kStopLists;
  if (control_.lost != ~0U) control_.stop |= kStopLost;
  write_control();
}

bool GrainEngine::list_neighbours(const Cells& cells) {
  device_.clear(most_.data(), sizeof(u32));
  const double reach = (2.0 * setup_.radius + setup_.skin) * per_unit_;
  const auto whole = static_cast<u64>(std::ceil(reach));
  device_.launch(count_,
                 ListKernel{pointers(state_), cells, images(), start_.data(), whole * whole, slots_, most_.data()});
  u32 needed = 0;
  device_.download(&needed, most_.data(), sizeof needed);
  max_slots_ = needed;
  if (needed > static_cast<u32>(kMostSlots))
    throw DeviceError{Status::fault, "a grain has " + std::to_string(needed) + " neighbours, expected at most " +
                                         std::to_string(kMostSlots)};
  return needed <= static_cast<u32>(slots_);
}

i32 GrainEngine::list_marked(Buffer<u32>& grain, Buffer<u32>& entry_of) {
  const auto n = static_cast<std::size_t>(count_);
  flag_sums_.reserve(device_, n);
  device_.exclusive_sums(flag_.data(), flag_sums_.data(), count_);
  u32 last[2] = {0, 0};
  if (count_ > 0) {
    device_.download(&last[0], flag_sums_.data() + n - 1, sizeof(u32));
    device_.download(&last[1], flag_.data() + n - 1, sizeof(u32));
  }
  const auto count = static_cast<i32>(last[0] + last[1]);
  grain.reserve(device_, static_cast<std::size_t>(count));
  entry_of.reserve(device_, n);
  device_.launch(count_, EntriesKernel{flag_.data(), flag_sums_.data(), grain.data(), entry_of.data()});
  return count;
}

void GrainEngine::find_near_walls(bool carry) {
  std::swap(near_walls_, spare_walls_);
  flag_.reserve(device_, static_cast<std::size_t>(count_));
  device_.launch(count_, NearWallKernel{pointers(state_), bin_, setup_.radius + setup_.skin, flag_.data()});
  NearWalls& now = near_walls_;
  now.count = list_marked(now.grain, now.entry_of);
  const auto n = static_cast<std::size_t>(now.count);
  now.spring.reserve(device_, n * dem::kWalls), now.impulse.reserve(device_, 3 * n), now.floor.reserve(device_, n);
  if (carry) {
    device_.launch(now.count, CarryWallsKernel{spare_walls_.pointers(), now.pointers(), order_.data(),
                                               spare_walls_.entry_of.data()});
  } else if (n > 0) {
    device_.clear(now.spring.data(), n * dem::kWalls * sizeof(WallSpring));
    device_.clear(now.impulse.data(), 3 * n * sizeof(i64));
    device_.clear(now.floor.data(), n * sizeof(double));
  }
}

// ---- surfaces ---------------------------------------------------------------------------------------------------

void GrainEngine::attach(const gpu::Surface& from) {
  auto s = std::make_unique<TireSurface>();
  s->vertices = from.vertices, s->triangles = from.triangles;
  const auto t = static_cast<std::size_t>(from.triangles), v = static_cast<std::size_t>(from.vertices);
  s->triangle.put(device_, from.triangle, t);
  s->neighbour.put(device_, from.neighbour, t);
  s->boundary.put(device_, from.boundary, v);
  s->around_first.put(device_, from.around_first, v + 1);
  s->around.put(device_, from.around, 3 * t);
  s->patch_first.put(device_, from.patch_first, t + 1);
  s->patch_vertex.put(device_, from.patch, static_cast<std::size_t>(from.patch_first[t]));
  for (i32 k = 0; k < from.vertices; ++k) s->end_host.push_back(triple(from.position[k]));
  for (Buffer<Vector>* const b : {&s->position, &s->start, &s->end}) b->put(device_, s->end_host.data(), v);
  s->velocity.put(device_, std::vector<Vector>(v, Vector{0, 0, 0}).data(), v);
  s->plane.reserve(device_, t);
  s->patch.reserve(device_, t);
  device_.clear(s->plane.data(), t * sizeof(FacetPlane));
  s->impulse.reserve(device_, 3 * v);
  device_.clear(s->impulse.data(), 3 * v * sizeof(i64));
  surfaces_.push_back(std::move(s));
}

void GrainEngine::set_surface_coefficients(int k, const dem::ContactCoefficients& c, bool rolls) {
  surfaces_.at(k)->coefficients = c;
  surfaces_[k]->rolls = rolls;
}

void GrainEngine::set_surface_motion(int k, const double (*end)[3], double duration, const FacetGrid& grid,
                                     bool same_grid) {
  TireSurface& s = *surfaces_.at(k);
  const auto v = static_cast<std::size_t>(s.vertices);
  s.duration = duration;
  std::vector<Vector> velocity(v);
  double fastest2 = 0.0;
  s.start.put(device_, s.end_host.data(), v);
  for (std::size_t a = 0; a < v; ++a) {
    const Vector to = triple(end[a]), way = to - s.end_host[a];
    velocity[a] = {way.x / duration, way.y / duration, way.z / duration};
    fastest2 = std::max(fastest2, dot(way, way));
    s.end_host[a] = to;
  }
  s.fastest = std::sqrt(fastest2) / duration;
  s.end.put(device_, s.end_host.data(), v);
  s.velocity.put(device_, velocity.data(), v);
  if (!same_grid) {
    const auto cells = static_cast<std::size_t>(grid.cells[0]) * grid.cells[1] * grid.cells[2];
    s.grid_first.put(device_, grid.first, cells + 1);
    s.grid_entry.put(device_, grid.entry, static_cast<std::size_t>(grid.first[cells]));
    s.grid_listed.put(device_, grid.listed, static_cast<std::size_t>(grid.listed_count));
    s.grid.origin = triple(grid.origin);
    s.grid.inverse_cell = grid.inverse_cell;
    std::copy_n(grid.cells, 3, s.grid.cells);
    s.grid.first = s.grid_first.data(), s.grid.entry = s.grid_entry.data(), s.grid.listed = s.grid_listed.data();
    s.grid.listed_count = grid.listed_count;
  }
  std::copy_n(grid.low, 3, s.low), std::copy_n(grid.high, 3, s.high);
  bool inside = true;
  for (int a = 0; a < 3; ++a)
    inside &= s.low[a] - setup_.skin >= s.listed_low[a] && s.high[a] + setup_.skin <= s.listed_high[a];
  if (!inside) {
    flush_surface(s);
    const double margin = setup_.skin + kListMargin * setup_.radius;
    for (int a = 0; a < 3; ++a) s.listed_low[a] = s.low[a] - margin, s.listed_high[a] = s.high[a] + margin;
    find_near_surface(s, nullptr);
  }
}

void GrainEngine::find_near_surface(TireSurface& s, const u32* order) {
  std::swap(s.near, spare_near_);
  flag_.reserve(device_, static_cast<std::size_t>(count_));
  device_.launch(count_, InBoxKernel{pointers(state_), triple(s.listed_low), triple(s.listed_high), flag_.data()});
  NearSurface& now = s.near;
  now.count = list_marked(now.grain, now.entry_of);
  const auto n = static_cast<std::size_t>(now.count);
  now.spring.reserve(device_, n * kMaxSurfaceHits), now.touched.reserve(device_, n),
      now.sums.reserve(device_, n * kFacetSums);
  device_.launch(now.count, CarryFacetsKernel{order, spare_near_.count > 0 ? spare_near_.entry_of.data() : nullptr,
                                              now.grain.data(), spare_near_.spring.data(), spare_near_.touched.data(),
                                              now.spring.data(), now.touched.data(), now.sums.data()});
  spare_near_.count = 0;
}

void GrainEngine::move_vertices(TireSurface& s, double share) {
  device_.launch(s.vertices, MoveVertexKernel{s.view(), share, control_at_.data()});
  device_.launch(s.grid.listed_count, PlaneKernel{s.view(), control_at_.data(), s.rolls && setup_.rolling != 0});
}

void GrainEngine::move_surfaces(double share) {
  control_.stop = 0;
  write_control();
  for (const auto& s : surfaces_) move_vertices(*s, share);
}

double GrainEngine::fastest_vertex() const {
  double fastest = 0.0;
  for (const auto& s : surfaces_) fastest = std::max(fastest, s->fastest);
  return fastest;
}

void GrainEngine::add_entries(const i64* from, i64 count, i32 width, i64* to) {
  if (count == 0) return;
  constexpr i64 kPiece = AddPiecesKernel::kPiece;
  i64 pieces = (count + kPiece - 1) / kPiece;
  Buffer<i64>*out = &added_, *other = &more_added_;
  for (;;) {
    out->reserve(device_, static_cast<std::size_t>(pieces * width));
    device_.launch(pieces * width, AddPiecesKernel{from, count, width, out->data()});
    if (pieces == 1) break;
    from = out->data(), count = pieces, pieces = (count + kPiece - 1) / kPiece;
    std::swap(out, other);
  }
  const std::vector<i64> sums = out->get(device_, static_cast<std::size_t>(width));
  for (i32 k = 0; k < width; ++k) to[k] += sums[k];
}

void GrainEngine::flush_walls() {
  NearWalls& w = near_walls_;
  add_entries(w.impulse.data(), w.count, 3, wall_sums_);
  if (w.count > 0) device_.clear(w.impulse.data(), 3 * static_cast<std::size_t>(w.count) * sizeof(i64));
}

void GrainEngine::take_wall_impulse(double (&impulse)[3]) {
  flush_walls();
  for (int k = 0; k < 3; ++k) impulse[k] = static_cast<double>(wall_sums_[k]) / kPerImpulse, wall_sums_[k] = 0;
}

void GrainEngine::flush_surface(TireSurface& s) {
  add_entries(s.near.sums.data(), s.near.count, kFacetSums, s.sums);
  if (s.near.count > 0)
    device_.clear(s.near.sums.data(), static_cast<std::size_t>(s.near.count) * kFacetSums * sizeof(i64));
}

void GrainEngine::surface_result(int k, double (*impulse)[3], SurfaceSums& sums) {
  TireSurface& s = *surfaces_.at(k);
  flush_surface(s);
  sums = {};
  const auto of = [&](int place) { return static_cast<double>(s.sums[place]) / kPerImpulse; };
  for (int a = 0; a < 3; ++a) sums.normal[a] = of(a), sums.tangential[a] = of(3 + a), sums.moment_gap[a] = of(6 + a);
  sums.force_scale = of(9), sums.moment_scale = of(10);
  std::fill_n(s.sums, kFacetSums, 0);
  for (const u32 touched : s.near.touched.get(device_, static_cast<std::size_t>(s.near.count)))
    sums.contacts += touched & 0xffffU, sums.sliding += touched >> 16;
  const auto v = static_cast<std::size_t>(s.vertices);
  const std::vector<i64> whole = s.impulse.get(device_, 3 * v);
  for (std::size_t a = 0; a < v; ++a)
    for (int axis = 0; axis < 3; ++axis) impulse[a][axis] = static_cast<double>(whole[3 * a + axis]) / kPerImpulse;
  device_.clear(s.impulse.data(), 3 * v * sizeof(i64));
}

// ---- steps ------------------------------------------------------------------------------------------------------

void GrainEngine::launch_forces(double dt, double kick) {
  with_law([&](auto law, auto rolling) {
    using Law = decltype(law);
    constexpr bool kRolling = decltype(rolling)::value;
    const Pointers g = pointers(state_);
    device_.launch(count_, PairKernel<Law, kRolling>{g, pair_params<Law>(dt)});
    device_.launch(near_walls_.count, WallKernel<Law, kRolling>{g, near_walls_.pointers(), wall_params<Law>(dt, kick)});
    for (const auto& s : surfaces_)
      device_.launch(s->near.count, FacetKernel<Law, kRolling>{g, s->view(), facet_params<Law>(*s, dt, kick)});
  });
}

RunResult GrainEngine::run(const Run& r) {
  RunResult result{};
  result.lost = -1;
  const double half_skin = 0.5 * setup_.skin * per_unit_;
  const double longest = (2.0 * setup_.radius) * per_unit_;
  control_.deepest = 0;
  bool first = true;
  while (result.done < r.steps && result.stop == Stop::none) {
    control_.stop = 0, control_.done = 0;
    write_control();
    const int begin = result.done, end = std::min(r.steps, begin + kBatch);
    for (int k = begin; k < end; ++k) {
      const double since = first && k == 0 ? r.since : r.dt, kick = 0.5 * (since + r.dt);
      for (const auto& s : surfaces_) move_vertices(*s, r.share + k * r.share_each);
      launch_forces(since, kick);
      device_.launch(count_, MoveKernel{pointers(state_),
                                        1.0 / setup_.mass,
                                        1.0 / setup_.inertia,
                                        kick,
                                        1.0 / (1.0 + kick * r.drag),
                                        r.dt,
                                        {setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]},
                                        longest});
      device_.launch(1, ControlKernel{control_at_.data(), static_cast<u64>(half_skin * half_skin), r.dt,
                                      fastest_vertex(), r.most});
    }
    read_control();
    result.done += static_cast<i32>(control_.done);
    if (control_.done > 0) first = false;
    if (control_.stop & kStopLost) result.stop = Stop::lost, result.lost = static_cast<i32>(control_.lost);
    if (control_.stop & kStopOverlap && result.stop == Stop::none) result.stop = Stop::overlap;
    if (control_.stop & kStopLists) {
      build();
      if (control_.lost != ~0U) result.stop = Stop::lost, result.lost = static_cast<i32>(control_.lost);
    }
  }
  const auto number = [](u32 bits) {
    float v = 0.0F;
    std::memcpy(&v, &bits, sizeof v);
    return static_cast<double>(v);
  };
  result.max_overlap = number(control_.deepest);
  result.last_overlap = number(control_.last_overlap);
  result.last_speed = std::sqrt(number(control_.last_speed2));
  return result;
}

Hardest GrainEngine::hardest(double above, double ahead, double deepest) {
  HardResult none{};
  device_.upload(hard_.data(), &none, sizeof none);
  const Pointers g = pointers(state_);
  const HardFinder find{hard_.data(), above, ahead, setup_.radius, deepest};
  device_.launch(count_, HardPairsKernel{g, find, images()});
  device_.launch(near_walls_.count, HardWallsKernel{g, near_walls_.pointers(), bin_, find});
  for (std::size_t k = 0; k < surfaces_.size(); ++k)
    device_.launch(surfaces_[k]->near.count, HardFacetsKernel{g, surfaces_[k]->view(), find, static_cast<u32>(k)});
  HardResult found{};
  device_.download(&found, hard_.data(), sizeof found);
  Hardest out{};
  out.count = found.count, out.past = found.past;
  std::memcpy(&out.overlap, &found.overlap, sizeof out.overlap);
  std::memcpy(&out.coming, &found.coming, sizeof out.coming);
  for (int kind = 0; kind < 3; ++kind) {
    if (found.deepest[kind] == 0) continue;
    const auto bits = static_cast<u32>(found.deepest[kind] >> 32);
    float share = 0.0F;
    std::memcpy(&share, &bits, sizeof share);
    if (static_cast<double>(share) <= out.share) continue;
    const u32 turned = ~static_cast<u32>(found.deepest[kind]);
    out.share = static_cast<double>(share), out.kind = kind, out.partner = static_cast<i32>(turned & 15U);
    out.grain = static_cast<i32>(turned >> 4);
  }
  return out;
}

Sums GrainEngine::sums(bool losses, double dt) {
  const auto n = static_cast<std::size_t>(count_);
  Measured* const to = measured_.reserve(device_, n);
  const Pointers g = pointers(state_);
  with_law([&](auto law, auto rolling) {
    using Law = decltype(law);
    constexpr bool kRolling = decltype(rolling)::value;
    device_.launch(count_,
                   MeasurePairsKernel<Law, kRolling>{g, pair_params<Law>(dt), pair_.of<Law, double>(), to, losses});
    device_.launch(near_walls_.count,
                   MeasureWallsKernel<Law, kRolling>{g, near_walls_.pointers(), wall_params<Law>(dt, 0.0), to, losses});
    for (const auto& s : surfaces_)
      device_.launch(s->near.count,
                     MeasureFacetsKernel<Law, kRolling>{g, s->view(), facet_params<Law>(*s, dt, 0.0), to, losses});
  });
  device_.launch(count_, NetForceKernel{to,
                                        {setup_.mass * setup_.gravity[0], setup_.mass * setup_.gravity[1],
                                         setup_.mass * setup_.gravity[2]}});
  Sums out{};
  if (count_ > 0) {
    const Measured* from = to;
    i64 count = count_;
    Buffer<Measured>*into = &pieces_, *other = &more_pieces_;
    for (;;) {
      const i64 pieces = (count + AddMeasuredKernel::kPiece - 1) / AddMeasuredKernel::kPiece;
      into->reserve(device_, static_cast<std::size_t>(pieces));
      device_.launch(pieces, AddMeasuredKernel{from, count, into->data()});
      if (pieces == 1) break;
      from = into->data(), count = pieces;
      std::swap(into, other);
    }
    Measured all{};
    device_.download(&all, into->data(), sizeof all);
    out.speed2 = all.speed2, out.spin2 = all.spin2;
    std::copy_n(all.speed, 3, out.speed), std::copy_n(all.place, 3, out.place);
    out.elastic = all.elastic, out.contacts = all.contacts, out.contact_force = all.contact_force;
    out.net_force = all.net_force, out.cohesion = all.cohesion, out.tangential = all.tangential;
    std::copy_n(all.losses, 5, out.losses);
    out.floor_force = all.floor, out.listed = all.listed;
  }
  out.rebuilds = rebuilds_, out.bytes = device_.bytes();
  out.top = top_height_ + setup_.skin;
  return out;
}

}  // namespace furrow::terrain::gpu
