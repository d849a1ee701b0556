#!/usr/bin/python3
"""The random campaign: many short runs, each of them disturbed once at a random moment in a random way, then continued
until done and compared with the run that nothing disturbed, every file (compare_runs.py).

A case is decided by the seed and its number: which of the scenarios (scenarios.py), which of the actions (actions.py),
which process, which moment. What becomes of it hangs on the machine's timing as well, so that a seed finds a deviation
again only if the moment is met. Cases whose record is in cases.jsonl are skipped: an interrupted campaign goes on.

usage: FURROW=build/furrow tests/campaign/campaign.py --out DIR [--seed N] [--cases N] [--minutes T]
           [--case I] [--action NAME] [--scenario NAME] [--fresh] [--list]
DIR holds cases.jsonl, references/, cache/ and failed/<case>/ with the folder of each deviation.
Prints a line per case and a table at the end; exits with 1 if there was a deviation.
"""
import argparse
import collections
import fcntl
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time
import traceback

import actions
import actions_on_files  # noqa: F401 adds its own to actions.ALL
import scenarios
from case import Case, Deviation

PROGRAM = pathlib.Path(os.environ.get("FURROW", pathlib.Path(__file__).resolve().parents[2] / "build" / "furrow"))
OWN_MOUNTS = "FURROW_CAMPAIGN_OWN_MOUNTS"
SHARE_AFTER_END = 0.05  # of the reference's time that a moment may lie beyond it


def with_own_mounts():
    """As root, what the campaign mounts is seen by its own processes alone, but in a chroot, which forbids that."""
    own = ["unshare", "--mount", "--propagation", "private"]
    if not actions.is_root() or OWN_MOUNTS in os.environ or not shutil.which("unshare"):
        return
    if subprocess.run([*own, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
        os.environ[OWN_MOUNTS] = "1"
        os.execvp("unshare", [*own, sys.executable, *sys.argv])


def drawn(names, seed, index):
    """The names in a random order, then in another one: every so many cases hold each of them once."""
    block = list(names)
    random.Random(f"{seed}/{len(block)}/{index // len(block)}").shuffle(block)
    return block[index % len(block)]


class Campaign:
    def __init__(self, folder, seed, choice):
        self.folder, self.seed, self.choice = folder.resolve(), seed, choice
        self.records = self.folder / "cases.jsonl"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lock = open(self.folder / ".lock", "w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit(f"{self.folder} is taken by a campaign that is not over")
        self.build = hashlib.sha256(PROGRAM.read_bytes()).hexdigest()[:12]

    def done(self):
        """{case: record} of this seed; a line that was cut short is none."""
        found = {}
        for line in self.records.read_text().splitlines() if self.records.exists() else ():
            try:
                record = json.loads(line)
            except json.JSONDecodeError:
                continue
            if record["seed"] == self.seed:
                found[record["case"]] = record
        return found

    def case(self, rng, scenario, earlier=None):
        return Case(rng, scenario, PROGRAM, self.folder, self.folder / "cache", earlier)

    def reference(self, scenario):
        """(folder, wall time in s) of the run that nothing disturbs, made by this build in the place of the cases."""
        kept = self.folder / "references" / f"{scenario}-{self.build}"
        if not (kept / "time.json").exists():
            shutil.rmtree(kept, ignore_errors=True)
            case = self.case(random.Random(0), scenario)
            while True:
                case.end()
                beds, begin = len(list(case.cache.rglob("*.h5"))), time.monotonic()
                case.finish(case.start(case.first), {0})
                seconds = time.monotonic() - begin
                if len(list(case.cache.rglob("*.h5"))) == beds:
                    break  # on a settled bed, as all cases are
            kept.mkdir(parents=True)
            shutil.move(case.out, kept / "out")
            case.end()
            (kept / "time.json").write_text(json.dumps(seconds))
        return kept / "out", json.loads((kept / "time.json").read_text())

    def run(self, index):
        rng = random.Random(f"{self.seed}:{index}")
        action = self.choice.action or drawn(actions.ALL, self.seed, index)
        scenario = self.choice.scenario or drawn(scenarios.NAMES, f"{self.seed} scenario", index)
        reference, usual = self.reference(scenario)
        earlier, _ = self.reference("shell" if scenario == "rigid" else "rigid")
        case = self.case(rng, scenario, earlier)
        case.end()  # of a campaign that was killed
        case.notes["moment_s"] = round(rng.uniform(0.0, 1.0 + SHARE_AFTER_END) * usual, 4)
        begin, outcome, why = time.monotonic(), "equal", ""
        try:
            actions.ALL[action](case)
            case.compare(reference)
        except Deviation as deviation:
            outcome, why = "DEVIATION", str(deviation)
        except Exception:  # a mistake of the campaign's own is told like any other, and stops no other case
            outcome, why = "ERROR", traceback.format_exc()
        record = {"seed": self.seed, "case": index, "scenario": scenario,
                  "action": action, **case.notes, "outcome": outcome,
                  "why": why, "seconds": round(time.monotonic() - begin, 2),
                  "build": self.build, "commands": case.steps}
        case.end(keep=self.folder / "failed" / f"{self.seed}-{index}" if why else None)
        with open(self.records, "a") as records:
            records.write(json.dumps(record) + "\n")
        return record


def summary(records):
    """Actions by what became of them."""
    rows = collections.defaultdict(collections.Counter)
    for record in records:
        codes = [step["exit"] for step in record["commands"]]
        late = "" if record.get("in_time", True) else ", too late"
        rows[record["action"]][record["outcome"] + (late if record["outcome"] == "equal" else "")] += 1
        rows[record["action"]]["first exit " + str(codes[0] if codes else None)] += 1
    lines = []
    for name in sorted(rows):
        counts = rows[name]
        total = sum(count for key, count in counts.items() if not key.startswith("first exit"))
        lines.append(f"{name:26} {total:5}  " + ", ".join(f"{key} {counts[key]}" for key in sorted(counts)))
    return "\n".join(lines)


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--cases", type=int, default=500)
    parser.add_argument("--minutes", type=float, default=0.0, help="begin no case after this time")
    parser.add_argument("--case", type=int, action="append", help="this one again, whatever its record says")
    parser.add_argument("--action", choices=actions.ALL)
    parser.add_argument("--scenario", choices=scenarios.NAMES)
    parser.add_argument("--fresh", action="store_true", help="forget earlier records in --out")
    parser.add_argument("--list", action="store_true", help="only print the table of the records")
    return parser.parse_args()


def main():
    choice = options()
    with_own_mounts()
    if not os.access(PROGRAM, os.X_OK):
        sys.exit(f"{PROGRAM} is not there; set FURROW to the program under test")
    campaign = Campaign(choice.out, choice.seed, choice)
    if choice.fresh:
        campaign.records.unlink(missing_ok=True)
    done = campaign.done()
    begin = time.monotonic()
    for index in [] if choice.list else choice.case or range(choice.cases):
        if index in done and not choice.case:
            continue
        if choice.minutes and time.monotonic() - begin > 60.0 * choice.minutes:
            break
        record = campaign.run(index)
        done[index] = record
        print(f"{index:5} {record['scenario']:9} {record['action']:26} {record.get('target', ''):11} "
              f"{record['moment_s']:7.3f} s  {[step['exit'] for step in record['commands']]} {record['outcome']} "
              f"{record['why']}", flush=True)
    print(summary(done.values()))
    failed = [record for record in done.values() if record["outcome"] != "equal"]
    print(f"{len(done)} cases, {len(failed)} deviations")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
