"""Finds names that meet where files are compiled together: joined_names.py ROOT. Exit code 1 and a line per name.

The sources of a library may be joined into few files (VANTAGE_UNITY). Then constants, and functions of the same
parameters, in the anonymous namespaces of two of them are one name with two definitions, whichever files meet.
definitions.py does the same for types.
"""

import collections
import pathlib
import re
import sys

LIBRARY = re.compile(r"^vantage_library\((\w+)((?:\s+\w+)+)\)", re.M)
ALONE = re.compile(r"^vantage_unity\(vantage_(\w+)((?:\s+\w+)*)\)", re.M)
ANONYMOUS = re.compile(r"^namespace \{\n(.*?)^\}  // namespace\n", re.S | re.M)
CONSTANT = re.compile(r"^(?:inline |static )?(?:constexpr|const) [\w:<>,\s*&]+?\b(\w+)(?:\[\w*\])*\s*(?:=|\{)", re.M)
FUNCTION = re.compile(r"^(?!\s|return|using|else|if|for|while|struct|class|enum|constexpr std|const )"
                      r"[\w:<>,&*\s\[\]]+?\b(\w+)\(([^;{}]*?)\)\s*(?:const\s*)?\{", re.M)


def names_of(text):
    """Names that `text` defines in anonymous namespaces; functions with the types of their parameters."""
    names = set()
    for block in ANONYMOUS.findall(text):
        names.update(CONSTANT.findall(block))
        for name, parameters in FUNCTION.findall(block):
            types = [re.sub(r"\s*\b\w+$", "", each.split("=")[0].strip()) for each in parameters.split(",")]
            names.add(f"{name}({', '.join(types)})")
    return names


def check(root):
    """(messages, number of names read)."""
    root = pathlib.Path(root)
    cmake = "".join(file.read_text(encoding="utf-8")
                    for file in [root / "CMakeLists.txt", *sorted((root / "cmake").glob("*.cmake"))] if file.exists())
    alone = {library: rooms.split() for library, rooms in ALONE.findall(cmake)}
    messages, read = [], 0
    for library, rooms in LIBRARY.findall(cmake):
        places = collections.defaultdict(list)
        for room in rooms.split():
            if room in alone.get(library, []):
                continue
            for file in sorted((root / "src/vantage" / room).glob("*.cpp")):
                if file.name.endswith("_test.cpp"):
                    continue
                for name in names_of(file.read_text(encoding="utf-8")):
                    places[name].append(str(file.relative_to(root)))
        read += len(places)
        messages += [f"{name}: in the anonymous namespaces of {' and '.join(files)}, which may be compiled together"
                     for name, files in sorted(places.items()) if len(files) > 1]
    return messages, read


def main():
    messages, read = check(sys.argv[1])
    print(*messages, f"{read} names read, {len(messages)} that meet", sep="\n")
    return 1 if messages or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
