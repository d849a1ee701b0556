#!/usr/bin/python3
"""Charts of the studies' CSV files, beside them: rigid_ground.png, budget.png, slip.png, lete_sand.png,
report_law.png."""
import re

import driver
import provenance
from soil_theory import LOAD


def opened(axes, x, y, marker, colour):
    """An open marker over the point of what is not steady."""
    axes.plot(x, y, marker=marker, mfc="white", mec=colour, ls="none", zorder=5)


def rigid_ground():
    """Drawbar pull over load against slip on hard ground."""
    lines, unsteady = {}, []
    for row in provenance.read_table(driver.HERE / "rigid_ground.csv"):
        if found := re.fullmatch(r"(flexible|rigid)_c(\d+)_slip_([\d.]+)", row["case"]):
            tire, c, slip = found.groups()
            point = float(slip), float(row["drawbar_coefficient"])
            lines.setdefault((tire, c), []).append(point)
            if row.get("drawbar_pull_N.steady", "").lower() == "false":
                unsteady.append(point)
    figure, axes = driver.subplots(figsize=(6.4, 4.0))
    for (tire, c), points in lines.items():
        axes.plot(*zip(*sorted(points)), marker="o" if tire == "flexible" else "s",
                  linestyle="-" if c == "50" else "--", label=f"{tire} tire, c = {c} s/m")
    axes.axhline(0.9, color="0.8", zorder=0)
    axes.annotate("friction 0.9", (0.5, 0.9), (0, 4), textcoords="offset points", ha="right", va="bottom", color="0.5")
    for point in unsteady:
        opened(axes, *point, "o", "black")
    driver.label(axes, "slip", "drawbar pull / load", "Hard ground, 4.6 kN, 200 kPa"
                 + (" (open: not steady)" if unsteady else ""), 10)
    driver.save(figure, "rigid_ground", 110)


def budget():
    """What every variant of the small rig changes in pull and sinkage, of those of its reference, with 95 % intervals
    over beds."""
    rows = provenance.read_table(driver.HERE / "budget.csv")
    mean = {row["variant"]: row for row in rows}
    rows = [row for row in rows if row["variant"] != row["reference"]][::-1]
    figure, panels = driver.subplots(1, 2, sharey=True, figsize=(9.6, 1.2 + 0.24 * len(rows)))
    for axes, name, title in zip(panels, ("pull_N", "sinkage_mm"), ("pull", "sinkage")):
        for place, row in enumerate(rows):
            scale = 100.0 / float(mean[row["reference"]][name])
            change, half = (scale * float(row[f"{name}_{what}"] or "nan") for what in ("change", "change_half_95"))
            axes.errorbar([change], [place], xerr=[half], marker="o", capsize=3,
                          color="C1" if abs(change) > half else "C0", mfc="white" if int(row["not_steady"]) else None)
        axes.axvline(0.0, color="0.6", zorder=0)
        axes.set(xlabel=f"change of {title} in %")
    panels[0].set_yticks(range(len(rows)), [row["variant"] for row in rows])
    figure.suptitle("Five beds each, 95 %; orange: interval without 0; open: a bed was not steady", fontsize="medium")
    figure.tight_layout()
    driver.save(figure, "budget", 110)


def lete_sand():
    """Pull and gross traction of the shipped example against slip, with 95 % intervals over beds, beside the report's
    soil and the regressions for the cone index of the sand. Open: more than a quarter of the beds is not steady."""
    rows = provenance.read_table(driver.HERE / "lete_sand_slip.csv")
    means = [row for row in rows if not row["seed"]]
    old = {float(row["variant"].removeprefix("slip ")) if row["variant"] != "base" else 0.3: row
           for row in provenance.read_table(driver.HERE / "budget.csv")
           if row["variant"] == "base" or row["variant"].startswith("slip ")}
    figure, panels = driver.subplots(1, 2, sharey=True, figsize=(9.6, 4.2))
    names = {"mason": "Mason 2018 (sand)", "wes_sand": "WES (sand)", "brixius_radial": "Brixius, radial (loam)",
             "wismer_luth": "Wismer–Luth (loam)"}
    for axes, what, of_old, title in zip(panels, ("pull", "gross"), ("pull", "tractive_effort"),
                                         ("drawbar pull / load", "gross traction / load")):
        slips = [float(row["slip"]) for row in means]
        axes.errorbar(slips, [float(row[f"{what}_N"]) / LOAD for row in means], capsize=3, marker="o", color="C0",
                      yerr=[float(row[f"{what}_N_half"] or 0.0) / LOAD for row in means], label="LETE sand")
        for slip, row in zip(slips, means):
            if int(row["steady"]) < 0.75 * int(row["beds"]):
                opened(axes, slip, float(row[f"{what}_N"]) / LOAD, "o", "C0")
        axes.errorbar(list(old), [float(row[f"{of_old}_N"]) / LOAD for row in old.values()], capsize=3, marker="s",
                      yerr=[float(row[f"{of_old}_N_half_95"]) / LOAD for row in old.values()], color="C1", ls="none",
                      label="the report's soil, bed 113 mm deep")
        for slip, row in old.items():
            if int(row["not_steady"]) > 0.25 * int(row["beds"]):
                opened(axes, slip, float(row[f"{of_old}_N"]) / LOAD, "s", "C1")
        for k, (name, text) in enumerate(names.items()):
            key = f"{name}_{'net' if what == 'pull' else 'gross'}_N"
            points = [(slip, float(row[key]) / LOAD) for slip, row in zip(slips, means) if row.get(key)]
            if name == "wes_sand" and what == "pull":  # at 20 % slip alone
                points = [point for point in points if abs(point[0] - 0.2) < 0.01]
            sand = name in ("mason", "wes_sand")
            if points:
                axes.plot(*zip(*points), ls="-" if sand else ":", color=f"C{k + 2}" if sand else f"{0.5 + 0.1 * k}",
                          marker="x" if len(points) == 1 else None, label=text)
        axes.axhline(0.0, color="0.8", zorder=0)
        driver.label(axes, "slip, of the undeformed radius", title)
    figure.tight_layout()
    driver.save(figure, "lete_sand", 110)


