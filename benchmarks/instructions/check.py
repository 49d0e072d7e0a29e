#!/usr/bin/env python3
"""Counts the instructions of evaluation and integration under valgrind and compares them with the recorded counts.

    check.py PROGRAM            ends with 1 where a count is more than 5 % away from the recorded one
    check.py PROGRAM --record   writes the counts down as the new ones, on purpose

Instruction counts do not depend on the clock or on other programs. They do depend on the compiler: the recorded ones
are those of the release build with g++ 12. Ends with 77 (skipped) where valgrind is missing.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

RECORDED = pathlib.Path(__file__).with_name("recorded.json")
TOLERANCE = 0.05
SKIPPED = 77
JOBS = ("integration", "evaluation")


def count_instructions(program: str, job: str) -> int:
    """Instructions within vantage::test::counted_JOB, callees included."""
    with tempfile.TemporaryDirectory() as scratch:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={scratch}/out", "--collect-atstart=no",
                   f"--toggle-collect=vantage::test::counted_{job}(*", program]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with {run.returncode}:\n{run.stderr}")
    found = re.search(r"Collected : (\d+)", run.stderr)
    if not found or int(found[1]) == 0:
        raise RuntimeError(f"callgrind counted nothing in counted_{job}; was it inlined or renamed?\n{run.stderr}")
    return int(found[1])


def compare(counts: dict[str, int], recorded: dict[str, int]) -> list[str]:
    """One line per count that strayed from the recorded one."""
    complaints = []
    for job, count in counts.items():
        if job not in recorded:
            complaints.append(f"{job}: no recorded count; run with --record")
            continue
        change = count / recorded[job] - 1
        print(f"{job}: {count:,} instructions, recorded {recorded[job]:,} ({change:+.2%})")
        if abs(change) > TOLERANCE:
            complaints.append(f"{job}: {change:+.1%}, must stay within {TOLERANCE:.0%}; if the change is meant to be, "
                              "run this script with --record and commit recorded.json")
    return complaints


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program built from instructions.cpp")
    parser.add_argument("--record", action="store_true", help="write the counts to recorded.json")
    arguments = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("skipped: valgrind is not installed (apt-get install valgrind)")
        return SKIPPED
    counts = {job: count_instructions(arguments.program, job) for job in JOBS}
    if arguments.record:
        RECORDED.write_text(json.dumps(counts, indent=2) + "\n", encoding="utf-8")
        print(f"recorded {counts} in {RECORDED}")
        return 0
    recorded = json.loads(RECORDED.read_text(encoding="utf-8")) if RECORDED.exists() else {}
    complaints = compare(counts, recorded)
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
