"""The steps that studies share: start the program, use finished results again, read them, write a table, draw a chart.

A typical study asks kept() for the folder of every run, reads it with summary() and series(), and gives its rows to
write(), which puts the lines of provenance.py above them. FURROW names another program than build/furrow.
"""
import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
import time

import provenance
from provenance import HERE, RECORD, ROOT, read_json

sys.path.insert(0, str(ROOT / "scripts" / "python"))
RESULTS = ROOT / "results" / "studies"


def options(doc, **more):
    """A parser that prints the head of a script as it stands. @param more its options: type and the like, by name"""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, settings in more.items():
        parser.add_argument("--" + name.replace("_", "-"), **settings)
    return parser


# ---- run ------------------------------------------------------------------------------------------------------------

def settings(*groups):
    """--set flags for the given {key: value} groups; later groups win."""
    merged = {key: value for group in groups for key, value in group.items()}
    return [flag for key, value in merged.items() for flag in ("--set", f"{key}={json.dumps(value)}")]


def furrow(*words, program=None, before=(), progress=False, **environment):
    """What the program prints. Where it fails, the script ends with its last words.
    @param before words of a command that starts it
    @param progress whether what it prints on its way is shown"""
    command = [*map(str, before), str(program or provenance.program()), *map(str, words)]
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True,
                          stderr=None if progress else subprocess.PIPE,
                          env={**os.environ, "FURROW_HOME": str(ROOT), **environment})
    if done.returncode != 0:
        sys.exit(f"{' '.join(command[:3])} ended with {done.returncode}: {(done.stderr or '')[-2000:]}")
    return done.stdout


