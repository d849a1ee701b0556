#include "terrain/liggghts/saved_grains.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
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

/// The numbers of an entry, in the order of the saved state.
auto numbers_of(auto& of) {
  using Entry = std::remove_cvref_t<decltype(of)>;
  if constexpr (std::is_same_v<Entry, NewGrain>)
    return std::tie(of.radius, of.position, of.list_position, of.exchange_position, of.velocity, of.spin);
  else if constexpr (std::is_same_v<Entry, PairRecord>)
    return std::tie(of.tangential, of.root_overlap, of.rolling);
  else
    return std::tie(of.partner, of.normal, of.tangential, of.root_overlap, of.rolling);
}

void put_one(std::vector<double>& to, double v) { to.push_back(v); }
void put_one(std::vector<double>& to, const std::array<double, 3>& v) { to.insert(to.end(), v.begin(), v.end()); }
void put(std::vector<double>& to, const auto& entry) {
  std::apply([&](const auto&... one) { (put_one(to, one), ...); }, numbers_of(entry));
}

void take_one(const double*& from, double& v) { v = *from++; }
void take_one(const double*& from, std::array<double, 3>& v) {
  for (double& x : v) x = *from++;
}
void take(const double*& from, auto& entry) {
  std::apply([&](auto&... one) { (take_one(from, one), ...); }, numbers_of(entry));
}

}  // namespace

void save_grains(Engine& engine, std::span<const CarriedBy> contacts, Archive& archive) {
  std::vector<std::int32_t> id, partners, carriers;
  std::vector<double> state, pairs, carried;
  for (const NewGrain& g : engine.own_state()) {
    id.push_back(g.id);
    put(state, g);
  }
  for (const PairRecord& p : engine.own_pairs()) {
    partners.insert(partners.end(), {p.i, p.j});
    put(pairs, p);
  }
  for (const CarriedBy& by : contacts) {
    carriers.push_back(by.grain);
    put(carried, by.contact);
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
  const double *state = states.data(), *pair = histories.data(), *contact = contacts.data();
  StartingBed bed;
  for (const std::int32_t k : id) {
    grain_of(k, size, "grains/id");
    NewGrain g;
    g.id = k;
    take(state, g);
    bed.grains.push_back(g);
  }
  for (std::size_t p = 0; p < partners.size(); p += 2) {
    PairRecord r;
    r.i = partners[p], r.j = partners[p + 1];
    grain_of(r.i, size, "pairs/grains"), grain_of(r.j, size, "pairs/grains");
    take(pair, r);
    bed.pairs.push_back(r);
  }
  for (const std::int32_t k : carriers) {
    grain_of(k, size, "carried/grain");
    Carried c;
    take(contact, c);
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
