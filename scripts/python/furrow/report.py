"""Plots of a run, of soil tests, of a pressed tire, of its natural frequencies, of a vehicle's suspensions, of a study
or of a calibration: PNG files in the run directory, and report.html, a page with all of it; their names, without the
folder, as a JSON list on stdout.

usage: python3 -m furrow report DIR [--out FOLDER] [--only NAME]... [--quiet] [--progress]
       python3 -m furrow report DIR DIR... --out FOLDER    one report.html that compares the runs

Every plot is made from what the directory holds; a plot whose data are missing is left out, and a message on stderr
says so. Exit codes: 0 at least one plot was written, 5 a file could not be read or written.
"""
import argparse
import io
import json
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads cost more than they save
import matplotlib  # noqa: E402

matplotlib.use("Agg")

from .plot import kinds  # noqa: E402
from .plot.digits import with_error  # noqa: E402
from .plot.own_files import may_write, remove_own, write_whole  # noqa: E402
from .plot.run_data import PROBLEMS, Damaged, Missing, Run, in_words, printable, why_no_folder  # noqa: E402


quiet = False  # set by --quiet
WORK = {"scene": 20, "page": 10}  # of most plots: 1; the shares of the progress follow from it


def note(text):
    """A message that is no error: --quiet leaves it out."""
    if not quiet:
        print(f"report: {text}", file=sys.stderr)


def tell_share(names, k):
    """How much is done before plot `k` of `names`, for `furrow` to show."""
    work = [WORK.get(name, 1) for name in names]
    print(f"progress {sum(work[:k]) / sum(work):.4f}", flush=True)


def words(run):
    """What a reader must know of the result besides the plots."""
    if run.cut_short:
        note(run.cut_short)
    for what, found in (run.summary.get("accounts") or {}).items():
        if isinstance(found, dict) and found.get("closes") is False:
            note(f"the account of {printable(what)} DOES NOT CLOSE: see accounts of summary.json")
    pull = run.summary.get("drawbar_pull_N") or {}
    if pull.get("mean") is None:
        return
    if not run.measured:
        note("the tire did not touch the terrain in the averaging window: nothing was measured")
        return
    if run.window is None:
        raise Damaged("summary.json: key 'drawbar_pull_N': lacks from_s and to_s, the window of the mean")
    note(f"drawbar pull {with_error(pull['mean'], pull.get('sem'))} N (standard error of this run) "
         f"from {run.window[0]:.3g} to {run.window[1]:.3g} s")
    if not pull.get("steady", False):
        reasons = "; ".join(map(printable, pull.get("unsteady_because") or
                                ["the averaging window is not long or even enough"]))
        note(f"this pull is NOT STEADY: {reasons}")


def fail(subject, what):
    print(f"furrow: error: {printable(subject)}: {what}", file=sys.stderr)
    return 5


def draw(plot, run, out, name):
    """Makes one picture. @returns whether it was written; None: there is none"""
    try:
        figure = plot(run)
    except Missing as reason:
        note(f"no {name}: {reason}")
        return remove_own(out, name)
    except PROBLEMS as error:
        return print(f"report: no {name}: {in_words(error)}", file=sys.stderr)
    picture = io.BytesIO()
    if write := may_write(out, name):
        figure.savefig(picture, format="png", dpi=130)
        write_whole(out / name, picture.getvalue())
    matplotlib.pyplot.close(figure)
    return write


def main():
    parser = argparse.ArgumentParser(description="Plots of a run as PNG files.")
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("others", type=pathlib.Path, nargs="*", help="further runs: one page that compares all of them")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the plots (default: the run directory)")
    parser.add_argument("--only", action="append", help="this plot only; may be repeated", choices=sorted(kinds.ALL))
    parser.add_argument("--quiet", action="store_true", help="print errors only")
    parser.add_argument("--progress", action="store_true",
                        help="print the share that is done, 'progress 0.25', before each plot")
    arguments = parser.parse_args()
    global quiet
    quiet = arguments.quiet
    directory, out = arguments.directory, arguments.out or arguments.directory
    if arguments.others:
        from . import page
        return page.compare([directory, *arguments.others], arguments.out or pathlib.Path("."), may_write)
    try:
        run = kinds.opened(directory)
    except PROBLEMS as error:
        return fail(directory, in_words(error))
    if why := why_no_folder(out):
        return fail(out, why)
    plots, written, in_the_way = kinds.plots_of(run), [], False
    names = [*(arguments.only or plots), "page"]
    for k, name in enumerate(names[:-1]):
        if arguments.progress:
            tell_share(names, k)
        try:
            made = draw(plots[name], run, out, f"{name}.png")
        except OSError as error:
            return fail(out / f"{name}.png", error)
        written += [f"{name}.png"] if made else []
        in_the_way |= made is False
    if isinstance(run, Run):
        try:
            words(run)
        except Damaged as error:
            return fail(directory, in_words(error))
    if (written or in_the_way or (directory / "summary_failed.json").is_file()) and not arguments.only:
        if arguments.progress:
            tell_share(names, len(names) - 1)
        from . import page
        written += page.write(out, [run], may_write)
    print(json.dumps(written))
    if written:
        return 0
    if in_the_way:
        return fail(out, "no plot was written, as other files have their names, expected another folder")
    before = directory / ".furrow-before"
    hint = f"; {before} holds earlier results, which 'furrow resume' brings back" if before.is_dir() else ""
    return fail(directory, f"holds nothing to plot{printable(hint)}")
