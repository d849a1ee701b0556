#include "terrain/liggghts/saved_grains.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr std::size_t kState = 16, kPair = 7, kCarried = 11;  // numbers of an entry
constexpr std::int64_t kMostGrains = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void damaged(const std::string& what) {
  throw Error(ExitCode::io, "saved state " + what + ": it is damaged");
}

void grain_of(std::int32_t grain, std::int64_t size, const char* array) {
  if (grain < 0 || grain >= size) damaged(fmt::format("'{}' names grain {} of {}", array, grain, size));
}

void put(std::vector<double>& to, const std::array<double, 3>& v) { to.insert(to.end(), v.begin(), v.end()); }

class Numbers {
 public:
  explicit Numbers(const std::vector<double>& values) : next_(values.data()) {}
  double one() { return *next_++; }
  std::array<double, 3> three() {
    std::array<double, 3> v{};
    for (double& x : v) x = one();
    return v;
  }

 private:
  const double* next_;
};

}  // namespace

void save_grains(Engine& engine, std::span<const CarriedBy> contacts, Archive& archive) {
  std::vector<std::int32_t> id, partners, carriers;
  std::vector<double> state, pairs, carried;
  for (const NewGrain& g : engine.own_state()) {
    id.push_back(g.id);
    state.push_back(g.radius);
    for (const auto* v : {&g.position, &g.list_position, &g.exchange_position, &g.velocity, &g.spin}) put(state, *v);
  }
  for (const PairRecord& p : engine.own_pairs()) {
    partners.insert(partners.end(), {p.i, p.j});
    put(pairs, p.tangential);
    pairs.push_back(p.root_overlap);
    put(pairs, p.rolling);
  }
  for (const CarriedBy& by : contacts) {
    const Carried& c = by.contact;
    carriers.push_back(by.grain);
    carried.push_back(c.partner);
    put(carried, c.normal);
    put(carried, c.tangential);
    carried.push_back(c.root_overlap);
    put(carried, c.rolling);
  }
  archive.put("grains/id", id);
  archive.put("grains/state", state);
  archive.put("pairs/grains", partners);
  archive.put("pairs/history", pairs);
  archive.put("carried/grain", carriers);
  archive.put("carried/history", carried);
}

StartingBed read_grains(const Archive& archive, std::int64_t size) {
  if (size < 0 || size > kMostGrains) damaged(fmt::format("'grains/all' is {}", size));
  const auto& id = archive.get<std::int32_t>("grains/id");
  const auto& states = archive.get<double>("grains/state", kState * id.size());
  const auto& partners = archive.get<std::int32_t>("pairs/grains");
  const auto& histories = archive.get<double>("pairs/history", kPair * (partners.size() / 2));
  const auto& carriers = archive.get<std::int32_t>("carried/grain");
  const auto& contacts = archive.get<double>("carried/history", kCarried * carriers.size());
  if (partners.size() % 2 != 0) damaged("'pairs/grains' holds a grain without its partner");
  Numbers state(states), pairs(histories), carried(contacts);
  StartingBed bed;
  for (const std::int32_t k : id) {
    grain_of(k, size, "grains/id");
    NewGrain g;
    g.id = k;
    g.radius = state.one();
    for (auto* v : {&g.position, &g.list_position, &g.exchange_position, &g.velocity, &g.spin}) *v = state.three();
    bed.grains.push_back(g);
  }
  for (std::size_t p = 0; p < partners.size(); p += 2) {
    PairRecord r;
    r.i = partners[p], r.j = partners[p + 1];
    grain_of(r.i, size, "pairs/grains"), grain_of(r.j, size, "pairs/grains");
    r.tangential = pairs.three();
    r.root_overlap = pairs.one();
    r.rolling = pairs.three();
    bed.pairs.push_back(r);
  }
  for (const std::int32_t k : carriers) {
    grain_of(k, size, "carried/grain");
    Carried c;
    c.partner = carried.one();
    c.normal = carried.three();
    c.tangential = carried.three();
    c.root_overlap = carried.one();
    c.rolling = carried.three();
    bed.walls.push_back({k, c});
  }
  return bed;
}

Archive as_solver_state(std::span<const Archive> parts, const dem::DemOptions& options) {
  StartingBed all;
  std::int64_t size = 0;
  for (const Archive& part : parts) {
    const Archive::Scope scope(part, "terrain/");
    size = part.get_int("grains/all");
    StartingBed bed = read_grains(part, size);
    all.grains.insert(all.grains.end(), bed.grains.begin(), bed.grains.end());
    all.pairs.insert(all.pairs.end(), bed.pairs.begin(), bed.pairs.end());
    all.walls.insert(all.walls.end(), bed.walls.begin(), bed.walls.end());
  }
  std::sort(all.grains.begin(), all.grains.end(), [](const NewGrain& a, const NewGrain& b) { return a.id < b.id; });
  for (std::int64_t k = 0; k < size; ++k)
    if (all.size() != size || all.grains[k].id != k) damaged("'grains' of all ranks are not those of the run");
  dem::GrainSolver solver(dem::solver_params(options));
  begin_from(solver, all);
  Archive archive;
  const Archive::Scope scope(archive, "terrain/");
  solver.save(archive);
  return archive;
}

}  // namespace furrow::terrain::liggghts
