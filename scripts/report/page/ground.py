"""The ground before and after a run, as the page shows it."""
import numpy as np

MOST_CELLS = 60000


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
