#!/usr/bin/python3
"""The Magic Formula of a tire property file (.tir), evaluated a second time: written from the equations of Pacejka,
Tire and Vehicle Dynamics (2012), section 4.3.2, as MF-Tyre 5.2 and Magic Formula 6.1 have them, with numpy and without
the program. It shares no line with tire/handling; formula_peer_test.py compares the two.

usage: evaluate_tir.py FILE.tir STATES.csv

STATES.csv has the columns Fz_N, kappa, alpha_rad, gamma_rad, Vx_m_s; written to standard output with Fx_N, Fy_N, Mx_Nm,
My_Nm, Mz_Nm added. ISO-W axes: x forward, y left, z up, about the contact centre.
"""
import csv
import re
import sys

import numpy as np

SI = {"LENGTH": "meter", "FORCE": "newton", "ANGLE": "radians", "MASS": "kg", "TIME": "second"}


def read(path):
    """Names and numbers of all sections; what is no number is left out."""
    values, section = {}, ""
    units = {}
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    for line in lines:
        line = re.split(r"[$!]", line)[0].strip()
        if line.startswith("["):
            section = line.strip("[] ").upper()
        elif "=" in line:
            name, text = (part.strip() for part in line.split("=", 1))
            if section == "UNITS":
                units[name.upper()] = text.strip("' ").lower()
            else:
                try:
                    values[name.upper()] = float(text)
                except ValueError:
                    pass
    if units != SI:
        sys.exit(f"{path}: [UNITS] are {units}, expected {SI}")
    return values


class Tire:
    def __init__(self, values):
        self.values = values

    def __getattr__(self, name):
        """pDx1 is PDX1; what a file leaves out is 0, a scaling factor l… is 1."""
        if name.startswith("__"):
            raise AttributeError(name)
        return self.values.get(name.upper(), 1.0 if name.startswith("l") else 0.0)

    def limits(self, name):
        return self.values[name + "MIN"], self.values[name + "MAX"]


def sgn(x):
    return np.where(x < 0, -1.0, 1.0)


def sine(x, B, C, D, E):
    """D sin[C arctan{Bx - E(Bx - arctan Bx)}]"""
    return D * np.sin(C * np.arctan((1 - E) * B * x + E * np.arctan(B * x)))


def cosine(x, B, C, D, E):
    return D * np.cos(C * np.arctan((1 - E) * B * x + E * np.arctan(B * x)))


