"""Where the numbers of a table come from: a committed CSV file begins with comment lines that name the program, its
compiler, the processor and the command that makes the table anew. Readers of these tables skip them: read_table().

    # commit: 1a2b3c4d
    # compiler: g++ 12.2.0
    # processor: AMD EPYC 7763 64-Core Processor
    # command: run_study.py budget.json
    # made before: ffb94a1, what sleeps follows the load        (only where the program of today would give other bits)
    # note: what else has to be known

A committed JSON file of results has an object `made` with the same keys. scripts/check_docs.py checks both.
"""
import csv
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KEYS = ("commit", "compiler", "processor", "command")
UNKNOWN = "unknown (before provenance was written)"
RECORD = "case.json"  # beside the summary of a run: build and commit of the program that made it


def program():
    """The program that studies run."""
    return os.path.abspath(os.environ.get("FURROW", ROOT / "build" / "furrow"))


def build_of(file):
    """Tells builds of the program apart: a hash of its file."""
    return hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()[:16]


TABLES = ("tests/studies/*.csv", "tests/studies/*.png", "tests/benchmarks/*.csv")  # what the scripts write


def commit(folder=ROOT):
    """The commit of the sources, with -dirty where files other than the tables of the scripts differ from it."""
    if not shutil.which("git"):
        sys.exit("git is not installed, expected it: a table names the commit of its program")

    def git(*words):
        return subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True)
    named = git("describe", "--always", "--abbrev=8", "--exclude=*")
    differs = git("diff", "--quiet", "HEAD", "--", ":/", *(f":(top,exclude){tables}" for tables in TABLES))
    if named.returncode != 0 or differs.returncode > 1:
        sys.exit(f"{folder}: is no checkout of git, expected one: a table names the commit of its program")
    return named.stdout.strip() + ("-dirty" if differs.returncode else "")


def compiler_of(file):
    """The compiler of a program, from the cache of the CMake build folder that it lies in."""
    for folder in pathlib.Path(file).resolve().parents:
        cache = folder / "CMakeCache.txt"
        if cache.exists():
            found = next(line.split("=", 1)[1] for line in cache.read_text().splitlines()
                         if line.startswith("CMAKE_CXX_COMPILER:"))
            version = subprocess.run([found, "-dumpfullversion", "-dumpversion"],
                                     capture_output=True, text=True, check=True)
            return f"{pathlib.Path(found).name} {version.stdout.strip()}".replace("c++ ", "g++ ")
    sys.exit(f"{file}: lies in no build folder of CMake, expected one: a table names the compiler of its program")


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    return next((line.split(": ", 1)[1] for line in lines if line.startswith("model name")), "unknown")


def command():
    """Of the running script."""
    return " ".join([pathlib.Path(sys.argv[0]).name, *sys.argv[1:]])


def made_here(of=None):
    """What the leading lines say of a table that the running script makes now with one program."""
    of = of or program()
    return {"commit": commit(), "compiler": compiler_of(of), "processor": processor(), "command": command()}


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def record_run(folder, made_at=None, **more):
    """Notes in the folder of a run which program has made it, just now. `made_at`: the commit, of the present files if
    None; a script that writes its table between runs names the one at its start, for its table makes files differ."""
    record = {"build": build_of(program()), "commit": made_at or commit(), **more}
    if "compiler" not in read_json(folder / "summary.json"):  # of `furrow press`
        record |= {"compiler": compiler_of(program()), "cpu": processor()}
    (folder / RECORD).write_text(json.dumps(record) + "\n", encoding="utf-8")


def origin_of_runs(folders):
    """What the leading lines say of a table that the running script makes of these runs. Runs of different programs are
    refused: they belong in tables of their own."""
    folders = list(folders)
    records = [read_json(folder / RECORD) for folder in folders]
    summaries = [{**record, **read_json(folder / "summary.json")} for folder, record in zip(folders, records)]

    def one(what, values):
        groups = {}
        for folder, value in zip(folders, values):
            groups.setdefault(value, []).append(folder.name)
        if None in groups:
            sys.exit(f"{groups[None][0]}: names no {what}, expected the {RECORD} and summary.json of a run by the "
                     f"scripts here")
        if len(groups) > 1:
            told = "; ".join(f"{value}: {', '.join(names)}" for value, names in groups.items())
            sys.exit(f"a table holds runs of one {what}, these are of {len(groups)}: {told}")
        return next(iter(groups))

    one("build of the program", [record.get("build") for record in records])
    # one build, whatever else was committed
    return {"commit": ", ".join(sorted({record["commit"] for record in records})),
            "compiler": one("compiler", [summary.get("compiler") for summary in summaries]),
            "processor": one("processor", [summary.get("cpu") for summary in summaries]),
            "command": command()}


def write_header(file, made):
    """`file` is open as text that leaves line ends alone."""
    for key, value in made.items():
        file.write(f"# {key}: {value}\n")


def write_table(path, columns, rows, made):
    """Writes `rows`, dictionaries, below comment lines, as of origin_of_runs() or made_here()."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        write_header(file, made)
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_origin(path):
    """{key: value} of the leading comment lines."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = [line[1:].strip() for line in file if line.startswith("#")]
    return dict(line.split(": ", 1) for line in lines if ": " in line)


def read_table(path):
    """The rows of a table as dictionaries."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
