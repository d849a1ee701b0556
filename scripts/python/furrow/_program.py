"""The program as a child process: found, started, listened to, stopped."""
from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import IO, Any, TypeAlias

from ._home import AROUND
from ._settings import as_json
from .errors import FurrowError, error_of

File: TypeAlias = str | os.PathLike[str]
Content: TypeAlias = Mapping[str, Any]
KEPT = 40  # last lines of the program, for a message when it gives none of its own


def program() -> str:
    """The program that is run: what FURROW names, else this checkout's scripts/furrow, which builds it if needed, else
    the installed tree's bin/furrow, else `furrow` on PATH. Raises FileNotFoundError."""
    named = os.environ.get("FURROW")
    places = (AROUND / "scripts" / "furrow", AROUND.parent.parent / "bin" / "furrow")
    found = named or next((str(place) for place in places if os.access(place, os.X_OK)), shutil.which("furrow"))
    if not found:
        raise FileNotFoundError("furrow is not found: set FURROW to the program")
    return found


def named_file(name: File) -> pathlib.Path:
    """A scenario or study: a path, or the name of a shipped one with or without .json."""
    path = pathlib.Path(name)
    if path.exists() or path.suffix == ".json":
        return path
    full = path.with_name(path.name + ".json")
    return full if full.exists() or path.parent == pathlib.Path(".") else path


@contextmanager
def as_file(content: File | Content, name: str) -> Iterator[pathlib.Path]:
    """A file as the program reads it; of a dict, one that is removed afterwards."""
    if not isinstance(content, Mapping):
        yield named_file(content)
        return
    with tempfile.TemporaryDirectory(prefix="furrow-") as folder:
        path = pathlib.Path(folder) / f"{name}.json"
        path.write_text(as_json(dict(content)), encoding="utf-8")
        try:
            yield path
        except FurrowError as error:  # which names a file that the caller does not know
            error.args = tuple(part.replace(str(path), name) if isinstance(part, str) else part for part in error.args)
            raise


class _Listener:
    """Reads what the program says, passes it on, and keeps what matters of it."""

    def __init__(self, stream: IO[str], show: bool) -> None:
        self.errors: list[str] = []
        self.last: list[str] = []
        self.folder: str | None = None
        self._show = show
        self._thread = threading.Thread(target=self._listen, args=(stream,), daemon=True)
        self._thread.start()

    def _listen(self, stream: IO[str]) -> None:
        for line in stream:
            if self._show:
                sys.stderr.write(line)
                sys.stderr.flush()
            text = line.rstrip("\n")
            if text.startswith("furrow: error: "):
                self.errors.append(text.removeprefix("furrow: error: "))
            if found := re.match(r"furrow: .*, results in (.+)$", text):
                self.folder = found[1]
            self.last = [*self.last[1 - KEPT:], text]

    def message(self) -> str:
        self._thread.join(10)
        return "\n".join(self.errors or [line for line in self.last if line])


def _wait(process: subprocess.Popen[str]) -> str:
    """What the program prints as its result. An interrupt stops it in its own way, with a checkpoint."""
    assert process.stdout
    try:
        out = process.stdout.read()
        process.wait()
        return out
    except BaseException:
        process.send_signal(signal.SIGINT)
        process.wait()
        raise


def call(arguments: Sequence[str], progress: bool) -> tuple[str, pathlib.Path | None]:
    """Runs the program to its end. Returns what it printed and the folder that it named on the way.

    Raises a FurrowError of its message, exit code and folder if it fails. KeyboardInterrupt stops it first.
    """
    with subprocess.Popen([program(), *arguments], text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True) as process:
        assert process.stderr
        listener = _Listener(process.stderr, progress)
        out = _wait(process)
        message = listener.message()
    folder = pathlib.Path(listener.folder) if listener.folder else None
    if process.returncode != 0:
        lines = out.splitlines()
        if folder is None and lines and pathlib.Path(lines[-1]).is_dir():
            folder = pathlib.Path(lines[-1])
        raise error_of(message, process.returncode, folder if folder and folder.is_dir() else None)
    return out, folder


def read_json(text: str) -> dict[str, Any]:
    found = json.loads(text)
    assert isinstance(found, dict)
    return found
