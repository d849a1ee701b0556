#!/usr/bin/python3
"""The whole command line with random arguments: an exit code that the program documents, and either a result or an
error message; never a crash, never silence.

usage: command_line.py [--cases N] [--seed S] [--state FILE] [--only CASE] [--patience S]

Case k of a seed is always the same. With --state a series goes on where it left off, and what was found stays in that
file. The program is $FURROW. No ranks are started: the launcher is one that does not exist. Cases share a cache, which
is empty before every fiftieth: a user has one too, and measuring the machine anew takes seconds of each `validate`.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from seeds import SMALL

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("FURROW", str(ROOT / "build" / "furrow"))
CODES = {0, 2, 3, 4, 5, 6, 75}
PATIENCE = 10.0  # s of the processor until a case is asked to stop: the same on a busy machine
# s by the clock, without those in which it waits for a processor, until a case is asked to stop, and as long again
# until it is a finding
HANGS = 600.0
LOOKED_AT = 0.2  # s by the clock between two looks at the processor time
FRESH_CACHE = 50  # cases

COMMANDS = ["run", "resume", "validate", "ranks", "explain", "bed", "soil",
            "press", "modes", "kc", "sweep", "calibrate", "report", "events", "list", "new", "bench",
            "bench grains", "bench tire", "bench rig", "help", "rnu", "", "--", "-", "RUN", "validate validate"]
# Those that compute get rarely what they need to begin.
WEIGHTS = [4, 4, 10, 4, 6, 1, 1, 1, 2, 2, 3, 3, 4, 2, 1, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]
FLAGS = ["--set", "--threads", "--out", "--overwrite", "--orders", "--count", "--elements-circumference", "--profile",
         "--no-plots", "--json", "--until", "--seeds", "--speed", "--only", "--quick", "--on", "--deflection",
         "--points", "--load", "--cleat-height", "--cleat-width", "--jobs", "--travel", "--csv", "--soil", "--bed",
         "--law", "--precision", "--cohesion", "--steps", "--warm", "--settle", "--save-bed", "--step", "--tire",
         "--pressure", "--tolerance", "--renewal", "--elements-width", "--quiet", "--vtk", "--cleat-position",
         "--camber", "--slurm", "--help", "-h", "--version", "--fast", "-x", "--set=", "--out="]
FILES = ["small.json", "study.json", "tire.json", "soil.json", "deep.json", "empty.json", "list.json", "binary.json",
         "folder", "run", "bed.csv", "bed.h5", "nowhere.json", "first_look.json", "study_slip.json",
         "hmmwv_layered.json", "rover.json", "car.json", "curb.json", "cleat_press.json", "aligator_planar.json",
         "hmmwv_ring.json", "/dev/null", "/proc/self/mem", "/", ".", "..", "", " ", "a" * 300, "a" * 5000, "folder/",
         "run/summary.json", "-", "--", "$(touch pwn)", "~"]
ODD = ["0", "1", "-1", "1e400", "-1e400", "nan", "inf", "1e-320", "0x10", "1e9", "4e-5", "0.3", "true", "null", "[]",
       "{}", "[[0, 1]]", "[1, 2, 3]", "\"\"", "'x'", "x", "", " ", "[" * 70, "{\"a\": {\"a\": 1}}", "9" * 400, "1,5",
       "ü", "🚙", "plate", "cleat", "auto", "mindlin", "2147483648", "9223372036854775808", "18446744073709551616", "-0",
       "+1", "1.", ".5", "1e", "%s%n", "\\", "\n", "\x1b[31m", "\udcff", "a=b"]


def leaves(schema, node, path=""):
    """Dotted keys of the scenario schema."""
    if "$ref" in node:
        node = schema["definitions"][node["$ref"].rsplit("/", 1)[1]]
    for name, child in node.get("properties", {}).items():
        yield path + name
        yield from leaves(schema, child, path + name + ".")
        if "items" in child:
            yield from leaves(schema, child["items"], path + name + ".0.")


def make_files(folder):
    (folder / "small.json").write_text(json.dumps(SMALL))
    (folder / "study.json").write_text(json.dumps({"scenario": "small.json", "grid": {"rig.slip": [0.1, 0.2]}}))
    (folder / "tire.json").write_text((ROOT / "tire" / "data" / "toroidal.json").read_text())
    (folder / "soil.json").write_text((ROOT / "terrain" / "data" / "loose_sand.json").read_text())
    (folder / "car.json").write_text((ROOT / "vehicle" / "data" / "rover.json").read_text().replace('"Rover"', "3"))
    (folder / "deep.json").write_text("[" * 100000)
    (folder / "empty.json").write_text("")
    (folder / "list.json").write_text("[1, 2]")
    (folder / "binary.json").write_bytes(bytes(range(256)))
    (folder / "folder").mkdir()
    (folder / "bed.csv").write_text("x_m,y_m,z_m\n0.1,0,0.1\n")
    (folder / "bed.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    (folder / "run").mkdir()
    (folder / "run" / "scenario.json").write_text(json.dumps(SMALL))
    (folder / "run" / "summary.json").write_text('{"drawbar_pull_N": 3}')


def arguments_of(chance, keys):
    """A command line that is neither always wrong nor often right."""
    def value():
        return chance.choice(ODD) if chance.random() < 0.7 else repr(chance.uniform(-10, 10)
                                                                     * 10.0 ** chance.randint(-12, 12))

    def setting():
        key = chance.choice(keys)
        if chance.random() < 0.15:
            place = chance.randrange(len(key) + 1)
            key = key[:place] + chance.choice("._ =x9ü") + key[place:]
        return f"{key}={value()}"

    arguments = chance.choices(COMMANDS, WEIGHTS)[0].split(" ")
    if chance.random() < 0.8:
        arguments.append(chance.choice(FILES[:2]) if chance.random() < 0.5 else chance.choice(FILES))
    if arguments[0] == "explain" and chance.random() < 0.6:
        arguments[1:] = [chance.choice(keys)]
    for _ in range(chance.choice([0, 0, 1, 1, 2, 3, 6])):
        flag = "--set" if chance.random() < 0.5 else chance.choice(FLAGS)
        arguments.append(flag)
        if flag == "--set":
            arguments.append(setting())
        elif chance.random() < 0.6:
            arguments.append(chance.choice(FILES) if chance.random() < 0.4 else value())
    if chance.random() < 0.1:
        chance.shuffle(arguments)
    return [argument.replace("\0", "") for argument in arguments]


def finding(arguments, code, out, err):
    """What is wrong with an answer; None when nothing is."""
    if code not in CODES:
        return f"exit code {code}" if code >= 0 else f"killed by {signal.Signals(-code).name}"
    for word in ("error: fault of the program", "Traceback", "terminate called", "Sanitizer",
                 "runtime error", "nlohmann", "bad_alloc", "basic_string"):
        if word in err or word in out:
            return f"says '{word}'"
    if re.search(r"[\x00-\x08\x0b-\x1f\x7f]", err):
        return "control characters on stderr"
    errors = [line for line in err.split("\n") if line.startswith("furrow: error: ")]
    if any(line == "furrow: error: " for line in errors):
        return "an empty message"
    if code == 0:
        return f"success with an error message: {errors[0]}" if errors else None if out else "silent success"
    if not errors:
        return "no error message"
    if out and code != 75 and "sweep" not in arguments:  # whose table tells of runs that failed
        return "a result beside an error"
    if len(errors) != len(set(errors)):
        return "the same message twice"
    if len(errors) > 1 and not all("key '" in line or "mistakes" in line for line in errors):
        return f"{len(errors)} messages"
    return None


def processor_time(pid):
    """Of a process and of those that it has waited for, s; infinite when it is gone."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return float("inf")
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def starved(pid):
    """What the thread that waited longest has waited for a processor, s."""
    waited = 0.0
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat"):
        try:
            waited = max(waited, 1e-9 * int(task.read_text().split()[1]))
        except (OSError, IndexError):
            continue
    return waited


