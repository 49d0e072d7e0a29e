"""Prints the type stubs of the module: make_stubs.py > python/vantage/__init__.pyi (with the module on PYTHONPATH).

pybind11 writes the signature of every function into its docstring; this puts them in the form of a .pyi file.
"""

import inspect
import re
import sys

if __name__ == "__main__":
    del sys.path[0]  # this folder, where the module is not yet compiled

from vantage import _vantage  # noqa: E402

SPECIAL = ("__init__", "__len__", "__enter__", "__exit__")
HEAD = '''"""Type stubs of vantage, made by python/make_stubs.py; a test compares them with the module."""

import enum
import pathlib
from typing import Any, Callable, Dict, List, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str
'''


def python_type(text, is_result):
    """A type as pybind11 writes it, as an annotation."""
    text = re.sub(r"numpy\.ndarray\[numpy\.(\w+)(?:\[[^\]]*\])?\]", r"NDArray[numpy.\1]" if is_result else "ArrayLike", text)
    text = text.replace("numpy.ndarray", "NDArray[Any]" if is_result else "ArrayLike")
    text = re.sub(r"vantage\._vantage\.|_vantage\.", "", text)
    text = re.sub(r"\bobject\b", "Any", text)
    return text.replace("os.PathLike", "Union[str, pathlib.Path]")


def split(text):
    """The parts between the commas that stand outside of brackets and quotes."""
    parts, depth, start, quoted = [], 0, 0, False
    for i, c in enumerate(text):
        quoted ^= c == "'"
        depth += 0 if quoted else (c in "[({<") - (c in "])}>" and text[i - 1:i + 1] != "->")
        if c == "," and depth == 0 and not quoted:
            parts.append(text[start:i].strip())
            start = i + 1
    return [part for part in parts + [text[start:].strip()] if part]


def parameter(text):
    """`name: type = value` with the type as an annotation; values that are not plain are left open."""
    if ":" not in text:
        return {"*args": "*args: Any", "**kwargs": "**options: Any"}.get(text, text)
    name, rest = text.split(":", 1)
    kind, _, value = rest.partition(" = ")
    if value and not re.fullmatch(r"[-\w.']+", value):
        value = "..."
    return f"{name}: {python_type(kind.strip(), False)}" + (f" = {value}" if value else "")


def signatures(function):
    """The (parameters, result) of each overload."""
    found = []
    for line in (function.__doc__ or "").splitlines():
        match = re.match(r"(?:\d+\. )?(\w+)\((.*)\) -> (.+)$", line)
        if match and match.group(1) == function.__name__:
            found.append((match.group(2), match.group(3).strip()))
    return found


def summary(text):
    """A docstring without pybind11's signature lines."""
    lines = [line for line in (text or "").splitlines() if not re.match(r"(\d+\. )?\w+\(.*\) -> |Overloaded function", line)]
    return inspect.cleandoc("\n".join(lines)).strip()


def document(text, indent):
    text = summary(text)
    return [f'{indent}"""{text}"""'.replace("\n\n", "\n").replace("\n", "\n" + indent)] if text else []


def function_lines(function, indent, is_static=False):
    overloads = signatures(function)
    lines = []
    for parameters, result in overloads:
        names = [parameter(each) for each in split(parameters)]
        if names and names[0].startswith("self:"):
            names[0] = "self"
        if len(overloads) > 1:
            lines.append(f"{indent}@overload")
        if is_static:
            lines.append(f"{indent}@staticmethod")
        body = document(function.__doc__, indent + "    ") if len(overloads) == 1 else []
        head = f"{indent}def {function.__name__}({', '.join(names)}) -> {python_type(result, True)}:"
        lines += [head] + body + [] if body else [head + " ..."]
    return lines


def property_lines(name, value, indent):
    match = re.search(r"-> (.+)", value.fget.__doc__ or "")
    kind = python_type(match.group(1).strip(), True) if match else "Any"
    lines = [f"{indent}@property", f"{indent}def {name}(self) -> {kind}:"]
    body = document(value.__doc__, indent + "    ")
    lines = lines + body if body else lines[:-1] + [lines[-1] + " ..."]
    if value.fset:
        kind = python_type(match.group(1).strip(), False) if match else "Any"
        lines += [f"{indent}@{name}.setter", f"{indent}def {name}(self, value: {kind}) -> None: ..."]
    return lines


def class_lines(cls):
    if issubclass(cls, Exception):
        bases = ", ".join(base.__name__ for base in cls.__bases__)
        return [f"class {cls.__name__}({bases}):"] + document(cls.__doc__, "    ")
    if hasattr(cls, "__members__"):
        doc = document(cls.__doc__.split("\n\nMembers:")[0], "    ")
        return [f"class {cls.__name__}(enum.Enum):"] + doc + [
            f"    {name} = {int(value)}" for name, value in cls.__members__.items()]
    lines = [f"class {cls.__name__}:"] + document(cls.__doc__, "    ")
    for name, value in cls.__dict__.items():
        if isinstance(value, property):
            lines += property_lines(name, value, "    ")
        elif isinstance(value, staticmethod):
            lines += function_lines(value.__func__, "    ", is_static=True)
        elif callable(value) and signatures(value) and (not name.startswith("_") or name in SPECIAL):
            lines += function_lines(value, "    ")
    return lines


def stubs():
    lines = []
    for name, value in vars(_vantage).items():
        if name.startswith("_"):
            continue
        lines += ["", ""] if inspect.isclass(value) else [""]
        lines += class_lines(value) if inspect.isclass(value) else function_lines(value, "")
    head = HEAD.replace("Union\n", "Union, overload\n") if any("@overload" in line for line in lines) else HEAD
    return head + "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(stubs(), end="")
