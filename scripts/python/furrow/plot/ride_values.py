"""Vibration of a seat or a body as ISO 2631-1 rates it: accelerations weighted by frequency, and figures of them.

ISO 2631-1:1997, annex A: the weighting W_k (vertical, seated or standing) is the product of a band limit (f1, f2), a
transition from acceleration to velocity (f3, f4, Q4) and an upward step (f5, Q5, f6, Q6), table A.1. Paragraph 6.2
gives the weighted mean square, 6.3.1 the running one (MTVV), 6.3.2 the fourth-power dose (VDV).
"""
import numpy as np

F1, F2, F3, F4, Q4, F5, Q5, F6, Q6 = 0.4, 100.0, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91  # Hz, -
Q_BAND = 1.0 / np.sqrt(2.0)  # of the two Butterworth filters
RUNNING = 1.0  # s, time constant of the running mean of MTVV


def weighting(frequency):
    """W_k as a complex factor. @param frequency Hz, from 0"""
    p = 2j * np.pi * np.asarray(frequency, float)
    w1, w2, w3, w4, w5, w6 = (2.0 * np.pi * f for f in (F1, F2, F3, F4, F5, F6))
    high = p ** 2 / (p ** 2 + w1 / Q_BAND * p + w1 ** 2)
    low = 1.0 / (1.0 + p / (Q_BAND * w2) + (p / w2) ** 2)
    transition = (1.0 + p / w3) / (1.0 + p / (Q4 * w4) + (p / w4) ** 2)
    step = (1.0 + p / (Q5 * w5) + (p / w5) ** 2) / (1.0 + p / (Q6 * w6) + (p / w6) ** 2) * (w5 / w6) ** 2
    return high * low * transition * step


def weighted(time, acceleration):
    """The weighted acceleration, m/s². @param time s, evenly spaced"""
    step = float(np.median(np.diff(time)))
    count = len(acceleration)
    padded = 2 * count  # what rings on does not come back at the start
    spectrum = np.fft.rfft(acceleration - np.mean(acceleration), padded)
    return np.fft.irfft(spectrum * weighting(np.fft.rfftfreq(padded, step)), padded)[:count]


def density(time, values, segments=8):
    """(frequencies Hz, power spectral density in units²/Hz) by Welch's method, Hann windows that overlap by half."""
    step = float(np.median(np.diff(time)))
    length = max(16, 2 * (len(values) // (segments + 1)))
    window = np.hanning(length + 1)[:-1]
    scale = 2.0 * step / np.sum(window ** 2)
    total, number = 0.0, 0
    for begin in range(0, len(values) - length + 1, length // 2):
        part = values[begin:begin + length]
        total = total + scale * np.abs(np.fft.rfft(window * (part - np.mean(part)))) ** 2
        number += 1
    if number == 0:
        raise ValueError("too few values for a density, expected 16 at least")
    return np.fft.rfftfreq(length, step), total / number


def ride_values(time, acceleration):
    """@returns {"rms": m/s², "weighted_rms": m/s², "mtvv": m/s², "vdv": m/s^1.75, "crest": weighted peak over weighted
    rms}"""
    a = weighted(time, acceleration)
    step = float(np.median(np.diff(time)))
    rms = float(np.sqrt(np.mean(a ** 2)))
    decay, running, most = np.exp(-step / RUNNING), 0.0, 0.0
    for value in a:
        running = decay * running + (1.0 - decay) * value * value
        most = max(most, running)
    return {"rms": float(np.std(acceleration)), "weighted_rms": rms, "mtvv": float(np.sqrt(most)),
            "vdv": float((np.sum(a ** 4) * step) ** 0.25), "crest": float(np.max(np.abs(a)) / rms)
            if rms > 0.0 else 0.0}


def in_words(weighted_rms):
    """Annex C.2.3: likely reactions in public transport; the ranges overlap, the milder of two is named first."""
    ranges = ((0.315, "not uncomfortable"), (0.63, "a little uncomfortable"), (1.0, "fairly uncomfortable"),
              (1.6, "uncomfortable"), (2.5, "very uncomfortable"))
    return next((words for limit, words in ranges if weighted_rms < limit), "extremely uncomfortable")
