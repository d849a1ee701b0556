#!/usr/bin/env python3
"""Prints the completion script of a shell: usage: scripts/docs/completion.py bash|zsh|fish [--program FURROW]

    source <(scripts/docs/completion.py bash)

It is made from the help of the program, so it knows its commands, options and fixed values. Scenario keys after --set
and names of shipped files are asked of the program while you type.
"""
import argparse
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import help_text

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What an argument or the value of an option is, beyond the words that its description lists.
KINDS = {"SCENARIO": "list:scenarios", "validate SCENARIO": "list:scenarios vehicles calibrations",
         "STUDY": "list:studies", "calibrate STUDY": "list:calibrations", "VEHICLE": "list:vehicles",
         "--scenario": "list:scenarios", "--tire": "list:tires", "--soil": "list:soils", "--vehicle": "list:vehicles",
         "DIR": "folder",
         "OTHERS": "folder", "--out": "folder", "--vtk": "folder", "KEY": "key", "--set": "setting",
         "--profile": "file", "--bed": "file", "--save-bed": "file"}


def value_of(command, entry):
    """What an argument or the value of an option of a command may be: 'words:a b', or one of the kinds above, or
    'free'."""
    words = [word for word in entry.words if word.isascii()]
    return "words:" + " ".join(words) if words else KINDS.get(f"{command.name} {entry.names[-1]}",
                                                              KINDS.get(entry.names[-1], "free"))


def all_commands(program):
    """Every command, those below others as 'bench grains'."""
    pending = list(program.commands)
    while pending:
        command = pending.pop(0)
        yield command
        pending[:0] = command.commands


def rules(program):
    """{'run --out': kind, 'run #': kind of its arguments} of everything that has a value."""
    found = {}
    for command in all_commands(program):
        if command.commands:
            found[f"{command.name} #"] = "words:" + " ".join(below.name.split()[-1] for below in command.commands)
        for entry in command.arguments:
            found.setdefault(f"{command.name} #", value_of(command, entry))
        for entry in command.options:
            for name in entry.names if entry.kind else []:
                found[f"{command.name} {name}"] = value_of(command, entry)
    return found


def options_of(command):
    return " ".join(name for entry in command.options for name in entry.names)


BASH = r"""# Completion of furrow for bash, made from its help.
_furrow_kind() {  # of a command and an option, or of a command and '#', its arguments: what may stand there
  case $1 in
@RULES@
  esac
}
_furrow_options() {
  case $1 in
@OPTIONS@
  esac
}
_furrow_list() {
  local kind
  for kind; do "${COMP_WORDS[0]}" list "$kind"; done 2>/dev/null | awk '/^  [^ ]/ {print $1}'
}
_furrow_keys() { "${COMP_WORDS[0]}" explain 2>/dev/null | awk '/^[^ ]/ {print $1}'; }
_furrow() {
  local word=$2 previous=$3 command=${COMP_WORDS[1]} kind IFS=$' \t\n'
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '@COMMANDS@ --help --version' -- "$word"))
    return
  fi
  # Values of keys are free, and bash takes '=' for a word of its own.
  [[ $word != '=' && $previous != '=' ]] || return
  case $command in @PARENTS@) ((COMP_CWORD == 2)) || command+=" ${COMP_WORDS[2]}" ;; esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(_furrow_options "$command")" -- "$word"))
    return
  fi
  [[ $previous != -* ]] || kind=$(_furrow_kind "$command $previous")
  [[ -n $kind ]] || kind=$(_furrow_kind "$command #")
  case $kind in
    words:*) COMPREPLY=($(compgen -W "${kind#words:}" -- "$word")) ;;
    list:*) compopt -o filenames
            COMPREPLY=($(compgen -W "$(_furrow_list ${kind#list:})" -- "$word") $(compgen -f -- "$word")) ;;
    folder) compopt -o filenames; COMPREPLY=($(compgen -d -- "$word")) ;;
    file) compopt -o filenames; COMPREPLY=($(compgen -f -- "$word")) ;;
    key) COMPREPLY=($(compgen -W "$(_furrow_keys)" -- "$word")) ;;
    setting) compopt -o nospace; COMPREPLY=($(compgen -S = -W "$(_furrow_keys)" -- "$word")) ;;
  esac
}
complete -F _furrow furrow
"""


