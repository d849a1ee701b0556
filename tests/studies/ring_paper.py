#!/usr/bin/python3
"""The flexible ring with the parameters of its paper, fitted to a shell tire on a plate and a 51 mm cleat pressed to
0.1 m, a fifth of its radius: ring_paper.csv (R² and largest errors, of cleats that are predicted too),
ring_paper_parameters.csv, ring_paper_pressure.csv (centre line on a plate under two loads), ring_paper.png.

usage: ring_paper.py

The paper's ring has A, B, q, k1, k2, k3 and meets the ground at undeformed angles. Here the inflated ring is in balance
for any k1, k2, k3, and q follows from them: a fitted q and a fitted k1 are the same. Its belt has no hoop tension and
its sidewall no tangential spring; what little of it the program needs is 1 N/m. Where segments meet the ground at
their exact places that spring holds them, and has the 250 kN/m of the shipped ring. The share of air is that of a tire
whose rim has the radius of the file's.
"""
import json

import numpy as np

import driver
import provenance
import ring_targets
from driver import RESULTS, ROOT, read_json
from furrow.plot.style import BLUE, GREEN, ORANGE, RED
from ring_protocol import stiffening

WIDE = {"bending": (1, 1e5, 146), "shear": (1e2, 1e8, 5e4), "sidewall_1": (1e4, 1e7, 8.84e5)}
CUBIC = {"sidewall_3": (1e4, 1e11, 1e6), "softening": (0, 1, 0.3)}
OURS = {"tangential": (1e3, 1e7, 5e4), "air_share": (0.05, 1, 0.674), "tension_share": (0, 1, 0.3)}
SETS = {  # name: (kinematics, tangential spring that is not fitted, parameters {name: (lower, upper, start)})
    "paper": ("radial", 1.0, WIDE | CUBIC),
    "paper, linear sidewall": ("radial", 1.0, WIDE),
    "paper, exact places": ("exact", 2.5e5, WIDE | CUBIC),
    "Furrow's": ("exact", 1.0, WIDE | CUBIC | OURS),
}
CLEATS = {"25": 0.025, "38": 0.038, "51": 0.051, "76": 0.076, "100": 0.1}  # mm: m
DEPTH, LOADS = 0.1, (4561.65, 9000.0)  # m, N
SHELL = ["rigs/cleat_press.json", *driver.settings({"tire.elements_circumference": 90, "tire.elements_width": 24})]
RING = ["--set", "tire.elements_circumference=null", "--set", "tire.elements_width=null"]


def shell_curves(made):
    """{name: CSV file of the loading} of the shell on the plate and on cleats; the plate's folders by load"""
    files, plates = {}, {}
    cases = {f"cleat {name}": ("--on", "cleat", "--cleat-height", 0.15, "--cleat-width", width)
             for name, width in CLEATS.items()} | {f"plate, {load:g} N": ("--on", "plate", "--load", load)
                                                   for load in LOADS}
    for name, words in cases.items():
        folder = RESULTS / "ring_paper" / name.replace(" ", "_").replace(",", "")
        driver.kept(folder, "press", *SHELL, *words, "--deflection", DEPTH, "--points", 20, made_at=made["commit"])
        if name.startswith("plate"):
            plates[float(name.split()[1])] = folder
            name = "plate"
        files[name] = folder.parent / f"{name.replace(' ', '_')}.csv"
        rows = [{key: float(row[key]) for key in ("deflection_m", "force_N")} for row in driver.press_curve(folder)]
        driver.write(files[name], rows, made, 9)
    return files, plates


def target_of(name, file):
    on = {"on": "plate"} if name == "plate" else {"on": "cleat", "cleat_width": CLEATS[name.split()[1]],
                                                  "cleat_height": 0.15}
    return {"data": str(file), "pressure": 200e3, **on}


def fit(name, files, made):
    """@returns the folder of the calibration, its result"""
    kinematics, tangential, parameters = SETS[name]
    folder = RESULTS / "ring_paper" / name.replace(" ", "_").replace(",", "").replace("'", "")
    start = read_json(ROOT / "tire" / "data" / "hmmwv_ring.json")
    share = 1.0 - (start["rim_radius"] / start["radius"]) ** 2
    start |= {"kinematics": kinematics, "air_share": share, "tangential": tangential, "sidewall": [8.84e5, 0.0, 0.0]}
    file = folder.parent / f"{folder.name}_{tangential:g}.json"
    file.write_text(json.dumps(start, indent=2), encoding="utf-8")
    fitted, held = ("plate", "cleat 51"), ("cleat 25", "cleat 38", "cleat 76", "cleat 100")
    study = {"format_version": 1, "calibrate": "ring", "start": str(file), "starts": 2, "seed": 1,
             "parameters": {key: dict(zip(("lower", "upper", "start"), of)) for key, of in parameters.items()},
             "targets": [target_of(of, files[of]) for of in fitted],
             "held_out": [target_of(of, files[of]) for of in held]}
    driver.kept(folder, "calibrate", scenario=study, made_at=made["commit"])
    return folder, read_json(folder / "calibration.json")


