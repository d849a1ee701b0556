#!/usr/bin/env python3
"""Prints the manual page furrow(1): usage: scripts/docs/manual.py [--program FURROW]. It is made from the program's
help."""
import argparse
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import help_text

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = {
    "FURROW_HOME": "folder that holds rigs/, tire/ and scripts/, if it is not that of the program",
    "FURROW_MPIRUN": "another launcher: Open MPI's mpirun, or Slurm's srun",
    "FURROW_START_TIMEOUT": "seconds after which a launcher that starts no ranks is ended (120)",
    "FURROW_LEVEL": "build that an installed furrow starts, such as x86-64-v3, if not the richest that the processor "
                    "runs",
    "XDG_CACHE_HOME": "folder of caches, whose furrow/ keeps settled beds and the speed of this machine (~/.cache)",
}


def escaped(text):
    """Text of a line for troff."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text.startswith((".", "\\(aq")) else text


def sentence(text):
    first = text.split(" ")[0]  # the name of a thing, as 'key=value', keeps its letters
    return escaped((text if "=" in first else text[:1].upper() + text[1:]).rstrip(".") + ".")


def entry_lines(entry):
    names = ", ".join(f"\\fB{escaped(name)}\\fR" for name in entry.names)
    value = f" \\fI{entry.kind}\\fR" + (" ..." if entry.repeated
                                        else "") if entry.kind and entry.names[0].startswith("-") else ""
    default = f" The default is {escaped(entry.default)}." if entry.default else ""
    relations = f" {sentence(entry.relations)}" if entry.relations else ""
    return [".TP", f"{names}{value}", sentence(entry.text) + default + relations]


def example_lines(command):
    lines = []
    for line, what in command.examples:
        lines += [".TP", f"\\fB{escaped(line)}\\fR", sentence(what)]
    return lines


def command_lines(command):
    lines = [f".SS {escaped(command.usage.removeprefix('furrow '))}", sentence(command.purpose)]
    entries = command.arguments + [option for option in command.options if "--help" not in option.names]
    for entry in entries:
        lines += entry_lines(entry)
    lines += example_lines(command)
    for below in command.commands:
        lines += command_lines(below)
    return lines


def manual(program, version):
    lines = [f".TH FURROW 1 \"\" \"Furrow {version}\" \"User Commands\"", ".SH NAME",
             f"furrow \\- {escaped(program.purpose.removeprefix('Furrow: ').rstrip('.'))}", ".SH SYNOPSIS"]
    for command in program.commands:
        lines += [f".B {escaped(command.usage.split(' [')[0])}",
                  escaped(command.usage[len(command.usage.split(" [")[0]):].strip()), ".br"]
    lines += [".SH DESCRIPTION",
              "Furrow simulates flexible tires and whole vehicles on grains, empirical soil or hard ground.",
              "A scenario, one JSON file, describes tires, terrain, and test rig or vehicle.",
              "\\fBfurrow explain\\fR lists all its keys."]
    for heading, group in program.groups.items():
        lines.append(f".SH {escaped(heading.upper())}")
        for command in group:
            lines += command_lines(command)
    lines += [".SH EXAMPLES", *example_lines(program)]
    lines.append(".SH EXIT STATUS")
    for number, meaning in program.exit_codes.items():
        lines += [".TP", f"\\fB{number}\\fR", sentence(meaning)]
    lines.append(".SH ENVIRONMENT")
    for name, meaning in ENVIRONMENT.items():
        lines += [".TP", f"\\fB{name}\\fR", sentence(meaning)]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=os.environ.get("FURROW", str(ROOT / "build" / "furrow")))
    options = parser.parse_args()
    print(manual(help_text.ask(options.program), help_text.version(options.program)), end="")


if __name__ == "__main__":
    main()
