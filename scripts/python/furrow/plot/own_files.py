"""Which files of a folder are furrow's, and files that appear whole or not at all. nodes/launch/run_list.hpp and
protocol/files/new_file.hpp are the same rules in the program.

A folder of results holds the list `.furrow-run`. Plots in any other folder are listed in `.furrow-report`, which makes
no run of that folder: commands that replace or continue a run refuse it as before.
"""
import os
import secrets
import stat
import sys

LISTS = (".furrow-run", ".furrow-report")


def head_of(path):
    return f"{path.name[1:]} 1\n"


def is_file(path):
    """Whether it is a file itself; a link is none."""
    try:
        return stat.S_ISREG(os.lstat(path).st_mode)
    except OSError:
        return False


def names_in(path):
    """What a list holds since it was last begun. A line that a full disk or a kill cut short is not a name."""
    if not is_file(path):
        return []
    text = path.read_text(encoding="utf-8", errors="replace")
    return text[:text.rfind("\n") + 1].split(head_of(path))[-1].splitlines()


def add_name(path, name):
    """Adds a name to a list and flushes it to the disk."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    with open(handle, "r+b") as file:
        file.seek(0)
        whole = file.read().rfind(b"\n") + 1
        file.truncate(whole)
        file.write((("" if whole else head_of(path)) + name + "\n").encode())
        file.flush()
        os.fsync(handle)


def may_write(folder, name):
    """Whether `name` may be written in a folder: it is free, or furrow wrote it. A free one is put on the folder's
    list, before its file is made. If it may not, a message says why."""
    why = None
    if os.path.islink(folder / name):
        why = "the file of that name in this folder is a link, which furrow does not follow"
    elif os.path.lexists(folder / name):
        listed = is_file(folder / name) and any(name in names_in(folder / one) for one in LISTS)
        why = None if listed else "furrow did not write the file of that name in this folder"
    elif not any(name in names_in(folder / one) for one in LISTS):
        add_name(folder / LISTS[0 if is_file(folder / LISTS[0]) else 1], name)
    if why:
        print(f"report: no {name}: {why}", file=sys.stderr)
    return why is None


def remove_own(folder, name):
    """Removes a file that furrow wrote: it shows what is no longer there."""
    if is_file(folder / name) and any(name in names_in(folder / one) for one in LISTS):
        (folder / name).unlink(missing_ok=True)


def write_whole(path, content):
    """Writes a file under a name that nobody can guess and gives it its own when it is whole. What has that name is
    replaced and not written to, even if it became a link meanwhile."""
    part = path.with_name(f".{path.name}.{secrets.token_hex(8)}.part")
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    try:
        with open(handle, "wb") as out:
            out.write(content)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
