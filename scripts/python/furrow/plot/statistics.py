"""Mean, standard error and drift of a series whose samples hang together; as nodes/output/statistics.cpp has them."""
import dataclasses
import math

import numpy as np

WINDOW = 5.0  # lags that are summed, in integrated autocorrelation times
COSINES = 4  # that the slowest one is compared with
DRIFT_LIMIT = 3.495  # Student's t of as many degrees of freedom that 2.5 % of stationary series exceed


@dataclasses.dataclass
class Statistics:
    mean: float
    std: float = math.nan
    sem: float = math.inf  # standard error of the mean, std / √n_eff
    n_eff: float = 0.0  # number of independent samples
    change: float = 0.0  # from the first to the second half
    drift_t: float = 0.0

    @property
    def drifts(self):
        return abs(self.drift_t) > DRIFT_LIMIT


def autocorrelation_time(rest, variance):
    """Integrated, in samples; `rest` has no mean."""
    n = len(rest)
    # All lags at once by Fourier transform; zeros keep the ends apart.
    spectrum = np.abs(np.fft.rfft(rest, 2 * n)) ** 2
    correlation = np.fft.irfft(spectrum)[:n] / (n * variance)
    tau = 1.0
    lag = 1
    while lag < n // 2:
        tau += 2.0 * correlation[lag]
        if lag >= WINDOW * tau:
            break
        lag += 1
    return max(tau * (1.0 + (2 * lag + 1) / n), 1.0)


def statistics(values):
    values = np.asarray(values, float)
    n = len(values)
    found = Statistics(float(values.mean()) if n else math.nan)
    if n < 4 or not np.isfinite(found.mean):
        return found
    rest = values - found.mean
    variance = float(np.mean(rest ** 2))
    found.std = float(np.std(values, ddof=1))
    found.n_eff = n / autocorrelation_time(rest, variance) if variance > 0.0 else float(n)
    found.sem = found.std / math.sqrt(found.n_eff)
    found.change = float(values[n // 2:].mean() - values[:n // 2].mean())
    if n >= 2 * (COSINES + 1):
        phase = np.pi * (np.arange(n) + 0.5) / n
        waves = [math.sqrt(2.0 / n) * float(rest @ np.cos(j * phase)) for j in range(1, COSINES + 2)]
        others = math.sqrt(sum(wave ** 2 for wave in waves[1:]) / COSINES)
        found.drift_t = -waves[0] / others if others > 0.0 else 0.0
    return found