def timed(*words, **more):
    """(what furrow() returns, processor time of all its processes in s, wall time in s)"""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    told = furrow(*words, **more)
    after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - begin
    return told, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def digest_of(words):
    """Of the scenario of these words as this program reads it; None where the program refuses it."""
    done = subprocess.run([provenance.program(), "validate", *words, "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)["scenario_digest"] if done.returncode == 0 else None


def stale_because(words, out):
    """Why the results of a run in `out` are not those that this program would get now; None if they are."""
    found, record = summary(out), read_json(out / RECORD)
    if not found:
        return "it has no summary"
    if record.get("build") != provenance.build_of(provenance.program()):
        return "another build of the program made it"
    return None if found.get("scenario_digest") == digest_of(words) else "its scenario has changed"


def begun(words, out):
    """Whether `out` holds the beginning of this run, up to a checkpoint, and the program has not been built since."""
    checkpoints = sorted((out / "checkpoints").glob("*/manifest.json"))
    return (bool(checkpoints) and not summary(out) and
            os.path.getmtime(checkpoints[-1]) > os.path.getmtime(provenance.program()) and
            read_json(checkpoints[-1]).get("scenario_digest") == digest_of(words))


def run_case(name, words, out, made_at=None):
    """Runs or continues the scenario that the words name. Returns whether the run was done."""
    (out / RECORD).unlink(missing_ok=True)
    begin = time.time()
    command = ["resume", str(out)] if begun(words, out) else ["run", *words, "--out", str(out), "--overwrite"]
    done = subprocess.run([provenance.program(), *command, "--no-plots"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True)
    print(f"{name}: exit {done.returncode}, {time.time() - begin:.0f} s", file=sys.stderr, flush=True)
    if done.returncode != 0:
        print(done.stderr[-2000:], file=sys.stderr)
        return False
    provenance.record_run(out, made_at)
    return True


def done_run(words, out, finished_only=False):
    """`out`, run unless this program has made it of this scenario. None where the run failed or `finished_only` forbids
    it."""
    stale = stale_because(words, out)
    return None if stale and (finished_only or not run_case(out.name, words, out)) else out


def finished_case(name, words, out):
    """`out`, run unless this program has made it of this scenario."""
    if stale_because(words, out) and not run_case(name, words, out):
        sys.exit(f"{name}: failed")
    return out


def content_of(word):
    """Of the file that a word names: where it is a scenario its digest, which covers what it refers to. None where the
    word names no file."""
    file = ROOT / word
    if not os.path.isfile(file):  # of a setting too long for a name as well
        return None
    return file.suffix == ".json" and digest_of([file]) or hashlib.sha256(file.read_bytes()).hexdigest()


def kept(out, command, *words, scenario=None, finished_only=False, made_at=None):
    """`out`, which holds what `furrow COMMAND WORDS` makes. It is made unless this build of the program made it of the
    same words and of files with the same content. None where `finished_only` forbids that.
    @param scenario a dictionary, which becomes the file OUT.json and the first word"""
    words = [str(word) for word in words]
    contents = [content_of(word) for word in words]
    made_of = hashlib.sha256(json.dumps([command, words, contents, scenario]).encode()).hexdigest()[:16]
    record = read_json(out / RECORD)
    if (record.get("build"), record.get("made_of")) == (provenance.build_of(provenance.program()), made_of):
        return out
    if finished_only:
        return None
    out.parent.mkdir(parents=True, exist_ok=True)
    if scenario:
        file = out.parent / f"{out.name}.json"
        file.write_text(json.dumps(scenario), encoding="utf-8")
        words.insert(0, str(file))
    (out / RECORD).unlink(missing_ok=True)
    furrow(command, *words, "--out", out, "--quiet", *(["--overwrite"] if command != "sweep" else []),
           *(["--no-plots"] if command in ("run", "sweep") else []))
    provenance.record_run(out, made_at, made_of=made_of)
    print(f"{out.parent.name}: {out.name}", file=sys.stderr, flush=True)
    return out


# ---- read -----------------------------------------------------------------------------------------------------------

def summary(folder):
    return read_json(folder / "summary.json")


def value_of(value, path):
    """value['a']['b'] for the dotted path 'a.b'; lists by index; None where there is nothing."""
    for part in path.split("."):
        if isinstance(value, list):
            value = value[int(part)] if int(part) < len(value) else None
        else:
            value = value.get(part) if isinstance(value, dict) else None
    return value


def mean_of(value):
    """Of a figure that may have its error beside it."""
    return value["mean"] if isinstance(value, dict) else value


def drawbar_row(summary, figures):
    """Whether the pull is steady, its standard error, and figures {column: key}, those of columns *_mm in mm."""
    row = {"steady": int(summary["drawbar_pull_N"]["steady"]), "sem_N": summary["drawbar_pull_N"]["sem"]}
    for column, key in figures.items():
        value = mean_of(summary[key])
        row[column] = value * 1e3 if column.endswith("_mm") and value is not None else value
    return row


def columns(file):
    """A table of numbers by the names of its columns."""
    import numpy
    return numpy.atleast_1d(numpy.genfromtxt(file, delimiter=",", names=True))


def series(folder, subject=None):
    return columns(folder / (f"timeseries_{subject}.csv" if subject else "timeseries.csv"))


def press_curve(folder):
    """The loading of `furrow press`."""
    curve = columns(folder / "press.csv")
    return curve[curve["unloading"] == 0]


def finished_runs(results, cases):
    """{case: folder} of those that are finished."""
    found = {case: results / case for case in cases if (results / case / "summary.json").exists()}
    if not found:
        sys.exit(f"{results}: holds no finished case, expected those of run_study.py")
    return found


def rows_before(table, made, *names):
    """{values of the named columns, as text: row} of a table beside the studies, so that a study is continued where its
    runs are no longer kept. Empty where the program of another commit, as in `made`, has made the table."""
    path = HERE / table
    if not path.exists() or provenance.read_origin(path).get("commit") != made["commit"]:
        return {}
    return {tuple(row[name] for name in names): {key: number_of(text) for key, text in row.items()}
            for row in provenance.read_table(path)}


def number_of(text):
    """Of an entry of a table; the text where it is none, None where it is empty."""
    try:
        return float(text) if text else None
    except ValueError:
        return text


# ---- write ----------------------------------------------------------------------------------------------------------

def short(value, digits=4):
    """Of a table: numbers with so many digits (all of them without `digits`); nothing for what is unknown."""
    if value is None or isinstance(value, float) and value != value:
        return ""
    return f"{value:.{digits}g}" if digits and isinstance(value, float) else value


def write(table, rows, made=None, digits=4, names=None, told=False):
    """Writes rows, dictionaries, to a table beside the studies (or to a path). Of several rows, the columns are all
    that any of them has.
    @param made as of provenance.made_here(), which is asked before a table makes files differ
    @param told whether the rows are printed too"""
    rows = [{key: short(value, digits) for key, value in row.items()} for row in rows]
    names = names or list(dict.fromkeys(key for row in rows for key in row))
    provenance.write_table(HERE / table, names, rows, made or provenance.made_here())
    for row in rows if told else ():
        print("  ".join(f"{key} {value}" for key, value in row.items() if value != ""), flush=True)


def over_beds(values):
    """(mean, half of its 95 % interval [Student's t])"""
    import statistics

    from furrow.plot.student import half_interval
    return statistics.mean(values), half_interval(values)


def pyplot():
    """In the look of all plots."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from furrow.plot import style  # noqa: F401
    return plt


def subplots(*sizes, **more):
    return pyplot().subplots(*sizes, **more)


def subplot_mosaic(mosaic, **more):
    return pyplot().subplot_mosaic(mosaic, **more)


def save(figure, name, dpi=90):
    figure.savefig(HERE / f"{name}.png", dpi=dpi)


def label(axes, x, y, title=None, legend=7.5, **more):
    axes.set(xlabel=x, ylabel=y, **({"title": title} if title else {}), **more)
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=legend)
