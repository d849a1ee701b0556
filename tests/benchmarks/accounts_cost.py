#!/usr/bin/python3
"""Which share of a run's processor time its accounts take: samples of `perf` on all ranks, by function.

usage: accounts_cost.py [--scenario rigs/drawbar_pull_small_report_soil.json] [--runs 3] [--csv FILE]
                        [-- --set KEY=VALUE ...]

Functions that only accounts need are counted by their names (ACCOUNTS below). Sums that the compiler moved into other
functions are not seen. Shares of processor time hardly depend on what else the machine does. The bed is settled before.
Needs Debian's linux-perf and a program with its symbols, as the build leaves it.
"""
import collections
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402
import provenance  # noqa: E402

ACCOUNTS = re.compile(
    r"PairForces<.*>::sample\b|sample_of<|spring_losses<|ContactSampleOf|take_samples|EnergyAccounts::|"
    r"dem::stored_energy|reported_energies|::book_loss(es)?\b|ShellCarcass::account\b|output::Accounts::|"
    r"output::(energy|momentum)_account|output::tire_residual|rigs::RigAccounts|add_normal_loss|add_shear_losses")


def record(words, folder):
    """{(process, function): samples} of one run."""
    data = folder / "perf.data"
    driver.furrow("run", *words, "--overwrite", "--no-plots", "--out", folder / "run",
                  before=["perf", "record", "-e", "cpu-clock", "-F", "997", "-o", data, "--"])
    text = subprocess.run(["perf", "script", "-i", data, "-F", "pid,ip,sym"],
                          check=True, capture_output=True, text=True).stdout
    found = re.findall(r"^\s*(\d+)\s+[0-9a-f]+\s+(.*)$", text, re.MULTILINE)
    return collections.Counter((int(process), function) for process, function in found)


def shares(counted):
    """{function: share of all ranks' samples}"""
    if not any("GrainSolver" in function for _, function in counted):
        sys.exit(f"{provenance.program()}: perf finds no names of functions in it")
    of_process = collections.Counter()
    for (process, _), samples in counted.items():
        of_process[process] += samples
    ranks = {process: samples for process, samples in of_process.items() if samples > 0.002 * of_process.total()}
    functions = collections.Counter()
    for (process, function), samples in counted.items():
        if process in ranks and ACCOUNTS.search(function):
            functions[re.sub(r"\(.*", "", function)] += samples / sum(ranks.values())
    return functions


def main():
    parser = driver.options(__doc__, scenario={"default": "rigs/drawbar_pull_small_report_soil.json"},
                            runs={"type": int, "default": 3}, csv={"type": pathlib.Path})
    parser.add_argument("words", nargs="*", help="further words for `furrow run`")
    arguments = parser.parse_args()
    words = [arguments.scenario, "--set", "output.frame_interval=0", *arguments.words]
    rows, sums = [], []
    with tempfile.TemporaryDirectory() as name:
        driver.furrow("run", *words, "--set", "run.end=0.1", "--set", "run.average_from=0.05", "--no-plots", "--out",
                      pathlib.Path(name) / "settle")
        for run in range(1, arguments.runs + 1):
            found = shares(record(words, pathlib.Path(name)))
            sums.append(found.total())
            rows += [{"run": run, "function": function, "share": f"{share:.5f}"}
                     for function, share in (*found.most_common(), ("all", sums[-1])) if share >= 1e-5]
            print(f"run {run}: accounts take {100 * sums[-1]:.2f} % of the ranks' processor time", flush=True)
    print(f"mean of {len(sums)} runs: {100 * statistics.mean(sums):.2f} %, "
          f"from {100 * min(sums):.2f} to {100 * max(sums):.2f}")
    if arguments.csv:
        driver.write(arguments.csv.absolute(), rows)


if __name__ == "__main__":
    main()
