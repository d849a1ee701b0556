// Tables from spreadsheets in other languages are refused with the reason.
#include "protocol/files/csv_file.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

std::string refused_table(const std::string& text) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "t.csv";
  std::ofstream(file, std::ios::binary) << text;
  const std::string told = refusal(ExitCode::bad_input, [&] {
    CsvFile(file, "a table", {"x_m", "z_m"}).number(0, "x_m");
  });
  return without_file(told, file.string());
}

TEST(CsvFile, tables_of_other_programs_are_refused_with_what_to_change) {
  EXPECT_EQ(refused_table("x_m;z_m\n0;0,1\n"),
            "key 'line 1': has ';' between its values, expected commas, and numbers with a decimal point: 0.1; the "
            "columns are: x_m, z_m");
  EXPECT_TRUE(holds(refused_table("Weg;Kraft\n0;1\n"), "has ';' between its values"));
  EXPECT_TRUE(holds(refused_table("x_m\tz_m\n0\t1\n"), "has tabs between its values"));
  EXPECT_TRUE(holds(refused_table("\"x_m\",\"z_m\"\n0,1\n"), "has quotes around its values, expected none"));
  EXPECT_TRUE(holds(refused_table("x_m,z_m,\n0,1,\n"), "ends with a comma"));
  EXPECT_TRUE(
      holds(refused_table("0,1\n1,1\n"), "begins with the number '0', expected the names of the columns first"));
  EXPECT_EQ(refused_table("x_m,z_m\n0,0,0,1\n"),
            "key 'line 2': has 4 values, expected 2, with decimal points, not commas");
  EXPECT_TRUE(holds(refused_table("x,z_m\n0,1\n"), "column 'x' is unknown"));
  EXPECT_EQ(refused_table("x_m,z_m\n0,1\n"), "");
}

}  // namespace
}  // namespace furrow
