"""Names all Debian packages that are missing at once, before the import of one of them fails."""
import importlib.util

NEEDS = {"h5py": "python3-h5py", "numpy": "python3-numpy", "pandas": "python3-pandas", "xarray": "python3-xarray"}

missing = [package for module, package in NEEDS.items() if importlib.util.find_spec(module) is None]
if missing:
    raise ImportError(f"the package 'furrow' needs what is not installed: apt install {' '.join(missing)}")
