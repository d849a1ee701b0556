// Tire files of handling tires: `"model": "handling"`, or a tire property file (.tir) itself.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "tire/handling/coefficients.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// The keys of a tire file of this model.
struct HandlingFile {
  static constexpr SchemaName kSchema{"handling",
                                      "A tire on hard ground by the Magic Formula: names a tire property file "
                                      "(.tir) of MF-Tyre 5.2, PAC2002 or Magic Formula 6.1, which may be "
                                      "the tire's file itself where it has a section [INERTIA]. SI units."};
  std::string path;
  std::filesystem::path tir;  // resolved: beside the tire file, or as it stands
  handling::MagicFormula formula;
  double mass = 0.0;                 // kg
  double spin_inertia = 0.0;         // about the axle, kg m²
  double diametral_inertia = 0.0;    // kg m²
  std::string lacking_key, lacking;  // the first of these that neither file says, and what is expected; empty: none
};
void visit_fields(FieldsOf<HandlingFile> auto& s, auto&& visit) {
  constexpr Allowed kPositive = allowed::above(0).optional();
  visit(s.tir, needed("tir", "", "Tire property file, relative to this file."));
  visit(s.mass, key("mass", "kg", kPositive.usual(0.01, 2000), "Mass of the tire; without it MASS of [INERTIA]."));
  visit(s.spin_inertia, key("spin_inertia", "kg m²", kPositive,
                            "Moment of inertia of the tire about its axle; without it IYY of [INERTIA]."));
  visit(s.diametral_inertia, key("diametral_inertia", "kg m²", kPositive,
                                 "Moment of inertia of the tire about a diameter; without it IXX of [INERTIA]."));
}

/// Mass and inertia are those of [INERTIA] where the tire file does not say them; to be pressed, a tire needs none.
/// @throws Error(bad_input)
HandlingFile read_handling_file(const nlohmann::json& document, const std::string& path);

std::unique_ptr<TireSpec> read_handling(const nlohmann::json& file, const TireOptions& options);

/// Whether a tire's file is a tire property file, by its name (.tir).
bool is_tir(const std::filesystem::path& file);
/// The tire file that such a file stands for.
nlohmann::json tire_file_of_tir(const std::filesystem::path& file);

}  // namespace furrow::tire
