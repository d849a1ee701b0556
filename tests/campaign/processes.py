"""The processes of one case: who is there, what each is, and how they end."""
import os
import pathlib
import signal
import time

RANK = b"OMPI_COMM_WORLD_RANK="


def role_of(command, environment):
    """rank 0, rank 1, …; launcher; sweep; supervisor; or what else holds the folder's name on its command line."""
    for variable in environment.split(b"\0"):
        if variable.startswith(RANK):
            return "rank " + variable[len(RANK):].decode()
    words = command.decode(errors="replace").split("\0")
    program = pathlib.Path(words[0]).name
    if program.startswith(("mpirun", "mpiexec", "orterun")):
        return "launcher"
    if program.startswith("furrow") and len(words) > 1:
        return "sweep" if words[1] == "sweep" else "supervisor"
    return program


def living(mark):
    """{pid: role} of all processes but this one whose command line holds `mark`; zombies are none."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            command = (entry / "cmdline").read_bytes()
            if mark.encode() in command:
                found[int(entry.name)] = role_of(command, (entry / "environ").read_bytes())
        except OSError:
            continue
    return found


def send(pid, number):
    """False when it has ended by now."""
    try:
        os.kill(pid, number)
        return True
    except ProcessLookupError:
        return False


def wait_until_gone(mark, seconds):
    """@returns those that still live"""
    end = time.monotonic() + seconds
    while (left := living(mark)) and time.monotonic() < end:
        time.sleep(0.02)
    return left


def end_all(mark):
    """Ends what a case has left behind: all of it was started by the campaign, with the case's folder on its command
    line."""
    while left := living(mark):
        for pid in left:
            send(pid, signal.SIGKILL)
        time.sleep(0.02)
