"""The block of the 3-D playback, and the section that says what it shows and what was left out."""
import numpy as np

from ..plot.run_data import Missing

from . import blocks
from .frames import pack


def chassis(run, times, arrays):
    """Poses of the chassis at the frames, from the vehicle's table: x, y, z in m and roll, pitch, yaw in rad."""
    table = run.table("timeseries_vehicle.csv")
    names = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad")
    if not table or any(name not in table for name in names):
        return None
    return arrays.add(np.stack([np.interp(times, table["time_s"], table[name]) for name in names], 1), exact=True)


def profile(run):
    """The profile of hard ground, [[x, z], …] in m; empty without one."""
    return (run.scenario.get("terrain") or {}).get("profile") or []


def meshes(packing, arrays):
    known, found = {}, []
    for k, (reference, triangle, quantum) in packing.mesh.items():
        key = triangle.tobytes()
        known.setdefault(key, len(known))
        found.append({"tire": k, "vertices": len(reference), "reference": arrays.add(reference, exact=True),
                      "triangles": arrays.add(triangle, exact=True), "quantum": quantum})
    return found


def bed_of(run):
    """What the points of a bed are."""
    return "nodes of the soil" if (run.scenario.get("terrain") or {}).get("engine") == "scm" else "grains"


def left_out(packing, what):
    """Sentences on what the playback does not show. @param what the bed is made of: grains, or nodes of a grid"""
    words = []
    all_, kept, bed = len(packing.frames.indices), len(packing.indices), packing.bed
    if kept < all_:
        words.append(f"{kept} of the run's {all_} frames are shown, evenly spaced, to keep the page small.")
    if bed and len(bed.shown) < bed.total:
        hidden = bed.total - bed.visible
        words.append(f"{len(bed.shown):,} of {bed.total:,} {what} are drawn: "
                     + (f"{hidden:,} are covered by others all the time" if hidden else "") + (" and " if hidden
                                                                                               and bed.visible
                                                                                               > len(bed.shown) else "")
                     + (f"{bed.visible - len(bed.shown):,} farthest from the wheels were left out to keep the page "
                        "small" if bed.visible > len(bed.shown) else "") + f". The surface is that of all {what}.")
    return words


def playback(run, arrays, budget):
    """(section, {name: base64}); raises Missing without frames."""
    packing = pack(run, budget)
    if not np.all(np.isfinite(packing.times)):
        raise Missing("the frames have no times")
    block = {"type": "playback", "times": packing.times, "tires": meshes(packing, arrays),
             "poses": arrays.add(np.array(packing.poses), exact=True) if packing.poses else None,
             "sign": run.travel_sign, "ground": float(run.number("surface_height_m", 0.0) or 0.0),
             "profile": profile(run), "chassis": chassis(run, packing.times, arrays), "bed": None}
    if bed := packing.bed:
        block["bed"] = {"grains": len(bed.shown), "radius": arrays.add(bed.radius), "speeds": packing.speeds,
                        "low": [float(v) for v in bed.low], "scale": [float(v) for v in bed.scale],
                        "cell": float(bed.cell), "nx": bed.nx, "ny": bed.ny, "largest": bed.largest}
    words = [blocks.text(" ".join(sentences), "note") for sentences in [left_out(packing, bed_of(run))] if sentences]
    blobs = {name: stream.base64() for name, stream in packing.stream.items() if packing.bed or name == "tires"}
    return {"id": "playback", "title": "Playback", "blocks": [block, *words]}, blobs
