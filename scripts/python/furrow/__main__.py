"""What `furrow report`, `furrow report --vtk` and `furrow events` run: python3 -m furrow report|frames_vtk|events …"""
import importlib
import pathlib
import sys

if not __package__:  # run by its path, by a Python that is isolated from the user's own settings
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

COMMANDS = ("report", "frames_vtk", "events")


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in COMMANDS:
        sys.exit(f"usage: python3 -m furrow {'|'.join(COMMANDS)} … (--help after it: its options)")
    name = sys.argv.pop(1)
    sys.argv[0] = f"python3 -m furrow {name}"
    return importlib.import_module(f"furrow.{name}").main()


if __name__ == "__main__":
    sys.exit(main())
