"""One case of the campaign: a scenario, an action and a moment drawn from its seed, then continuing until done, and the
comparison with the run that nothing disturbed."""
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import time

import processes
import scenarios
from compare_runs import differences

PATIENCE = 180.0  # s that one command may take before it counts as hanging
START_TIMEOUT = "60"  # s after which a launcher that hangs is noticed; a sweep may meet two of them in turn
DOCUMENTED = {0, 2, 3, 4, 5, 6, 75}
BUSY_PATIENCE = 30.0  # s that a folder may stay taken by processes that are ending
# What a message must hold: an error, a stop, or the failure of a run of a study, with words that follow.
MESSAGE = re.compile(r"furrow: (error: \S.{5,}|.*stopped by a signal|stopping|.*FAILED with exit code \d+: "
                     r"[^;\s].{4,})")
NEWEST_DIFFERS = re.compile(r"checkpoints: the newest is \d+ and (\d+|none)$")
LOST_CHECKPOINT = re.compile(r"the checkpoint at t = \S+ s could not be written: \S")


class Deviation(Exception):
    """The promise is not kept: something lost, wrong, silent or hanging."""


class Started:
    def __init__(self, process, log, words, silent):
        self.process, self.log, self.words = process, log, words
        self.silent = silent  # its standard error is closed
        self.signalled = set()  # signals that the case sent to this very process

    def ended(self):
        return self.process.poll() is not None


