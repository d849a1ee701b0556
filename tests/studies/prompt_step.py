#!/usr/bin/python3
"""Which step prompt forces bear: the HMMWV on handling tires, from standstill to 30 m/s, and rigid wheels of 20 N to
60 kN on empirical soil, each at several steps. Writes prompt_step.csv and prompt_step_soil.csv beside this script; a
run that is finished is used again.

Vehicles: over the window the mean of the wheels' F_x together and the spread of one wheel's, the mean acceleration, and
where the vehicle stands at the end. Soil: a wheel that is let down and rolls at a slip of 0.2, its sinkage and pull.
Either file has the step that `furrow validate` prints, and how far each figure is from that at the smallest step, in
per cent: of the load where it is a force.
"""
import json
import math

import driver
import provenance

STEPS = (1e-3, 5e-4, 1e-4)
SOIL_STEPS = (1e-3, 5e-4, 1e-4, 1e-5)
STILL = {"throttle": 0, "brake": [[0, 1]]}
# Manoeuvre: (keys of the rig, end, window)
MANOEUVRES = {
    "creeps in gear": ({"driver": {"inputs": {"throttle": 0, "brake": [[0, 1], [0.5, 1], [0.51, 0]]}}}, 5.0, 3.0),
    "coasts to a stop": ({"start_speed": 1.5, "driver": {"inputs": {"throttle": 0, "gear": 0, "brake": 0}}}, 8.0, 2.0),
    "drives off": ({"driver": {"inputs": {"throttle": [[0, 0], [0.5, 0], [0.7, 0.5]], "brake": [[0, 1], [0.5, 1],
                                                                                              [0.7, 0]]}}}, 4.0, 1.5),
    "brakes on a slope": ({"slope": 0.2, "start_speed": 4.0,
                           "driver": {"inputs": {"throttle": 0, "gear": 0, "brake": [[0, 0], [0.2, 0.6]]}}}, 3.0, 2.0),
    "turns at full lock": ({"start_speed": 2.0, "driver": {"speed": {"target": 2},
                                                           "inputs": {"steering": [[0, 0], [0.5, 0], [1.5, 1]]}}},
                           8.0, 5.0),
    "brakes from 30 m/s": ({"start_speed": 30.0, "driver": {"inputs": {"throttle": 0, "gear": 0,
                                                                       "brake": [[0, 0], [0.5, 0], [0.7, 0.5]]}}},
                           3.0, 1.0),
}
# Wheels: load, N; radius, width, m
WHEELS = ((20, 0.058, 0.05), (200, 0.15, 0.08), (2e3, 0.3, 0.2), (6e3, 0.47, 0.28), (2e4, 0.6, 0.45), (6e4, 0.9, 0.7))


def kept(name, scenario):
    run = driver.kept(driver.RESULTS / "prompt_step" / name, "run", scenario=scenario)
    told = json.loads(driver.furrow("validate", run.parent / f"{run.name}.json", "--json"))
    return run, min(one["step_s"] or math.inf for one in told["coupling_step"])


def vehicle_row(manoeuvre, step):
    rig, end, begin = MANOEUVRES[manoeuvre]
    run, bears = kept(f"{manoeuvre.replace(' ', '_')}_{step:g}", {
        "format_version": 1, "rig": {"type": "vehicle", "vehicle": "hmmwv.json", **rig},
        "tire": {"file": "hmmwv_handling.json"}, "terrain": {"engine": "rigid"},
        "run": {"step": step, "end": end, "average_from": begin},
        "output": {"series_interval": 5e-3, "frame_interval": 0}})
    wheels = [driver.series(run, f"wheel{k}") for k in range(4)]
    vehicle = driver.series(run, "vehicle")
    late = vehicle["time_s"] >= begin
    forces = [wheel["force_x_N"][late] for wheel in wheels]
    time, speed = vehicle["time_s"][late], vehicle["speed_m_s"][late]
    load = float(sum(wheel["vertical_force_N"][late].mean() for wheel in wheels))
    return {"case": manoeuvre, "step_s": step, "bears_s": bears, "load_N": load,
            "force_x_N": float(sum(f.mean() for f in forces)), "spread_of_wheel_0_N": float(forces[0].std()),
            "acceleration_m_s2": float((speed[-1] - speed[0]) / (time[-1] - time[0])),
            "distance_m": float(vehicle["distance_m"][-1]), "share": driver.summary(run)["interface"]["share"]}


def soil_row(load, radius, width, step):
    file = driver.RESULTS / "prompt_step" / f"drum_{radius:g}.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    drum = json.loads((driver.ROOT / "tire/data/rigid_drum.json").read_text())
    file.write_text(json.dumps(drum_of(drum, radius, width)))
    speed = 0.5 * math.sqrt(9.81 * radius)
    time = math.sqrt(radius / 9.81)
    run, bears = kept(f"soil_{load:g}_{step:g}", {
        "format_version": 1,
        "rig": {"type": "drawbar", "mode": "fixed_speed", "speed": round(speed, 3), "slip": 0.2, "load": load,
                "ramp": round(2 * time, 2), "rim_mass": round(load / 9.81 / 10, 3),
                "rim_spin_inertia": round(load / 9.81 / 10 * radius**2 / 2, 6)},
        "tire": {"file": str(file), "rigid": True},
        "terrain": {"engine": "scm", "material": "lete_sand.json", "length": round(16 * radius, 2),
                    "width": round(4 * width, 2), "grid_spacing": round(width / 10, 3)},
        "run": {"step": step, "end": round(14 * time, 2), "average_from": round(7 * time, 2)},
        "output": {"series_interval": 2e-3, "frame_interval": 0}})
    told = driver.summary(run)
    return {"load_N": load, "radius_m": radius, "step_s": step, "bears_s": bears, "sinkage_mm": 1e3 * told["sinkage_m"],
            "pull_N": told["drawbar_pull_N"]["mean"], "share": told["interface"]["share"]}


def drum_of(drum, radius, width):
    """rigid_drum.json in another size; the wall is as thick in proportion to the radius."""
    scale = radius / drum["radius"]
    tread = {**drum["sections"]["tread"]["layers"][0], "thickness": 2e-3 * scale}
    return {**drum, "radius": radius, "rim_radius": drum["rim_radius"] * scale, "rim_width": width,
            "sections": {name: {**section, "layers": [tread]} for name, section in drum["sections"].items()},
            "profile": [[at, out * scale, across * width / 0.05] for at, out, across in drum["profile"]]}


def compared(rows, of, scale):
    """Adds how far each figure is from the last row's, in per cent."""
    for row in rows:
        for name in of:
            row[f"{name}_off_percent"] = 100 * (row[name] - rows[-1][name]) / scale(name, rows[-1])
    return rows


def main():
    driver.options(__doc__).parse_args()
    made, vehicles, soil = provenance.made_here(), [], []
    for load, radius, width in WHEELS:
        soil += compared([soil_row(load, radius, width, step) for step in SOIL_STEPS], ("sinkage_mm", "pull_N"),
                         lambda name, row: row["load_N"] if name.endswith("_N") else row[name])
        driver.write("prompt_step_soil.csv", soil, made)
    for manoeuvre in MANOEUVRES:
        vehicles += compared([vehicle_row(manoeuvre, step) for step in STEPS],
                             ("force_x_N", "acceleration_m_s2", "distance_m"),
                             lambda name, row: row["load_N"] if name == "force_x_N" else max(abs(row[name]), 0.1))
        driver.write("prompt_step.csv", vehicles, made)


if __name__ == "__main__":
    main()
