"""Finds words that the glossary of CONTRIBUTING.md replaces: english.py ROOT. Exit code 1 and one line per finding.

Read are documents, messages, comments and the page's texts, that is every line of a source file: a name in the code is
a word too.
"""

import pathlib
import re
import sys

import repository

SUFFIXES = {".md", ".hpp", ".cpp", ".ts", ".py", ".cmake", ".yaml", ".html", ".css", ".txt", ".in", ".sh"}
# This page and its test have to write the words that they look for.
EXEMPT = {"CONTRIBUTING.md", "tests/repository/english.py", "tests/repository/english_test.py"}

GLOSSARY = [
    (r"(?<!both )(?<!two )(?<!either )(?<!three )\bways\b", "path, distance, travel; or means"),
    (r"\bmend(s|ed|ing)?\b", "fix"),
    (r"\b(is|are|was|were|be) told(?! apart)\b", "gets, is given; or: is reported"),
    (r"\bdear(er|est)?\b", "cost, expensive"),
    (r"\banew\b", "again"),
    (r"\blest\b", "to avoid, so that ... not"),
    (r"\bstands? in\b", "is stored in, is given by"),
    (r"\bends? up beside\b", "stops near, misses"),
    (r"\bgo(es)? on where (it|he|she|they) (was|were)\b", "resume"),
    (r"\bmeshes that it was not chosen on\b", "held-out meshes"),
    (r"\bbeyond doubt\b|\bnothing that can be told\b", "statistically significant; no measurable effect"),
    (r"\bmade files\b", "generated files"),
    (r"\bsomebody else('s)?\b", "external, another"),
    (r"\bhears of\b", "is notified of"),
]
PATTERNS = [(re.compile(pattern, re.IGNORECASE), better) for pattern, better in GLOSSARY]


def check_text(name, text):
    """Messages about one file with the given text."""
    return [f"{name}:{number}: '{match[0]}': write {better}: {line.strip()[:90]}"
            for number, line in enumerate(text.splitlines(), 1)
            for pattern, better in PATTERNS for match in [pattern.search(line)] if match]


def check(root):
    """(messages, number of files read)."""
    messages, read = [], 0
    for name in repository.files(root):
        if name.suffix not in SUFFIXES or str(name) in EXEMPT or "corpus" in name.parts:
            continue
        read += 1
        text = (pathlib.Path(root) / name).read_text(encoding="utf-8", errors="replace")
        messages += check_text(str(name), text)
    return messages, read


def main():
    messages, read = check(sys.argv[1])
    print(*messages, f"{read} files read, {len(messages)} findings", sep="\n")
    return 1 if messages or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
