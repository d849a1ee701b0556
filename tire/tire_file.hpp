// What the file of a shell tire says: profile, layup, materials, pressure, contact. Two layouts are read, our own
// (data/tire.schema.json describes it) and the public ANCFTire layout of Project Chrono; template names are
// registered in read_tire_file.cpp.
#pragma once

#include <string>
#include <vector>

#include "protocol/core/surface.hpp"

namespace furrow::tire {

/// Elements that a file may ask for: around, and of a band on each side; a mesh has at most kMaxElements.
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

/// A spring and a dashpot in series, beside the tire's elastic stiffness.
struct MaxwellBranch {
  double modulus = 0.0;  // g, relative to the long-term stiffness
  double time = 0.0;     // relaxation time, s
};

/// One knot of the meridian of the mid-surface.
struct ProfileKnot {
  double t = 0.0;  // share of the way from the left to the right bead, 0…1
  double x = 0.0;  // height above the rim radius, m
  double y = 0.0;  // axial, m
};

struct TireFile {
  std::string path;
  std::string name;
  double rim_radius = 0.0;           // m
  double rim_width = 0.0;            // m
  double radius = 0.0;               // of the undeformed mid-surface at the crown, m
  double pressure = 0.0;             // gauge, Pa
  double structural_damping = 0.0;   // τ of the Kelvin–Voigt law, s
  std::vector<MaxwellBranch> prony;  // branches of a generalised Maxwell model; none: no relaxation
  double tread_mass_per_area = 0.0;  // rubber outside the tread's layup, kg/m²
  ContactMaterial contact;
  std::vector<LayerMaterial> materials;
  Section bead, sidewall, tread;
  int elements_circumference = 0;
  std::vector<ProfileKnot> profile;

  int elements_width() const {
    return 2 * (bead.elements_per_side + sidewall.elements_per_side + tread.elements_per_side);
  }
  /// The section of element j of the width, counted from the left bead. @pre 0 ≤ j < elements_width()
  const Section& section(int j) const;
};

/// Stiffness matrix in material axes; strain order xx, yy, 2xy, zz, 2xz, 2yz.
/// @throws Error(bad_input) when it is not positive definite.
Eigen::Matrix<double, 6, 6> stiffness(const LayerMaterial& material, const std::string& file);

/// Splits `elements` of the width over the sections in the file's proportions, at least one in each.
/// @throws Error(bad_input) when `elements` is odd or below six.
void set_elements_width(TireFile& file, int elements);

}  // namespace furrow::tire
