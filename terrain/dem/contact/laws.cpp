#include "terrain/dem/contact/laws.hpp"

#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {

std::string law_names() {
  constexpr std::size_t kCount = std::tuple_size_v<Laws>;
  std::string names;
  std::size_t place = 0;
  for_each_law([&](auto law) {
    names += (place == 0 ? "" : place + 1 < kCount ? ", " : " or ") + std::string(law.kName);
    ++place;
  });
  return names;
}

LawKind law_from(const std::string& name) {
  int place = 0, found = -1;
  for_each_law([&](auto law) { found = name == law.kName ? place : found, ++place; });
  if (found >= 0) return LawKind{found};
  throw input_error("scenario", "terrain.law", "'" + name + "' is unknown, expected " + law_names());
}

}  // namespace furrow::terrain::dem
