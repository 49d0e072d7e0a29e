"""The command `vantage` of a wheel: becomes the program that came with the module."""

import os
import pathlib
import sys


def main():
    program = pathlib.Path(__file__).parent / "bin" / "vantage"
    try:
        os.execv(program, ["vantage", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"vantage: cannot run {program}: {error.strerror}; install the package again")
