"""The ground before and after a run, as the page shows it."""
import numpy as np

from . import blocks

MOST_CELLS = 60000


def unchanged(run, arrays):
    """Of hard ground, which no wheel changes: the plot of its height along the path, without a line where it is level.
    None where the ground changes."""
    before, after = run.heights()
    if before.z.shape != after.z.shape or not np.array_equal(before.z, after.z, equal_nan=True):
        return None
    along = after.z[:, after.z.shape[1] // 2]
    lines = [{"label": "height", "x": arrays.add(after.x, exact=True),
              "y": arrays.add(1e3 * along), "style": "line"}] if np.ptp(along) > 0 else []
    return {**blocks.chart("Height of the ground along the path", "x", "m", "mm", lines), "wide": True}


def rut(run, arrays):
    """The block of the height field; raises Missing where there is none."""
    before, after = run.heights()
    z, first = after.z, before.z
    if z.shape != first.shape:
        raise ValueError("the height fields before and after differ in size")
    step = max(1, int(np.ceil(np.sqrt(z.size / MOST_CELLS))))
    z, first = z[::step, ::step], first[::step, ::step]
    return {"type": "ground", "nx": z.shape[0], "ny": z.shape[1], "x0": float(after.x[0]), "y0": float(after.y[0]),
            "cell": float(after.cell * step), "before": arrays.add(1e3 * first), "after": arrays.add(1e3 * z)}
