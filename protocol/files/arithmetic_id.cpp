#include "protocol/files/arithmetic_id.hpp"

namespace furrow {

std::string arithmetic_id() { return FURROW_ARITHMETIC; }

}  // namespace furrow
