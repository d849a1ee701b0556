#include "tire/tire_spec.hpp"

#include "tire/press.hpp"

namespace furrow::tire {

std::unique_ptr<StaticTest> TireSpec::static_test() const { return nullptr; }

}  // namespace furrow::tire