def rows_of(name, folder, result):
    points = {}
    for row in provenance.read_table(folder / "fit.csv"):
        points.setdefault(row["target"], []).append(row)
    for key, how in (("targets", "fitted"), ("held_out_targets", "predicted")):
        for target in result[key]:
            yield {"set": name.replace(",", ""), "target": target["what"].replace(",", ""), "use": how,
                   "r_squared": f"{target['r_squared']:.4f}",
                   "largest_error_of_peak": f"{target['largest_error_of_peak']:.3f}", "peak_N": f"{target['peak']:.5g}",
                   "stiffening": f"{stiffening(points[target['name']]):.3f}"}


def pressed(folder, result, load):
    """The fitted ring on a plate under a load: its pressure along the centre line"""
    out = folder / f"press_{load:g}"
    driver.furrow("press", "rigs/cleat_press.json", "--set", f"tire.file={folder / result['result']}", *RING,
                  "--on", "plate", "--deflection", DEPTH, "--points", 20, "--load", load, "--out", out, "--overwrite",
                  "--quiet")
    return driver.columns(out / "footprint.csv")


def centre_line(folder):
    """Of the shell: mean over the middle quarter of the footprint's width."""
    rows = list(ring_targets.centre_line(folder, 2 * np.pi * 0.47 / 90 / 3))
    return np.array([row["x_m"] for row in rows]), np.array([row["pressure_Pa"] for row in rows])


def main():
    driver.options(__doc__).parse_args()
    made = provenance.made_here()
    files, plates = shell_curves(made)
    fits = {name: fit(name, files, made) for name in SETS}
    driver.write("ring_paper.csv", [row for name, of in fits.items() for row in rows_of(name, *of)], made)
    driver.write("ring_paper_parameters.csv", [
        {"set": name.replace(",", ""), "parameter": key, "unit": p["unit"], "value": float(p["value"]),
         "low": (p["interval_95"] or ("", ""))[0], "high": (p["interval_95"] or ("", ""))[1],
         "at_bound": p["at_bound"] or ""}
        for name, (_, result) in fits.items() for key, p in result["parameters"].items()], made)
    rows = []
    colour = dict(zip(SETS, (BLUE, ORANGE, GREEN, RED)))
    figure, charts = driver.subplots(1, 3, figsize=(14, 4.4))
    for load, chart in zip(LOADS, charts[1:]):
        x, shell = centre_line(plates[load])
        chart.plot(1e3 * x, 1e-3 * shell, "ko", ms=3.5, label="shell")
        lines = {"shell_Pa": shell}
        for name in ("paper", "paper, exact places", "Furrow's"):
            ring = pressed(*fits[name], load)
            chart.plot(1e3 * ring["x_m"], 1e-3 * ring["pressure_Pa"], color=colour[name], label=name)
            key = {"paper": "radial_Pa", "paper, exact places": "exact_Pa", "Furrow's": "furrow_Pa"}[name]
            lines[key] = np.interp(x, ring["x_m"], ring["pressure_Pa"], left=0.0, right=0.0)
        driver.label(chart, "along, mm", "pressure, kPa", f"centre line under {1e-3 * load:.3g} kN", 8, ylim=(0, None))
        rows += [{"load_N": load, "x_m": of, **{key: line[k] for key, line in lines.items()}} for k, of in enumerate(x)]
    driver.write("ring_paper_pressure.csv", rows, made, 5)
    for name, (folder, result) in fits.items():
        cleat = next(target["name"] for target in result["targets"] if "51 mm" in target["what"])
        x, shell, ring = np.array([[float(row[key]) for key in ("x", "data", "model")]
                                   for row in provenance.read_table(folder / "fit.csv") if row["target"] == cleat]).T
        if name == "paper":
            charts[0].plot(1e3 * x, 1e-3 * shell, "ko", ms=3.5, label="shell")
        charts[0].plot(1e3 * x, 1e-3 * ring, color=colour[name], label=name)
    driver.label(charts[0], "deflection, mm", "force, kN", "cleat of 51 mm, fitted", 8)
    driver.save(figure, "ring_paper")


if __name__ == "__main__":
    main()
