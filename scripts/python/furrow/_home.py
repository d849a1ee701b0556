"""The folder that holds rigs/ and vehicle/data/: a checkout, or share/furrow of an installed tree."""
from __future__ import annotations

import os
import pathlib
import shutil

AROUND = pathlib.Path(__file__).resolve().parents[3]  # of a package that lies in scripts/python


def home() -> pathlib.Path:
    """What FURROW_HOME names, else the tree around this package, else that of the program on PATH."""
    program = shutil.which(os.environ.get("FURROW", "furrow"))
    beside = [pathlib.Path(program).resolve().parents[1] / "share" / "furrow"] if program else []
    named = os.environ.get("FURROW_HOME")
    places = [pathlib.Path(named)] if named else [AROUND, *beside]
    return next((place for place in places if (place / "rigs").is_dir()), places[0])
