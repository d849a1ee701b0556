#!/usr/bin/python3
"""Runs a program that writes tables to the files that environment variables name, and puts the lines of provenance.py
above them: the records of the verification programs, and whatever else a test program writes.

usage: made_with.py VARIABLE=TABLE.csv [VARIABLE=TABLE.csv …] [VARIABLE=VALUE …] -- PROGRAM [ARGUMENT …]

    tests/studies/made_with.py FURROW_VERIFICATION_CSV=tests/terrain/verification/verification.csv --
    build/terrain_verification
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import provenance


def main():
    words = sys.argv[1:]
    if "--" not in words or not 0 < words.index("--") < len(words) - 1 or not all("=" in word
                                                                                  for word in words[: words.index("--")]):
        sys.exit(__doc__)
    cut = words.index("--")
    given = dict(word.split("=", 1) for word in words[:cut])
    tables = {variable: value for variable, value in given.items() if value.endswith(".csv")}
    made = provenance.made_here(words[cut + 1])  # before a table is written, which makes the checkout dirty
    with tempfile.TemporaryDirectory() as name:
        bare = {variable: pathlib.Path(name) / f"{variable}.csv" for variable in tables}
        subprocess.run(words[cut + 1:], check=True,
                       env={**os.environ, **given, **{variable: str(file) for variable, file in bare.items()}})
        for variable, table in tables.items():
            if not bare[variable].exists():
                sys.exit(f"{words[cut + 1]}: wrote no file for {variable}")
            with open(table, "w", newline="", encoding="utf-8") as file:
                provenance.write_header(file, made)
                file.write(bare[variable].read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
