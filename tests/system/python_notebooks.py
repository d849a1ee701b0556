#!/usr/bin/python3
"""A notebook of scripts/python from its first cell to its last, in a folder of its own: by nbclient where Debian's
python3-nbclient and python3-ipykernel are installed, else cell by cell in this process.

usage: python_notebooks.py NOTEBOOK
Exit codes: 0 passed, 1 a cell failed, 77 Debian's packages for the package itself are missing.
"""
import importlib.util
import json
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "scripts" / "python"
SECONDS = 500  # for a cell


def by_kernel(path, folder):
    import nbclient
    import nbformat
    os.environ["PYTHONPATH"] = str(PACKAGE)
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=SECONDS, kernel_name="python3",
                            resources={"metadata": {"path": folder}}).execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    return sum("image/png" in output.get("data", {}) for cell in cells for output in cell.outputs)


def by_hand(path, folder):
    os.environ["MPLBACKEND"] = "Agg"
    sys.path.insert(0, str(PACKAGE))
    os.chdir(folder)
    names = {}
    for cell in json.loads(path.read_text())["cells"]:
        if cell["cell_type"] == "code":
            lines = [line for line in cell["source"] if not line.startswith("%")]
            exec(compile("".join(lines), path.name, "exec"), names)  # pylint: disable=exec-used
    return len(names["plt"].get_fignums())


def main():
    if not all(importlib.util.find_spec(name) for name in ("pandas", "xarray")):
        print("skipped: needs what scripts/setup.sh --python installs")
        return 77
    path = PACKAGE / sys.argv[1]
    cells = json.loads(path.read_text())["cells"]
    if any(cell.get("outputs") or cell.get("execution_count") for cell in cells):
        print(f"{path.name}: holds outputs, expected none: clear them before it is committed")
        return 1
    kernel = importlib.util.find_spec("nbclient") and importlib.util.find_spec("ipykernel")
    with tempfile.TemporaryDirectory(prefix="furrow test ") as folder:
        pictures = (by_kernel if kernel else by_hand)(path, folder)
    print(f"{path.name}: {pictures} pictures, {'by nbclient' if kernel else 'cell by cell'}")
    return 0 if pictures > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
