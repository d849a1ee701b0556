#!/usr/bin/python3
"""Length of the contact patch of the tires of a study's runs on rigid ground, from their frames: where the middle of
the tread crosses the plane z = 0. Adds the column contact_length_m to the study's CSV file."""
import argparse
import json
import pathlib

import h5py
import numpy as np

import provenance

ROOT = pathlib.Path(__file__).resolve().parents[2]


def crossings(x, z):
    """Least and largest x at which the closed line (x, z) crosses z = 0; None above the ground."""
    found = []
    for i in range(len(x)):
        k = (i + 1) % len(x)
        if (z[i] < 0) != (z[k] < 0):
            found.append(x[i] + (x[k] - x[i]) * z[i] / (z[i] - z[k]))
    return (min(found), max(found)) if found else None


def contact_length(run, rows):
    """Mean over the frames of the averaging window, m; `rows` vertices across the tire."""
    begin = json.loads((run / "summary.json").read_text())["drawbar_pull_N"]["from_s"]
    lengths = []
    for name in sorted((run / "frames").glob("tire0_*.h5")):
        with h5py.File(name) as frame:
            if frame.attrs["time_s"] < begin:
                continue
            position = frame["position"][: len(frame["position"]) // rows * rows]
        middle = position.reshape(-1, rows, 3)[:, rows // 2]
        ends = crossings(middle[:, 0], middle[:, 2])
        if ends:
            lengths.append(ends[1] - ends[0])
    return float(np.mean(lengths)) if lengths else float("nan")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=pathlib.Path)
    arguments = parser.parse_args()
    study = json.loads(arguments.study.read_text())
    rows_across = study["set"]["tire.elements_width"] + 1
    table = arguments.study.with_suffix(".csv")
    rows, made = provenance.read_table(table), provenance.read_origin(table)
    for row in rows:
        run = ROOT / "results" / "studies" / arguments.study.stem / row["case"]
        row["contact_length_m"] = contact_length(run, rows_across)
    made["command"] += f"; {provenance.command()}"
    provenance.write_table(table, list(rows[0]), rows, made)


if __name__ == "__main__":
    main()
