#!/usr/bin/env python3
"""Writes the reference pages: usage: scripts/docs/reference.py FOLDER --program FURROW [--root ROOT]

Scenario keys, tire and vehicle files come from the schemas, result columns from the lists of fields in the sources,
commands and exit codes from the program's help and SURVIVES.md.
"""
import argparse
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import help_text
from stage import write_if_changed

TABLES = (  # header with the list of columns, struct, heading
    ("nodes/output/wheel_row.hpp", "WheelRow", "Every wheel",
     "`timeseries.csv`, or `timeseries_wheel<k>.csv` of several wheels"),
    ("rigs/drawbar_rig.cpp", "DrawbarRow", "A wheel of the drawbar rig, besides", "the same tables"),
    ("rigs/ride_row.hpp", "RideRow", "A wheel of a quarter car or a half car, besides", "the same tables"),
    ("rigs/half_car_rig.hpp", "HalfCarBodyRow", "The body of a half car", "`timeseries_body.csv`"),
    ("rigs/vehicle/vehicle_rows.hpp", "VehicleWheelRow", "A wheel of a vehicle, besides", "the same tables"),
    ("rigs/vehicle/vehicle_rows.hpp", "VehicleRow", "A vehicle", "`timeseries_vehicle.csv`"),
)
KINDS = {
    "instant": "value at the line's time",
    "mean": "mean since the line before",
    "cumulative": "sum since the start",
    "largest": "largest since the start",
    "derived": "computed from the line",
}


def cell(text):
    """Text for a cell of a table: no character of Markdown counts."""
    return re.sub(r"([|*_<>\[\]$\\])", r"\\\1", str(text)).replace("\n", " ")


def code(text):
    return f"`{text}`".replace("|", r"\|") if text not in ("", None) else ""


def table(head, rows):
    lines = [" | ".join(head), " | ".join("---" for _ in head), *(" | ".join(row) for row in rows)]
    return "\n".join(f"| {line} |" for line in lines) + "\n"


def shown(value):
    return json.dumps(value, ensure_ascii=False)


def number(value):
    return f"{value:g}" if isinstance(value, (int, float)) else shown(value)


def bounds(entry):
    """What a schema allows, in words."""
    if "enum" in entry:
        return ", ".join(code(shown(value)) for value in entry["enum"])
    if "const" in entry:
        return code(shown(entry["const"]))
    types = entry.get("type", [])
    words = " or ".join([types] if isinstance(types, str) else types)
    low = entry.get("minimum", entry.get("exclusiveMinimum"))
    high = entry.get("maximum", entry.get("exclusiveMaximum"))
    parts = []
    if low is not None:
        parts.append(("above " if "exclusiveMinimum" in entry else "from ") + number(low))
    if high is not None:
        parts.append(("below " if "exclusiveMaximum" in entry else "to ") + number(high))
    if "minItems" in entry or "maxItems" in entry:
        few, many = entry.get("minItems", 0), entry.get("maxItems")
        parts.append(f"{few} entries" if few == many else f"{few} to {many} entries"
                     if many else f"{few} or more entries")
    return cell(", ".join(filter(None, [words, " ".join(parts)])))


class Schema:
    def __init__(self, path):
        self.content = json.loads(path.read_text())

    def resolved(self, entry):
        if "$ref" not in entry:
            return entry
        return {**self.content["definitions"][entry["$ref"].rsplit("/", 1)[1]],
                **{k: v for k, v in entry.items() if k != "$ref"}}

    def rows(self, entry, path=""):
        """(path, entry) of every key below, dotted; entries of a list as [k]."""
        for name, child in self.resolved(entry).get("properties", {}).items():
            child = self.resolved(child)
            here = f"{path}.{name}" if path else name
            yield here, child
            yield from self.rows(child, here)
            if isinstance(child.get("items"), dict):
                yield from self.rows(self.resolved(child["items"]), f"{here}[k]")


