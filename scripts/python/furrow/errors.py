"""What can go wrong."""
from __future__ import annotations

import pathlib


class FurrowError(RuntimeError):
    """The program did not do what it was asked for.

    `str(error)` is the program's own message, `exit_code` its exit code and `directory` the folder of the results where
    there is one: a run that failed can be opened like any other. The subclasses stand for the exit codes.
    """

    def __init__(self, message: str, exit_code: int, directory: pathlib.Path | None = None) -> None:
        super().__init__(message)
        self.exit_code = exit_code
        self.directory = directory


class BadInput(FurrowError, ValueError):
    """Exit code 2: a file, a key or an option is not as expected. Nothing was written."""


class PhysicsFailed(FurrowError):
    """Exit code 3: the simulation cannot continue. What was measured until then is in `directory`."""


class RankLost(FurrowError):
    """Exit code 4: a process of the run died."""


class InputOutputError(FurrowError, OSError):
    """Exit code 5: a file could not be read or written."""


class LimitReached(FurrowError, MemoryError):
    """Exit code 6: memory or another limit of the machine ran out."""


class ProgramFault(FurrowError):
    """Exit code 70: a fault of the program itself, which its message asks to report."""


class Stopped(FurrowError):
    """Exit code 75: the program was stopped by a signal. `furrow resume` continues the run."""


BY_EXIT_CODE: dict[int, type[FurrowError]] = {2: BadInput, 3: PhysicsFailed, 4: RankLost, 5: InputOutputError,
                                              6: LimitReached, 70: ProgramFault, 75: Stopped}


def error_of(message: str, exit_code: int, directory: pathlib.Path | None) -> FurrowError:
    return BY_EXIT_CODE.get(exit_code, FurrowError)(message, exit_code, directory)
