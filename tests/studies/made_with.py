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
    if words[:1] in (["-h"], ["--help"]):
        print(__doc__)
        return
    cut = words.index("--") if "--" in words else 0
    command = words[cut + 1:]
    if not cut or not command or not all("=" in word for word in words[:cut]):
        sys.exit(__doc__)
    given = dict(word.split("=", 1) for word in words[:cut])
    made = provenance.made_here(command[0])  # before a table is written, which makes the checkout dirty
    with tempfile.TemporaryDirectory() as name:
        bare = {variable: pathlib.Path(name) / f"{variable}.csv" for variable, value in given.items()
                if value.endswith(".csv")}
        subprocess.run(command, check=True, env={**os.environ, **given, **{key: str(bare[key]) for key in bare}})
        for variable, file in bare.items():
            if not file.exists():
                sys.exit(f"{command[0]}: wrote no file for {variable}")
            with open(given[variable], "w", newline="", encoding="utf-8") as table:
                provenance.write_header(table, made)
                table.write(file.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
