"""What the comparisons share: the material, start positions, and how each program is run."""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "scripts" / "python"), str(ROOT / "tests" / "studies")]
import driver  # noqa: E402, F401
import provenance  # noqa: E402

RADIUS, DENSITY = 0.006, 2500.0  # m, kg/m³
GRAVITY = 9.81  # m/s²
MATERIAL = {"radius": RADIUS, "density": DENSITY, "young_modulus": 2.49e7, "poisson_ratio": 0.3, "restitution": 0.2,
            "friction": 0.9}
MASS = DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3  # kg
E_STAR = 0.5 * MATERIAL["young_modulus"] / (1.0 - MATERIAL["poisson_ratio"] ** 2)  # Pa
FREE, BASE, LID = 0, 1, 2  # kinds of grains
SWITCHES = {"rescaled on loading": 1, "plain projection": 2, "no spin about the normal": 4, "damper apart": 8,
            "limit of |F_e|": 16}
ALL_SWITCHES = sum(SWITCHES.values())


def pull_force(cohesion):
    """F_c = π r² c_t, N."""
    return math.pi * RADIUS**2 * cohesion


def program(name):
    """A program of the build, or None."""
    path = pathlib.Path(os.environ.get("FURROW_BUILD", ROOT / "build")) / name
    return path if path.exists() else None


def record_program(out):
    """Notes in OUT which program makes what lies there; results of another one are not mixed in."""
    record, build = out / "made.json", provenance.build_of(program("peer_grains"))
    if record.exists() and json.loads(record.read_text())["build"] != build:
        sys.exit(f"{out}: holds results of another build of peer_grains, expected none or this one's")
    made = {key: value for key, value in provenance.made_here(program("peer_grains")).items() if key != "command"}
    record.write_text(json.dumps({"build": build, **made}) + "\n")


def origin(out):
    """What a table says that is made of OUT."""
    record = out / "made.json"
    made = json.loads(record.read_text()) if record.exists() else {}
    return {key: made.get(key, provenance.UNKNOWN)
            for key in ("commit", "compiler", "processor")} | {"command": provenance.command()}


def liggghts():
    return shutil.which("liggghts")


def nearest(d, size, periodic):
    """Distances to nearest images along x and y."""
    for a in range(2):
        if periodic[a]:
            d[..., a] -= size[a] * numpy.round(d[..., a] / size[a])
    return d


def random_spheres(count, length, width, low, high, seed, periodic=(True, True)):
    """Centres of spheres at random without overlap [random sequential addition], m."""
    generator = numpy.random.default_rng(seed)
    size, gap = numpy.array([length, width, high - low]), 2.001 * RADIUS
    placed, n = numpy.empty((count, 3)), 0
    for _ in range(4000 * count):
        p = generator.random(3) * size
        for a in range(3):
            if a == 2 or not periodic[a]:
                p[a] = RADIUS * 1.001 + p[a] * (1.0 - 2.002 * RADIUS / size[a])
        d = nearest(placed[:n] - p, size, periodic)
        if not (numpy.einsum("ka,ka->k", d, d) < gap * gap).any():
            placed[n] = p
            n += 1
            if n == count:
                return placed + [0.0, -0.5 * width, low]
    raise RuntimeError("the spheres do not fit: make the space higher")


def write_start(file, kinds, x):
    with open(file, "w") as out:
        out.write("kind,x_m,y_m,z_m\n")
        out.writelines(f"{k},{p[0]:.17g},{p[1]:.17g},{p[2]:.17g}\n" for k, p in zip(kinds, x))


def read_series(file):
    with open(file) as lines:
        rows = list(csv.reader(lines))
    return {name: numpy.array([float(r[k]) for r in rows[1:]]) for k, name in enumerate(rows[0])}


def run_furrow(folder, job, kinds, x, switches=None, **more):
    """Runs the engine's side; returns frames (time × grain × 3) and the series. `switches`: use the switched law."""
    folder.mkdir(parents=True, exist_ok=True)
    write_start(folder / "start.csv", kinds, x)
    full = {**MATERIAL, "start": str(folder / "start.csv"), "periodic_x": True, "periodic_y": True, "cohesion": 0.0,
            "wall_friction": MATERIAL["friction"], "precision": "mixed", "half_step_start": True,
            "damper_mass": "sliding", "switches": switches or 0, **job, **more}
    (folder / "job.json").write_text(json.dumps(full))
    name = "peer_grains" if switches is None else "peer_grains_switched"
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive")
    subprocess.run([program(name), folder / "job.json", folder], check=True, env=environment)
    frames = numpy.fromfile(folder / "positions.f64").reshape(-1, len(x), 3)
    return frames, read_series(folder / "series.csv")