def evaluate(t, Fz, kappa, alpha, gamma, Vx):
    """Arrays of the five outputs, held within the file's ranges as furrow holds them: loads beyond in proportion."""
    given = np.asarray(Fz, float)
    Fz = np.clip(given, *t.limits("FZ"))
    kappa, alpha, gamma = np.clip(kappa, *t.limits("KPU")), np.clip(alpha,
                                                                    *t.limits("ALP")), np.clip(gamma, *t.limits("CAM"))
    scale = np.divide(given, Fz, out=np.zeros_like(given), where=Fz > 0)
    R0, Fz0 = t.UNLOADED_RADIUS, t.FNOMIN
    Fz0s = t.lfzo * Fz0
    df = Fz / Fz0s - 1
    a = np.tan(alpha)
    one = np.minimum
    later = t.FITTYP >= 61
    dp = t.INFLPRES / (t.lip * t.NOMPRES) - 1 if t.NOMPRES > 0 and t.INFLPRES > 0 else 0.0

    def star(angle):
        return np.sin(angle) if later else angle

    # longitudinal, pure
    gx = gamma * t.lgax
    mux = t.lmux * (t.pdx1 + t.pdx2 * df) * (1 - t.pdx3 * gx**2) * (1 + dp * (t.ppx3 + dp * t.ppx4))
    Kx = t.lkx * Fz * (t.pkx1 + t.pkx2 * df) * np.exp(t.pkx3 * df) * (1 + dp * (t.ppx1 + dp * t.ppx2))
    Cx, Dx = t.pcx1 * t.lcx, mux * Fz
    kx = kappa + t.lhx * (t.phx1 + t.phx2 * df)
    Ex = one(1, t.lex * (t.pex1 + df * (t.pex2 + df * t.pex3)) * (1 - t.pex4 * sgn(kx)))
    Fx0 = sine(kx, Kx / (Cx * Dx), Cx, Dx, Ex) + t.lvx * t.lmux * Fz * (t.pvx1 + t.pvx2 * df)

    # lateral, pure
    def sideways(gy):
        muy = t.lmuy * (t.pdy1 + t.pdy2 * df) * (1 - t.pdy3 * gy**2) * (1 + dp * (t.ppy3 + dp * t.ppy4))
        top = (t.pky2 + t.pky5 * gy**2) * (1 + t.ppy2 * dp) * Fz0s
        Ky = (t.lky * t.pky1 * Fz0s * (1 + t.ppy1 * dp) * np.sin((t.pky4 if later else 2) * np.arctan2(Fz, top))
              * (1 - t.pky3 * abs(gy)))
        Cy, Dy = t.pcy1 * t.lcy, muy * Fz
        SVg = t.lmuy * t.lkyc * Fz * gy * (t.pvy3 + t.pvy4 * df)
        SVy = t.lmuy * t.lvy * Fz * (t.pvy1 + t.pvy2 * df) + SVg
        SHy = t.lhy * (t.phy1 + t.phy2 * df)
        if later:
            SHy = SHy + (t.lkyc * Fz * (t.pky6 + t.pky7 * df) * (1 + t.ppy5 * dp) * gy - SVg) / Ky
        else:
            SHy = SHy + t.phy3 * gy
        ay = a + SHy
        Ey = one(1, t.ley * (t.pey1 + t.pey2 * df) * (1 + t.pey5 * gy**2 - sgn(ay) * (t.pey3 + t.pey4 * gy)))
        By = Ky / (Cy * Dy)
        return sine(ay, By, Cy, Dy, Ey) + SVy, muy, Ky, By, Cy, SHy, SVy

    gy = star(gamma * t.lgay)
    Fy0, muy, Ky, By, Cy, SHy, SVy = sideways(gy)

    # combined
    Bxa = t.lxal * (t.rbx1 + t.rbx3 * star(gamma) ** 2) / np.sqrt(1 + (t.rbx2 * kappa) ** 2)
    Exa = one(1, t.rex1 + t.rex2 * df)
    Gx = cosine(a + t.rhx1, Bxa, t.rcx1, 1, Exa) / cosine(t.rhx1, Bxa, t.rcx1, 1, Exa)
    Fx = np.maximum(Gx, 0) * Fx0
    Byk = t.lyka * (t.rby1 + t.rby4 * gy**2) / np.sqrt(1 + (t.rby2 * (a - t.rby3)) ** 2)
    Eyk = one(1, t.rey1 + t.rey2 * df)
    SHk = t.rhy1 + t.rhy2 * df
    Gy = cosine(kappa + SHk, Byk, t.rcy1, 1, Eyk) / cosine(SHk, Byk, t.rcy1, 1, Eyk)
    DVk = muy * Fz * (t.rvy1 + t.rvy2 * df + t.rvy3 * gy) / np.sqrt(1 + (t.rvy4 * a) ** 2)
    SVk = t.lvyka * DVk * np.sin(t.rvy5 * np.arctan(t.rvy6 * kappa))
    Fy = np.maximum(Gy, 0) * Fy0 + SVk

    # aligning moment: trail on what is lateral by slip angle, residual, arm of Fx
    gz = star(gamma * t.lgaz)
    ratio = (Kx / Ky * kappa) ** 2

    def with_slip(angle):
        return sgn(angle) * np.sqrt(angle**2 + ratio)

    at0 = a + t.qhz1 + t.qhz2 * df + gz * (t.qhz3 + t.qhz4 * df)
    at = with_slip(at0)
    ar = with_slip(a + SHy + SVy / Ky)
    Bt = t.lky / t.lmuy * (t.qbz1 + t.qbz2 * df + t.qbz3 * df**2) * (1 + t.qbz4 * gz + t.qbz5 * abs(gz))
    Ct = t.qcz1
    Dt = t.ltr * Fz * R0 / Fz0s * (t.qdz1 + t.qdz2 * df) * (1 + t.qdz3 * gz + t.qdz4 * gz**2) * (1 - t.ppz1 * dp)
    Et = one(1, (t.qez1 + t.qez2 * df + t.qez3 * df**2)
             * (1 + (t.qez4 + t.qez5 * gz) * 2 / np.pi * np.arctan(Bt * Ct * at0)))
    trail = cosine(at, Bt, Ct, Dt, Et) * np.cos(alpha)
    Br = t.qbz9 * t.lky / t.lmuy + t.qbz10 * By * Cy
    Dr = t.lmuy * R0 * Fz * (t.lres * (t.qdz6 + t.qdz7 * df) + t.lkzc * gz * (
        (t.qdz8 + t.qdz9 * df) * (1 + t.ppz2 * dp) + (t.qdz10 + t.qdz11 * df) * abs(gz)))
    Mzr = Dr * np.cos(alpha) / np.sqrt(1 + (Br * ar) ** 2)
    arm = t.ls * R0 * (t.ssz1 + t.ssz2 * Fy / Fz0s + gz * (t.ssz3 + t.ssz4 * df))
    Mz = Mzr - trail * (np.maximum(Gy, 0) * sideways(0.0)[0] if later else Fy - SVk) + arm * Fx

    nz, ny = Fz / Fz0, Fy / Fz0
    Mx = R0 * Fz * (t.lvmx * t.qsx1 * (t.lmx if later else 1) + t.lmx * (
        t.qsx3 * ny - t.qsx2 * gamma * (1 + t.ppmx1 * dp) + t.qsx10 * np.arctan(t.qsx11 * nz) * gamma
        + t.qsx4 * np.cos(t.qsx5 * np.arctan((t.qsx6 * nz) ** 2))
        * np.sin(t.qsx7 * gamma + t.qsx8 * np.arctan(t.qsx9 * ny))
        - t.qsx12 * gamma * abs(gamma))) + t.lmx * R0 * Fy * (t.qsx13 + t.qsx14 * abs(gamma))
    v = np.asarray(Vx, float) / t.LONGVL if t.LONGVL > 0 else 0.0
    My = -R0 * Fz0 * t.lmy * (t.qsy1 + t.qsy2 * Fx / Fz0 + t.qsy3 * abs(v) + t.qsy4 * v**4
                              + (t.qsy5 + t.qsy6 * nz) * gamma**2) * nz ** (t.qsy7 + (not later)) * (1 + dp)**t.qsy8
    return {"Fx_N": scale * Fx, "Fy_N": scale * Fy, "Mx_Nm": scale * Mx, "My_Nm": scale * My, "Mz_Nm": scale * Mz}


INPUTS = ("Fz_N", "kappa", "alpha_rad", "gamma_rad", "Vx_m_s")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    tire = Tire(read(sys.argv[1]))
    with open(sys.argv[2], encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    states = {name: np.array([float(row[name]) for row in rows]) for name in INPUTS}
    found = evaluate(tire, *(states[name] for name in INPUTS))
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow([*INPUTS, *found])
    for k in range(len(rows)):
        out.writerow([repr(float(column[k])) for column in [*states.values(), *found.values()]])


if __name__ == "__main__":
    main()
