#include "nodes/scenario/scenario_schema.hpp"

#include <string>

#include "nodes/scenario/scenario.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/key_schema.hpp"
#include "rigs/drawbar_spec.hpp"
#include "rigs/rigs.hpp"
#include "terrain/terrains.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::scenario {
namespace {

using Json = nlohmann::ordered_json;

struct Head {
  std::string schema, description, completed_by;
  int format_version = 1;
};
void visit_fields(FieldsOf<Head> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.schema, key("$schema", "", optional(), "Schema for editors. The program ignores it."));
  visit(s.description, key("description", "", optional(), "What the scenario is about. The program ignores it."));
  visit(s.completed_by, key("completed_by", "", optional(),
                            "Version that completed the scenario of a run with the defaults. Keys of other engines and "
                            "types of rig are then ignored instead of refused. It has no other effect."));
  visit(s.format_version, key("format_version", "", from(1, 1), "Version of the scenario format."));
}

/// A section that a scenario may omit: all its keys have defaults.
Json with_default(Json section) {
  section["default"] = Json::object();
  return section;
}

/// A section in which the key `chooser` chooses one of the models.
template <class Options, class Models>
Json model_section(SchemaWriter& writer, const char* chooser, const Models& models, const char* description) {
  Json section = writer.object<Options>(description);
  Json names = Json::array();
  std::string text = section["properties"][chooser]["description"];
  for (const auto& model : models) {
    names.push_back(model.name);
    text += std::string(" ") + model.name + ": " + model.says + ".";
    model.keys.add_to(writer, section);
  }
  section["properties"][chooser]["enum"] = names;
  section["properties"][chooser]["description"] = text;
  return with_default(section);
}

}  // namespace

Json scenario_schema() {
  SchemaWriter writer;
  Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"},
               {"title", "Furrow scenario"},
               {"description",
                "What a scenario may say. SI units, angles in radians. `unit`, `usual` (outside of it: a warning) and "
                "`entries` (what a list holds) are read by furrow; everything else is JSON Schema."},
               {"type", "object"},
               {"additionalProperties", false},
               {"required", {"terrain"}},
               {"properties", Json::object()}};
  writer.add_keys<Head>(root);
  Json& sections = root["properties"];
  writer.reference<rigs::DrawbarWheel>();
  const Json tire = writer.reference<tire::TireOptions>();
  sections["rig"] = model_section<rigs::RigOptions>(writer, "type", rigs::rig_kinds(),
                                                    "What carries the tires: a test rig or a vehicle.");
  sections["tire"] = tire;
  sections["tires"] = {
      {"type", "array"},
      {"minItems", 1},
      {"maxItems", 64},
      {"items", tire},
      {"description",
       "One entry per wheel of rig.wheels, in place of a `tire` for all. A vehicle takes one entry per wheel (left and "
       "right of each axle, in the order of its file) or one per axle; each states what differs from the vehicle's own "
       "tire, and from `tire` where that is given for all of them."}};
  sections["terrain"] =
      model_section<terrain::CommonOptions>(writer, "engine", terrain::terrains(), "What the tire rolls on.");
  sections["run"] = with_default(writer.object<RunOptions>("Time stepping."));
  sections["output"] = with_default(writer.object<OutputOptions>("How often results are written."));
  sections["checkpoint"] = with_default(writer.object<CheckpointOptions>(
      "When the state of the run is written to its folder. 'furrow resume' continues from there bit for bit. The "
      "signals TERM, INT, HUP and USR1 have a checkpoint written too."));
  sections["press"] = writer.object<PressKeys>(
      "How `furrow press` presses the tire of this scenario. Its options override these keys; a run ignores them.");
  sections["expected"] =
      writer.object<ExpectedResult>("What a shipped scenario is known to give, printed beside the result.");
  root["definitions"] = writer.definitions;
  return root;
}

}  // namespace furrow::scenario
