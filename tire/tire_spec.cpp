#include "tire/tire_spec.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "tire/modes.hpp"
#include "tire/press/press.hpp"

namespace furrow::tire {
namespace {

// Keys of every model: its file, its coupling, and tangents, which have their own check.
constexpr std::array<std::string_view, 4> kOfEveryModel{"file", "rigid", "contact_tangent", "substeps"};

}  // namespace

std::unique_ptr<StaticTest> TireSpec::static_test() const { return nullptr; }
std::unique_ptr<ModalTest> TireSpec::modal_test() const { return nullptr; }

std::vector<std::string> idle_keys(const TireSpec& tire) {
  const std::vector<std::string> takes = tire.describe().takes;
  const TireOptions defaults;
  std::vector<const void*> members;  // of the defaults, in the order of the list
  visit_fields(defaults, [&](const auto& value, const furrow::Field&) { members.push_back(&value); });
  std::vector<std::string> idle;
  std::size_t place = 0;
  visit_fields(tire.options(), [&](const auto& value, const furrow::Field& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    const bool stated = !(value == *static_cast<const Value*>(members[place++]));
    const auto named = [&](const auto& names) {
      return std::find(names.begin(), names.end(), field.name) != names.end();
    };
    if (stated && !named(takes) && !named(kOfEveryModel)) idle.emplace_back(field.name);
  });
  return idle;
}

}  // namespace furrow::tire
