// Size of a table's file when a checkpoint was made.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/core/fields.hpp"

namespace furrow::checkpoint {

struct SeriesMark {
  std::int64_t bytes = 0, lines = 0;  // lines of values
  std::string checksum;               // of those bytes
  std::string subject;                // of the table: "wheel0", "vehicle"
};
void visit_fields(FieldsOf<SeriesMark> auto& s, auto&& visit) {
  visit(s.subject, Field{"subject", ""});
  visit(s.bytes, Field{"bytes"});
  visit(s.lines, Field{"lines"});
  visit(s.checksum, Field{"checksum", ""});
}

}  // namespace furrow::checkpoint
