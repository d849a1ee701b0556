"""Where the numbers of a table come from: a study's CSV file begins with comment lines that name the program, its compiler, the
processor and the command. Readers of these tables skip them: read_table().

    # commit: 1a2b3c4d
    # compiler: g++ 12.2.0
    # processor: AMD EPYC 7763 64-Core Processor
    # command: run_study.py behaviour.json
"""
import csv
import hashlib
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_RECORDED = "not recorded"
RECORD = "case.json"  # beside the summary of a run: build and commit of the program that made it


def program():
    """The program that studies run."""
    return os.environ.get("FURROW", str(ROOT / "build" / "furrow"))


def build_of(file):
    """Tells builds of the program apart: a hash of its file."""
    return hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()[:16]


def commit():
    """The commit of the sources, with -dirty where files differ from it."""
    done = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=8", "--exclude=*"], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else NOT_RECORDED


def command():
    """Of the running script."""
    return " ".join([pathlib.Path(sys.argv[0]).name, *sys.argv[1:]])


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def record_run(folder):
    """Notes in the folder of a run which program has made it, just now."""
    (folder / RECORD).write_text(json.dumps({"build": build_of(program()), "commit": commit()}) + "\n", encoding="utf-8")


def origin_of_runs(folders):
    """What the leading lines say of a table that the running script makes of these runs."""
    summaries = [read_json(folder / "summary.json") for folder in folders]

    def of_all(values):
        return ", ".join(sorted({str(value or NOT_RECORDED) for value in values})) or NOT_RECORDED

    return {"commit": of_all(read_json(folder / RECORD).get("commit") for folder in folders),
            "compiler": of_all(summary.get("compiler") for summary in summaries),
            "processor": of_all(summary.get("cpu") for summary in summaries),
            "command": command()}


def write_table(path, columns, rows, made):
    """Writes `rows`, dictionaries, below comment lines, as of origin_of_runs()."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        for key, value in made.items():
            file.write(f"# {key}: {value}\r\n")
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)


def data_lines(lines):
    return [line for line in lines if not line.startswith("#")]


def read_origin(path):
    """{key: value} of the leading comment lines."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = [line[1:].strip() for line in file if line.startswith("#")]
    return dict(line.split(": ", 1) for line in lines if ": " in line)


def read_table(path):
    """The rows of a table as dictionaries."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(data_lines(file)))
