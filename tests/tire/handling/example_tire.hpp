// A tire that uses every coefficient of the formula, for tests. Its numbers are invented, within usual ranges.
#pragma once

#include "tire/handling/coefficients.hpp"

namespace furrow::tire::handling {

inline MagicFormula example_tire() {
  MagicFormula t;
  t.dimension = {.unloaded_radius = 0.35, .width = 0.22, .aspect_ratio = 0.5, .rim_radius = 0.2, .rim_width = 0.18};
  t.vertical = {.vertical_stiffness = 2.2e5,
                .vertical_damping = 150.0,
                .breff = 8.0,
                .dreff = 0.25,
                .freff = 0.05,
                .fnomin = 4000.0};
  t.inertia = {.mass = 10.0, .ixx = 0.5, .iyy = 0.9};
  t.low_speed = 1.0;
  t.reference_speed = 16.7;
  t.slip = {-1.2, 1.2};
  t.slip_angle = {-0.6, 0.6};
  t.camber = {-0.2, 0.2};
  t.load = {200.0, 9000.0};
  t.scaling.lmux = 0.97, t.scaling.lmuy = 0.95, t.scaling.lky = 1.05, t.scaling.ltr = 0.9, t.scaling.lgay = 1.1;
  t.longitudinal = {.pcx1 = 1.6,
                    .pdx1 = 1.1,
                    .pdx2 = -0.08,
                    .pdx3 = 0.5,
                    .pex1 = 0.4,
                    .pex2 = 0.2,
                    .pex3 = -0.1,
                    .pex4 = 0.05,
                    .pkx1 = 22.0,
                    .pkx2 = 0.4,
                    .pkx3 = 0.2,
                    .phx1 = 1e-3,
                    .phx2 = 5e-4,
                    .pvx1 = 2e-3,
                    .pvx2 = -1e-3,
                    .rbx1 = 12.0,
                    .rbx2 = 9.0,
                    .rcx1 = 1.05,
                    .rex1 = -0.3,
                    .rex2 = -0.1,
                    .rhx1 = 0.01,
                    .ptx1 = 0.4,
                    .ptx2 = 0.05,
                    .ptx3 = -0.1};
  t.overturning = {.qsx1 = 3e-3, .qsx2 = 0.6, .qsx3 = 0.04};
  t.lateral = {.pcy1 = 1.35,
               .pdy1 = 0.98,
               .pdy2 = -0.15,
               .pdy3 = 1.5,
               .pey1 = -0.5,
               .pey2 = -0.2,
               .pey3 = 0.1,
               .pey4 = -2.0,
               .pky1 = -18.0,
               .pky2 = 1.9,
               .pky3 = 0.3,
               .phy1 = 2e-3,
               .phy2 = -1e-3,
               .phy3 = 0.04,
               .pvy1 = 0.02,
               .pvy2 = -0.01,
               .pvy3 = -0.2,
               .pvy4 = -0.1,
               .rby1 = 10.0,
               .rby2 = 8.0,
               .rby3 = -0.02,
               .rcy1 = 1.08,
               .rey1 = 0.2,
               .rey2 = -0.1,
               .rhy1 = 0.01,
               .rhy2 = 0.004,
               .rvy1 = 0.02,
               .rvy2 = -0.03,
               .rvy3 = -0.3,
               .rvy4 = 12.0,
               .rvy5 = 1.9,
               .rvy6 = -10.0,
               .pty1 = 1.3,
               .pty2 = 1.7};
  t.rolling = {.qsy1 = 0.01, .qsy2 = 0.002, .qsy3 = 1e-3, .qsy4 = 1e-4};
  t.aligning = {.qbz1 = 9.0,
                .qbz2 = -1.2,
                .qbz3 = -0.3,
                .qbz4 = 0.1,
                .qbz5 = 0.2,
                .qbz9 = 20.0,
                .qbz10 = 0.3,
                .qcz1 = 1.2,
                .qdz1 = 0.1,
                .qdz2 = -3e-3,
                .qdz3 = -0.2,
                .qdz4 = 1.0,
                .qdz6 = -2e-3,
                .qdz7 = 1e-3,
                .qdz8 = -0.1,
                .qdz9 = -0.05,
                .qez1 = -1.5,
                .qez2 = 0.6,
                .qez3 = -0.1,
                .qez4 = 0.1,
                .qez5 = -1.0,
                .qhz1 = 5e-3,
                .qhz2 = 1e-3,
                .qhz3 = 0.1,
                .qhz4 = 0.02,
                .ssz1 = 0.02,
                .ssz2 = -5e-3,
                .ssz3 = 0.5,
                .ssz4 = -0.2};
  return t;
}

/// The tire with the additions of Magic Formula 6.1, at a pressure other than the nominal one.
inline MagicFormula later_tire() {
  MagicFormula t = example_tire();
  t.version61 = true;
  t.conditions = {.inflpres = 2.4e5, .nompres = 2e5};
  t.scaling.lkyc = 1.1, t.scaling.lkzc = 0.9;
  t.vertical.q_fz2 = 12.0, t.vertical.pfz1 = 0.7;
  auto& x = t.longitudinal;
  x.ppx1 = -0.35, x.ppx2 = 0.4, x.ppx3 = -0.1, x.ppx4 = 0.06, x.rbx3 = 5.0;
  auto& m = t.overturning;
  m.qsx4 = 0.05, m.qsx5 = 0.4, m.qsx6 = 0.6, m.qsx7 = 0.8, m.qsx8 = 0.7, m.qsx9 = 0.5, m.qsx10 = 0.04, m.qsx11 = 1.2;
  m.qsx12 = 0.3, m.qsx13 = 0.01, m.qsx14 = 0.05, m.ppmx1 = 0.2;
  auto& y = t.lateral;
  y.phy3 = 0.0;
  y.pey5 = -3.0, y.pky4 = 1.8, y.pky5 = 0.5, y.pky6 = -0.9, y.pky7 = -0.25, y.rby4 = 4.0;
  y.ppy1 = -0.6, y.ppy2 = -0.05, y.ppy3 = -0.15, y.ppy4 = 0.02, y.ppy5 = -0.3;
  auto& r = t.rolling;
  r.qsy5 = 0.1, r.qsy6 = 0.2, r.qsy7 = 0.85, r.qsy8 = -0.4;
  auto& z = t.aligning;
  z.qdz10 = 0.2, z.qdz11 = -0.1, z.ppz1 = -0.4, z.ppz2 = -0.1;
  t.structural = {.longitudinal_stiffness = 3.2e5,
                  .lateral_stiffness = 1.4e5,
                  .pcfx1 = 0.2,
                  .pcfx2 = -0.05,
                  .pcfx3 = 0.3,
                  .pcfy1 = 0.1,
                  .pcfy2 = -0.02,
                  .pcfy3 = 0.25};
  return t;
}

/// example_tire() without shifts, camber and residual moments: odd in slip and in slip angle.
inline MagicFormula symmetric_tire() {
  MagicFormula t = example_tire();
  auto& x = t.longitudinal;
  x.phx1 = x.phx2 = x.pvx1 = x.pvx2 = x.pex4 = x.rhx1 = 0.0;
  auto& y = t.lateral;
  y.phy1 = y.phy2 = y.pvy1 = y.pvy2 = y.pey3 = y.rby3 = y.rhy1 = y.rhy2 = y.rvy1 = y.rvy2 = 0.0;
  auto& z = t.aligning;
  z.qdz6 = z.qdz7 = z.qez4 = z.qhz1 = z.qhz2 = z.ssz1 = z.qbz4 = z.qdz3 = 0.0;
  t.overturning.qsx1 = 0.0;
  return t;
}

}  // namespace furrow::tire::handling
