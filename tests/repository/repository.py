"""Checks of the repository's own files: repository.py ROOT. Exit code 1 and one line per finding."""

import pathlib
import re
import sys

LONGEST = 400  # lines of a source file
SOURCES = {".cpp", ".hpp", ".ts", ".tsx", ".py"}
# Folders that hold what was made or fetched.
MADE = {".git", "build", "node_modules", "dist", "runs", "__pycache__"}

# Brackets keep these patterns from finding themselves.
FOREIGN = [
    (re.compile(r"(^|[\s\"'`(=:])/(w[o]rk|h[o]me|r[o]ot|Us[e]rs)/"), "path of one machine"),
    (re.compile(r"\b(deb[.]debian|registry[.]n[p]mjs|registry[.]yarn|pypi[.]p[y]thon|files[.]pythonh[o]sted)\b"),
     "host of a package registry"),
]


def files(root):
    """All files of the project, as paths relative to `root`."""
    for path in sorted(pathlib.Path(root).iterdir()):
        if path.name in MADE:
            continue
        if path.is_dir() and not path.is_symlink():
            yield from files_below(path, pathlib.Path(root))
        elif path.is_file():
            yield path.relative_to(root)


def files_below(folder, root):
    for path in sorted(folder.rglob("*")):
        relative = path.relative_to(root)
        if path.is_file() and not MADE.intersection(relative.parts):
            yield relative


def check_file(name, text):
    """Messages about one file with the given text."""
    lines = text.splitlines()
    messages = []
    if pathlib.PurePath(name).suffix in SOURCES and len(lines) > LONGEST:
        messages.append(f"{name}: {len(lines)} lines; split it, {LONGEST} is the most")
    for number, line in enumerate(lines, 1):
        for pattern, what in FOREIGN:
            if pattern.search(line):
                messages.append(f"{name}:{number}: {what}: {line.strip()[:100]}")
    return messages


def check(root):
    """(messages, number of files read)."""
    messages, read = [], 0
    for name in files(root):
        data = (pathlib.Path(root) / name).read_bytes()
        if b"\0" in data[:4096]:
            continue  # a picture or another binary file
        read += 1
        messages += check_file(str(name), data.decode("utf-8", errors="replace"))
    return messages, read


def main():
    messages, read = check(sys.argv[1])
    print(*messages, f"{read} files read, {len(messages)} findings", sep="\n")
    return 1 if messages or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
