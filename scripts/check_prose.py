#!/usr/bin/env python3
"""Checks the English of the pages: no sentence of more than 35 words, and none of the words that CONTRIBUTING.md
replaces. Prints FILE:LINE with each finding; exit status 1 if there is one.

usage: check_prose.py [--root DIR]
"""
import argparse
import pathlib
import re
import sys

import check_docs

MOST_WORDS = 35
WORDS = {r"(?<!there )(?:is|are|was|were) no (?!longer|more|less)\w+": "'is not a …'",
         r"tell(?:s|ing)?|told": "'print', 'report', 'show'",
         r"know(?:s|n to)?": "'has', 'contains', 'depends on'", r"believes?": "'assumes'", r"anew": "'again'",
         r"mend(?:s|ed|ing)?": "'fix'", r"book(?:s|ed|ing)?": "'record'", r"likewise": "the noun again",
         r"in place of": "'instead of'", r"the house": "'the repository'", r"by name": "the name"}
FINDINGS = [(re.compile(rf"\b(?:{word})\b", re.IGNORECASE), instead) for word, instead in WORDS.items()]
MARKUP = re.compile(r"!?\[([^\]]*)\]\([^)]*\)|`[^`]*`")
END = re.compile(r"(?<=[.!?:;])\)?\s+(?=[\"'(*`\[A-Z])")


def paragraphs(page):
    """(number of its first line, text) of each paragraph of prose; an entry of a list is one"""
    begin, words, last = 0, [], 0
    for number, text, kind in check_docs.lines_of(page):
        if kind == "prose" and not text.lstrip().startswith("#"):
            if words and number == last + 1 and not re.match(r"\s*(?:[-*>]|\d+\.) ", text):
                words.append(text.strip())
            else:
                if words:
                    yield begin, " ".join(words)
                begin, words = number, [text.strip()]
            last = number
    if words:
        yield begin, " ".join(words)


def findings(page):
    for line, text in paragraphs(page):
        plain = MARKUP.sub(lambda found: found.group(1) or "X", text)  # a name is one word
        for sentence in END.split(plain):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > MOST_WORDS:
                begin = " ".join(words[:6])
                yield line, f"has a sentence of {len(words)} words, expected at most {MOST_WORDS}: '{begin} …'"
        for pattern, instead in FINDINGS:
            for found in pattern.finditer(plain):
                yield line, f"has '{found.group()}', expected {instead}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    arguments = parser.parse_args()
    wrong = 0
    for page in check_docs.pages(arguments.root):
        for line, what in findings(page):
            print(f"{page.relative_to(arguments.root)}:{line}: {what}")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
