"""What every target has done so far: a table of processor time, executions, coverage and findings, a row for each
target and commit. Several processes may add to it at a time."""
import csv
import fcntl
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "studies"))
import provenance  # noqa: E402

TABLE = ROOT / "tests" / "fuzz" / "hours.csv"
COLUMNS = ("target", "commit", "processor_s", "executions", "edges", "features", "findings", "corpus_inputs")
SUMMED = ("processor_s", "executions", "findings")
OWED = 3600  # s of the processor, of each target
NOTE = ("edges, features: the most that libFuzzer counted, those of the inputs that it began with included; "
        "corpus_inputs: the most "
        "that were kept; findings: inputs that ended in a crash, in silence, in too much time or memory")


def build(program, table):
    """Builds `program` of the present sources. @returns their commit; the committed table names none that is not what
    ran."""
    done = subprocess.run(["ninja", "-C", str(program.parent), program.name], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{program}: could not be built, expected cmake --preset fuzz before:\n{done.stdout[-2000:]}")
    pages = [f":!{TABLE.relative_to(ROOT)}", ":!*.md"]
    changed = subprocess.run(["git", "status", "--porcelain", "--untracked-files=no", "--", ".", *pages],
                             cwd=ROOT, capture_output=True,
                             text=True, check=True).stdout.splitlines()
    name = subprocess.run(["git", "describe", "--always", "--abbrev=8", "--exclude=*"],
                          cwd=ROOT, capture_output=True, text=True,
                          check=True).stdout.strip()
    if changed and table == TABLE:
        sys.exit(f"{changed[0][3:]} differs from its commit, expected none that does: {TABLE.relative_to(ROOT)} names "
                 f"the commit that ran "
                 "(--hours FILE writes another table)")
    return f"{name}-dirty" if changed else name


def number(text):
    value = float(text)
    return int(value) if value.is_integer() else value


def rows_of(table):
    if not table.exists():
        return []
    return [{key: value if key in ("target", "commit") else number(value) for key, value in row.items()}
            for row in provenance.read_table(table)]


def merge(row, more):
    for key in COLUMNS[2:]:
        row[key] = round(row[key] + more[key], 1) if key in SUMMED else max(row[key], more[key])


def add(table, program, more):
    """Adds a row, or to the row of that target and commit."""
    folder = os.open(table.parent, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        rows = rows_of(table)
        same = [row for row in rows if (row["target"], row["commit"]) == (more["target"], more["commit"])]
        if same:
            merge(same[0], more)
        else:
            rows.append(dict(more))
        origin = {"commit": "of each row", "compiler": provenance.compiler_of(program),
                  "processor": provenance.processor(),
                  "command": "run_targets.py --out DIR --seconds S", "note": NOTE}
        new = table.with_name(f".{table.name}.new")
        provenance.write_table(new, COLUMNS, sorted(rows, key=lambda row: row["target"]), origin)
        new.replace(table)
    finally:
        os.close(folder)


def totals(table):
    """{target: row}: all commits together."""
    found = {}
    for row in rows_of(table):
        if row["target"] in found:
            merge(found[row["target"]], row)
        else:
            found[row["target"]] = dict(row)
    return found


def told(table, targets):
    """The totals as a table in Markdown."""
    have = totals(table)
    lines = ["| target | processor time (s) | of the hour | executions | edges | features | findings | corpus |",
             "|---|--:|--:|--:|--:|--:|--:|--:|"]
    for target in targets:
        row = have.get(target, dict.fromkeys(COLUMNS[2:], 0))
        lines.append(f"| `{target}` | {row['processor_s']:.0f} | {100 * row['processor_s'] / OWED:.0f} % | "
                     f"{row['executions']:,} | {row['edges']:,} "
                     f"| {row['features']:,} | {row['findings']} | {row['corpus_inputs']:,} |")
    return "\n".join(lines)
