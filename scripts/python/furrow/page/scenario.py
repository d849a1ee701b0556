"""The scenario of a run beside the defaults of the schema."""
import json
import pathlib

from ..plot.run_data import read_object

from . import blocks

SCHEMA = pathlib.Path(__file__).resolve().parent / "scenario.schema.json"
MOST_ROWS = 600
LONGEST = 160  # characters of a value


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
    root = read_object(SCHEMA) if SCHEMA.is_file() else {}
    found = resolved(root, root)
    for part in key.split("."):
        found = resolved((found.get("items") or {}) if part.isdigit()
                         else (found.get("properties") or {}).get(part, {}), root)
    return str(found.get("unit", "")).replace("-", "")  # "-": of a number without one


def flat(value, schema, root, path):
    """(key, value, schema of the key) for every key of a scenario."""
    schema = resolved(schema, root)
    if isinstance(value, dict) and value and (schema.get("properties") or not path or not root):
        for key, inner in value.items():
            yield from flat(inner, (schema.get("properties") or {}).get(key, {}),
                            root, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and all(isinstance(item, dict) for item in value) and len(value) <= 64:
        for k, item in enumerate(value):
            yield from flat(item, schema.get("items", {}), root, f"{path}.{k}")
    else:
        yield path, value, schema


def shown(value):
    if isinstance(value, float) and abs(value) < 1e300:
        return f"{value:.12g}"
    words = json.dumps(value, ensure_ascii=False)
    return words if len(words) <= LONGEST else words[:LONGEST] + " …"


def is_default(value, schema):
    if "default" not in schema or value != schema["default"]:
        return False
    return isinstance(value, bool) == isinstance(schema["default"], bool)  # true is not 1


def section(scenario):
    """Every key with its unit and default; those that differ are marked."""
    root = read_object(SCHEMA) if SCHEMA.is_file() else {}
    rows, marked = [], []
    for key, value, schema in flat(scenario, root, root, ""):
        if key in ("$schema", "description", "format_version", "completed_by"):
            continue
        if len(rows) == MOST_ROWS:
            break
        if not is_default(value, schema):
            marked.append(len(rows))
        default = shown(schema["default"]) if "default" in schema else "none"
        rows.append([key, shown(value), schema.get("unit") or "", default, schema.get("description") or ""])
    words = []
    if isinstance(scenario.get("description"), str):
        words.append(blocks.text(scenario["description"]))
    words.append(blocks.table(["key", "value", "unit", "default", "meaning"], rows, marked=marked,
                              only_marked="only keys that differ from the default", note="Highlighted keys differ from "
                              "the default. Derived values, such as a start position, also differ."))
    return {"id": "scenario", "title": "Scenario", "blocks": words}
