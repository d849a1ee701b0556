#!/usr/bin/python3
"""How often the test for drifts is wrong, and how good the standard error is, on synthetic series: steadiness.csv.

    cmake --build build --target steadiness_rates
    /usr/bin/python3 tests/studies/steadiness.py
"""
import csv
import pathlib

import driver
import provenance


def main():
    arguments = driver.options(__doc__, trials={"type": int, "default": 4000}, program={
        "type": pathlib.Path, "default": provenance.ROOT / "build" / "steadiness_rates"}).parse_args()
    compiler, *lines = driver.furrow(arguments.trials, program=arguments.program.absolute()).splitlines()
    driver.write("steadiness.csv", list(csv.DictReader(lines)), {
        "commit": provenance.commit(), "compiler": compiler.split(": ", 1)[1], "processor": provenance.processor(),
        "command": provenance.command()})


if __name__ == "__main__":
    main()
