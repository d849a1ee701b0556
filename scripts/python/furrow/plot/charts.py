"""Time series and rank shares."""
import matplotlib.pyplot as plt
import numpy as np

from .chart_table import WHEEL
from .digits import digits, with_error
from .run_data import Missing
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, mark_window, panels

SMOOTHING = 0.05  # s, width of the running mean drawn over noisy forces


def smooth(time, values):
    """Running mean over SMOOTHING, shorter at the ends; None when the series is too short for one."""
    if len(time) < 3:
        return None
    half = int(0.5 * SMOOTHING / max(float(np.median(np.diff(time))), 1e-12))
    if half < 2 or len(time) < 4 * half:
        return None
    total = np.concatenate([[0.0], np.cumsum(values)])
    index = np.arange(len(values))
    low, high = np.maximum(index - half, 0), np.minimum(index + half + 1, len(values))
    return (total[high] - total[low]) / (high - low)


def settled_limits(axis, run, *curves):
    """Limits that show what happens after touch-down; the impact itself may run out of the picture."""
    time = run.column("time_s")
    late = time > (run.window[0] if run.window else 0.4 * time[-1])
    if late.sum() < 10:
        return
    values = np.concatenate([curve[late] for curve in curves])
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    margin = 0.35 * (high - low)
    if margin > 0.0:
        axis.set_ylim(low - margin, high + margin)


def noisy(axis, time, values, colour, label):
    """A thin curve of the samples with its running mean over it."""
    mean = smooth(time, values)
    if mean is None:
        axis.plot(time, values, color=colour, label=label)
        return
    axis.plot(time, values, color=colour, alpha=0.3, lw=0.7)
    axis.plot(time, mean, color=colour, label=label)


def plain(axis, time, values, colour, label):
    axis.plot(time, values, color=colour, label=label)


def draw(axis, run, chart, colours, line=plain):
    """The columns of a chart that the run has, over time. @returns their values"""
    curves = chart.curves(run.series)
    for name, called, values in curves:
        line(axis, run.column("time_s"), values, dict(zip(chart.lines, colours))[name], called)
    axis.set(ylabel=chart.label, title=chart.heading + (" (thick: mean over 50 ms)" if line is noisy else ""))
    return [values for _, _, values in curves]


def pull_slip_sinkage(run):
    """Drawbar pull with its mean, slip and sinkage over time."""
    time, pull = run.column("time_s"), run.column("drawbar_pull_N")
    figure, (top, middle, bottom) = panels(run, 3, 9.0, gridspec_kw={"height_ratios": [2.2, 1, 1.3]})

    raw = run.series.get("drawbar_pull_raw_N")
    if raw is not None:
        top.plot(time, raw, color=GREY, lw=0.8, alpha=0.6, label="raw: force on the rail")
    draw(top, run, WHEEL["pull"], (BLUE,), noisy)
    statistics = run.summary.get("drawbar_pull_N") or {}
    mark_window(top, run, "averaging window")
    if run.measured and run.window and statistics.get("mean") is not None:
        mean, sem = statistics["mean"], statistics.get("sem") or np.nan
        share = run.number("drawbar_coefficient")
        text = f"mean {with_error(mean, sem)} N (standard error)" + (f" = {100 * share:.1f} % of load" if share else "")
        top.plot(run.window, [mean, mean], color=RED, lw=1.8, label=text)
        if np.isfinite(sem):
            top.fill_between(run.window, mean - sem, mean + sem, color=RED, alpha=0.3, lw=0)
        if not statistics.get("steady", False):
            reasons = statistics.get("unsteady_because") or ["see summary.json"]
            top.text(0.99, 0.02, "NOT STEADY\n" + "\n".join(reasons), transform=top.transAxes, ha="right",
                     va="bottom", color=RED, fontsize=8.5)
    theory = run.soil_estimate.get("drawbar_pull_N")
    if theory is not None:
        error = run.soil_estimate.get("drawbar_pull_standard_error_N")
        top.axhline(theory, color=ORANGE, ls="--", lw=1.5, label="soil theory for a rigid wheel, furrow soil's "
                    f"parameters: {with_error(theory, error) if error is not None else digits(theory)} N")
    top.axhline(0.0, color="black", lw=0.8)
    settled_limits(top, run, *([pull] if theory is None else [pull, np.full_like(pull, theory)]))
    top.legend(loc="upper right", ncol=1)

    run.column("slip")
    draw(middle, run, WHEEL["slip"], (GREEN,))
    middle.set_ylim(min(-0.05, 1.1 * np.nanmin(run.series["slip"])), max(1.05, 1.05 * np.nanmax(run.series["slip"])))
    mark_window(middle, run)

    run.column("sinkage_m")
    draw(bottom, run, WHEEL["sinkage"], (BLUE, ORANGE, GREEN))
    bottom.axhline(0.0, color="black", lw=0.8)
    mark_window(bottom, run)
    bottom.invert_yaxis()
    bottom.legend(loc="upper right")
    bottom.set(xlabel="time, s", xlim=(0.0, time[-1]))
    return figure