def answer_within(process, patience, by_clock):
    """(stdout, stderr), or None when the process has taken so many seconds of the processor, or by the clock"""
    begin, used = time.monotonic(), processor_time(process.pid)
    while True:
        try:
            return process.communicate(timeout=LOOKED_AT)
        except subprocess.TimeoutExpired:
            late = time.monotonic() - begin > by_clock + starved(process.pid)
            if late or used + patience < processor_time(process.pid) < float("inf"):
                return None


def run_case(arguments, folder, cache, patience):
    """(exit code, stdout, stderr, whether it had to be asked to stop)"""
    environment = {**os.environ, "FURROW_MPIRUN": "/no/mpirun", "FURROW_HOME": str(ROOT), "XDG_CACHE_HOME": str(cache),
                   "OMP_NUM_THREADS": "2"}
    raw = [argument.encode("utf-8", "surrogateescape") for argument in arguments]
    with subprocess.Popen([PROGRAM.encode(), *raw], cwd=folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          env=environment, start_new_session=True) as process:
        answer = answer_within(process, patience, HANGS)
        asked = answer is None
        if asked:
            process.terminate()
            answer = answer_within(process, patience, HANGS)
            if answer is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.communicate()
                return -signal.SIGKILL, "", "does not answer TERM", True
        out, err = answer
        return process.returncode, out.decode(errors="replace"), err.decode(errors="replace"), asked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--state", type=pathlib.Path, help="JSON file of what is done; made, or gone on from")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after this time")
    parser.add_argument("--only", type=int, help="this case, with its output")
    parser.add_argument("--patience", type=float, default=PATIENCE,
                        help="s of the processor until a case is asked to stop")
    options = parser.parse_args()
    schema = json.loads((ROOT / "rigs" / "scenario.schema.json").read_text())
    keys = sorted(set(leaves(schema, schema)))
    state = {"seed": options.seed, "done": 0, "codes": {}, "findings": []}
    if options.state and options.state.exists():
        state = json.loads(options.state.read_text())
    codes = collections.Counter(state["codes"])
    cases = [options.only] if options.only is not None else range(state["done"], options.cases)
    begin = time.monotonic()
    caches = tempfile.TemporaryDirectory(prefix="furrow fuzz cache ")
    for k in cases:
        if time.monotonic() - begin > options.seconds:
            break
        cache = pathlib.Path(caches.name) / str(k // FRESH_CACHE)
        shutil.rmtree(cache.with_name(str(k // FRESH_CACHE - 1)), ignore_errors=True)
        chance = random.Random(f"{state['seed']}:{k}")
        arguments = arguments_of(chance, keys)
        with tempfile.TemporaryDirectory(prefix="furrow fuzz ") as name:
            folder = pathlib.Path(name)
            make_files(folder)
            code, out, err, asked = run_case(arguments, folder, cache, options.patience)
        wrong = finding(arguments, code, out, err)
        codes[str(code)] += 1
        state["done"] = k + 1
        if options.only is not None:
            print(arguments, "\nexit", code, "\n--- stdout\n" + out, "\n--- stderr\n" + err)
        if wrong:
            state["findings"].append({"case": k, "arguments": arguments, "what": wrong, "stderr": err[-500:]})
            print(f"case {k}: {wrong}: {arguments}\n  {err[-300:]!r}", flush=True)
        if asked and not wrong:
            codes["asked to stop"] += 1
        if options.state and options.only is None and (k % 50 == 49 or wrong):
            options.state.write_text(json.dumps({**state, "codes": codes}, indent=1))
    if options.state and options.only is None:
        options.state.write_text(json.dumps({**state, "codes": codes}, indent=1))
    print(f"{state['done']} cases of seed {state['seed']}, exit codes {dict(codes)}, {len(state['findings'])} findings")
    return 1 if state["findings"] else 0


if __name__ == "__main__":
    sys.exit(main())
