"""What the fuzzing targets begin with: the shipped files, and small documents of the kinds that each of them reads."""
import json
import random

SMALL = {
    "rig": {"slip": 0.3, "ramp": 0.01}, "tire": {"file": "hmmwv_layered.json", "rigid": True},
    "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 2, "length": 1.4, "width": 0.4},
    "run": {"step": 1e-4, "end": 0.02, "average_from": 0},
}
GROUND = {"tire": {"file": "toroidal.json"}, "terrain": {"engine": "rigid"}, "run": {"end": 0.1}}
ROAD = ("$ROAD_CRG\nREFERENCE_LINE_START_U = 2.0\nREFERENCE_LINE_END_U = 4.0 ! m\nREFERENCE_LINE_INCREMENT = "
        "1\nLONG_SECTION_V_RIGHT = -0.5\n"
        "LONG_SECTION_V_INCREMENT = 0.5\n$!***\n$KD_DEFINITION\n")
CUTS = "".join(f"D:long section {k},m\n" for k in (1, 2, 3)) + "D:reference line slope,m/m\n$\n$$$$\n"
ROWS = {"LRFI": 3 * " 0.0000000 0.0100000 0.0200000 0.0300000\n", "LDFI": 3 * (4 * "                0.01" + "\n"),
        "KRBI": 48 * "\0", "KDBI": 96 * "\0"}


def documents(root, *patterns):
    return [json.loads(path.read_text()) for pattern in patterns for path in sorted(root.glob(pattern))]


def public_layout(tire):
    """A tire of our own layout in the public one (template ANCFTire), whose keys tire/README.md lists."""
    names = list(tire["materials"])
    contact = tire["contact"]

    def material(given):
        names_here = {"E": "young_modulus", "nu": "poisson_ratio", "G": "shear_modulus"}
        values = {theirs: given[ours] for theirs, ours in names_here.items() if ours in given}
        if any(isinstance(value, list) for value in values.values()):
            return {"Type": "Orthotropic", "Density": given["density"],
                    **{key: value if isinstance(value, list) else [value] * 3 for key, value in values.items()}}
        return {"Type": "Isotropic", "Density": given["density"], **values}

    def section(given):
        layers = given["layers"]
        return {"Number Elements": given["elements_per_side"],
                "Layer Thickness": [layer["thickness"] for layer in layers],
                "Ply Angle": [layer["angle_deg"] for layer in layers],
                "Material ID": [names.index(layer["material"]) for layer in layers]}
    return {"Name": tire["name"], "Type": "Tire", "Template": "ANCFTire",
            "Tire Radius": tire["radius"], "Rim Radius": tire["rim_radius"],
            "Rim Width": tire["rim_width"], "8-Node Elements": False, "rim": tire["rim"],
            "Contact Material": {"Coefficient of Friction": contact["friction"],
                                 "Coefficient of Restitution": contact["restitution"],
                                 "Properties": {"Young Modulus": contact["young_modulus"],
                                                "Poisson Ratio": contact["poisson_ratio"]},
                                 "Coefficients": {"Normal Stiffness": contact["normal_stiffness"],
                                                  "Normal Damping": contact["normal_damping"],
                                                  "Tangential Stiffness": 1e6, "Tangential Damping": 0}},
            "Materials": [material(tire["materials"][name]) for name in names],
            "Structural Damping Coefficient": tire["structural_damping"], "Default Pressure": tire["pressure"],
            **{f"{name.title()} Section": section(tire["sections"][name]) for name in ("bead", "sidewall", "tread")},
            "Number Elements Circumference": tire["elements_circumference"], "Profile": tire["profile"]}


