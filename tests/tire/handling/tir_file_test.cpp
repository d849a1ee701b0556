// Tire property files: written files are read back, and errors are refused with their names.
#include "tire/handling/tir_file.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <tuple>

#include "protocol/core/error.hpp"
#include "tests/tire/handling/example_tire.hpp"
#include "tire/handling/magic_formula.hpp"

namespace furrow::tire::handling::tir_file_test {
namespace {

std::string whole() { return tir_text(example_tire(), {"a tire for tests", "made up"}); }

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = whole();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The file without the section of that name.
std::string without(const std::string& section) {
  std::string text = whole();
  const std::size_t at = text.find("[" + section + "]");
  return text.erase(at, text.find("\n[", at) + 1 - at);
}

std::string complaint(const std::string& text) {
  return refusal(ExitCode::bad_input, [&] { parse_tir(text, "a.tir"); });
}

TEST(TirFile, reads_back_what_it_wrote_bit_for_bit) {
  MagicFormula t = example_tire();
  t.longitudinal.pdx2 = -0.1 / 3.0;
  t.load.most = 1e4 / 7.0;
  t.friction_ellipse = true;
  const std::string text = tir_text(t, {});
  EXPECT_EQ(tir_text(parse_tir(text, "a.tir"), {}), text);
  EXPECT_EQ(parse_tir(text, "a.tir").longitudinal.pdx2, t.longitudinal.pdx2);
  EXPECT_TRUE(parse_tir(text, "a.tir").friction_ellipse);
}

/// Comments, quotes, line ends, names in small letters, and sections of other programs.
TEST(TirFile, takes_layouts_of_others) {
  std::string text = whole();
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"[UNITS]\n", "$------ units\n[units]\n"},
                                 {"FORCE = 'newton'", "force ='Newton'   $ N"},
                                 {"LENGTH = 'meter'", "LENGTH              ='meter'"},
                                 {"FITTYP             = 5", "FITTYP = 5 $Magic Formula Version number\nMFSAFE3 ="},
                                 {"PKX1               = 22", "PKX1 = +0.2200E+02 $Longitudinal slip stiffness"},
                                 {"[SHAPE]", "[CONTACT_PATCH]\nELLIPS_MAX_STEP = 0.02\n[SHAPE]"}})
    text.replace(text.find(from), from.size(), to);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(tir_text(parse_tir(text, "a.tir"), {}), tir_text(example_tire(), {}));
}

