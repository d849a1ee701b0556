"""What the system tests share: the program under test, a scenario that runs in a second, and how to look at
processes."""
import copy
import csv
import fcntl
import json
import os
import pathlib
import pty
import re
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("FURROW", str(ROOT / "build" / "furrow"))

# Of an environment in which the C library's mathematics round otherwise, and whether the processor can show it.
OTHER_MATHEMATICS = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX512F,-FMA,-FMA4,-AVX"}
HAS_OTHER_MATHEMATICS = " fma " in pathlib.Path("/proc/cpuinfo").read_text()

# A rigid wheel on a few large grains.
SMALL = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.3, "angular_speed": 4.28, "ramp": 0.01, "carrier_mass": 450},
    "tire": {"file": "hmmwv_layered.json", "rigid": True},
    "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4, "width": 0.4},
    "run": {"step": 1e-4, "end": 0.05, "average_from": 0.02},
    "output": {"series_interval": 1e-3, "frame_interval": 0.02},
}


def changed(**sections):
    """SMALL with some keys of its sections replaced; None removes a section."""
    scenario = copy.deepcopy(SMALL)
    for name, values in sections.items():
        if values is None:
            del scenario[name]
        elif isinstance(values, dict):
            scenario[name] = {**scenario.get(name, {}), **values}
        else:
            scenario[name] = values
    return scenario


def with_keys(document, changes):
    """A copy in which keys such as "rig.slip" or "axles[0].wheel" have other values; ... removes the key."""
    document = copy.deepcopy(document)
    for key, value in changes.items():
        place = document
        *way, last = [int(part) if part.isdigit() else part for part in re.findall(r"\w+", key)]
        for part in way:
            place = place[part]
        if value is ...:
            del place[last]
        elif isinstance(place, list) and last == len(place):
            place.append(value)
        else:
            place[last] = value
    return document


def message_of(changes, words):
    """What the message for a document with these changes holds: the first key before the words, unless they begin with
    an ellipsis."""
    return words[2:] if words.startswith("… ") else f"key '{next(iter(changes))}': {words}"


def write_scenario(folder, scenario=None, name="small.json"):
    return write_json(pathlib.Path(folder) / name, scenario if scenario is not None else SMALL)


def read_json(path):
    return json.loads(pathlib.Path(path).read_text())


def write_json(path, content):
    """Writes a file and returns its path."""
    pathlib.Path(path).write_text(json.dumps(content))
    return path


def rows_of(path):
    """The lines of a CSV file as dictionaries of texts."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def furrow(*arguments, cwd, timeout=200, env=None, program=PROGRAM):
    """Runs the program to its end."""
    return subprocess.run([program, *map(str, arguments)], cwd=cwd, timeout=timeout, text=True, errors="replace",
                          stdin=subprocess.DEVNULL, capture_output=True, env={**os.environ, **(env or {})})


def on_terminal(*arguments, cwd, columns=100, env=None, program=PROGRAM):
    """Runs the program to its end on a terminal of this width; the exit code and what it printed, both streams."""
    ours, terminal = pty.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    process = subprocess.Popen([program, *map(str, arguments)], cwd=cwd, stdin=subprocess.DEVNULL, stdout=terminal,
                               stderr=terminal, env={**os.environ, "TERM": "xterm", **(env or {})})
    os.close(terminal)
    printed = b""
    try:
        while part := os.read(ours, 65536):
            printed += part
    except OSError:  # the program has ended
        pass
    os.close(ours)
    return process.wait(), printed.decode(errors="replace").replace("\r\n", "\n")


def attend_to_signals():
    """Whoever runs the tests in the background has them ignore these."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def start(*arguments, cwd, env=None, program=PROGRAM):
    """Starts the program, whose output can be read when it has ended."""
    return subprocess.Popen([program, *map(str, arguments)], cwd=cwd, text=True, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **(env or {})},
                            preexec_fn=attend_to_signals)


