"""What a case does to a run at its moment. Each action leaves a folder that can be continued, unless it says so."""
import os
import resource
import signal
import subprocess
import time

import processes
from case import DOCUMENTED, Deviation

ALL = {}


def action(function):
    ALL[function.__name__] = function
    return function


def is_root():
    return os.geteuid() == 0


def mount(*words):
    return is_root() and subprocess.run(["mount", *map(str, words)], capture_output=True).returncode == 0


def unmount(folder):
    subprocess.run(["umount", "-l", str(folder)], capture_output=True)


def begin(case, **options):
    """@returns (what was started, whether it still runs at the moment)"""
    started = case.start(case.first, **options)
    alive = case.wait(started, case.notes["moment_s"])
    case.notes["in_time"] = alive
    return started, alive


def strike(case, started, number):
    pid, role = case.target(started)
    case.notes["target"] = role
    case.send(started, pid, number)
    return pid


def strike_all(case, started):
    everyone = list(processes.living(str(case.work)))
    case.rng.shuffle(everyone)
    for pid in everyone:
        case.send(started, pid, signal.SIGKILL)


def struck(case, number):
    """One of its processes gets a signal, and the run is continued."""
    started, alive = begin(case)
    if alive:
        strike(case, started, number)
    case.finish_and_continue(started)


@action
def kill(case):
    struck(case, signal.SIGKILL)


@action
def term(case):
    struck(case, signal.SIGTERM)


@action
def other_signal(case):
    """One that is not asked for: a terminal that is closed, a pipe that ends, a stray one."""
    number = case.rng.choice([signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGPIPE, signal.SIGALRM,
                              signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU])
    case.notes["signal"] = number.name
    struck(case, number)


@action
def kill_all(case):
    """As when the machine goes down, but for what the disk had not got yet."""
    started, _ = begin(case)
    strike_all(case, started)
    case.finish_and_continue(started)


@action
def kill_and_kill(case):
    """Each continuation is killed as well, without a pause."""
    started, alive = begin(case)
    ends = {0}
    for _ in range(case.rng.randint(2, 4)):
        if alive:
            strike(case, started, signal.SIGKILL)
        case.finish(started, DOCUMENTED if alive else ends)
        if not case.newest_checkpoints():
            return case.until_done()
        started, ends = case.start(case.again), {0, 2}  # it may find the folder taken by those that are ending
        alive = case.wait(started, case.rng.uniform(0.1, 1.0))
    case.finish_and_continue(started, ends)


@action
def stop_and_continue(case):
    started, alive = begin(case)
    if alive:
        pid = strike(case, started, signal.SIGSTOP)
        time.sleep(case.rng.uniform(0.05, 1.0))
        processes.send(pid, signal.SIGCONT)
    case.finish(started, {0})


@action
def closed_streams(case):
    """Standard input, output or error are closed by who starts the program, and perhaps by who continues it."""
    streams = case.rng.choice([[0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]])
    case.notes["closed"] = streams
    started, alive = begin(case, closed=streams)
    if alive and case.rng.random() < 0.5:
        strike(case, started, signal.SIGKILL)
    case.finish(started)
    processes.wait_until_gone(str(case.work), 10)
    if case.newest_checkpoints() or case.again == case.first:
        case.finish(case.start(case.again, closed=streams))
    case.until_done()


def small_disk(case):
    """@returns False without root, or where nothing can be mounted"""
    case.work.mkdir(parents=True, exist_ok=True)
    if not mount("-t", "tmpfs", "-o", "size=64m", "tmpfs", case.work):
        return False
    case.clean_up.append(lambda: unmount(case.work))
    return True


def fill_disk(ballast):
    with open(ballast, "wb", buffering=0) as file:
        try:
            for size in (1 << 20, 4096, 1):
                while file.write(bytes(size)) == size:
                    pass
        except OSError:
            pass


