"""Which page each kind of folder gets."""
from ..plot.calibrate import Calibration
from ..plot.kinematics import Kinematics
from ..plot.modes import Modes
from ..plot.press import Press
from ..plot.run_data import Run
from ..plot.soil import Soil
from ..plot.sweep import Sweep

from . import calibration_page, compare, run_page, study_page, test_pages


def has_frames(run):
    return isinstance(run, Run) and (run.directory / "frames").is_dir()


def fill(page, arrays, runs, sections):
    """Title, badges and sections of the page."""
    run = runs[0]
    if len(runs) > 1:
        compare.fill(page, arrays, runs, sections)
        return
    for kind, fill_it in ((Calibration, calibration_page.fill), (Press, test_pages.press),
                          (Modes, test_pages.modes), (Soil, test_pages.soil), (Kinematics, test_pages.kinematics),
                          (Sweep, study_page.fill), (Run, run_page.fill)):
        if isinstance(run, kind):  # presses and modes are read like a soil test
            fill_it(page, arrays, run, sections)
            return
