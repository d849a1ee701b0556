#!/usr/bin/python3
"""Charts of the studies' CSV files, beside them: step_size.png, tire_step.png, rigid_ground.png, budget.png."""
import argparse
import pathlib
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))
import plot.style  # noqa: E402, F401  the look of all plots
import provenance  # noqa: E402


def table(name):
    return provenance.read_table(HERE / f"{name}.csv")


def mark_unsteady(axes, points):
    """Draws (x, y, row of the table) that are not steady as open points."""
    for x, y, row in points:
        if row.get("drawbar_pull_N.steady", "").lower() == "false":
            axes.plot([x], [y], marker="o", mfc="white", mec="black", ls="none", zorder=5)
            axes.set_title(axes.get_title().removesuffix(" (open: not steady)") + " (open: not steady)")


def step_size():
    """Mean drawbar pull over the step, one line per contact law, bars of two standard errors."""
    lines, all_points = {}, []
    for row in table("step_size"):
        law, share = re.fullmatch(r"(.*)_step_1(?:_(\d+))?", row["case"]).groups()
        lines.setdefault(law, []).append((60.0 / int(share or 1), float(row["drawbar_pull_N.mean"]),
                                          2.0 * float(row["drawbar_pull_N.sem"])))
        all_points.append((*lines[law][-1][:2], row))
    names = {"mindlin": "Hertz–Mindlin with history", "hertz_tanh_limited": "tanh friction, impulse limit on",
             "hertz_tanh_unlimited": "tanh friction as in the report"}
    figure, axes = plt.subplots(figsize=(6.4, 4.0))
    for (law, points), marker in zip(lines.items(), "os^"):
        step, pull, bar = zip(*sorted(points))
        axes.errorbar(step, pull, bar, marker=marker, capsize=3, label=names[law])
    axes.set(xscale="log", xlabel="step in µs", ylabel="drawbar pull in N",
             title="Rigid wheel, slip 0.3, bed of 10 mm grains")
    axes.set_xticks([15, 30, 60], ["15", "30", "60"])
    axes.minorticks_off()
    axes.axhline(0.0, color="0.8", zorder=0)
    mark_unsteady(axes, all_points)
    axes.legend()
    save(figure, "step_size")


def tire_step():
    """Drawbar pull, and energy lost or gained at the interface, over the communication step, one line per damping
    time."""
    lines, all_points = {}, []
    for row in table("tire_step"):
        found = re.fullmatch(r"tau_([\d.]+)ms_step_([\de-]+)_seed_(\d+)", row["case"])
        if found:
            tau, step, seed = found.groups()
            lines.setdefault((float(tau), seed), []).append(
                (1e6 * float(step), float(row["drawbar_pull_N.mean"]), 2.0 * float(row["drawbar_pull_N.sem"]),
                 100.0 * float(row["interface_energy_error_abs_J"]) / float(row["spindle_work_J"])))
            all_points.append((*lines[float(tau), seed][-1][:2], row))
    figure, (pull, error) = plt.subplots(1, 2, figsize=(9.6, 4.0))
    markers = {2.5: "v", 5.0: "o", 10.0: "s", 20.0: "D"}
    for (tau, seed), points in sorted(lines.items()):
        step, mean, bar, share = zip(*sorted(points))
        label = f"τ = {tau:g} ms, seed {seed}"
        pull.errorbar(step, mean, bar, marker=markers[tau], capsize=3, label=label)
        error.plot(step, share, marker=markers[tau], label=label)
    pull.set(xlabel="step in µs", ylabel="drawbar pull in N", title="Small rig, slip 0.3, 4.6 kN")
    error.set(xlabel="step in µs", ylabel="Σ|energy error| / spindle work in %",
              yscale="log", title="Interface of tire and soil")
    for axes in (pull, error):
        axes.set(xscale="log")
        axes.set_xticks([40, 100, 200, 400], ["40", "100", "200", "400"])
        axes.minorticks_off()
    mark_unsteady(pull, all_points)
    pull.legend()
    figure.tight_layout()
    save(figure, "tire_step")


def rigid_ground():
    """Drawbar pull over load against slip on hard ground."""
    lines, all_points = {}, []
    for row in table("rigid_ground"):
        found = re.fullmatch(r"(flexible|rigid)_c(\d+)_slip_([\d.]+)", row["case"])
        if found:
            tire, c, slip = found.groups()
            lines.setdefault((tire, c), []).append((float(slip), float(row["drawbar_coefficient"])))
            all_points.append((*lines[tire, c][-1], row))
    figure, axes = plt.subplots(figsize=(6.4, 4.0))
    for (tire, c), points in lines.items():
        axes.plot(*zip(*sorted(points)), marker="o" if tire == "flexible" else "s",
                  linestyle="-" if c == "50" else "--", label=f"{tire} tire, c = {c} s/m")
    axes.axhline(0.9, color="0.8", zorder=0)
    axes.annotate("friction 0.9", (0.5, 0.9), (0, 4), textcoords="offset points", ha="right", va="bottom", color="0.5")
    axes.set(xlabel="slip", ylabel="drawbar pull / load", title="Hard ground, 4.6 kN, 200 kPa")
    mark_unsteady(axes, all_points)
    axes.legend()
    save(figure, "rigid_ground")


def budget():
    """What every variant of the small rig changes in pull and sinkage, of those of its reference, with 95 % intervals
    over beds."""
    rows = table("budget")
    mean = {row["variant"]: row for row in rows}
    rows = [row for row in rows if row["variant"] != row["reference"]][::-1]
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(9.6, 1.2 + 0.24 * len(rows)))
    for axes, name, title in zip(panels, ("pull_N", "sinkage_mm"), ("pull", "sinkage")):
        for place, row in enumerate(rows):
            scale = 100.0 / float(mean[row["reference"]][name])
            change, half = (scale * float(row[f"{name}_{what}"] or "nan") for what in ("change", "change_half_95"))
            seen = abs(change) > half
            axes.errorbar([change], [place], xerr=[half], marker="o", capsize=3, color="C1" if seen else "C0",
                          mfc="white" if int(row["not_steady"]) else None)
        axes.axvline(0.0, color="0.6", zorder=0)
        axes.set(xlabel=f"change of {title} in %")
    panels[0].set_yticks(range(len(rows)), [row["variant"] for row in rows])
    figure.suptitle("Five beds each, 95 %; orange: interval without 0; open: a bed was not steady", fontsize="medium")
    figure.tight_layout()
    save(figure, "budget")


def save(figure, name):
    figure.savefig(HERE / f"{name}.png", dpi=110)


CHARTS = {"step_size": step_size, "tire_step": tire_step, "rigid_ground": rigid_ground, "budget": budget}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("charts", nargs="*", help=f"of {', '.join(CHARTS)}; all without")
    chosen = parser.parse_args().charts or list(CHARTS)
    if unknown := set(chosen) - set(CHARTS):
        parser.error(f"'{min(unknown)}' is no chart, expected of: {', '.join(CHARTS)}")
    for name in chosen:
        if (HERE / f"{name}.csv").exists():
            CHARTS[name]()


if __name__ == "__main__":
    main()