def tires(root):
    files = documents(root, "tire/data/*.json")
    files = [file for file in files if "template" in file or "Template" in file or "model" in file]
    files += [public_layout(file) for file in files if file.get("template") == "ancf_shell"]
    files += [{**files[-1], "8-Node Elements": True},
              {"Name": "wheel", "Type": "Tire", "Template": "RigidTire", "Radius": 0.4, "Width": 0.2, "Mass": 30,
               "Inertia": [3, 5, 3], "Contact Material": files[-1]["Contact Material"]},
              {**{key: value for key, value in files[-1].items() if key != "8-Node Elements"},
               "Template": "ReissnerTire", "Materials": 3 * [
                  {"Type": "Orthotropic", "Density": 1000, "Ex": 4e8, "Ey": 1e8, "nu": 0.4, "Gxy": 3e7, "Gxz": 2e7,
                   "Gyz": 1e7}]}]
    return files + [{"file": files[0], "pressure": [[0, 2e5], [0.5, 1e5]], "rigid": True},
                    {"file": files[-1], "pressure": 1.5e5, "around": 24, "across": 6}]


def vehicles(root):
    drivers = [document["rig"]["driver"] for document in documents(root, "rigs/hmmwv_*.json", "rigs/rover_small.json")
               if isinstance(document.get("rig", {}).get("driver"), dict)]
    tables = ["time_s,throttle,brake,steering,gear\n0,0,1,0,1\n1,0.5,0,-0.2,2\n",
              "x_m,y_m\n0,0\n5,0\n10,1\n", "time_s,speed_m_s\n0,1\n2,3\n"]
    drivers += [{"speed": {"target": "points.csv"}}, {"inputs": "points.csv"},
                {"speed": {"target": 2.0}, "path": {"kind": "waypoints", "points": "points.csv"}}]
    return [{"vehicle": vehicle, "driver": {"format_version": 1, **drivers[k % len(drivers)]},
             "csv": tables[k % len(tables)]}
            for k, vehicle in enumerate(3 * documents(root, "vehicle/data/[bhr]*.json"))]


def texts(target, root):
    """JSON documents, or texts, or nothing where a target makes its files of random bytes."""
    if target == "bed":
        return ["x_m,y_m,z_m\n0.1,0,0.1\n0.2,0,0.1\n", "\ufeffx_m,y_m,z_m,radius_m\r\n0.1, -1e-3,0.1,0.03\r\n\r\n"]
    if target == "road":
        return ["cx_m,z_m\n-1,0\n6,0\n6,0.2\n", "cx_m,y_m,z_m\n0,0,0\n0,1,0\n1,0,0.1\n1,1,0\n",
                "ancols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2 3 4\n",
                *(f"k{ROAD}#:{form}\n{CUTS}{rows}" for form, rows in ROWS.items()),
                f"k{ROAD}#:LRFI\n{CUTS.replace('slope,m/m', 'phi,rad')}{ROWS['LRFI']}".replace(
                    "$KD", "$ROAD_CRG_MODS\nREFPOINT_U_FRACTION = 0.5\nREFPOINT_Z = 1\n$\n$KD")]
    if target == "handling":
        return [(root / "tire" / "data" / name).read_text() for name in ("handling_start.tir", "sweep_lumped.csv")]
    found = {
        "scenario": lambda: [d for d in documents(root, "rigs/*.json") if "properties" not in d and "scenario" not in d]
        + [SMALL, GROUND],
        "tire": lambda: tires(root),
        "study": lambda: [d for d in documents(root, "rigs/*.json") if "scenario" in d],
        "soil": lambda: documents(root, "terrain/data/*.json"),
        "vehicle": lambda: vehicles(root),
    }
    return [json.dumps(document) for document in found[target]()] if target in found else []


def make(target, root, folder):
    """Fills an empty corpus."""
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        return
    for k, text in enumerate(texts(target, root)):
        (folder / f"seed{k}").write_text(text, encoding="utf-8")
    if not any(folder.iterdir()):
        for k in range(20):
            (folder / f"seed{k}").write_bytes(random.Random(k).randbytes(100 * (k % 5 + 1)))
