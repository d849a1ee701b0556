#!/usr/bin/python3
"""Runs the shipped files and keeps what the gallery shows of each: pictures (scripts/docs/pictures/) and gallery.csv,
with the figures that the program found, the processor time of all ranks and the wall time.

usage: gallery.py [NAME...]     (needs Debian's python3-pil; FURROW names another program than build/furrow)

NAME is one of CASES without its ending. Without names all are made. A case that this program has made is not run again.
The rows of other cases stay as they are: the column commit says which program made each row.
"""
import json
import sys

from PIL import Image

import driver
import provenance
from driver import HERE, ROOT, read_json

TABLE, PICTURES = HERE / "gallery.csv", ROOT / "scripts" / "docs" / "pictures"
WIDTH, MOST_BYTES = 800, 100_000  # of a picture: pixels, bytes
TIMES = "time.json"  # in a folder of results: what it took

PULL = ("drawbar_pull_N.mean", "drawbar_pull_N.sem", "drawbar_pull_N.steady",
        "vertical_load_N", "sinkage_m", "rut_depth_m")
VEHICLE = ("vehicle.distance_m", "vehicle.mean_speed_m_s", "figures.gear_changes", "end_reason", "end_time_s")
# Simulated time of the two scenarios at full size: they are shown, not measured.
START = ("--set", "run.end=0.5", "--set", "run.average_from=0.4")
# name → (command, picture of its folder, keys of the summary, options)
CASES = {
    "first_look": ("run", "scene", PULL),
    "small_wheel": ("run", "scene", PULL),
    "drawbar_pull_small": ("run", "pull_slip_sinkage", PULL),
    "drawbar_pull_scm": ("run", "pull_slip_sinkage", PULL),
    "drawbar_pull": ("run", "scene", PULL, *START),
    "drawbar_pull_tr": ("run", "scene", PULL, *START),
    "rigid_ground": ("run", "pull_slip_sinkage", PULL[:4]),
    "curb": ("run", "scene", ("wheels.0.columns.body_acceleration_m_per_s2",)),
    "rough_road": ("run", "ride", ()),
    "half_car": ("run", "ride", ()),
    "cleat_roll": ("run", "forces", ("vertical_load_N",)),
    "cleat_press": ("press", "load_deflection",
                    ("load_N", "deflection_m", "secant_stiffness_N_per_m", "footprint.length_m", "footprint.width_m")),
    # its scene.png shows one wheel; the picture is the playback of its page (report_pictures.py)
    "four_wheels": ("run", None,
                    ("wheels.0.sinkage_m", "wheels.1.sinkage_m", "wheels.2.sinkage_m", "wheels.3.sinkage_m")),
    "hmmwv_turn": ("run", "scene", VEHICLE),
    "rover_small": ("run", "scene", VEHICLE),
    "hmmwv_small": ("run", "scene", VEHICLE),
    "hmmwv_rigid": ("run", "gear", VEHICLE),
    "hmmwv_slope": ("run", "vehicle", VEHICLE),
    "hmmwv_lane_change": ("run", "path", VEHICLE + ("figures.lane_margin_least_m", "figures.path_error_largest_m")),
    "calibrate_ring": ("calibrate", "fit", ()),
    "calibrate_scm": ("calibrate", "fit", ()),
    "calibrate_handling": ("calibrate", "fit", ()),
    "calibrate_lete_sand": ("calibrate", "fit", ()),
    "calibrate_sandy_loam": ("calibrate", "fit", ()),
}


def made(name):
    """The folder of results of a case, made unless this program made it."""
    command, _, _, *options = CASES[name]
    folder, build = driver.RESULTS / "gallery" / name, provenance.build_of(provenance.program())
    if read_json(folder / TIMES).get("build") == build:
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    later = [] if command == "press" else ["--no-plots"]
    _, processor, wall = driver.timed(command, f"{name}.json", *options, *later, "--out", folder, "--overwrite",
                                      "--quiet")
    (folder / TIMES).write_text(json.dumps({"build": build, "commit": provenance.commit(),
                                            "processor_s": round(processor, 1), "wall_s": round(wall, 1)}) + "\n")
    driver.furrow("report", folder, "--quiet")
    return folder


def figures_of(folder, keys):
    """[(name, value)] of a run or a press, or of a calibration."""
    fitted = read_json(folder / "calibration.json")
    found = [(f"{name} fitted", entry["value"]) for name, entry in fitted.get("parameters", {}).items()]
    for what, key in (("fitted", "targets"), ("predicted", "held_out_targets")):
        found += [(f"{what} {entry['name']}: R²", entry["r_squared"])
                  for entry in fitted.get(key, []) if entry.get("r_squared") is not None]
        found += [(f"{what} {entry['name']}", entry["figures"][0]["surrogate"]["value"])
                  for entry in fitted.get(key, []) if entry["points"] == 1 and "surrogate" in entry["figures"][0]]
    values = [(key, driver.value_of(driver.summary(folder), key)) for key in keys]
    return found + [(key, len(value) if isinstance(value, list) else value) for key, value in values]


def picture_of(folder, name, plot):
    if plot is None:
        return
    if not (folder / f"{plot}.png").exists():
        sys.exit(f"{folder}: has no {plot}.png, expected that `furrow report` draws it")
    picture = Image.open(folder / f"{plot}.png").convert("RGB")
    picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.Resampling.LANCZOS)
    PICTURES.mkdir(exist_ok=True)
    file = PICTURES / f"{name}.jpg"
    for quality in range(88, 30, -6):
        picture.save(file, quality=quality, optimize=True)
        if file.stat().st_size <= MOST_BYTES:
            return


def rows_of(name, folder):
    times = read_json(folder / TIMES)
    return [{"case": name, "processor_s": times["processor_s"], "wall_s": times["wall_s"], "figure": figure,
             "value": value, "commit": times["commit"]}
            for figure, value in figures_of(folder, CASES[name][2]) or [("", "")]]


def main():
    parser = driver.options(__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    names = parser.parse_args().names or list(CASES)
    if unknown := [name for name in names if name not in CASES]:
        sys.exit(f"{unknown[0]}: is no case, expected one of: {', '.join(CASES)}")
    order = list(CASES)
    for name in names:
        folder = made(name)
        picture_of(folder, name, CASES[name][1])
        others = provenance.read_table(TABLE) if TABLE.exists() else []
        rows = rows_of(name, folder) + [row for row in others if row["case"] in CASES and row["case"] != name]
        driver.write(TABLE, sorted(rows, key=lambda row: order.index(row["case"])), provenance.made_here() | {
            "commit": ", ".join(sorted({row["commit"] for row in rows})), "command": "gallery.py",
            "note": "wall times of a machine that ran other programs too"}, None)
        print(name, flush=True)


if __name__ == "__main__":
    main()
