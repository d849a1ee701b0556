"""Keys of scenarios and of results, as people are shown them."""
import functools
import pathlib

from .run_data import read_object
from .units import naming

SCHEMA = pathlib.Path(__file__).resolve().parents[1] / "scenario.schema.json"
# What the parts of a result with an error are.
PARTS = {".mean": "", ".sem": " standard error", ".steady": " steady", ".n_eff": " independent values"}


@functools.cache
def schema_of_scenarios():
    return read_object(SCHEMA) if SCHEMA.is_file() else {}


def resolved(schema, root):
    """The schema that a `$ref` stands for."""
    for _ in range(8):
        name = schema.get("$ref", "") if isinstance(schema, dict) else ""
        if not name.startswith("#/definitions/"):
            break
        schema = (root.get("definitions") or {}).get(name.rsplit("/", 1)[1], {})
    return schema if isinstance(schema, dict) else {}


def unit_of(key):
    """The unit of a key such as `terrain.cohesion`; empty without one."""
    root = schema_of_scenarios()
    found = resolved(root, root)
    for part in key.split("."):
        found = resolved((found.get("items") or {}) if part.isdigit()
                         else (found.get("properties") or {}).get(part, {}), root)
    return str(found.get("unit", "")).replace("-", "")  # "-": of a number without one


def named(key, keys=()):
    """(words, unit, factor) of a column of a study: of a key of the scenario, one of `keys`, such as `rig.slip`, or of
    a result such as `drawbar_pull_N.mean`."""
    if key in keys:
        return key, unit_of(key), 1.0
    part = next((part for part in PARTS if key.endswith(part)), "")
    words, unit, factor = naming(key.removesuffix(part))
    if part in (".steady", ".n_eff"):
        unit, factor = "", 1.0
    if words.endswith(" sem"):
        words = words.removesuffix("sem") + "standard error"
    return words + PARTS.get(part, ""), unit, factor