TEST(TirFile, refuses_what_is_wrong_by_section_and_key) {
  const std::pair<std::string, std::string> cases[] = {
      {replaced("LENGTH = 'meter'", "LENGTH = 'mm'"), "key '[UNITS] LENGTH': is 'mm', expected 'METER'"},
      {replaced("FORCE = 'newton'", "FORCE = 'pound_force'"), "key '[UNITS] FORCE': is 'pound_force'"},
      {replaced("ANGLE = 'radians'", "ANGLE = 'degrees'"), "key '[UNITS] ANGLE': is 'degrees'"},
      {replaced("TIME = 'second'\n", ""), "key '[UNITS] TIME': is missing"},
      {replaced("FITTYP             = 5", "FITTYP = 70"),
       "key '[MODEL] FITTYP': is 70, expected one of 5, 6, 21, 52, 61, 62"},
      {replaced("TYRESIDE = 'LEFT'", "TYRESIDE = 'UP'"), "key '[MODEL] TYRESIDE': is 'UP'"},
      {replaced("[UNITS]", "[UNITS]\nPRESSURE = 'bar'"), "key '[UNITS] PRESSURE': is 'bar', expected 'PASCAL'"},
      {without("UNITS"), "key '[UNITS]': is missing"},
      {without("VERTICAL"), "key '[VERTICAL]': is missing"},
      {without("LATERAL_COEFFICIENTS"), "key '[LATERAL_COEFFICIENTS]': is missing"},
      {without("LONG_SLIP_RANGE"), "key '[LONG_SLIP_RANGE]': is missing"},
      {replaced("PDX1               = 1.1", "PDX1 = nan"),
       "key '[LONGITUDINAL_COEFFICIENTS] PDX1': is 'nan', expected a finite number"},
      {replaced("PKY2               = 1.9", "PKY2 = +-5"), "key '[LATERAL_COEFFICIENTS] PKY2': is '+-5'"},
      {replaced("TYRESIDE = 'LEFT'", "TYRESIDE = 'L$!T' $ a comment"), "key '[MODEL] TYRESIDE': is 'L$!T'"},
      {replaced("PKY2               = 1.9", "PKY2 = inf"), "key '[LATERAL_COEFFICIENTS] PKY2': is 'inf'"},
      {replaced("QBZ1               = 9", "QBZ1 = 9.0e"), "key '[ALIGNING_COEFFICIENTS] QBZ1': is '9.0e'"},
      {replaced("PCY1               = 1.35", "PCY1 = 0"), "key '[LATERAL_COEFFICIENTS] PCY1': is 0"},
      {replaced("PKX1               = 22\n", ""), "key '[LONGITUDINAL_COEFFICIENTS] PKX1': is missing"},
      {replaced("PKX1               = 22\n", "PKX1 = 22\nPKX1 = 23\n"),
       "key '[LONGITUDINAL_COEFFICIENTS] PKX1': is given twice"},
      {replaced("PKY1               = -18", "PKY1 = 18"),
       "key '[LATERAL_COEFFICIENTS] PKY1': is 18, expected less than 0"},
      {replaced("VERTICAL_STIFFNESS = 220000", "VERTICAL_STIFFNESS = -1"),
       "key '[VERTICAL] VERTICAL_STIFFNESS': is -1"},
      {replaced("FNOMIN             = 4000", "FNOMIN = 0"), "key '[VERTICAL] FNOMIN': is 0"},
      {replaced("UNLOADED_RADIUS    = 0.35", "UNLOADED_RADIUS = 0.1"), "key '[DIMENSION] RIM_RADIUS': is 0.2 m"},
      {replaced("KPUMIN             = -1.2", "KPUMIN = 3"), "key '[LONG_SLIP_RANGE] KPUMIN': is 3, expected less than"},
      {replaced("ALPMAX             = 0.6", "ALPMAX = 30"), "key '[SLIP_ANGLE_RANGE] ALPMAX': is 30"},
      {replaced("FZMIN              = 200", "FZMIN = -200"), "key '[VERTICAL_FORCE_RANGE] FZMIN': is -200"},
      {replaced("LMUY               = 0.95", "LMUY = 0"), "key '[SCALING_COEFFICIENTS] LMUY': is 0"},
      {replaced("[ROLLING_COEFFICIENTS]", "[ROLLING_COEFFICIENTS"), "expected a section [NAME]"},
      {replaced("PCX1               = 1.6", "PCX1 1.6"), "expected a section [NAME] or a line NAME = VALUE"},
      {replaced("[SHAPE]", "[UNITS]"), "key '[UNITS]': is given twice, in lines 7 and 27"},
      {replaced("PKX1               = 22\n", "PKX1 =\n"),
       "key '[LONGITUDINAL_COEFFICIENTS] PKX1': is missing, expected a number"},
      {replaced("\nWIDTH              = 0.22", "\n$ WIDTH = 0.22"),
       "key '[DIMENSION] WIDTH': is missing, expected a number"},
      {replaced("PKX1               = 22", "PKX1 = 22 \xf6"), "byte 0xf6 is not UTF-8"},
      {replaced("ALPMAX             = 0.6", "ALPMAX = 1.58"), "expected between -1.5709 and 1.5709 rad"},
      {replaced("[SHAPE]", "[DEFLECTION_LOAD_CURVE]\n0 0\n0.01 2000\n0.02 1900\n[SHAPE]"),
       "'0.02 1900', expected a deflection and a load above those of the line before"},
      {replaced("[SHAPE]", "[DEFLECTION_LOAD_CURVE]\n0 0\n0.01\n[SHAPE]"),
       "expected a deflection in m and a load in N"},
      {replaced("[SHAPE]", "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n[SHAPE]"), "has no points"},
      {replaced("FREFF              = 0.05", "FREFF = 0.05\nQ_FZ2 = -400"), "key '[VERTICAL] Q_FZ2'"},
      {"PCX1 = 1\n", "line 1"},
      {"", "key '[UNITS]': is missing"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string said = complaint(text);
    EXPECT_EQ(said.substr(0, 5), "a.tir") << said;
    EXPECT_TRUE(holds(said, expected)) << said << "\nexpected: " << expected;
  }
}

std::string remarks(const std::string& text) {
  std::string all;
  for (const auto& [key, what] : parse_tir(text, "a.tir").remarks) all += key + " " + what + "\n";
  return all;
}

/// Free text in unread sections, marks of other programs, a byte order mark, Latin-1 in comments.
TEST(TirFile, passes_over_what_it_does_not_read) {
  std::string text = whole();
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"[MDI_HEADER]\n", "\xef\xbb\xbf[MDI_HEADER]\n"},
                                 {"FILE_FORMAT", "(COMMENTS)\n{comment_string}\n'a tire'\nfree text\nFILE_FORMAT"},
                                 {"[SHAPE]", "[SHAPE]\n 1.0 0.5\n[see below\n[SHAPE]\n"},
                                 {"LENGTH = 'meter'",
                                  "* a mark\n# another\nLENGTH = \"meter\" $ Gr\xf6\xdf"
                                  "e"},
                                 {"ALPMAX             = 0.6", "ALPMAX = 1.5708"}})
    text.replace(text.find(from), from.size(), to);
  EXPECT_EQ(remarks(text), "");
  MagicFormula expected = example_tire();
  expected.slip_angle.most = 1.57;
  EXPECT_EQ(tir_text(parse_tir(text, "a.tir"), {}), tir_text(expected, {}));
}