def bash(program):
    lists = {"@COMMANDS@": " ".join(command.name for command in program.commands),
             "@PARENTS@": "|".join(command.name for command in program.commands if command.commands)}
    lists["@RULES@"] = "\n".join(f"    {quoted(pattern)}) echo {quoted(kind)} ;;" for pattern,
                                 kind in rules(program).items())
    lists["@OPTIONS@"] = "\n".join(f"    {quoted(command.name)}) echo {quoted(options_of(command))} ;;"
                                   for command in all_commands(program))
    text = BASH
    for mark, value in lists.items():
        text = text.replace(mark, value)
    return text


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_action(kind):
    """What _arguments calls to complete a value."""
    what, _, rest = kind.partition(":")
    return {"words": f"({rest})", "list": f"_furrow_list {rest}", "folder": "_files -/", "file": "_files",
            "key": "_furrow_keys", "setting": "_furrow_keys -S=", "free": " "}[what]


def zsh_text(text):
    return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")


def zsh_spec(command, entry):
    """One option for _arguments, of each of its names."""
    for name in entry.names:
        value = "" if not entry.kind else f": :{zsh_action(value_of(command, entry))}"
        yield f"'{'*' if entry.repeated else ''}{name}[{zsh_text(entry.text)}]{value}'"


def zsh_command(command):
    specs = [spec for entry in command.options for spec in zsh_spec(command, entry)]
    if command.commands:
        words = " ".join(below.name.split()[-1] for below in command.commands)
        specs += [f"'1: :({words})'"]
        for below in command.commands:
            specs += [spec for entry in below.options for spec in zsh_spec(below, entry) if spec not in specs]
    for number, entry in enumerate(command.arguments, 1):
        place = "*" if entry.repeated else number
        specs.append(f"'{place}:{zsh_text(entry.names[-1])}:{zsh_action(value_of(command, entry))}'")
    body = " \\\n        ".join(specs)
    return f"      {command.name})\n      _arguments -s : \\\n        {body} ;;"


def zsh(program):
    commands = "\n".join(f"    '{command.name}:{zsh_text(command.purpose)}'" for command in program.commands)
    cases = "\n".join(zsh_command(command) for command in program.commands)
    return f"""#compdef furrow
# Completion of furrow for zsh, made from its help.
_furrow_list() {{
  local -a names
  names=(${{(f)"$(for kind; do furrow list $kind; done 2>/dev/null | awk '/^  [^ ]/ {{print $1}}')"}})
  compadd -- $names
  _files
}}
_furrow_keys() {{
  local -a keys
  keys=(${{(f)"$(furrow explain 2>/dev/null | awk '/^[^ ]/ {{print $1}}')"}})
  compadd "$@" -- $keys
}}
_furrow() {{
  local -a commands
  commands=(
{commands}
  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  shift words
  ((CURRENT--))
  case $words[1] in
{cases}
  esac
}}
if [[ $funcstack[1] == _furrow ]]; then _furrow "$@"; else compdef _furrow furrow; fi
"""


def fish_value(command, entry):
    what, _, rest = value_of(command, entry).partition(":")
    return {"words": f"-x -a {quoted(rest)}", "list": f"-r -a '(__furrow_list {rest})'",
            "folder": "-x -a '(__fish_complete_directories)'",
            "file": "-r", "key": "-x -a '(__furrow_keys)'", "setting": "-x -a '(__furrow_keys)'", "free": "-x"}[what]


def fish(program):
    lines = ["# Completion of furrow for fish, made from its help.", "function __furrow_list; for kind in $argv; "
             "furrow list $kind; end 2>/dev/null | awk '/^  [^ ]/ {print $1}'; end",
             "function __furrow_keys; furrow explain 2>/dev/null | awk '/^[^ ]/ {print $1}'; end",
             "complete -c furrow -f"]
    for command in program.commands:
        lines.append(f"complete -c furrow -n __fish_use_subcommand -a {command.name} -d {quoted(command.purpose)}")
    for command in all_commands(program):
        condition = " ; and ".join(f"__fish_seen_subcommand_from {word}" for word in command.name.split())
        start = f"complete -c furrow -n {quoted(condition)}"
        for below in command.commands:
            lines.append(f"{start} -a {below.name.split()[-1]} -d {quoted(below.purpose)}")
        for entry in command.options:
            names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in entry.names)
            lines.append(f"{start} {names} -d {quoted(entry.text)}"
                         + (f" {fish_value(command, entry)}" if entry.kind else ""))
        for entry in command.arguments:
            value = fish_value(command, entry).replace("-x", "").replace("-r", "-F").strip()
            lines.append(f"{start} {value}" if value else f"{start} -F")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shell", choices=("bash", "zsh", "fish"))
    parser.add_argument("--program", default=os.environ.get("FURROW", str(ROOT / "build" / "furrow")))
    options = parser.parse_args()
    print({"bash": bash, "zsh": zsh, "fish": fish}[options.shell](help_text.ask(options.program)), end="")


if __name__ == "__main__":
    main()