def ranks(mark):
    """{rank: pid} of the living ranks whose command line holds `mark`."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            command = (entry / "cmdline").read_bytes().decode(errors="replace")
            environment = (entry / "environ").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        for variable in environment:
            if variable.startswith("OMPI_COMM_WORLD_RANK=") and str(mark) in command:
                found[int(variable.split("=")[1])] = int(entry.name)
    return found


def children(pid):
    """Processes that it has started and that have not ended."""
    return [int(word) for word in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def survivors(mark):
    """Command lines of all living processes that hold `mark`, this one's aside."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            command = (entry / "cmdline").read_bytes().decode(errors="replace").replace("\0", " ")
        except OSError:
            continue
        if str(mark) in command:
            found.append(f"{entry.name}: {command}")
    return found


def wait_for(condition, seconds, what):
    """The first true value of condition(). @param what a text, or a function that makes it when the time is over"""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"{what() if callable(what) else what}: not within {seconds} s")


class SystemTest(unittest.TestCase):
    """Every test has a folder of its own, with a space in its name."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="furrow test ")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def expect(self, done, code=0, says=(), lacks=(), matches=None, errors=None, shows=(), prints=None):
        """A program has ended with this exit code. Standard error has the words `says`, not those of `lacks`, something
        that matches the pattern, and so many errors; standard output has the words `shows`, or is `prints`.
        @returns it"""
        self.assertEqual(done.returncode, code, done.stderr or done.stdout[-2000:])
        if errors is not None:
            self.assertEqual(done.stderr.count("furrow: error: "), errors, done.stderr)
        for check, text, words in ((self.assertIn, done.stderr, says), (self.assertNotIn, done.stderr, lacks),
                                   (self.assertIn, done.stdout, shows)):
            for word in [words] if isinstance(words, str) else words:
                check(word, text)
        if matches is not None:
            self.assertRegex(done.stderr, matches)
        if prints is not None:
            self.assertEqual(done.stdout, prints)
        return done

    def furrow(self, *arguments, cwd=None, env=None, program=PROGRAM, timeout=200, **expected):
        """Runs the program to its end, which is as `expect` says."""
        return self.expect(furrow(*arguments, cwd=cwd or self.folder, env=env, program=program, timeout=timeout),
                           **expected)

    def call(self, command, cwd=None, env=None, timeout=900, **expected):
        """The same for any command."""
        return self.expect(subprocess.run(command, cwd=cwd or self.folder, env=env, timeout=timeout, text=True,
                                          errors="replace", capture_output=True, stdin=subprocess.DEVNULL), **expected)

    def start(self, *arguments, **options):
        """Starts the program, which ends with the test at the latest."""
        process = start(*arguments, **{"cwd": self.folder, **options})
        self.addCleanup(process.kill)
        return process

    def ended(self, process, code, timeout=60, **expected):
        """Waits for a program to end as `expect` says. @returns what it said on standard error"""
        out, err = process.communicate(timeout=timeout)
        self.expect(subprocess.CompletedProcess(process.args, process.returncode, out, err), code, **expected)
        return err

    def summary(self, run="out", name="summary.json"):
        return read_json(self.folder / run / name)

    def run_of(self, name, scenario, *flags, **expected):
        """Runs a scenario into a folder of this name. @returns its summary and what was said on standard error"""
        done = self.furrow("run", write_scenario(self.folder, scenario, f"{name}.json"), "--no-plots", "--out",
                           self.folder / name, *flags, timeout=400, **expected)
        return self.summary(name), done.stderr

    def accounts_close(self, summary):
        for what in ("energy", "momentum"):
            self.assertTrue(summary["accounts"][what]["closes"], summary["accounts"][what])

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def small_disk(self, folder, size):
        """Makes the folder and mounts a disk of this size there; skips the test where that is not allowed."""
        folder.mkdir()
        if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder],
                                               capture_output=True).returncode != 0:
            self.skipTest("needs root and the right to mount")
        self.addCleanup(subprocess.run, ["umount", "-l", folder])
        return folder


def main():
    if not os.access(PROGRAM, os.X_OK):
        sys.exit(f"{PROGRAM} is not there; set FURROW to the program under test")
    unittest.main(verbosity=2)