TEST(TirFile, names_what_it_does_not_use_once) {
  EXPECT_EQ(remarks(whole()), "");
  std::string text = replaced("[ROLLING_COEFFICIENTS]", "PKYX = 1\nPTY3 = 0\nPTY4 =\n[ROLLING_COEFFICIENTS]");
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"[ALIGNING_COEFFICIENTS]", "[ALIGNING_COEFFICIENTS]\nCONTACT_MODEL = '3D'"},
        {"[SHAPE]", "[BOTTOMING_CURVE]\n{pen fz}\n0 0\n[TURNSLIP_COEFFICIENTS]\nPECP1 = 0.7\nPECP2 = 0\n[SHAPE]"},
        {"LFZO", "LKG = 1\nLMP = 1.1\nLFZO"}})
    text.replace(text.find(from), from.size(), to);
  EXPECT_EQ(
      remarks(text),
      "[ALIGNING_COEFFICIENTS] CONTACT_MODEL; [BOTTOMING_CURVE]; [LATERAL_COEFFICIENTS] PKYX; "
      "[SCALING_COEFFICIENTS] LMP; [TURNSLIP_COEFFICIENTS] PECP1 is not used: unknown, or without a place in this "
      "model\n");
}

TEST(TirFile, names_an_optional_section_whose_name_is_misspelt) {
  EXPECT_EQ(remarks(replaced("[OVERTURNING_COEFFICIENTS]", "[OVERTURNING_COEFICIENTS]")),
            "[OVERTURNING_COEFICIENTS] is not used: did you mean [OVERTURNING_COEFFICIENTS]?\n");
}

TEST(TirFile, speed_terms_of_the_rolling_resistance_need_the_speed_they_are_relative_to) {
  MagicFormula tire = example_tire();
  tire.rolling.qsy3 = 0.002;
  tire.reference_speed = 0.0;
  EXPECT_TRUE(holds(remarks(tir_text(tire, {})), "[MODEL] LONGVL is missing: QSY3 and QSY4"));
  tire.reference_speed = 16.7;
  EXPECT_EQ(remarks(tir_text(tire, {})), "");
}

TEST(TirFile, refuses_what_is_missing_together) {
  std::string text = replaced("PKX1               = 22\n", "");
  text.replace(text.find("FNOMIN             = 4000"), 25, "FNOMIN =");
  EXPECT_TRUE(holds(complaint(text), "key '[VERTICAL] FNOMIN': is missing")) << complaint(text);
  text = replaced("KPUMIN             = -1.2\n", "");
  text.replace(text.find("WIDTH              = 0.22"), 25, "WIDTH =");
  EXPECT_TRUE(holds(complaint(text),
                    "key '[DIMENSION] WIDTH': is missing, expected a number; missing too: "
                    "[LONG_SLIP_RANGE] KPUMIN"))
      << complaint(text);
}

