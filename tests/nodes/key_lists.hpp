// What tests demand of the keys of a section, from the tables of models alone.
#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/scenario/schema.hpp"
#include "protocol/files/json_fields.hpp"

namespace furrow::testing {

/// A number without a unit, "-" in its list, may lack the entry in the schema.
inline void expect_unit(const nlohmann::json& node, const Field& field, const std::string& key) {
  const std::string unit = node.value("unit", "");
  EXPECT_TRUE(unit == field.unit || (unit.empty() && std::string(field.unit) == "-")) << key << ": " << field.unit;
}

/// The keys of all lists together are those of the schema's section; each has the schema's unit, and the schema's
/// defaults are those of the structs.
inline void expect_keys_of_schema(const std::string& section, const std::vector<KeyList>& lists) {
  const scenario::Schema schema = scenario::Schema::load();
  const nlohmann::json* node = schema.find(section);
  ASSERT_NE(node, nullptr) << section;
  std::set<std::string> listed, known;
  nlohmann::json defaults = nlohmann::json::object();
  for (const auto& [name, unused] : node->at("properties").items()) {
    known.insert(name);
    const nlohmann::json* key = schema.find(section + "." + name);
    defaults[name] = key->value("default", nlohmann::json());
  }
  for (const KeyList& list : lists) {
    for (const Field& field : list.fields()) {
      if (!field.is(role::key)) continue;
      listed.insert(field.name);
      const std::string key = section + "." + field.name;
      ASSERT_NE(schema.find(key), nullptr) << key;
      expect_unit(*schema.find(key), field, key);
    }
    EXPECT_EQ(list.changed(defaults), std::vector<std::string>()) << "defaults of " << section;
  }
  EXPECT_EQ(listed, known) << section;
}

}  // namespace furrow::testing
