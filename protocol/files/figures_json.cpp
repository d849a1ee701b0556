#include "protocol/files/figures_json.hpp"

#include <string_view>

namespace furrow {

std::string name_with_unit(const Field& field) {
  const std::string_view unit = field.unit;
  std::string name = field.name;
  if (unit.empty() || unit == "-") return name;
  name += '_';
  constexpr std::string_view kSquare = "²";
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit.substr(i).starts_with(kSquare)) {
      name += '2';
      i += kSquare.size() - 1;
    } else if (unit[i] == '/') {
      name += "_per_";
    } else {
      name += unit[i] == ' ' ? '_' : unit[i];
    }
  }
  return name;
}

}  // namespace furrow
