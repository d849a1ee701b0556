#!/usr/bin/python3
"""Do grains roll along a tread? The interface test of `furrow soil` on the sand of small_wheel.json, over the rolling
friction among the grains and the friction between grains and plate. Writes interface.csv beside this script; a run that
is finished is used again.

One row per rolling friction, plate friction and face: δ of τ = σ tan δ at the end of 20 grain diameters of travel with
its 95 % half-width, K, ω r/v of the first layer, the share of contacts at the limit of friction, the solid fraction
within 4 r of the face and the lid's rise, means over beds and stresses. Rows of face `teeth` are the direct shear test.
Rows of --rolling take the place of those in the table; each row has the commit that made it. With --by-stress the
plates are sheared at 2, 5, 10 and 20 kPa, and interface_stress.csv has a row per stress: δ = atan(τ/σ) at the end, its
mean over beds with the 95 % half-width.
"""
import json
import math

import driver
import provenance

ROLLING = (0.0, 0.2, 0.4, 0.8)
FRICTION = (0.2, 0.4, 0.8)
STRESSES = (5e3, 10e3)
MORE_STRESSES = (2e3, 5e3, 10e3, 20e3)


def run(out, rolling, seeds, *words, stresses=STRESSES):
    if not (out / "soil.json").exists():
        driver.furrow("soil", "rigs/small_wheel.json", *driver.settings({"terrain.rolling_friction": rolling}), *words,
                      *(w for s in stresses for w in ("--stress", s)), "--seeds", seeds, "--out", out, "--overwrite")
    return json.loads((out / "soil.json").read_text())


def mean(tests, name):
    return sum(t[name] for t in tests) / len(tests)


def rows_of(rolling, friction, soil):
    for face in soil["interface"]["faces"]:
        tests = [t for t in soil["interface"]["tests"] if t["face"] == face["face"]]
        interval = face["interval_95"]["friction_angle_without_adhesion_deg"]
        yield {"rolling_friction": rolling, "plate_friction": friction, "face": face["face"],
               "friction_angle_deg": face["friction_angle_without_adhesion_deg"],
               "half_width_deg": (interval[1] - interval[0]) / 2 if interval else "",
               "janosi_K_mm": 1e3 * face["janosi_K_m"], "roll": face["roll"], "sliding_share": face["sliding_share"],
               "solid_fraction_at_face": mean(tests, "solid_fraction_at_face"), "rise_mm": 1e3 * mean(tests, "rise_m")}


def finished(rolling):
    """Rows of the table that are of other rolling frictions."""
    rows = provenance.read_table(driver.HERE / "interface.csv")
    return [row for row in rows if float(row["rolling_friction"]) not in rolling]


def rows_by_stress(rolling, friction, soil):
    for face in ("flat", "glued"):
        for stress in MORE_STRESSES:
            beds = [t for t in soil["interface"]["tests"]
                    if t["face"] == face and abs(t["normal_stress_Pa"] / stress - 1) < 0.1]
            angle, half = driver.over_beds([math.degrees(math.atan2(t["final_shear_stress_Pa"], t["normal_stress_Pa"]))
                                            for t in beds])
            yield {"rolling_friction": rolling, "plate_friction": friction, "face": face, "stress_kPa": stress / 1e3,
                   "friction_angle_deg": angle, "half_width_deg": half, "roll": mean(beds, "roll"),
                   "sliding_share": mean(beds, "sliding_share"), "janosi_K_mm": 1e3 * mean(beds, "janosi_K_m")}


def by_stress(results, rollings, seeds, made):
    rows = []
    for rolling in rollings:
        for friction in FRICTION:
            soil = run(results / f"by_stress_{rolling:g}_{friction:g}", rolling, seeds, "--only", "interface",
                       "--friction", friction, stresses=MORE_STRESSES)
            rows += rows_by_stress(rolling, friction, soil)
            driver.write("interface_stress.csv", rows, made)


def main():
    given = driver.options(__doc__, seeds={"type": int, "default": 3},
                           rolling={"type": float, "nargs": "+", "default": ROLLING},
                           by_stress={"action": "store_true"}).parse_args()
    results, made = driver.RESULTS / "interface", provenance.made_here()
    if given.by_stress:
        return by_stress(results, given.rolling, given.seeds, made)
    rows = finished(given.rolling)
    for rolling in given.rolling:
        shear = run(results / f"shear_{rolling:g}", rolling, given.seeds, "--only", "shear")
        new = [{"rolling_friction": rolling, "face": "teeth",
                "friction_angle_deg": shear["friction_angle_without_cohesion_deg"],
                "janosi_K_mm": 1e3 * shear["janosi_K_m"]}]
        for friction in FRICTION:
            soil = run(results / f"{rolling:g}_{friction:g}", rolling, given.seeds, "--only", "interface",
                       "--friction", friction)
            new += rows_of(rolling, friction, soil)
            print(*new[-2:], sep="\n", flush=True)
        rows += [{**row, "commit": made["commit"]} for row in new]
        driver.write("interface.csv", rows, made)


if __name__ == "__main__":
    main()
