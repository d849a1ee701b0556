"""Results of `furrow COMMAND SCENARIO` that a study keeps: made once for each build and input."""
import json
import subprocess

import provenance


def furrow(*arguments):
    """What the program prints."""
    return subprocess.run([provenance.program(), *map(str, arguments)],
                          check=True, capture_output=True, text=True).stdout


class KeptResults:
    """Folders of results below `root`; with `finished_only` none is made."""

    def __init__(self, root):
        self.root, self.finished_only = root, False

    def folder_of(self, name, made, command, *more):
        """Of the results, made unless this build made them of the same input; None where it may not be made."""
        folder, stamp = self.root / name, self.root / f"{name}.stamp"
        key = json.dumps([provenance.build_of(provenance.program()), made, command, list(map(str, more))])
        if (folder / "summary.json").exists() and stamp.exists() and stamp.read_text() == key:
            return folder
        if self.finished_only:
            return None
        (self.root / f"{name}.json").write_text(json.dumps(made))
        furrow(command, self.root / f"{name}.json", *more, "--out", folder, "--overwrite", "--quiet")
        stamp.write_text(key)
        print(name, flush=True)
        return folder
