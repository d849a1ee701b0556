"""The scenario of a run beside the defaults of the schema."""
import json

from ..plot.keys import resolved, schema_of_scenarios

from . import blocks

MOST_ROWS = 600
LONGEST = 160  # characters of a value


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
    root = schema_of_scenarios()
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