class Case:
    def __init__(self, rng, scenario, program, folder, cache, earlier=None):
        """@param earlier folder of the results of another run"""
        self.earlier = earlier
        self.rng, self.scenario, self.program = rng, scenario, program
        self.work, self.inputs, self.cache = folder / "work", folder / "inputs", cache
        self.out = self.work / "out"
        self.first, self.again, self.anew = scenarios.commands(scenario, self.inputs, self.out)
        self.steps, self.notes = [], {}
        self.checkpoints_may_be_lost = False  # if the program has told so
        self.clean_up = []  # called in reverse order when the case is over

    # commands

    def start(self, words, limits=(), prefix=(), env=None, closed=()):
        """@param limits (resource, value): of the program and all that it starts
        @param closed standard streams that are closed before it starts"""
        self.work.mkdir(parents=True, exist_ok=True)
        log = self.inputs / f"log_{len(self.steps)}_{time.monotonic_ns()}"

        def prepare():
            for which, value in limits:
                resource.setrlimit(which, (value, value))
            for number in (signal.SIGINT, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            for stream in closed:
                os.close(stream)
        with open(log, "wb") as sink:
            process = subprocess.Popen([*prefix, self.program, *words], cwd=self.inputs, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL, stderr=sink,
                                       preexec_fn=prepare, start_new_session=True,
                                       env={**os.environ, "XDG_CACHE_HOME": str(self.cache),
                                            "FURROW_START_TIMEOUT": START_TIMEOUT, **(env or {})})
        return Started(process, log, words, silent=2 in closed)

    def finish(self, started, expected=DOCUMENTED):
        """Waits for the end, records and judges it. @returns the exit code"""
        try:
            code = started.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            left = processes.living(str(self.work))
            self.record(started, None)
            raise Deviation(f"{started.words[0]} hangs; still there: {sorted(left.values())}") from None
        text = self.record(started, code)
        if -code in started.signalled:
            return code
        if code == 127 and "error while loading shared libraries" in text:
            return code  # a limit so low that the system could not load the program, and has told so
        if code not in DOCUMENTED:
            raise Deviation(f"{started.words[0]} ended with {code}, which is no exit code of furrow")
        if code != 0 and not started.silent and not MESSAGE.search(text):
            raise Deviation(f"{started.words[0]} ended with {code} and names nothing")
        if code not in expected:
            raise Deviation(f"{started.words[0]} ended with {code}, expected {sorted(expected)}")
        return code

    def record(self, started, code):
        text = started.log.read_text(errors="replace")
        started.log.unlink()
        lines = [line for line in text.splitlines() if line.startswith("furrow: ") or code not in (0, None)]
        self.steps.append({"command": started.words[0], "exit": code, "said": "\n".join(lines)[-1500:]})
        return text

    # the moment

    def wait(self, started, seconds):
        """@returns False when it ended before"""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if started.ended():
                return False
            time.sleep(0.002)
        return not started.ended()

    def target(self, started):
        """(pid, role) of one process of this case, chosen by its role; None when all have ended."""
        found = processes.living(str(self.work))
        found.setdefault(started.process.pid, "started")
        roles = sorted(set(found.values()))
        role = self.rng.choice(roles)
        return self.rng.choice(sorted(pid for pid, name in found.items() if name == role)), role

    def send(self, started, pid, number):
        if pid == started.process.pid:
            started.signalled.add(int(number))
        return processes.send(pid, number)

    # continuing

    def newest_checkpoints(self):
        """{folder of a run: newest step}"""
        found = {}
        for manifest in self.out.rglob("checkpoints/*/manifest.json") if self.out.exists() else ():
            if manifest.parent.name.isdigit():
                run = manifest.parents[2]
                found[run] = max(found.get(run, 0), int(manifest.parent.name))
        return found

    def until_done(self, expected=frozenset({0}), repeats=False, **options):
        """Continues as the program says until it ends with 0; a folder that is still taken is waited for, a run without
        a checkpoint starts again.
        @param repeats work after a saved step may be done again"""
        begin = time.monotonic()
        while True:
            busy, had = processes.living(str(self.work)), self.newest_checkpoints()
            finished = (self.out / "summary.json").exists()
            words = self.again if had or finished or self.again == self.first else self.anew
            code = self.finish(self.start(words, **options), expected | {0, 2})
            if code == 0:
                if not repeats:
                    self.nothing_repeated(had, finished)
                return
            if code in expected and code != 2:
                continue
            if not busy and not self.newest_checkpoints().keys() - had.keys():
                raise Deviation(f"{words[0]} is refused though nobody has the folder")
            if time.monotonic() - begin > BUSY_PATIENCE:
                raise Deviation(f"{words[0]} is refused for {BUSY_PATIENCE} s by {sorted(busy.values())}")
            time.sleep(0.2)

    def finish_and_continue(self, started, expected=DOCUMENTED):
        self.finish(started, expected)
        self.until_done()

    def nothing_repeated(self, had, finished):
        """The work until the newest checkpoint that there was is not done again."""
        for run, step in had.items():
            if finished or not (run / "summary.json").exists():
                continue
            last = json.loads((run / "summary.json").read_text())["segments"][-1]
            if last["from_step"] < step and last["to_step"] > step:
                raise Deviation(f"{run.name} went on from step {last['from_step']}, though step {step} was saved")

    def compare(self, reference, out=None):
        left = processes.wait_until_gone(str(self.work), 10)
        if left:
            raise Deviation(f"processes outlive the run: {sorted(left.values())}")
        found = differences(reference, out or self.out)
        if self.checkpoints_may_be_lost:
            found = [line for line in found if not self.told_as_lost(line)]
        if found:
            more = f"; {len(found) - 5} more" if len(found) > 5 else ""
            raise Deviation("not as the undisturbed run: " + "; ".join(found[:5]) + more)

    def told_as_lost(self, difference):
        """Whether it is of the newest checkpoint of a run, and the program has said that it could not write one."""
        said = [step["said"] for step in self.steps]
        said += [log.read_text(errors="replace") for log in self.out.rglob("*.log")]
        return NEWEST_DIFFERS.search(difference) and any(LOST_CHECKPOINT.search(text) for text in said)

    def end(self, keep=None):
        """@param keep folder that receives what the case left"""
        processes.end_all(str(self.work))
        for undo in reversed(self.clean_up):
            undo()
        self.clean_up.clear()
        if keep and self.work.exists():
            shutil.rmtree(keep, ignore_errors=True)
            shutil.copytree(self.work, keep, symlinks=True)
        shutil.rmtree(self.work, ignore_errors=True)
        for log in pathlib.Path(self.inputs).glob("log_*"):
            log.unlink()
