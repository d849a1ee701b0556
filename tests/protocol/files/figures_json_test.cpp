// Results as JSON: names with units, null for what does not exist, structs within structs.
#include "protocol/files/figures_json.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace furrow;

namespace {

struct Strut {
  double length = 0.2, room = std::numeric_limits<double>::infinity();
};
void visit_fields(FieldsOf<Strut> auto& s, auto&& visit) {
  visit(s.length, Field{"length", "m"});
  visit(s.room, Field{"room", "m"});
}

struct Wheel {
  std::string name = "left";
  int bodies = 3;
  double rate = 4.5, share = std::numeric_limits<double>::quiet_NaN();
  Vec3 place = Vec3(1, 2, 3);
  std::optional<Strut> spring = Strut{}, shock;
  std::vector<double> loads = {1.0, 2.0};
};
void visit_fields(FieldsOf<Wheel> auto& s, auto&& visit) {
  visit(s.name, Field{"name", ""});
  visit(s.bodies, Field{"bodies", ""});
  visit(s.rate, Field{"rate", "N/m"});
  visit(s.share, Field{"share"});
  visit(s.place, Field{"place", "m"});
  visit(s.spring, Field{"spring", ""});
  visit(s.shock, Field{"shock", ""});
  visit(s.loads, Field{"loads", "N"});
}

}  // namespace

TEST(FiguresJson, has_names_with_units_and_null_for_what_does_not_exist) {
  EXPECT_EQ(figures_json(Wheel{}).dump(),
            R"({"name":"left","bodies":3,"rate_N_per_m":4.5,"share":null,"place_m":[1.0,2.0,3.0],)"
            R"("spring":{"length_m":0.2,"room_m":null},"shock":null,"loads_N":[1.0,2.0]})");
}

TEST(FiguresJson, units_can_be_written_in_a_name) {
  EXPECT_EQ(name_with_unit({"inertia", "kg m²"}), "inertia_kg_m2");
  EXPECT_EQ(name_with_unit({"slope", "-"}), "slope");
  EXPECT_EQ(name_with_unit({"coefficient", "N s/m"}), "coefficient_N_s_per_m");
}
