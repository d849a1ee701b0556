// Context of the reader of a model's keys: the file that it reads, and the section.
#pragma once

#include <string>

namespace furrow {

struct ReadContext {
  std::string file;     // the scenario, for messages
  std::string section;  // "terrain": prefix of each key in messages

  std::string key(const std::string& name) const { return section.empty() ? name : section + "." + name; }
};

}  // namespace furrow
