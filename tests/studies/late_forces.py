#!/usr/bin/python3
"""What late forces make in the scenarios that are shipped, wheel by wheel. Writes late_forces.csv beside this script; a
run that is finished is used again. Scenarios of many grains are cut short.

One row per scenario: its step, what `furrow validate` says that the pair of tire and ground bears and why, and the
largest share of what passes a wheel that late forces made in the averaging window, at ground, rim and driveline.
"""
import json

import driver
import provenance

# Scenarios with what their runs are cut to: None, as they are.
CUT = {"cleat_roll": None, "curb": None, "drawbar_pull_scm": None, "first_look": None, "four_wheels": None,
       "half_car": None, "rough_road": None, "hmmwv_slope": None, "hmmwv_lane_change": 3.0, "rigid_ground": None,
       "drawbar_pull_small_report_soil": None, "rover_small": 2.0, "hmmwv_turn": 2.0, "small_wheel": 1.0,
       "hmmwv_small": 1.0, "hmmwv_rigid": 2.0, "drawbar_pull": 0.8}


def row_of(name, end):
    scenario = f"rigs/{name}.json"
    cut = driver.settings({"run.end": end, "run.average_from": 0.6 * end}) if end else []
    run = driver.kept(driver.RESULTS / "late_forces" / name, "run", scenario, *cut,
                      *driver.settings({"run.on_lag": "warn", "output.frame_interval": 0}))
    told = json.loads(driver.furrow("validate", scenario, "--json"))
    least = min(told["coupling_step"], key=lambda one: one["step_s"] or float("inf"))
    judged = driver.summary(run)["interface"]
    worst = {at: max((one["share"] for one in judged["entries"] if one["name"].endswith(at)), default=None)
             for at in ("ground", "rim", "driveline")}
    return {"scenario": name, "end_s": end or "", "step_s": told["step_s"], "bears_s": least["step_s"] or "",
            "limited_by": least["limited_by"], "ground_share": worst["ground"], "rim_share": worst["rim"],
            "driveline_share": worst["driveline"],
            "ok": judged["ok"]}


def main():
    driver.options(__doc__).parse_args()
    rows, made = [], provenance.made_here()
    for name, end in CUT.items():
        rows.append(row_of(name, end))
        driver.write("late_forces.csv", rows, made)
        print(rows[-1], flush=True)


if __name__ == "__main__":
    main()
