#include "protocol/files/fault_point.hpp"

namespace furrow {

void fault_point(const char*) {}
std::string fault_text(const char*) { return {}; }

}  // namespace furrow