/// A range that does not contain 0 on both sides would give a force that does not exist.
TEST(TirFile, a_range_without_room_on_a_side_of_0_is_taken_as_symmetric) {
  for (const auto& [from, to, key] :
       {std::tuple<std::string, std::string, std::string>{"KPUMAX             = 1.2", "KPUMAX = 0",
                                                          "[LONG_SLIP_RANGE] KPUMAX is 0: "},
        {"KPUMIN             = -1.2", "KPUMIN = 0.05", "[LONG_SLIP_RANGE] KPUMIN is 0.05: "},
        {"ALPMIN             = -0.6", "ALPMIN = 0", "[SLIP_ANGLE_RANGE] ALPMIN is 0: "},
        {"CAMMAX             = 0.2", "CAMMAX = -0.1", "[INCLINATION_ANGLE_RANGE] CAMMAX is -0.1: "}}) {
    const std::string text = replaced(from, to);
    EXPECT_TRUE(holds(remarks(text), key)) << remarks(text);
    EXPECT_EQ(tir_text(parse_tir(text, "a.tir"), {}), tir_text(example_tire(), {})) << to;
  }
  EXPECT_TRUE(holds(remarks(replaced("KPUMAX             = 1.2", "KPUMAX = 0.001")), "KPUMAX is 0.001: forces stay"));
}

TEST(TirFile, reads_the_names_of_pac2002_and_a_later_version_s_curve) {
  std::string text = replaced("[SHAPE]",
                              "[TIRE_CONDITIONS]\nIP = 250000\nIP_NOM = 200000\n[DEFLECTION_LOAD_CURVE]\n"
                              "{pen fz}\n0 0\n0.01\t2000 $ N\n0.02 5000\n[SHAPE]");
  text.replace(text.find("PVX2"), 4, "PPX1 = 0.3\nPVX2");
  text.replace(text.find("QBZ1 "), 5, "QPZ1 = 0.2\nQBZ1 ");
  const MagicFormula t = parse_tir(text, "a.tir");
  EXPECT_TRUE(t.remarks.empty());
  EXPECT_NEAR(pressure_change(t), 0.25, 1e-15);
  EXPECT_EQ(t.longitudinal.ppx1, 0.3);
  EXPECT_EQ(t.aligning.ppz1, 0.2);
  ASSERT_EQ(t.load_curve.size(), 3u);
  EXPECT_EQ(t.load_curve[1], std::pair(0.01, 2000.0));
  const std::string written = tir_text(t, {});
  EXPECT_EQ(tir_text(parse_tir(written, "a.tir"), {}), written);
  MagicFormula later = later_tire();
  EXPECT_EQ(tir_text(parse_tir(tir_text(later, {}), "a.tir"), {}), tir_text(later, {}));
  EXPECT_TRUE(holds(remarks(replaced("PKY1 ", "PKY6 = -1\nPKY1 ")), "[MODEL] FITTYP is not 61"));
}

TEST(TirFile, coefficients_that_are_left_out_are_none_and_factors_one) {
  const MagicFormula t = parse_tir(without("ALIGNING_COEFFICIENTS"), "a.tir");
  EXPECT_EQ(t.aligning.qbz1, 0.0);
  EXPECT_EQ(remarks(without("ALIGNING_COEFFICIENTS")),
            "[ALIGNING_COEFFICIENTS] is missing: the aligning moment is 0\n");
  std::string text = whole();
  const std::size_t at = text.find("[SCALING_COEFFICIENTS]");
  text.erase(at, text.find("\n[", at) + 1 - at);
  EXPECT_EQ(parse_tir(text, "a.tir").scaling.lmux, 1.0);
}

/// Damaged files are read, or refused with a sentence.
TEST(TirFile, survives_damage) {
  std::mt19937 random(1);
  const std::string text = whole();
  const std::string odd = "[]={}$!'\n\t-+.eE0naif\x7f";
  for (int n = 0; n < 3000; ++n) {
    std::string damaged = text;
    for (int k = 0; k < 1 + n % 4; ++k) {
      const std::size_t at = random() % damaged.size(), length = random() % 40;
      if (n % 3 == 0)
        damaged.erase(at, length);
      else if (n % 3 == 1)
        damaged.insert(at, 1, odd[random() % odd.size()]);
      else
        damaged[at] = odd[random() % odd.size()];
      if (damaged.empty()) break;
    }
    const std::string said = complaint(damaged);
    EXPECT_TRUE(said.empty() || said.starts_with("a.tir")) << said;
  }
}

}  // namespace
}  // namespace furrow::tire::handling::tir_file_test