def slip():
    """Drawbar pull against slip on two cohesions, one bed each, ± one standard error."""
    rows = provenance.read_table(driver.HERE / "slip.csv")
    figure, axes = driver.subplots(figsize=(6.4, 4.0))
    for cohesion in sorted({float(row["terrain.cohesion"]) for row in rows}):
        line = [[float(row[name]) for name in ("rig.slip", "drawbar_pull_N.mean", "drawbar_pull_N.sem")]
                for row in rows if float(row["terrain.cohesion"]) == cohesion]
        axes.errorbar(*zip(*sorted(line)), marker="o", capsize=3, label=f"cohesion {cohesion / 1e3:g} kPa")
    driver.label(axes, "slip", "drawbar pull, N", "One bed each, ± one standard error", 10)
    driver.save(figure, "slip", 110)


def report_law():
    """Figs 8, 13, 14 to 16 and 20 of the 2016 report with its own contact law on the small rig; 95 % over beds. Steps
    of 60 µs, the other two of one bed. Open: not all beds are steady."""
    def table(name):
        return provenance.read_table(driver.HERE / f"report_law{name}.csv")

    def points(axes, rows, x, y, label, **look):
        places = sorted({float(row[x]) for row in rows})
        means = [driver.over_beds([float(row[y]) for row in rows if float(row[x]) == place]) for place in places]
        steady = all(int(row["steady"]) for row in rows)
        beds = len({row["seed"] for row in rows})
        halves = [half for _, half in means] if beds > 1 else None
        axes.errorbar(places, [mean for mean, _ in means], halves, marker="o", capsize=3, label=label,
                      mfc=None if steady else "white", **look)

    rows = table("")
    figure, panels = driver.subplots(1, 4, figsize=(13, 3.6), layout="constrained")
    small = table("_small_steps")
    of_step = {60: rows} | {step: [row for row in small if float(row["step_us"]) == step] for step in (20, 6)}
    for (step, found), line in zip(of_step.items(), ("-", "--", ":")):
        slips = [row for row in found if row["case"].startswith("slip") and float(row["slip"]) < 1.0]
        points(panels[0], slips, "slip", "pull_N", f"{step} µs", color="C0", linestyle=line)
        at_slip = [row for row in found if row["case"].startswith("cohesion") or row["case"] == "slip 0.3"]
        for k, (name, label) in enumerate((("gross_N", "tractive effort"), ("resistance_N", "resistance"),
                                           ("pull_N", "net force"))):
            points(panels[1], at_slip, "cohesion_kPa", name, label if step == 60 else None, color=f"C{k}",
                   linestyle=line)
    driver.label(panels[0], "slip", "drawbar pull, N", "Fig. 8")
    driver.label(panels[1], "cohesion, kPa", "force, N", "Figs 14 to 16, slip 0.3")
    over_time = table("_resistance")
    for name in over_time[0]:
        if name.startswith("resistance_"):
            panels[2].plot([float(row["time_s"]) for row in over_time], [float(row[name]) for row in over_time],
                           label=name.split("_")[1] + " kPa")
    driver.label(panels[2], "time, s", "resistance, N", "Fig. 13, slip 0.3")
    passes = [row for row in table("_passes") if row["case"] == "cohesion 80 kPa"]
    points(panels[3], passes, "pass", "pull_N", "drawbar pull", color="C0")
    sinkage = panels[3].twinx()
    points(sinkage, passes, "pass", "sinkage_mm", "sinkage", color="C1")
    sinkage.set(ylim=(0, None))
    sinkage.set_ylabel("sinkage, mm", color="C1")
    panels[3].set(xticks=(1, 2, 3), ylim=(0, None))
    driver.label(panels[3], "pass", "drawbar pull, N", "Fig. 20, slip 0.3", 0)
    panels[3].yaxis.label.set_color("C0")
    driver.save(figure, "report_law", 100)


CHARTS = {"rigid_ground": rigid_ground, "budget": budget, "slip": slip, "lete_sand": lete_sand,
          "report_law": report_law}


def main():
    parser = driver.options(__doc__)
    parser.add_argument("charts", nargs="*", help=f"of {', '.join(CHARTS)}; all without")
    chosen = parser.parse_args().charts or list(CHARTS)
    if unknown := set(chosen) - set(CHARTS):
        parser.error(f"'{min(unknown)}' is no chart, expected of: {', '.join(CHARTS)}")
    for name in chosen:
        CHARTS[name]()


if __name__ == "__main__":
    main()
