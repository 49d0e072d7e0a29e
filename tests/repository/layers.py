"""Reads every #include of the library and tells which ones the architecture does not allow.

layers.py ROOT: exit code 1 and one line per forbidden include.
"""

import pathlib
import re
import sys

# Each folder with its layer and what it builds on directly (ARCHITECTURE.md). What those build on is allowed too. A test
# may set up its case with anything from the layers below.
FOLDERS = {
    "core": (0, []),
    "files": (1, ["core"]),
    "sensor": (1, ["core"]),
    "map": (2, ["sensor"]),
    "candidates": (2, ["sensor"]),
    "formats": (3, ["files", "map"]),
    "visibility": (3, ["map"]),
    "robot": (3, ["map"]),
    "registration": (3, ["sensor"]),
    "recordings": (4, ["formats"]),
    "arm": (4, ["robot"]),
    "utility": (4, ["visibility", "robot"]),
    "search": (5, ["utility", "candidates"]),
    "planning": (6, ["search"]),
    "model": (7, ["planning", "registration"]),
    "options": (8, ["model", "arm", "recordings"]),
    "simulation": (9, ["options"]),
    "runs": (9, ["options"]),
    "report": (10, ["runs"]),
    "session": (10, ["runs"]),
    "doctor": (10, ["recordings", "model"]),
    "experiments": (11, ["simulation", "report"]),
    "server": (11, ["session", "report"]),
}

# The library vantage::core: Eigen, oneTBB and the standard library, nothing else.
CORE_FOLDERS = ["core", "sensor", "map", "candidates", "visibility", "robot", "utility", "search", "planning"]
CORE_PACKAGES = ["Eigen", "tbb", "oneapi"]
CORE_COMPILER_HEADERS = ["immintrin.h", "cpuid.h", "sanitizer/tsan_interface.h"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def allowed_folders(folder, is_test):
    """The folder itself and all that it builds on, directly or not."""
    layer, builds_on = FOLDERS[folder]
    if is_test:
        return {folder} | {other for other, (height, _) in FOLDERS.items() if height < layer}
    return {folder}.union(*(allowed_folders(below, is_test) for below in builds_on))


def why_forbidden(folder, header, is_test):
    """Why a file of `folder` may not include `header`, or None where it may."""
    parts = header.split("/")
    if parts[0] == "vantage":
        if len(parts) != 3 or parts[1] not in FOLDERS:
            return "is not of the form vantage/FOLDER/FILE.hpp with a known folder"
        allowed = allowed_folders(folder, is_test)
        if parts[1] not in allowed:
            return f"{folder} may include only {', '.join(sorted(allowed))}"
        return None
    if ".." in parts:
        return "leaves its folder; write vantage/FOLDER/FILE.hpp"
    if folder in CORE_FOLDERS and not is_test:
        standard = len(parts) == 1 and "." not in header or header in CORE_COMPILER_HEADERS
        if not standard and parts[0] not in CORE_PACKAGES:
            return "vantage::core needs only Eigen, oneTBB and the standard library"
    return None


def check(root):
    """(messages, number of includes read) for the tree below `root`/src/vantage."""
    messages, read = [], 0
    library = pathlib.Path(root) / "src" / "vantage"
    for file in sorted(library.rglob("*")):
        if file.suffix not in (".hpp", ".cpp"):
            continue
        name = file.relative_to(root)
        folder = file.relative_to(library).parts[0]
        if folder not in FOLDERS or file.parent.parent != library:
            messages.append(f"{name}: not in one of the folders that ARCHITECTURE.md lists")
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            read += 1
            reason = why_forbidden(folder, match[2], file.name.endswith("_test.cpp"))
            if reason:
                messages.append(f"{name}:{number}: #include {match[2]}: {reason}")
    return messages, read


def main():
    messages, read = check(pathlib.Path(sys.argv[1]))
    print(*messages, f"{read} includes read, {len(messages)} forbidden", sep="\n")
    return 1 if messages or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
