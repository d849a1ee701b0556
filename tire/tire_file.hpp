// The file of a shell tire: profile, layup, materials, pressure, contact. Two layouts are read: our own
// (data/tire.schema.json describes it) and the public one of Project Chrono (tire_file_chrono.hpp). read_tire_file.cpp
// registers the template names.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/surface.hpp"
#include "tire/tire_file_keys.hpp"

namespace furrow::tire {

// Schemas of the lists in a tire file.
extern const char* const kMaterialsShape;
extern const char* const kSectionsShape;
extern const char* const kProfileShape;

/// Largest numbers of elements that a file may set: around, and of a band on each side. A mesh has at most
/// kMaxElements.
inline constexpr int kMaxAround = 10000, kMaxPerSide = 500, kMaxElements = 1000000;

/// Orthotropic linear elastic material; x along the fibre, y across it in the layer, z through the thickness.
struct LayerMaterial {
  std::string name;
  double density = 0.0;               // kg/m³
  Vec3 young_modulus = Vec3::Zero();  // x, y, z, Pa
  Vec3 poisson_ratio = Vec3::Zero();  // ν_xy, ν_xz, ν_yz with ν_xy / E_x = ν_yx / E_y
  Vec3 shear_modulus = Vec3::Zero();  // xy, xz, yz, Pa
};

struct Layer {
  double thickness = 0.0;  // m
  double angle = 0.0;      // fibre from the circumferential direction towards +y, rad
  int material = 0;        // index into TireFile::materials
};

/// A band of the tire; layers from the inside outwards.
struct Section {
  int elements_per_side = 0;
  std::vector<Layer> layers;
  double thickness() const {  // m
    double sum = 0.0;
    for (const Layer& layer : layers) sum += layer.thickness;
    return sum;
  }
};

/// A spring and a dashpot in series, in parallel to the tire's elastic stiffness.
struct MaxwellBranch {
  static constexpr SchemaName kSchema{"branch", "A branch of the generalised Maxwell model."};
  double modulus = 0.0;  // g, relative to the long-term stiffness
  double time = 0.0;     // relaxation time, s
};
void visit_fields(FieldsOf<MaxwellBranch> auto& s, auto&& visit) {
  visit(s.modulus, needed("relative_modulus", "-", allowed::above(0),
                          "g_i: stiffness of the branch relative to the materials' moduli, which are those after "
                          "complete relaxation."));
  visit(s.time, needed("relaxation_time", "s", allowed::above(0), "tau_i: relaxation time of the branch."));
}

/// One knot of the meridian of the mid-surface.
struct ProfileKnot {
  double t = 0.0;  // share of the distance from the left to the right bead, 0…1
  double x = 0.0;  // height above the rim radius, m
  double y = 0.0;  // axial, m
};

struct TireFile {
  static constexpr SchemaName kSchema{"shell",
                                      "A tire as a layered shell on a rim. SI units. The program reads this layout "
                                      "(template ancf_shell) and the public layouts ANCFTire and ReissnerTire of "
                                      "Project Chrono."};
  std::string path;
  std::string name;
  double rim_radius = 0.0;           // m
  double rim_width = 0.0;            // m
  double radius = 0.0;               // of the undeformed mid-surface at the crown, m
  double pressure = 0.0;             // gauge, Pa
  double structural_damping = 0.0;   // τ of the Kelvin–Voigt law, s
  std::vector<MaxwellBranch> prony;  // branches of a generalised Maxwell model; none: no relaxation
  double tread_mass_per_area = 0.0;  // rubber outside the tread's layup, kg/m²
  ContactBlock contact;
  std::vector<LayerMaterial> materials;
  Section bead, sidewall, tread;
  int elements_circumference = 0;
  std::vector<ProfileKnot> profile;
  std::vector<std::pair<std::string, std::string>> remarks;  // keys of a public layout that are not followed, and how

  int elements_width() const {
    return 2 * (bead.elements_per_side + sidewall.elements_per_side + tread.elements_per_side);
  }
  /// The section of element j of the width, counted from the left bead. @pre 0 ≤ j < elements_width()
  const Section& section(int j) const;
};

/// The keys of our own layout. Materials, sections and profile refer to each other: read_tire_file.cpp reads them.
void visit_fields(FieldsOf<TireFile> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.path,
        key("template", "", role::by_hand, shaped(R"({"const": "ancf_shell"})").required(), "Name of the layout."));
  visit(s.radius, needed("radius", "m", keys::kSize,
                         "Radius of the undeformed mid-surface at the crown; must agree with the profile within 1 %."));
  visit(s.rim_radius, needed("rim_radius", "m", keys::kSize, "Radius at which the beads sit."));
  visit(s.rim_width, needed("rim_width", "m", keys::kSize.usual(0.05, 1.5), "Distance between the beads' seats."));
  visit(s.pressure, keys::kPressure);
  visit(s.structural_damping, needed("structural_damping", "s", keys::kDampingTime,
                                     "Kelvin-Voigt time tau: stress = C (strain + tau × strain rate)."));
  visit(s.prony,
        key("prony", "", optional(),
            "Generalised Maxwell model beside tau: stress = C (strain + tau × strain rate + sum of g_i h_i), h_i' = "
            "strain "
            "rate - h_i / tau_i. The same in all layers; static results are those without it."));
  visit(s.tread_mass_per_area, key("tread_mass_per_area", "kg/m²", from(0).usual(0.01, 100),
                                   "Mass of rubber outside the tread's layup; adds inertia, no stiffness."));
  visit(s.elements_circumference,
        needed("elements_circumference", "", from(8, kMaxAround), "Elements around the tire."));
  visit(s.contact, keys::kContact);
  visit(s.materials, key("materials", "", role::by_hand, shaped(kMaterialsShape).required(),
                         "Materials by name; x along the fibre, y across it in the layer, z through the thickness."));
  visit(s.bead, key("sections", "", role::by_hand, shaped(kSectionsShape).required(),
                    "The bands from each bead to the crown; both sides are alike."));
  visit(
      s.profile,
      key("profile", "", role::by_hand, shaped(kProfileShape).required(),
          "Meridian of the mid-surface from the left to the right bead: rows t, x, y with t from 0 to 1, x the height "
          "above the rim radius in m, y axial in m. Natural cubic splines interpolate it; node rows lie at equal steps "
          "of t."));
}

/// Stiffness matrix in material axes; strain order xx, yy, 2xy, zz, 2xz, 2yz.
/// @throws Error(bad_input) when it is not positive definite.
Eigen::Matrix<double, 6, 6> stiffness(const LayerMaterial& material, const std::string& file);

/// Splits `elements` of the width over the sections in the file's proportions, at least one in each.
/// @throws Error(bad_input) when `elements` is odd or below six.
void set_elements_width(TireFile& file, int elements);

}  // namespace furrow::tire
