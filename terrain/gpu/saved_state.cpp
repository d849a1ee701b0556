#include "terrain/gpu/saved_state.hpp"

#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/bin.hpp"

namespace furrow::terrain::gpu {
namespace {

[[noreturn]] void damaged(const std::string& what) {
  throw Error(ExitCode::io, "saved state " + what + ": it is damaged");
}

/// The numbers of an entry, in the order of the saved state, after its two names.
auto numbers_of(auto& of) {
  using Entry = std::remove_cvref_t<decltype(of)>;
  if constexpr (std::is_same_v<Entry, FacetTouch>)
    return std::tie(of.normal, of.tangential, of.root_overlap, of.rolling);
  else
    return std::tie(of.tangential, of.root_overlap, of.rolling);
}
auto names_of(auto& of) {
  using Entry = std::remove_cvref_t<decltype(of)>;
  if constexpr (std::is_same_v<Entry, Pair>)
    return std::tie(of.i, of.j);
  else if constexpr (std::is_same_v<Entry, WallTouch>)
    return std::tie(of.grain, of.wall);
  else
    return std::tie(of.grain, of.surface);
}

template <class Number>
void each(Number& v, auto&& f) {
  if constexpr (std::is_array_v<Number>)
    for (auto& one : v) f(one);
  else
    f(v);
}

template <class Entry>
void put(const std::vector<Entry>& entries, const std::string& word, Archive& archive) {
  std::vector<std::int32_t> names;
  std::vector<double> numbers;
  for (const Entry& one : entries) {
    std::apply([&](const auto&... name) { (names.push_back(name), ...); }, names_of(one));
    std::apply([&](const auto&... number) { (each(number, [&](auto v) { numbers.push_back(v); }), ...); },
               numbers_of(one));
  }
  archive.put(word + "/of", names);
  archive.put(word + "/springs", numbers);
}

/// @param partners  number of those that the second name may have
template <class Entry>
void take(std::vector<Entry>& entries, const std::string& word, std::int64_t grains, std::int64_t partners,
          const Archive& archive) {
  constexpr std::size_t kNumbers = std::is_same_v<Entry, FacetTouch> ? 10 : 7;
  const auto& names = archive.get<std::int32_t>(word + "/of");
  if (names.size() % 2 != 0) damaged("'" + word + "/of' holds a grain without its partner");
  const auto& numbers = archive.get<double>(word + "/springs", kNumbers * names.size() / 2);
  const double* from = numbers.data();
  for (std::size_t k = 0; k < names.size(); k += 2) {
    if (names[k] < 0 || names[k] >= grains || names[k + 1] < 0 || names[k + 1] >= partners)
      damaged(fmt::format("'{}/of' names {} and {} of {} and {}", word, names[k], names[k + 1], grains, partners));
    Entry& one = entries.emplace_back();
    std::get<0>(names_of(one)) = names[k], std::get<1>(names_of(one)) = names[k + 1];
    std::apply(
        [&](auto&... number) {
          (each(number, [&](auto& v) { v = static_cast<std::remove_reference_t<decltype(v)>>(*from++); }), ...);
        },
        numbers_of(one));
  }
}

}  // namespace

void save_grains(const GrainMotion& motion, const Histories& histories, Archive& archive) {
  save_value(archive, "position", motion.position);
  save_value(archive, "velocity", motion.velocity);
  save_value(archive, "spin", motion.spin);
  put(histories.pairs, "pairs", archive);
  put(histories.walls, "walls", archive);
  put(histories.facets, "facets", archive);
}

SavedGrains read_grains(const Archive& archive) {
  SavedGrains saved;
  restore_value(archive, "position", saved.motion.position);
  const std::size_t n = saved.motion.position.size();
  restore_value(archive, "velocity", saved.motion.velocity, n);
  restore_value(archive, "spin", saved.motion.spin, n);
  for (const auto* of : {&saved.motion.position, &saved.motion.velocity, &saved.motion.spin})
    for (const Vec3& v : *of)
      if (!v.allFinite()) damaged("of the grains is not finite");
  const auto grains = static_cast<std::int64_t>(n);
  take(saved.histories.pairs, "pairs", grains, grains, archive);
  take(saved.histories.walls, "walls", grains, dem::kWalls, archive);
  take(saved.histories.facets, "facets", grains, archive.get_int("surfaces/count"), archive);
  return saved;
}

}  // namespace furrow::terrain::gpu
