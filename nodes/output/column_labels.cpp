#include "nodes/output/column_labels.hpp"

#include <algorithm>
#include <string_view>

namespace furrow::output {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;) text.replace(at, what.size(), by);
  return text;
}

}  // namespace

std::string units_label(std::string_view unit) {
  if (unit == "-" || unit.empty()) return "1";
  return replaced(replaced(std::string(unit), "²", "2"), "³", "3");
}

std::string long_name(const Column& column) {
  std::string name = column.name;
  const std::string unit = replaced(units_label(column.unit), "/", "_per_");
  for (const std::string_view space : {"_", ""}) {  // "kg m/s" ends a name as kg_m_per_s, "N m" as Nm
    const std::string ending = "_" + replaced(unit, " ", space);
    if (name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      break;
    }
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string cell_methods(const Column& column) {
  constexpr const char* kMethods[] = {"time_s: point", "time_s: mean", "time_s: sum", "time_s: maximum", ""};
  return kMethods[static_cast<std::size_t>(column.kind)];
}

}  // namespace furrow::output
