"""Ride of a quarter car or a half car: the body's acceleration, weighted as ISO 2631-1 does it, and its spectrum."""
import numpy as np

from .digits import digits
from .ride_values import density, in_words, ride_values, weighted, weighting
from .run_data import Missing
from .style import BLUE, GREEN, GREY, ORANGE, panels

COLUMN = "body_acceleration_m_per_s2"
BODY = "timeseries_body.csv"  # of a half car
COLOURS = (BLUE, ORANGE, GREEN)


def places(run):
    """[(where on the body, its table)]: of a half car the centre, above the front axle and above the rear one."""
    body = run.table(BODY)
    if COLUMN not in body:
        return [("body", run.series)]
    found = [("body's centre", body)]
    for k, where in enumerate(("above the front axle", "above the rear axle")):
        table = run.table(f"timeseries_wheel{k}.csv")
        if COLUMN in table:
            found.append((where, table))
    return found


def averaged(run, table):
    """(time s, acceleration m/s²) in the averaging window."""
    if COLUMN not in table or "time_s" not in table:
        raise Missing("no body whose acceleration is measured")
    inside = table["time_s"] > run.number("average_from_s", 0.0)
    if inside.sum() < 64:
        raise Missing("too few values in the averaging window, expected 64 at least")
    return table["time_s"][inside], table[COLUMN][inside]


def ride(run):
    shown = [(where, *averaged(run, table)) for where, table in places(run)]
    figure, axes = panels(run, len(shown) + 1, 3.0 * (len(shown) + 1) + 1.5, sharex=False)
    for axis, colour, (where, time, acceleration) in zip(axes, COLOURS, shown):
        values = ride_values(time, acceleration)
        axis.plot(time, acceleration, color=GREY, lw=0.7, label=f"{where}, rms {digits(values['rms'])} m/s²")
        axis.plot(time, weighted(time, acceleration), color=colour, lw=1.0,
                  label=f"weighted by $W_k$, rms {digits(values['weighted_rms'])} m/s²: "
                        f"{in_words(values['weighted_rms'])}")
        axis.set(ylabel="vertical acceleration (m/s²)", xlabel="time (s)")
        axis.legend(loc="upper right", fontsize=8,
                    title=f"MTVV {digits(values['mtvv'])} m/s², VDV {digits(values['vdv'])} m/s$^{{1.75}}$, "
                    f"crest {digits(values['crest'])} (ISO 2631-1)", title_fontsize=8)
        frequency, power = density(time, acceleration)
        low = (frequency > 0.0) & (frequency <= 100.0)
        axes[-1].loglog(frequency[low], power[low], color=colour, lw=0.9, alpha=0.5, label=where)
        axes[-1].loglog(frequency[low], power[low] * np.abs(weighting(frequency[low])) ** 2, color=colour, lw=1.2,
                        label=f"{where}, weighted by $W_k$")
    axes[-1].set(ylabel="density (m²/s⁴/Hz)", xlabel="frequency (Hz)")
    axes[-1].legend(fontsize=8)
    return figure
