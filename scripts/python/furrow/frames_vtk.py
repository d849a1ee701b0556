"""The frames of a run as VTP files, for any VTK or ParaView; the names of the lists (PVD) on stdout.

usage: python3 -m furrow frames_vtk --out FOLDER DIR

FOLDER, which must be new or empty, then holds tire<k>_<index>.vtp, terrain_<index>.vtp and <kind>.pvd, which lists the
files of a kind by time. scripts/python/paraview_run.py shows such a folder in ParaView.
Exit codes: 0 files were written, 2 FOLDER is not new or the run has no frames, 5 a file could not be read or written.
"""
import argparse
import pathlib
import sys

from .plot import frames, vtk
from .plot.run_data import Run


def kinds_of(run):
    """{"tire0": frames, …, "terrain": frames} of what the folder holds."""
    found, wheel = {}, 0
    while files := run.frames(f"tire{wheel}"):
        found[f"tire{wheel}"] = frames.Frames(frames.TireFrame, files)
        wheel += 1
    if files := run.frames("terrain"):
        found["terrain"] = frames.Frames(frames.GrainFrame, files)
    return found


class Taken:
    """The same frames, one after the other."""

    def __init__(self, kinds, tell):
        """@param tell  print the share that is done, for `furrow` to show"""
        self.done, self.total, self.tell = 0, sum(len(frames) for frames in kinds.values()), tell
        self.path = None  # of the frame that was taken last
        self.kinds = {kind: self.taken(frames) for kind, frames in kinds.items()}

    def taken(self, frames):
        for frame in frames:
            if self.tell:
                print(f"progress {self.done / self.total:.4f}", flush=True)
            self.done += 1
            self.path = frame.path
            yield frame


def remove_files(folder, kinds):
    """What was written of these, so that the same command can be given again."""
    for kind in kinds:
        for file in (*folder.glob(f"{kind}_*.vtp"), folder / f"{kind}.pvd"):
            file.unlink(missing_ok=True)


def fail(what, code):
    print(f"furrow: error: {what}", file=sys.stderr)
    return code


def main():
    parser = argparse.ArgumentParser(description="Frames of a run as VTP files.")
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="new folder for the files")
    parser.add_argument("--progress", action="store_true",
                        help="print the share that is done, 'progress 0.25', now and then")
    arguments = parser.parse_args()
    out, taken = arguments.out, None
    try:
        if out.exists() and (not out.is_dir() or any(out.iterdir())):
            return fail(f"command line: key '--vtk': {out} exists and is not an empty folder, expected a new one", 2)
        kinds = kinds_of(Run(arguments.directory))
        if not kinds:
            return fail(f"{arguments.directory}: has no frames, expected a run with output.frame_interval above 0", 2)
        taken = Taken(kinds, arguments.progress)
        vtk.write_kinds(out, taken.kinds)
    except (OSError, RuntimeError, ValueError) as error:  # h5py's errors for a damaged file are among them
        if taken:
            remove_files(out, taken.kinds)
        return fail(f"{taken.path if taken and taken.path else arguments.directory}: {error}", 5)
    for kind in kinds:
        print(out / f"{kind}.pvd")
    return 0
