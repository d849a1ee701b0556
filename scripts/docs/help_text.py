"""What `furrow --help` says, as data: completion scripts, the manual page and the reference are made from it.

Every command is asked for its own help, so that nothing here has to be changed with the program.
"""
import dataclasses
import re
import subprocess

INDENT = 30  # column in which descriptions begin, where the name leaves room
END = ("Examples:", "Exit codes:")  # begin what every help text ends with


@dataclasses.dataclass
class Entry:
    """An option, an argument or a command in the text."""
    names: list  # ["-h", "--help"], ["SCENARIO"]
    kind: str = ""  # TEXT, INT, FLOAT; empty: takes no value
    default: str = ""
    required: bool = False
    repeated: bool = False
    text: str = ""
    relations: str = ""  # "Excludes: --csv --json"

    @property
    def words(self):
        """The values that the description lists: of 'Choose the contact law: mindlin or hertz_tanh.' these two."""
        match = re.match(r"(?:[^:]*: )?((?:\w+, )*\w+ or \w+)(?:;| \(|\.|$)", self.text)
        return re.split(r", | or ", match[1]) if match and self.kind == "TEXT" else []


@dataclasses.dataclass
class Command:
    name: str  # "run", "bench grains"; the program itself: ""
    purpose: str = ""
    usage: str = ""
    arguments: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    groups: dict = dataclasses.field(default_factory=dict)  # heading: [Command]
    examples: list = dataclasses.field(default_factory=list)  # (command line, what it does)
    exit_codes: dict = dataclasses.field(default_factory=dict)  # number: meaning

    @property
    def commands(self):
        return [command for group in self.groups.values() for command in group]


def entry(line, text):
    """An entry from the part of its line before the description."""
    relation = re.search(r" ((?:Excludes|Needs): .*)", line)
    head = line[:relation.start()] if relation else line
    first, *others = head.split()
    made = Entry(first.split(","), text=text, relations=relation[1] if relation else "")
    for word in others:
        if word == "REQUIRED":
            made.required = True
        elif word == "...":
            made.repeated = True
        elif match := re.match(r"(TEXT|INT|FLOAT|UINT)(?::\w+)?(?:=(.*))?$", word):
            made.kind, made.default = match[1], match[2] or ""
    return made


def sections(text):
    """(heading, [(left, description)]) of every list of a help text."""
    heading, rows = "", []
    for line in text.splitlines():
        if re.match(r"\S.*:$", line):
            if rows:
                yield heading, rows
            heading, rows = line[:-1], []
        elif line.startswith(" " * INDENT) and rows:
            rows[-1] = (rows[-1][0], (rows[-1][1] + " " + line.strip()).strip())
        elif line.startswith("  ") and heading:
            left, _, right = line.strip().partition("  ")
            rows.append((left, right.strip()))
        elif not line.strip() and rows:
            yield heading, rows
            heading, rows = "", []
    if rows:
        yield heading, rows


def parse(name, text):
    """@param text what `furrow NAME --help` printed"""
    body = re.split(rf"^(?:{'|'.join(END)})", text, maxsplit=1, flags=re.MULTILINE)[0]
    lines = body.splitlines()
    usage = next(k for k, line in enumerate(lines) if line.startswith("Usage: "))
    made = Command(name, " ".join(lines[:usage]).strip(), lines[usage].removeprefix("Usage: "))
    for heading, rows in sections("\n".join(lines[usage + 1:])):
        if heading == "Positionals":
            made.arguments = [entry(left, text) for left, text in rows]
        elif heading == "Options":
            made.options = [entry(left, text) for left, text in rows]
        else:
            made.groups[heading] = [Command(f"{name} {left}".strip(), text) for left, text in rows]
    examples = re.search(r"^Examples:\n((?:  .*\n)+)", text, re.MULTILINE)
    for line in examples[1].splitlines() if examples else []:
        match = re.match(r"  (.*?)  +(\S.*)$", line)
        made.examples.append((match[1], match[2]) if match else (line.strip(), ""))
    codes = re.search(r"^Exit codes: (.*)", text, re.MULTILINE | re.DOTALL)
    for code in " ".join(codes[1].split()).rstrip(".").split(", ") if codes else []:
        number, _, meaning = code.partition(" ")
        made.exit_codes[int(number)] = meaning
    return made


def ask(program, name=""):
    """The command with all below it, from the help of the program."""
    done = subprocess.run([program, *name.split(), "--help"], capture_output=True, text=True, check=True, timeout=60)
    made = parse(name, done.stdout)
    made.groups = {heading: [ask(program, command.name) for command in group] for heading, group in made.groups.items()}
    return made


def version(program):
    done = subprocess.run([program, "--version"], capture_output=True, text=True, check=True, timeout=60)
    return done.stdout.split()[-1]
