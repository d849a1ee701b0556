"""Ride of a quarter car: the body's acceleration, weighted as ISO 2631-1 does it, and its spectrum."""
import numpy as np

from .digits import digits
from .ride_values import density, in_words, ride_values, weighted, weighting
from .run_data import Missing
from .style import BLUE, GREY, RED, panels

COLUMN = "body_acceleration_m_per_s2"


def ride(run):
    if COLUMN not in run.series:
        raise Missing("no body whose acceleration is measured")
    time, acceleration = run.column("time_s"), run.column(COLUMN)
    inside = time > run.number("average_from_s", 0.0)
    if inside.sum() < 64:
        raise Missing("too few values in the averaging window, expected 64 at least")
    time, acceleration = time[inside], acceleration[inside]
    values = ride_values(time, acceleration)
    figure, (top, bottom) = panels(run, 2, 7.5, sharex=False)
    top.plot(time, acceleration, color=GREY, lw=0.7, label=f"body, rms {digits(values['rms'])} m/s²")
    top.plot(time, weighted(time, acceleration), color=BLUE, lw=1.0,
             label=f"weighted by $W_k$, rms {digits(values['weighted_rms'])} m/s²: {in_words(values['weighted_rms'])}")
    top.set_ylabel("vertical acceleration (m/s²)")
    top.set_xlabel("time (s)")
    top.legend(loc="upper right", fontsize=8, title=f"MTVV {digits(values['mtvv'])} m/s², VDV {digits(values['vdv'])} m/s$^{{1.75}}$, "
               f"crest {digits(values['crest'])} (ISO 2631-1)", title_fontsize=8)
    frequency, power = density(time, acceleration)
    shown = (frequency > 0.0) & (frequency <= 100.0)
    bottom.loglog(frequency[shown], power[shown], color=GREY, lw=0.9, label="body")
    bottom.loglog(frequency[shown], power[shown] * np.abs(weighting(frequency[shown])) ** 2, color=RED, lw=0.9, label="weighted by $W_k$")
    bottom.set_ylabel("density (m²/s⁴/Hz)")
    bottom.set_xlabel("frequency (Hz)")
    bottom.legend(fontsize=8)
    return figure