def run_liggghts(folder, deck, kinds, x, box, cohesion=0.0, sjkr=0.0, clear=True, **values):
    """Runs a deck of this folder with {keys} filled in. box: length, width, height, periodic_x, periodic_y.

    cohesion: c_t of the engine's constant pull, Pa, through liggghts_with_pull; sjkr: energy density of LIGGGHTS's own
    model, J/m³. clear: end springs when grains part. LIGGGHTS 3.8 by itself looks at pairs that touch only, and a pair
    that touches again before the neighbour list is made anew goes on with the spring it had.
    """
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    n_base, n_lid = kinds.count(BASE), kinds.count(LID)
    assert kinds == [BASE] * n_base + [LID] * n_lid + [FREE] * (len(kinds) - n_base - n_lid)
    length, width = box["length"], box["width"]
    room = [0.0 if box.get(f"periodic_{a}", True) else RADIUS for a in "xy"]
    with open(folder / "start.data", "w") as out:
        out.write(f"spheres\n\n{len(x)} atoms\n2 atom types\n\n{-room[0]!r} {length + room[0]!r} xlo xhi\n"
                  f"{-0.5 * width - room[1]!r} {0.5 * width + room[1]!r} ylo yhi\n"
                  f"{-RADIUS!r} {box['height']!r} zlo zhi\n\nAtoms\n\n")
        out.writelines(f"{n} 1 {2 * RADIUS!r} {DENSITY!r} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g}\n"
                       for n, p in enumerate(x, 1))
    common = {**MATERIAL, "wall_friction": MATERIAL["friction"], **values}
    side = {a: "p" if box.get(f"periodic_{a}", True) else "f" for a in "xy"}
    law = "model hertz tangential history"
    walls = "".join(f"fix wall_{a}{k} all wall/gran {law} primitive type 2 {a}plane {v!r}\n"
                    for a, ends in (("x", (0.0, length)), ("y", (-0.5 * width, 0.5 * width))) if side[a] == "f"
                    for k, v in enumerate(ends))
    head = (HERE / "deck_common.in").read_text().format(
        side_x=side["x"], side_y=side["y"], law=law, walls=walls, last_plate=max(1, n_base + n_lid),
        first_lid=n_base + 1, first_free=n_base + n_lid + 1, last=len(x),
        clear="contact_distance_factor 1.5" if clear else "",
        pull="fix pull all external pf/callback 1 1" if cohesion else "",
        pair_law=law + (" cohesion sjkr" if sjkr else ""),
        sjkr=f"fix m5 all property/global cohesionEnergyDensity peratomtypepair 2 {sjkr!r} 0 0 0" if sjkr else "",
        **common)
    text = head + (HERE / deck).read_text().format(**{"n_lid": n_lid, "law": law, **common})
    (folder / "deck.in").write_text(text)
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    # "-screen none" would do, but for meshes, which write to the screen without asking whether there is one.
    if cohesion:
        command = [program("liggghts_with_pull"), "deck.in", "log", repr(pull_force(cohesion)), repr(2 * RADIUS)]
    else:
        command = [liggghts(), "-in", "deck.in", "-log", "log", "-screen", "/dev/null"]
    subprocess.run(command, check=True, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
    return read_dump(folder / "positions.dump", len(x)), read_averages(folder)


def read_dump(file, count):
    frames = []
    if not file.exists():
        return None
    with open(file) as lines:
        while lines.readline():
            for _ in range(8):
                lines.readline()
            rows = numpy.array([lines.readline().split() for _ in range(count)], dtype=float)
            frame = numpy.empty((count, 3))
            frame[rows[:, 0].astype(int) - 1] = rows[:, 1:]
            frames.append(frame)
    return numpy.array(frames)


def read_averages(folder):
    """The file of `fix ave/time`: rows of numbers after two comment lines."""
    file = folder / "series.dat"
    return numpy.loadtxt(file, ndmin=2) if file.exists() else None


def folder_name(text):
    return re.sub(r"[^A-Za-z0-9.]+", "_", text)
