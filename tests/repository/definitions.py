"""Finds types that are defined twice: definitions.py ROOT. Exit code 1 and one line per type.

Two different classes of one name make a program whose behaviour depends on the order of linking. Types in anonymous
namespaces may repeat between source files, but not within one folder, whose sources may be compiled together.
"""

import collections
import pathlib
import re
import sys

FOLDERS = ("src/vantage", "apps", "python/src", "fuzz", "tests/support")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
TEXT = re.compile(r'R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'')
TOKEN = re.compile(
    r"(?P<namespace>\bnamespace\s*(?P<space>\w+(?:::\w+)*)?\s*\{)"
    r"|(?P<type>\b(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?P<name>\w+(?:::\w+)*)"
    r"(?:\s+final)?\s*(?::(?!:)[^;{}()]*)?\{)"
    r"|(?P<open>\{)|(?P<close>\})")


def types_of(text):
    """Names of the types that `text` defines outside of other types and functions, with their namespace.

    An anonymous namespace is the part `(anonymous)`.
    """
    text = TEXT.sub('""', COMMENT.sub("", text))
    blocks, found = [], []
    for token in TOKEN.finditer(text):
        if token["namespace"]:
            blocks.append(token["space"] or "(anonymous)")
        elif token["close"]:
            if blocks:
                blocks.pop()
        else:
            if token["type"] and None not in blocks:
                found.append("::".join(blocks + [token["name"]]))
            blocks.append(None)
    return found


def check(root):
    """(messages, number of types read)."""
    places = collections.defaultdict(list)
    for folder in FOLDERS:
        for file in sorted((pathlib.Path(root) / folder).rglob("*")):
            if file.suffix not in (".hpp", ".cpp"):
                continue
            name = file.relative_to(root)
            for kind in types_of(file.read_text(encoding="utf-8")):
                # Tests of one folder are one program; so are its sources.
                scope = f"{name.parent}{'/test' if name.name.endswith('_test.cpp') else ''}"
                places[(scope if "(anonymous)" in kind else "", kind)].append(str(name))
    messages = [f"{kind}: defined in {' and '.join(where)}" for (_, kind), where in sorted(places.items())
                if len(where) > 1]
    return messages, len(places)


def main():
    messages, read = check(sys.argv[1])
    print(*messages, f"{read} types read, {len(messages)} defined twice", sep="\n")
    return 1 if messages or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
