"""The readers and plots of scripts/plot, which `furrow report` uses as well: this package reads and draws by them."""
from __future__ import annotations

import importlib
import importlib.util
import pathlib
import sys
from functools import cache
from types import ModuleType
from typing import Any

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "plot"


def _load() -> str:
    """Makes scripts/plot a subpackage of this one, so that no module called `plot` is taken from anybody."""
    name = f"{__package__}._plot"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, FOLDER / "__init__.py",
                                                      submodule_search_locations=[str(FOLDER)])
        if not spec or not spec.loader or not FOLDER.is_dir():
            raise ImportError(f"{FOLDER} is missing: furrow.open and the plots need the scripts of the checkout")
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return name


def module(name: str) -> ModuleType:
    """One module of scripts/plot, of those that do not draw."""
    return importlib.import_module(f"{_load()}.{name}")


@cache
def style() -> dict[str, Any]:
    """What scripts/plot sets in matplotlib for its own plots; for those of the user all stays as it is."""
    import matplotlib
    before = dict(matplotlib.rcParams)
    module("style")
    changed = {key: value for key, value in matplotlib.rcParams.items() if before[key] != value}
    matplotlib.rcParams.update({key: before[key] for key in changed})
    return changed


def drawing(name: str) -> ModuleType:
    """A module of scripts/plot that draws."""
    style()
    return module(name)


run_data = module("run_data")
Missing = run_data.Missing
Damaged = run_data.Damaged
Missing.__module__ = Damaged.__module__ = "furrow"  # where a user finds them
