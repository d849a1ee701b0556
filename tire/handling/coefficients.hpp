// The coefficients of the Magic Formula as tire property files (.tir) name them, MF-Tyre 5.2: dimensionless unless a
// unit is said. One list serves reading, writing and fitting.
//
// Sources: [1] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, Butterworth-Heinemann 2012, section 4.3.2 (the
// names of the coefficients: appendix 3); 2nd edition 2006 alike. [2] TNO Automotive, MF-Tyre User Manual, version 5.2,
// 2001: names and sections of the file.
#pragma once

#include "protocol/core/fields.hpp"

namespace furrow::tire::handling {

/// λ: 1 leaves the formula as it is.
struct ScalingFactors {
  double lfzo = 1.0, lcx = 1.0, lmux = 1.0, lex = 1.0, lkx = 1.0, lhx = 1.0, lvx = 1.0, lgax = 1.0, lcy = 1.0,
         lmuy = 1.0, ley = 1.0, lky = 1.0, lhy = 1.0, lvy = 1.0, lgay = 1.0, ltr = 1.0, lres = 1.0, lgaz = 1.0,
         lxal = 1.0, lyka = 1.0, lvyka = 1.0, ls = 1.0, lsgkp = 1.0, lsgal = 1.0, lgyr = 1.0, lmx = 1.0, lvmx = 1.0,
         lmy = 1.0;
};
void visit_fields(auto&& visit, FieldsOf<ScalingFactors> auto& s) {
  visit(Field{"LFZO"}, s.lfzo);
  visit(Field{"LCX"}, s.lcx);
  visit(Field{"LMUX"}, s.lmux);
  visit(Field{"LEX"}, s.lex);
  visit(Field{"LKX"}, s.lkx);
  visit(Field{"LHX"}, s.lhx);
  visit(Field{"LVX"}, s.lvx);
  visit(Field{"LGAX"}, s.lgax);
  visit(Field{"LCY"}, s.lcy);
  visit(Field{"LMUY"}, s.lmuy);
  visit(Field{"LEY"}, s.ley);
  visit(Field{"LKY"}, s.lky);
  visit(Field{"LHY"}, s.lhy);
  visit(Field{"LVY"}, s.lvy);
  visit(Field{"LGAY"}, s.lgay);
  visit(Field{"LTR"}, s.ltr);
  visit(Field{"LRES"}, s.lres);
  visit(Field{"LGAZ"}, s.lgaz);
  visit(Field{"LXAL"}, s.lxal);
  visit(Field{"LYKA"}, s.lyka);
  visit(Field{"LVYKA"}, s.lvyka);
  visit(Field{"LS"}, s.ls);
  visit(Field{"LSGKP"}, s.lsgkp);
  visit(Field{"LSGAL"}, s.lsgal);
  visit(Field{"LGYR"}, s.lgyr);
  visit(Field{"LMX"}, s.lmx);
  visit(Field{"LVMX"}, s.lvmx);
  visit(Field{"LMY"}, s.lmy);
}

/// Of F_x: p of pure slip, r of combined slip, ptx of the relaxation length.
struct LongitudinalCoefficients {
  double pcx1 = 0.0, pdx1 = 0.0, pdx2 = 0.0, pdx3 = 0.0, pex1 = 0.0, pex2 = 0.0, pex3 = 0.0, pex4 = 0.0, pkx1 = 0.0,
         pkx2 = 0.0, pkx3 = 0.0, phx1 = 0.0, phx2 = 0.0, pvx1 = 0.0, pvx2 = 0.0, rbx1 = 0.0, rbx2 = 0.0, rcx1 = 0.0,
         rex1 = 0.0, rex2 = 0.0, rhx1 = 0.0, ptx1 = 0.0, ptx2 = 0.0, ptx3 = 0.0;
};
void visit_fields(auto&& visit, FieldsOf<LongitudinalCoefficients> auto& s) {
  visit(Field{"PCX1"}, s.pcx1);
  visit(Field{"PDX1"}, s.pdx1);
  visit(Field{"PDX2"}, s.pdx2);
  visit(Field{"PDX3"}, s.pdx3);
  visit(Field{"PEX1"}, s.pex1);
  visit(Field{"PEX2"}, s.pex2);
  visit(Field{"PEX3"}, s.pex3);
  visit(Field{"PEX4"}, s.pex4);
  visit(Field{"PKX1"}, s.pkx1);
  visit(Field{"PKX2"}, s.pkx2);
  visit(Field{"PKX3"}, s.pkx3);
  visit(Field{"PHX1"}, s.phx1);
  visit(Field{"PHX2"}, s.phx2);
  visit(Field{"PVX1"}, s.pvx1);
  visit(Field{"PVX2"}, s.pvx2);
  visit(Field{"RBX1"}, s.rbx1);
  visit(Field{"RBX2"}, s.rbx2);
  visit(Field{"RCX1"}, s.rcx1);
  visit(Field{"REX1"}, s.rex1);
  visit(Field{"REX2"}, s.rex2);
  visit(Field{"RHX1"}, s.rhx1);
  visit(Field{"PTX1"}, s.ptx1);
  visit(Field{"PTX2"}, s.ptx2);
  visit(Field{"PTX3"}, s.ptx3);
}

/// Of M_x.
struct OverturningCoefficients {
  double qsx1 = 0.0, qsx2 = 0.0, qsx3 = 0.0;
};
void visit_fields(auto&& visit, FieldsOf<OverturningCoefficients> auto& s) {
  visit(Field{"QSX1"}, s.qsx1);
  visit(Field{"QSX2"}, s.qsx2);
  visit(Field{"QSX3"}, s.qsx3);
}

/// Of F_y, likewise.
struct LateralCoefficients {
  double pcy1 = 0.0, pdy1 = 0.0, pdy2 = 0.0, pdy3 = 0.0, pey1 = 0.0, pey2 = 0.0, pey3 = 0.0, pey4 = 0.0, pky1 = 0.0,
         pky2 = 0.0, pky3 = 0.0, phy1 = 0.0, phy2 = 0.0, phy3 = 0.0, pvy1 = 0.0, pvy2 = 0.0, pvy3 = 0.0, pvy4 = 0.0,
         rby1 = 0.0, rby2 = 0.0, rby3 = 0.0, rcy1 = 0.0, rey1 = 0.0, rey2 = 0.0, rhy1 = 0.0, rhy2 = 0.0, rvy1 = 0.0,
         rvy2 = 0.0, rvy3 = 0.0, rvy4 = 0.0, rvy5 = 0.0, rvy6 = 0.0, pty1 = 0.0, pty2 = 0.0;
};
void visit_fields(auto&& visit, FieldsOf<LateralCoefficients> auto& s) {
  visit(Field{"PCY1"}, s.pcy1);
  visit(Field{"PDY1"}, s.pdy1);
  visit(Field{"PDY2"}, s.pdy2);
  visit(Field{"PDY3"}, s.pdy3);
  visit(Field{"PEY1"}, s.pey1);
  visit(Field{"PEY2"}, s.pey2);
  visit(Field{"PEY3"}, s.pey3);
  visit(Field{"PEY4"}, s.pey4);
  visit(Field{"PKY1"}, s.pky1);
  visit(Field{"PKY2"}, s.pky2);
  visit(Field{"PKY3"}, s.pky3);
  visit(Field{"PHY1"}, s.phy1);
  visit(Field{"PHY2"}, s.phy2);
  visit(Field{"PHY3"}, s.phy3);
  visit(Field{"PVY1"}, s.pvy1);
  visit(Field{"PVY2"}, s.pvy2);
  visit(Field{"PVY3"}, s.pvy3);
  visit(Field{"PVY4"}, s.pvy4);
  visit(Field{"RBY1"}, s.rby1);
  visit(Field{"RBY2"}, s.rby2);
  visit(Field{"RBY3"}, s.rby3);
  visit(Field{"RCY1"}, s.rcy1);
  visit(Field{"REY1"}, s.rey1);
  visit(Field{"REY2"}, s.rey2);
  visit(Field{"RHY1"}, s.rhy1);
  visit(Field{"RHY2"}, s.rhy2);
  visit(Field{"RVY1"}, s.rvy1);
  visit(Field{"RVY2"}, s.rvy2);
  visit(Field{"RVY3"}, s.rvy3);
  visit(Field{"RVY4"}, s.rvy4);
  visit(Field{"RVY5"}, s.rvy5);
  visit(Field{"RVY6"}, s.rvy6);
  visit(Field{"PTY1"}, s.pty1);
  visit(Field{"PTY2"}, s.pty2);
}

/// Of M_y.
struct RollingCoefficients {
  double qsy1 = 0.0, qsy2 = 0.0, qsy3 = 0.0, qsy4 = 0.0;
};
void visit_fields(auto&& visit, FieldsOf<RollingCoefficients> auto& s) {
  visit(Field{"QSY1"}, s.qsy1);
  visit(Field{"QSY2"}, s.qsy2);
  visit(Field{"QSY3"}, s.qsy3);
  visit(Field{"QSY4"}, s.qsy4);
}

/// Of M_z: q of trail and residual moment, s of the arm of F_x. QTZ1 and MBELT, of the gyroscopic moment, are kept
/// and not used.
struct AligningCoefficients {
  double qbz1 = 0.0, qbz2 = 0.0, qbz3 = 0.0, qbz4 = 0.0, qbz5 = 0.0, qbz9 = 0.0, qbz10 = 0.0, qcz1 = 0.0, qdz1 = 0.0,
         qdz2 = 0.0, qdz3 = 0.0, qdz4 = 0.0, qdz6 = 0.0, qdz7 = 0.0, qdz8 = 0.0, qdz9 = 0.0, qez1 = 0.0, qez2 = 0.0,
         qez3 = 0.0, qez4 = 0.0, qez5 = 0.0, qhz1 = 0.0, qhz2 = 0.0, qhz3 = 0.0, qhz4 = 0.0, ssz1 = 0.0, ssz2 = 0.0,
         ssz3 = 0.0, ssz4 = 0.0, qtz1 = 0.0, mbelt = 0.0;
};
void visit_fields(auto&& visit, FieldsOf<AligningCoefficients> auto& s) {
  visit(Field{"QBZ1"}, s.qbz1);
  visit(Field{"QBZ2"}, s.qbz2);
  visit(Field{"QBZ3"}, s.qbz3);
  visit(Field{"QBZ4"}, s.qbz4);
  visit(Field{"QBZ5"}, s.qbz5);
  visit(Field{"QBZ9"}, s.qbz9);
  visit(Field{"QBZ10"}, s.qbz10);
  visit(Field{"QCZ1"}, s.qcz1);
  visit(Field{"QDZ1"}, s.qdz1);
  visit(Field{"QDZ2"}, s.qdz2);
  visit(Field{"QDZ3"}, s.qdz3);
  visit(Field{"QDZ4"}, s.qdz4);
  visit(Field{"QDZ6"}, s.qdz6);
  visit(Field{"QDZ7"}, s.qdz7);
  visit(Field{"QDZ8"}, s.qdz8);
  visit(Field{"QDZ9"}, s.qdz9);
  visit(Field{"QEZ1"}, s.qez1);
  visit(Field{"QEZ2"}, s.qez2);
  visit(Field{"QEZ3"}, s.qez3);
  visit(Field{"QEZ4"}, s.qez4);
  visit(Field{"QEZ5"}, s.qez5);
  visit(Field{"QHZ1"}, s.qhz1);
  visit(Field{"QHZ2"}, s.qhz2);
  visit(Field{"QHZ3"}, s.qhz3);
  visit(Field{"QHZ4"}, s.qhz4);
  visit(Field{"SSZ1"}, s.ssz1);
  visit(Field{"SSZ2"}, s.ssz2);
  visit(Field{"SSZ3"}, s.ssz3);
  visit(Field{"SSZ4"}, s.ssz4);
  visit(Field{"QTZ1"}, s.qtz1);
  visit(Field{"MBELT", "kg"}, s.mbelt);
}

/// [VERTICAL]
struct VerticalCoefficients {
  double vertical_stiffness = 0.0;               // C_z, N/m
  double vertical_damping = 0.0;                 // K_z, N s/m
  double breff = 0.0, dreff = 0.0, freff = 0.0;  // of the effective rolling radius
  double fnomin = 0.0;                           // F_z0, N
};
void visit_fields(auto&& visit, FieldsOf<VerticalCoefficients> auto& s) {
  visit(Field{"VERTICAL_STIFFNESS", "N/m"}, s.vertical_stiffness);
  visit(Field{"VERTICAL_DAMPING", "N s/m"}, s.vertical_damping);
  visit(Field{"BREFF"}, s.breff);
  visit(Field{"DREFF"}, s.dreff);
  visit(Field{"FREFF"}, s.freff);
  visit(Field{"FNOMIN", "N"}, s.fnomin);
}

/// [DIMENSION]
struct Dimensions {
  double unloaded_radius = 0.0;  // R_0, m
  double width = 0.0;            // m
  double aspect_ratio = 0.0;     // -
  double rim_radius = 0.0;       // m
  double rim_width = 0.0;        // m
};
void visit_fields(auto&& visit, FieldsOf<Dimensions> auto& s) {
  visit(Field{"UNLOADED_RADIUS", "m"}, s.unloaded_radius);
  visit(Field{"WIDTH", "m"}, s.width);
  visit(Field{"ASPECT_RATIO"}, s.aspect_ratio);
  visit(Field{"RIM_RADIUS", "m"}, s.rim_radius);
  visit(Field{"RIM_WIDTH", "m"}, s.rim_width);
}

/// [INERTIA], which files of version 5.2 need not have.
struct TireInertia {
  double mass = 0.0;  // kg; 0: not said
  double ixx = 0.0;   // about a diameter, kg m²
  double iyy = 0.0;   // about the axle, kg m²
};
void visit_fields(auto&& visit, FieldsOf<TireInertia> auto& s) {
  visit(Field{"MASS", "kg"}, s.mass);
  visit(Field{"IXX", "kg m²"}, s.ixx);
  visit(Field{"IYY", "kg m²"}, s.iyy);
}

/// What the coefficients were fitted for; the formula is held at the ends of it.
struct Range {
  double least = 0.0, most = 0.0;
};

struct MagicFormula {
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
};

/// Calls visit(field, value) for every coefficient of the formula and for what else a fit may change, by their names in
/// the file. @param tire MagicFormula, const or not
template <class Visit, class Tire>
void visit_coefficients(Visit&& visit, Tire& tire) {
  visit_fields(visit, tire.dimension);
  visit_fields(visit, tire.vertical);
  visit_fields(visit, tire.scaling);
  visit_fields(visit, tire.longitudinal);
  visit_fields(visit, tire.overturning);
  visit_fields(visit, tire.lateral);
  visit_fields(visit, tire.rolling);
  visit_fields(visit, tire.aligning);
}

}  // namespace furrow::tire::handling
