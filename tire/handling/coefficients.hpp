// The coefficients of the Magic Formula as tire property files (.tir) name them, MF-Tyre 5.2, PAC2002 and Magic Formula
// 6.1: dimensionless unless a unit is said. One list serves reading, writing and fitting. In each struct the fields
// from kLater on came after version 5.2: they are written for 6.1, and where they are not what a file without them has.
//
// Sources: [1] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, Butterworth-Heinemann 2012, section 4.3.2 (the
// names of the coefficients: appendix 3); 2nd edition 2006 alike. [2] TNO Automotive, MF-Tyre User Manual, version 5.2,
// 2001: names and sections of the file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"

namespace furrow::tire::handling {

/// λ: 1 leaves the formula as it is.
struct ScalingFactors {
  double lfzo = 1.0, lcx = 1.0, lmux = 1.0, lex = 1.0, lkx = 1.0, lhx = 1.0, lvx = 1.0, lgax = 1.0, lcy = 1.0,
         lmuy = 1.0, ley = 1.0, lky = 1.0, lhy = 1.0, lvy = 1.0, lgay = 1.0, ltr = 1.0, lres = 1.0, lgaz = 1.0,
         lxal = 1.0, lyka = 1.0, lvyka = 1.0, ls = 1.0, lsgkp = 1.0, lsgal = 1.0, lgyr = 1.0, lmx = 1.0, lvmx = 1.0,
         lmy = 1.0;
  static constexpr int kLater = 28;
  double lkyc = 1.0, lkzc = 1.0, lcz = 1.0, lip = 1.0;
};
void visit_fields(FieldsOf<ScalingFactors> auto& s, auto&& visit) {
  visit(s.lfzo, Field{"LFZO"});
  visit(s.lcx, Field{"LCX"});
  visit(s.lmux, Field{"LMUX"});
  visit(s.lex, Field{"LEX"});
  visit(s.lkx, Field{"LKX"});
  visit(s.lhx, Field{"LHX"});
  visit(s.lvx, Field{"LVX"});
  visit(s.lgax, Field{"LGAX"});
  visit(s.lcy, Field{"LCY"});
  visit(s.lmuy, Field{"LMUY"});
  visit(s.ley, Field{"LEY"});
  visit(s.lky, Field{"LKY"});
  visit(s.lhy, Field{"LHY"});
  visit(s.lvy, Field{"LVY"});
  visit(s.lgay, Field{"LGAY"});
  visit(s.ltr, Field{"LTR"});
  visit(s.lres, Field{"LRES"});
  visit(s.lgaz, Field{"LGAZ"});
  visit(s.lxal, Field{"LXAL"});
  visit(s.lyka, Field{"LYKA"});
  visit(s.lvyka, Field{"LVYKA"});
  visit(s.ls, Field{"LS"});
  visit(s.lsgkp, Field{"LSGKP"});
  visit(s.lsgal, Field{"LSGAL"});
  visit(s.lgyr, Field{"LGYR"});
  visit(s.lmx, Field{"LMX"});
  visit(s.lvmx, Field{"LVMX"});
  visit(s.lmy, Field{"LMY"});
  visit(s.lkyc, Field{"LKYC"});
  visit(s.lkzc, Field{"LKZC"});
  visit(s.lcz, Field{"LCZ"});
  visit(s.lip, Field{"LIP"});
}

/// Of F_x: p of pure slip, r of combined slip, ptx of the relaxation length.
struct LongitudinalCoefficients {
  double pcx1 = 0.0, pdx1 = 0.0, pdx2 = 0.0, pdx3 = 0.0, pex1 = 0.0, pex2 = 0.0, pex3 = 0.0, pex4 = 0.0, pkx1 = 0.0,
         pkx2 = 0.0, pkx3 = 0.0, phx1 = 0.0, phx2 = 0.0, pvx1 = 0.0, pvx2 = 0.0, rbx1 = 0.0, rbx2 = 0.0, rcx1 = 0.0,
         rex1 = 0.0, rex2 = 0.0, rhx1 = 0.0, ptx1 = 0.0, ptx2 = 0.0, ptx3 = 0.0;
  static constexpr int kLater = 24;
  double ppx1 = 0.0, ppx2 = 0.0, ppx3 = 0.0, ppx4 = 0.0, rbx3 = 0.0;
};
void visit_fields(FieldsOf<LongitudinalCoefficients> auto& s, auto&& visit) {
  visit(s.pcx1, Field{"PCX1"});
  visit(s.pdx1, Field{"PDX1"});
  visit(s.pdx2, Field{"PDX2"});
  visit(s.pdx3, Field{"PDX3"});
  visit(s.pex1, Field{"PEX1"});
  visit(s.pex2, Field{"PEX2"});
  visit(s.pex3, Field{"PEX3"});
  visit(s.pex4, Field{"PEX4"});
  visit(s.pkx1, Field{"PKX1"});
  visit(s.pkx2, Field{"PKX2"});
  visit(s.pkx3, Field{"PKX3"});
  visit(s.phx1, Field{"PHX1"});
  visit(s.phx2, Field{"PHX2"});
  visit(s.pvx1, Field{"PVX1"});
  visit(s.pvx2, Field{"PVX2"});
  visit(s.rbx1, Field{"RBX1"});
  visit(s.rbx2, Field{"RBX2"});
  visit(s.rcx1, Field{"RCX1"});
  visit(s.rex1, Field{"REX1"});
  visit(s.rex2, Field{"REX2"});
  visit(s.rhx1, Field{"RHX1"});
  visit(s.ptx1, Field{"PTX1"});
  visit(s.ptx2, Field{"PTX2"});
  visit(s.ptx3, Field{"PTX3"});
  visit(s.ppx1, Field{"PPX1"});
  visit(s.ppx2, Field{"PPX2"});
  visit(s.ppx3, Field{"PPX3"});
  visit(s.ppx4, Field{"PPX4"});
  visit(s.rbx3, Field{"RBX3"});
}

/// Of M_x.
struct OverturningCoefficients {
  double qsx1 = 0.0, qsx2 = 0.0, qsx3 = 0.0;
  static constexpr int kLater = 3;
  double qsx4 = 0.0, qsx5 = 0.0, qsx6 = 0.0, qsx7 = 0.0, qsx8 = 0.0, qsx9 = 0.0, qsx10 = 0.0, qsx11 = 0.0, qsx12 = 0.0,
         qsx13 = 0.0, qsx14 = 0.0, ppmx1 = 0.0;
};
void visit_fields(FieldsOf<OverturningCoefficients> auto& s, auto&& visit) {
  visit(s.qsx1, Field{"QSX1"});
  visit(s.qsx2, Field{"QSX2"});
  visit(s.qsx3, Field{"QSX3"});
  visit(s.qsx4, Field{"QSX4"});
  visit(s.qsx5, Field{"QSX5"});
  visit(s.qsx6, Field{"QSX6"});
  visit(s.qsx7, Field{"QSX7"});
  visit(s.qsx8, Field{"QSX8"});
  visit(s.qsx9, Field{"QSX9"});
  visit(s.qsx10, Field{"QSX10"});
  visit(s.qsx11, Field{"QSX11"});
  visit(s.qsx12, Field{"QSX12"});
  visit(s.qsx13, Field{"QSX13"});
  visit(s.qsx14, Field{"QSX14"});
  visit(s.ppmx1, Field{"PPMX1"});
}

/// Of F_y, likewise.
struct LateralCoefficients {
  double pcy1 = 0.0, pdy1 = 0.0, pdy2 = 0.0, pdy3 = 0.0, pey1 = 0.0, pey2 = 0.0, pey3 = 0.0, pey4 = 0.0, pky1 = 0.0,
         pky2 = 0.0, pky3 = 0.0, phy1 = 0.0, phy2 = 0.0, phy3 = 0.0, pvy1 = 0.0, pvy2 = 0.0, pvy3 = 0.0, pvy4 = 0.0,
         rby1 = 0.0, rby2 = 0.0, rby3 = 0.0, rcy1 = 0.0, rey1 = 0.0, rey2 = 0.0, rhy1 = 0.0, rhy2 = 0.0, rvy1 = 0.0,
         rvy2 = 0.0, rvy3 = 0.0, rvy4 = 0.0, rvy5 = 0.0, rvy6 = 0.0, pty1 = 0.0, pty2 = 0.0;
  static constexpr int kLater = 34;
  double pey5 = 0.0, pky4 = 2.0, pky5 = 0.0, pky6 = 0.0, pky7 = 0.0, ppy1 = 0.0, ppy2 = 0.0, ppy3 = 0.0, ppy4 = 0.0,
         ppy5 = 0.0, rby4 = 0.0;
};
void visit_fields(FieldsOf<LateralCoefficients> auto& s, auto&& visit) {
  visit(s.pcy1, Field{"PCY1"});
  visit(s.pdy1, Field{"PDY1"});
  visit(s.pdy2, Field{"PDY2"});
  visit(s.pdy3, Field{"PDY3"});
  visit(s.pey1, Field{"PEY1"});
  visit(s.pey2, Field{"PEY2"});
  visit(s.pey3, Field{"PEY3"});
  visit(s.pey4, Field{"PEY4"});
  visit(s.pky1, Field{"PKY1"});
  visit(s.pky2, Field{"PKY2"});
  visit(s.pky3, Field{"PKY3"});
  visit(s.phy1, Field{"PHY1"});
  visit(s.phy2, Field{"PHY2"});
  visit(s.phy3, Field{"PHY3"});
  visit(s.pvy1, Field{"PVY1"});
  visit(s.pvy2, Field{"PVY2"});
  visit(s.pvy3, Field{"PVY3"});
  visit(s.pvy4, Field{"PVY4"});
  visit(s.rby1, Field{"RBY1"});
  visit(s.rby2, Field{"RBY2"});
  visit(s.rby3, Field{"RBY3"});
  visit(s.rcy1, Field{"RCY1"});
  visit(s.rey1, Field{"REY1"});
  visit(s.rey2, Field{"REY2"});
  visit(s.rhy1, Field{"RHY1"});
  visit(s.rhy2, Field{"RHY2"});
  visit(s.rvy1, Field{"RVY1"});
  visit(s.rvy2, Field{"RVY2"});
  visit(s.rvy3, Field{"RVY3"});
  visit(s.rvy4, Field{"RVY4"});
  visit(s.rvy5, Field{"RVY5"});
  visit(s.rvy6, Field{"RVY6"});
  visit(s.pty1, Field{"PTY1"});
  visit(s.pty2, Field{"PTY2"});
  visit(s.pey5, Field{"PEY5"});
  visit(s.pky4, Field{"PKY4"});
  visit(s.pky5, Field{"PKY5"});
  visit(s.pky6, Field{"PKY6"});
  visit(s.pky7, Field{"PKY7"});
  visit(s.ppy1, Field{"PPY1"});
  visit(s.ppy2, Field{"PPY2"});
  visit(s.ppy3, Field{"PPY3"});
  visit(s.ppy4, Field{"PPY4"});
  visit(s.ppy5, Field{"PPY5"});
  visit(s.rby4, Field{"RBY4"});
}

/// Of M_y.
struct RollingCoefficients {
  double qsy1 = 0.0, qsy2 = 0.0, qsy3 = 0.0, qsy4 = 0.0;
  static constexpr int kLater = 4;
  double qsy5 = 0.0, qsy6 = 0.0, qsy7 = 0.0, qsy8 = 0.0;
};
void visit_fields(FieldsOf<RollingCoefficients> auto& s, auto&& visit) {
  visit(s.qsy1, Field{"QSY1"});
  visit(s.qsy2, Field{"QSY2"});
  visit(s.qsy3, Field{"QSY3"});
  visit(s.qsy4, Field{"QSY4"});
  visit(s.qsy5, Field{"QSY5"});
  visit(s.qsy6, Field{"QSY6"});
  visit(s.qsy7, Field{"QSY7"});
  visit(s.qsy8, Field{"QSY8"});
}

/// Of M_z: q of trail and residual moment, s of the arm of F_x. QTZ1 and MBELT, of the gyroscopic moment, are kept
/// and not used.
struct AligningCoefficients {
  double qbz1 = 0.0, qbz2 = 0.0, qbz3 = 0.0, qbz4 = 0.0, qbz5 = 0.0, qbz9 = 0.0, qbz10 = 0.0, qcz1 = 0.0, qdz1 = 0.0,
         qdz2 = 0.0, qdz3 = 0.0, qdz4 = 0.0, qdz6 = 0.0, qdz7 = 0.0, qdz8 = 0.0, qdz9 = 0.0, qez1 = 0.0, qez2 = 0.0,
         qez3 = 0.0, qez4 = 0.0, qez5 = 0.0, qhz1 = 0.0, qhz2 = 0.0, qhz3 = 0.0, qhz4 = 0.0, ssz1 = 0.0, ssz2 = 0.0,
         ssz3 = 0.0, ssz4 = 0.0, qtz1 = 0.0, mbelt = 0.0;
  static constexpr int kLater = 31;
  double qdz10 = 0.0, qdz11 = 0.0, ppz1 = 0.0, ppz2 = 0.0;
};
void visit_fields(FieldsOf<AligningCoefficients> auto& s, auto&& visit) {
  visit(s.qbz1, Field{"QBZ1"});
  visit(s.qbz2, Field{"QBZ2"});
  visit(s.qbz3, Field{"QBZ3"});
  visit(s.qbz4, Field{"QBZ4"});
  visit(s.qbz5, Field{"QBZ5"});
  visit(s.qbz9, Field{"QBZ9"});
  visit(s.qbz10, Field{"QBZ10"});
  visit(s.qcz1, Field{"QCZ1"});
  visit(s.qdz1, Field{"QDZ1"});
  visit(s.qdz2, Field{"QDZ2"});
  visit(s.qdz3, Field{"QDZ3"});
  visit(s.qdz4, Field{"QDZ4"});
  visit(s.qdz6, Field{"QDZ6"});
  visit(s.qdz7, Field{"QDZ7"});
  visit(s.qdz8, Field{"QDZ8"});
  visit(s.qdz9, Field{"QDZ9"});
  visit(s.qez1, Field{"QEZ1"});
  visit(s.qez2, Field{"QEZ2"});
  visit(s.qez3, Field{"QEZ3"});
  visit(s.qez4, Field{"QEZ4"});
  visit(s.qez5, Field{"QEZ5"});
  visit(s.qhz1, Field{"QHZ1"});
  visit(s.qhz2, Field{"QHZ2"});
  visit(s.qhz3, Field{"QHZ3"});
  visit(s.qhz4, Field{"QHZ4"});
  visit(s.ssz1, Field{"SSZ1"});
  visit(s.ssz2, Field{"SSZ2"});
  visit(s.ssz3, Field{"SSZ3"});
  visit(s.ssz4, Field{"SSZ4"});
  visit(s.qtz1, Field{"QTZ1"});
  visit(s.mbelt, Field{"MBELT", "kg"});
  visit(s.qdz10, Field{"QDZ10"});
  visit(s.qdz11, Field{"QDZ11"});
  visit(s.ppz1, Field{"PPZ1"});
  visit(s.ppz2, Field{"PPZ2"});
}

/// [VERTICAL]
struct VerticalCoefficients {
  double vertical_stiffness = 0.0;               // C_z, N/m
  double vertical_damping = 0.0;                 // K_z, N s/m
  double breff = 0.0, dreff = 0.0, freff = 0.0;  // of the effective rolling radius
  double fnomin = 0.0;                           // F_z0, N
  static constexpr int kLater = 6;
  double q_fz1 = 0.0, q_fz2 = 0.0, pfz1 = 0.0;
};
void visit_fields(FieldsOf<VerticalCoefficients> auto& s, auto&& visit) {
  visit(s.vertical_stiffness, Field{"VERTICAL_STIFFNESS", "N/m"});
  visit(s.vertical_damping, Field{"VERTICAL_DAMPING", "N s/m"});
  visit(s.breff, Field{"BREFF"});
  visit(s.dreff, Field{"DREFF"});
  visit(s.freff, Field{"FREFF"});
  visit(s.fnomin, Field{"FNOMIN", "N"});
  visit(s.q_fz1, Field{"Q_FZ1"});
  visit(s.q_fz2, Field{"Q_FZ2"});
  visit(s.pfz1, Field{"PFZ1"});
}

/// [STRUCTURAL], of version 6.1: what gives the relaxation lengths; with 0 the coefficients PT do.
struct StructuralCoefficients {
  double longitudinal_stiffness = 0.0, lateral_stiffness = 0.0;  // N/m
  double pcfx1 = 0.0, pcfx2 = 0.0, pcfx3 = 0.0, pcfy1 = 0.0, pcfy2 = 0.0, pcfy3 = 0.0;
};
void visit_fields(FieldsOf<StructuralCoefficients> auto& s, auto&& visit) {
  visit(s.longitudinal_stiffness, Field{"LONGITUDINAL_STIFFNESS", "N/m"});
  visit(s.lateral_stiffness, Field{"LATERAL_STIFFNESS", "N/m"});
  visit(s.pcfx1, Field{"PCFX1"});
  visit(s.pcfx2, Field{"PCFX2"});
  visit(s.pcfx3, Field{"PCFX3"});
  visit(s.pcfy1, Field{"PCFY1"});
  visit(s.pcfy2, Field{"PCFY2"});
  visit(s.pcfy3, Field{"PCFY3"});
}

/// [OPERATING_CONDITIONS]; IP and IP_NOM of [TIRE_CONDITIONS] in PAC2002. 0: not said.
struct OperatingConditions {
  double inflpres = 0.0, nompres = 0.0;  // Pa
};
void visit_fields(FieldsOf<OperatingConditions> auto& s, auto&& visit) {
  visit(s.inflpres, Field{"INFLPRES", "Pa"});
  visit(s.nompres, Field{"NOMPRES", "Pa"});
}

/// [DIMENSION]
struct Dimensions {
  double unloaded_radius = 0.0;  // R_0, m
  double width = 0.0;            // m
  double aspect_ratio = 0.0;     // -
  double rim_radius = 0.0;       // m
  double rim_width = 0.0;        // m
};
void visit_fields(FieldsOf<Dimensions> auto& s, auto&& visit) {
  visit(s.unloaded_radius, Field{"UNLOADED_RADIUS", "m"});
  visit(s.width, Field{"WIDTH", "m"});
  visit(s.aspect_ratio, Field{"ASPECT_RATIO"});
  visit(s.rim_radius, Field{"RIM_RADIUS", "m"});
  visit(s.rim_width, Field{"RIM_WIDTH", "m"});
}

/// [INERTIA], which files of version 5.2 need not have.
struct TireInertia {
  double mass = 0.0;  // kg; 0: not said
  double ixx = 0.0;   // about a diameter, kg m²
  double iyy = 0.0;   // about the axle, kg m²
};
void visit_fields(FieldsOf<TireInertia> auto& s, auto&& visit) {
  visit(s.mass, Field{"MASS", "kg"});
  visit(s.ixx, Field{"IXX", "kg m²"});
  visit(s.iyy, Field{"IYY", "kg m²"});
}

/// What the coefficients were fitted for; the formula is held at the ends of it.
struct Range {
  double least = 0.0, most = 0.0;
};

struct MagicFormula {
  bool version61 = false;         // of [MODEL] FITTYP 61 or 62; otherwise 5.2, with the pressure terms of PAC2002
  bool friction_ellipse = false;  // of [MODEL] FE_METHOD 'YES': of combined slip, whatever coefficients there are
  Dimensions dimension;
  VerticalCoefficients vertical;
  TireInertia inertia;
  double low_speed = 1.0;         // VXLOW, below which slip is regularised, m/s
  double reference_speed = 0.0;   // LONGVL, V_0, m/s
  Range slip{-1.5, 1.5};          // κ, -
  Range slip_angle{-1.5, 1.5};    // α, rad
  Range camber{-0.2618, 0.2618};  // γ, rad
  Range load;                     // F_z, N
  ScalingFactors scaling;
  LongitudinalCoefficients longitudinal;
  OverturningCoefficients overturning;
  LateralCoefficients lateral;
  RollingCoefficients rolling;
  AligningCoefficients aligning;
  StructuralCoefficients structural;
  OperatingConditions conditions;
  std::vector<std::pair<double, double>> load_curve;  // [DEFLECTION_LOAD_CURVE]: m, N; empty: none
  std::vector<std::pair<std::string, std::string>>
      remarks;  // of reading: "[SECTION] KEY", "is …"; what a user must know
};

/// Calls visit(value, field) for every coefficient of the formula and for what else a fit may change, by their names in
/// the file. @param tire MagicFormula, const or not
template <class Tire, class Visit>
void visit_coefficients(Tire& tire, Visit&& visit) {
  visit_fields(tire.dimension, visit);
  visit_fields(tire.vertical, visit);
  visit_fields(tire.scaling, visit);
  visit_fields(tire.longitudinal, visit);
  visit_fields(tire.overturning, visit);
  visit_fields(tire.lateral, visit);
  visit_fields(tire.rolling, visit);
  visit_fields(tire.aligning, visit);
  visit_fields(tire.structural, visit);
}

}  // namespace furrow::tire::handling