@action
def disk_full(case):
    """A small disk that is filled at the moment; without root, or where nothing can be mounted, limited file sizes."""
    if not small_disk(case):
        return file_limit(case)
    started, _ = begin(case)
    ballast = case.work / "ballast"
    fill_disk(ballast)
    case.finish(started)
    ballast.unlink()
    case.until_done()


@action
def disk_full_for_moments(case):
    """As before, but others make room again after moments, several times: what was refused must be told or written
    anew."""
    if not small_disk(case):
        return file_limit(case)
    case.checkpoints_may_be_lost = True
    started, alive = begin(case)
    ballast, case.notes["times"] = case.work / "ballast", 0
    while alive and case.notes["times"] < 8:
        fill_disk(ballast)
        time.sleep(case.rng.uniform(0.0, 0.05))
        ballast.unlink()
        case.notes["times"] += 1
        alive = case.wait(started, case.rng.uniform(0.01, 0.1))
    case.finish_and_continue(started)


@action
def file_limit(case):
    """RLIMIT_FSIZE of all processes: every file that grows beyond it."""
    size = int(2 ** case.rng.uniform(10, 22))
    case.notes["limit_bytes"] = size
    started, _ = begin(case, limits=[(resource.RLIMIT_FSIZE, size)])
    case.finish_and_continue(started)


@action
def memory_limit(case):
    """RLIMIT_AS of all processes from the start, or of one of them at the moment."""
    size = int(2 ** case.rng.uniform(26, 31))
    case.notes["limit_bytes"] = size
    if case.rng.random() < 0.5:
        started, _ = begin(case, limits=[(resource.RLIMIT_AS, size)])
    else:
        started, alive = begin(case)
        if alive:
            pid, case.notes["target"] = case.target(started)
            try:
                resource.prlimit(pid, resource.RLIMIT_AS, (size, size))
            except ProcessLookupError:
                pass
    case.finish_and_continue(started)


@action
def clock(case):
    """All is killed and continued where the clock since boot is another, as after a reboot; needs root."""
    started, _ = begin(case)
    strike_all(case, started)
    case.finish(started)
    offset = case.rng.choice([-int(time.monotonic() * 0.9), 3600, 10 ** 8])
    case.notes["offset_s"] = offset
    prefix = ["unshare", "--time", "--fork", "--monotonic", str(offset), "--boottime", str(offset)]
    if not is_root() or subprocess.run([*prefix, "true"], capture_output=True).returncode != 0:
        case.notes["no_time_namespace"] = True
        prefix = []
    case.until_done(prefix=prefix)


@action
def second_user(case):
    """Somebody else continues or overwrites the folder while it is written: refused, and the first one continues."""
    started, alive = begin(case)
    if alive and case.out.exists():
        words = case.rng.choice([case.again, case.anew])
        case.notes["second"] = words[0] + (" --overwrite" if "--overwrite" in words else "")
        code = case.finish(case.start(words), {0, 2})
        if code == 0 and not started.ended():
            raise Deviation(f"{words[0]} was let into a folder that is taken")
    case.finish_and_continue(started, {0} if alive else DOCUMENTED)


@action
def second_user_of_the_cache(case):
    """Two runs settle the same bed into one empty cache, and one of them is killed."""
    case.cache = case.work / "cache"
    other = [str(word).replace(str(case.out), str(case.work / "other")) for word in case.first]
    started = case.start(case.first)
    second = case.start(other)
    if case.wait(second, case.notes["moment_s"]) and not second.ended():
        case.send(second, second.process.pid, signal.SIGKILL)
    case.finish(second)
    case.finish(started, {0})


@action
def double_resume(case):
    """Two continue it at once: one does, the other is refused."""
    started, alive = begin(case)
    if alive:
        strike_all(case, started)
    case.finish(started)
    if case.newest_checkpoints():
        pair = [case.start(case.again), case.start(case.again)]
        codes = [case.finish(one, {0, 2}) for one in pair]
        if 0 not in codes:
            case.notes["both_refused"] = True
    case.until_done()