def section_pages(schema):
    """The page of scenario keys: one table for every section."""
    text = ("# Scenario keys\n\nEvery key of a scenario, made from its schema. SI units, angles in radians. `furrow "
            "explain KEY` prints the same. [Writing a scenario](../scenarios.md) explains how the "
            "sections fit together.\n")
    plain = []
    for name, entry in schema.content["properties"].items():
        entry = schema.resolved(entry)
        rows = list(schema.rows(entry, name))
        if entry.get("type") == "array":
            text += f"\n## {name}\n\n{sentence(entry)} Each entry takes the keys of `{name.rstrip('s')}`.\n"
        elif rows:
            text += f"\n## {name}\n\n{sentence(entry)}\n\n" + key_table(rows)
        else:
            plain.append((name, entry))
    return text + "\n## Other keys\n\n" + key_table(plain)


def sentence(entry):
    text = entry.get("description", "")
    return cell(text[:1].upper() + text[1:].rstrip(".") + ".") if text else ""


def key_table(rows):
    def row(path, entry):
        usual = f" Usual: {number(entry['usual'][0])} to {number(entry['usual'][1])}." if "usual" in entry else ""
        return [code(path), code(shown(entry["default"])) if "default" in entry else "", cell(entry.get("unit", "")),
                bounds(entry), sentence(entry) + usual]
    return table(["key", "default", "unit", "allowed", "meaning"], [row(*item) for item in rows])


def file_page(title, lead, schema):
    """The page of a kind of file: one table for every definition."""
    text = f"# {title}\n\n{lead}\n"
    tops = [("The file", schema.content)] if "properties" in schema.content else []
    for name, entry in tops + list(schema.content.get("definitions", {}).items()):
        entry = schema.resolved(entry)
        if not entry.get("properties"):
            continue
        required = set(entry.get("required", []))
        rows = []
        for key, child in entry["properties"].items():
            refs = [part["$ref"] for part in [child, child.get("items", {})]
                    + child.get("oneOf", []) + child.get("anyOf", [])
                    if isinstance(part, dict) and "$ref" in part]
            refers = "".join(f" [{ref.rsplit('/', 1)[1]}](#{ref.rsplit('/', 1)[1]})" for ref in refs
                             if schema.content["definitions"][ref.rsplit("/", 1)[1]].get("properties"))
            child = schema.resolved(child)
            rows.append([code(key), "yes" if key in required else "",
                         code(shown(child["default"])) if "default" in child else "", cell(child.get("unit", "")),
                         bounds(child) + refers, sentence(child)])
        text += f"\n## {name}\n\n{sentence(entry)}\n\n" + table(
            ["key", "required", "default", "unit", "allowed", "meaning"], rows)
    return text


def columns(source, struct):
    """[(column, unit, kind, meaning)] of a list of fields in a source."""
    body = re.search(rf"struct {struct} \{{(.*?)\n\}};", source, re.DOTALL)[1]
    meaning, before = {}, ""
    for line in body.splitlines():
        field = re.match(r"\s*(?:double|Vec3) (.*?);\s*(?:// (.*))?$", line)
        if not field:
            comment = re.match(r"\s*// (.*)", line)
            before = comment[1] if comment else ""
            continue
        for name in re.findall(r"(\w+) =", field[1]):
            meaning[name] = field[2] or before
        before = ""
    listed = re.search(rf"FieldsOf<{struct}> auto& r, auto&& visit\) \{{(.*?)\n\}}", source, re.DOTALL)[1]
    found = re.findall(r"visit\(r\.(\w+)(?:\.\w\(\))?,\s*(?:column::)?(\w+)\(\"(\w+)\"(?:, \"([^\"]*)\")?\)", listed)
    if len(found) != len(re.findall(r"visit\(", listed)):
        raise ValueError(f"{struct}: {len(found)} columns were understood of those that its list has")
    return [(name, unit or "-", KINDS[kind], meaning.get(member, "")) for member, kind, name, unit in found]


def without_unit(text, unit):
    """The comment of a member ends in its unit, which has a column of its own."""
    for ending in (f", {unit}", f" {unit}", unit):
        if unit and text.endswith(ending):
            return text[:-len(ending)].rstrip(" ,")
    return text


