"""What a case does to the files of a run at its moment, or between its parts."""
import os
import shutil
import signal
import time

import processes
from actions import action, begin, mount, strike, strike_all, unmount
from case import Deviation
from compare_runs import differences


@action
def moved(case):
    """The folder is given another name, and back."""
    started, _ = begin(case)
    elsewhere = case.work / "elsewhere"
    if not case.out.exists():
        case.notes["in_time"] = False
        return case.finish_and_continue(started)
    case.out.rename(elsewhere)
    ended = case.rng.random() < 0.5
    if ended:
        case.finish(started)
    else:
        time.sleep(case.rng.uniform(0.0, 0.5))
    if case.out.exists():
        raise Deviation(f"the moved folder was made anew with {sorted(path.name for path in case.out.iterdir())}")
    elsewhere.rename(case.out)
    if not ended:
        case.finish(started)
    case.until_done()


@action
def read_only(case):
    """A read-only mount over the folder; without root its mode."""
    started, _ = begin(case)
    if not case.out.exists():
        case.notes["in_time"] = False
    elif mount("--bind", case.out, case.out):
        case.clean_up.append(lambda: unmount(case.out))
        mount("-o", "remount,ro,bind", case.out)
    else:
        os.chmod(case.out, 0o555)
    case.finish(started)
    if case.clean_up:
        case.clean_up.pop()()
    if case.out.exists():
        os.chmod(case.out, 0o755)
    case.until_done()


@action
def removed(case):
    """The folder is gone: that is told, nothing is continued, and the run starts again."""
    started, alive = begin(case)
    had_begun = alive and case.out.exists()
    before = os.open(case.out, os.O_DIRECTORY) if had_begun else None
    shutil.rmtree(case.out, ignore_errors=True)
    gone = time.monotonic()
    code = case.finish(started)
    if before is not None:
        # Where the removal met a file that was just written the folder stays: whoever removes it does so again.
        stays = case.out.exists() and os.path.samestat(os.stat(case.out), os.fstat(before))
        os.close(before)
        if stays and code != 0:
            case.notes["removal_met_writing"] = True
            processes.wait_until_gone(str(case.work), 10)
            shutil.rmtree(case.out)
        elif code != 0 and case.out.exists():
            raise Deviation("the folder was made anew after it was removed")
    if code == 0 and had_begun:
        if time.monotonic() - gone > 1.0:
            raise Deviation("ended with 0 though its folder was removed a while ago")
        case.notes["ended_meanwhile"] = True
        shutil.rmtree(case.out, ignore_errors=True)
    processes.wait_until_gone(str(case.work), 10)
    if not case.newest_checkpoints() and case.again != case.first and not (case.out / "summary.json").exists():
        case.finish(case.start(case.again), {2})
        case.finish(case.start(case.anew), {0})
    else:
        case.until_done()


@action
def overwrite(case):
    """Another's results stand in the folder: they stay whole until the run that replaces them has begun its steps."""
    shutil.copytree(case.earlier, case.out)
    if case.again == case.first:  # a study has no --overwrite, and is refused
        case.finish(case.start(case.first), {2})
        if differences(case.earlier, case.out):
            raise Deviation("a study that was refused has changed what stood in its place")
        shutil.rmtree(case.out)
        return case.finish(case.start(case.first), {0})
    if case.rng.random() < 0.5:
        case.cache = case.work / "cache"  # it settles its bed first
    case.first = case.anew
    started, alive = begin(case)
    if alive:
        way = case.notes["way"] = case.rng.choice(["kill", "term", "all"])
        if way == "all":
            strike_all(case, started)
        else:
            strike(case, started, signal.SIGKILL if way == "kill" else signal.SIGTERM)
    if case.finish(started) == 0:
        return
    processes.wait_until_gone(str(case.work), 10)
    case.finish(case.start(case.again), {0, 2})
    case.notes["restored"] = not differences(case.earlier, case.out)
    if case.notes["restored"]:
        case.finish(case.start(case.anew), {0})
    elif not any(case.out.glob("timeseries*.csv")):
        raise Deviation("the folder holds neither the earlier results nor those of the new run")
    else:
        case.until_done()


@action
def damaged_checkpoint(case):
    """All is killed, and a file of the newest checkpoint is damaged: the run continues from the one before it."""
    started, _ = begin(case)
    strike_all(case, started)
    case.finish(started)
    processes.wait_until_gone(str(case.work), 10)
    alone = False
    for run, step in case.newest_checkpoints().items():
        if (run / "summary.json").exists():
            continue  # nothing of it is read again
        file = case.rng.choice(sorted((run / "checkpoints" / f"{step:012}").iterdir()))
        way = case.notes["way"] = case.rng.choice(["flip", "cut", "remove", "empty", "add"])
        case.notes["damaged"] = file.name
        content = bytearray(file.read_bytes())
        at = case.rng.randrange(len(content))
        content[at] ^= 1 << case.rng.randrange(8)
        if way == "remove":
            file.unlink()
        else:
            file.write_bytes({"flip": content, "cut": content[:at], "empty": b"", "add": content + b"\n{}"}[way])
        alone |= len(list((run / "checkpoints").glob("[0-9]*"))) == 1
    if alone:  # nothing to go on from: that is told, and the run starts again
        case.finish(case.start(case.again))
        shutil.rmtree(case.out)
        return case.finish(case.start(case.first), {0})
    case.until_done(repeats=True)