def forces(run):
    """Vertical force, forces along the travel and spindle torque over time."""
    time = run.column("time_s")
    figure, (top, middle, bottom) = panels(run, 3, 9.5)
    vertical = run.column("force_z_N")
    draw(top, run, WHEEL["vertical"], (BLUE,), noisy)
    if run.number("vertical_load_N"):
        top.axhline(run.number("vertical_load_N"), color=RED, ls="--", lw=1.2,
                    label=f"load (weight carried) {digits(run.number('vertical_load_N'))} N")
    settled_limits(top, run, vertical)

    shown = draw(middle, run, WHEEL["along"], (GREEN, RED, BLUE), noisy)
    middle.axhline(0.0, color="black", lw=0.8)
    if shown:
        settled_limits(middle, run, *shown)

    run.column("spindle_torque_Nm")
    draw(bottom, run, WHEEL["torque"], (PURPLE, SKY), noisy)
    radius = run.number("tire_radius_m")
    if radius and "tractive_effort_N" in run.series:
        mean = smooth(time, run.series["tractive_effort_N"] * radius)
        if mean is not None:
            bottom.plot(time, mean, color=GREEN, ls="--", lw=1.2, label="tractive effort × undeformed radius")
    settled_limits(bottom, run, run.series["spindle_torque_Nm"])
    bottom.set(xlabel="time, s", xlim=(0.0, time[-1]))
    for axis in (top, middle, bottom):
        mark_window(axis, run)
        axis.legend(loc="upper right")
    return figure


def unknowns(run, node):
    """What a node computes, as far as the summary says."""
    grains = run.told.get("grains")
    if node == "terrain" and grains:
        return f", {grains:,.0f} grains"
    wheels = run.told.get("wheels") or [run.told]
    number = node.removeprefix("tire ")
    if node.startswith("tire ") and number.isdigit() and int(number) < len(wheels):
        if found := wheels[int(number)].get("tire_coordinates"):
            return f", {found:,.0f} coordinates"
    return ""


def ranks(run):
    """How long each rank computed, communicated and waited."""
    table = run.told.get("ranks")
    if not table:
        raise Missing(f"{run.told_in} has no table of ranks")
    figure, axis = plt.subplots(figsize=(9, 1.8 + 0.55 * len(table)))
    names = [f"rank {r['rank']}: {r['node']}" + (f" ({r['kind']})" if r.get("kind") else "") + unknowns(run, r["node"])
             + f", {r['threads']} thread{'s' if r['threads'] != 1 else ''}" for r in table]
    compute = np.array([r["compute_s"] for r in table])
    communicate = np.array([r.get("communicate_s", 0.0) for r in table])
    wait = np.array([r["wait_s"] for r in table])
    position = np.arange(len(table))
    axis.barh(position, compute, color=BLUE, label="computing")
    axis.barh(position, communicate, left=compute, color="#e0a030", label="communicating")
    busy = compute + communicate
    axis.barh(position, wait, left=busy, color="#d0d0d0", label="waiting for others")
    longest = max((busy + wait).max(), 1e-12)
    for i, r in enumerate(table):
        share = r.get("busy_share")
        text = f"{100 * share:.0f} % busy" if share is not None else ""
        axis.text(busy[i] + wait[i] + 0.01 * longest, i, f"{text}, {r['cpu_s']:.0f} s CPU", va="center", fontsize=9)
    axis.set_yticks(position, names)
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set(xlim=(0.0, 1.3 * longest), xlabel="wall time of the stepping loop, s")
    per_second = run.told.get("wall_s_per_simulated_s")
    axis.set_title(f"{run.title}\nTime that each rank computes and waits"
                   + (f" · {per_second:.1f} s of wall time per simulated second" if per_second else ""))
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncol=3)
    return figure