def columns_page(root):
    text = ("# Result columns\n\nThe columns of the time series, made from the lists of fields in the sources. "
            "`results.h5` holds the same tables. [Signs](../results.md#signs) defines axes and signs; `columns` of "
            "`summary.json` has the mean of every column over the averaging window, or the last value of a sum.\n")
    for path, struct, heading, where in TABLES:
        rows = [[code(name), cell(unit), kind, cell(without_unit(meaning, unit))]
                for name, unit, kind, meaning in columns((root / path).read_text(), struct)]
        text += f"\n## {heading}\n\nIn {where}.\n\n" + table(["column", "unit", "a line holds", "meaning"], rows)
    return text


def option_rows(entries):
    for item in entries:
        names = ", ".join(code(name) for name in item.names)
        value = item.kind + (" (repeatable)" if item.repeated else "")
        yield [names, value, code(item.default), cell(item.text)
               + (f" {cell(item.relations)}." if item.relations else "")]


def command_text(command, level):
    text = f"\n{'#' * level} furrow {command.name}\n\n{cell(command.purpose)}\n\n"
    text += f"```\n{command.usage}\n```\n\n"
    head = ["argument or option", "value", "default", "meaning"]
    rows = list(option_rows(command.arguments + [option for option in command.options if "--help" not in option.names]))
    text += table(head, rows) if rows else ""
    text += "\n" + table(["example", "what it does"],
                         [[code(line), cell(what)] for line, what in command.examples]) if command.examples else ""
    return text + "".join(command_text(below, level + 1) for below in command.commands)


def commands_page(program):
    text = f"# Commands\n\n{program.purpose} Every command has `--help`; this page is made from it.\n\n"
    text += "Examples:\n\n" + table(["command", "what it does"],
                                    [[code(line), cell(what)] for line, what in program.examples])
    for heading, group in program.groups.items():
        text += f"\n## {heading}\n" + "".join(command_text(command, 3) for command in group)
    return text


def exit_codes_page(program, survives):
    rows = [[f"{number}", cell(meaning)] for number, meaning in program.exit_codes.items()]
    full = re.search(r"\n## Exit codes\n(.*?)\n## ", survives, re.DOTALL)[1]
    listed = {int(number) for number in re.findall(r"^\| (\d+) \|", full, re.MULTILINE)}
    if listed != set(program.exit_codes):
        raise ValueError(f"exit codes: --help has {sorted(program.exit_codes)}, nodes/SURVIVES.md {sorted(listed)}")
    return ("# Exit codes\n\nEvery command ends with one of these.\n\n" + table(["code", "meaning"], rows) +
            "\n[What survives what](../nodes/SURVIVES.md#exit-codes) says what each leaves behind and what to do "
            "next.\n")


def index_page():
    return """# Reference

These pages are made from the schemas, the lists of fields and the help of the program that this manual belongs to.

```{toctree}
:maxdepth: 1

commands
exit_codes
scenario_keys
columns
tire_files
vehicle_files
```

See also [the files of a run, accounts and errors](../results.md) and [study files](../nodes/study/README.md).
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", required=True)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    root = options.root
    program = help_text.ask(options.program)
    pages = {
        "index": index_page(),
        "commands": commands_page(program),
        "exit_codes": exit_codes_page(program, (root / "nodes/SURVIVES.md").read_text()),
        "scenario_keys": section_pages(Schema(root / "rigs/scenario.schema.json")),
        "columns": columns_page(root),
        "tire_files": file_page("Tire files",
                                "Every key of a tire file, made from its schema. One section for each model. "
                                "[A new tire from a drawing](../tire/HOWTO.md) shows where the numbers come from.",
                                Schema(root / "tire/data/tire.schema.json")),
        "vehicle_files": file_page("Vehicle files", "Every key of a vehicle file, made from its schema. "
                                   "[Vehicles](../vehicle_models.md#vehicle-files) explains how the parts fit "
                                   "together.",
                                   Schema(root / "vehicle/data/vehicle.schema.json")),
    }
    for name, text in pages.items():
        write_if_changed(options.folder / f"{name}.md", text)


if __name__ == "__main__":
    main()
