#!/usr/bin/python3
"""Runs the benchmarks and prints the table of spec, section 12, as Markdown.

table.py PROGRAM [--json FILE] [--filter REGEX] [--repetitions N] [--plots FOLDER] [--vantage FILE]
    PROGRAM       build/release/vantage_benchmarks
    --vantage     build/release/vantage: also times a whole reconstruction of the mug, from start to end of the process
    --json        keep the benchmark's output there, or with --read: take it from there instead of running
    --plots       also draw growth-views.svg, growth-rays.svg and growth-voxels.svg into this folder

Ratios are of medians of CPU time in one run, rows in random order; rows about threads go by the wall clock. A row whose
programs were not run is printed as "not run". Exit code 1 where a row failed, differs from its reference, or misses its
"must".
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

# job, fast row, baseline row, must, aim, whether the wall clock counts
ROWS = [
    ("80 views × 320², after 1 scan, against Bresenham", "evaluation_fast/scans:1/side:320",
     "evaluation_bresenham/scans:1/side:320/iterations:1", 250, 400, False),
    ("80 views × 320², after 4 scans, against Bresenham", "evaluation_fast/scans:4/side:320",
     "evaluation_bresenham/scans:4/side:320/iterations:1", 450, 800, False),
    ("80 views × 320², after 4 scans, against exact rays", "evaluation_fast/scans:4/side:320",
     "evaluation_exact/scans:4/side:320/iterations:1", None, None, False),
    ("80 views × 79², after 4 scans, against Bresenham", "evaluation_fast/scans:4/side:79",
     "evaluation_bresenham/scans:4/side:79/iterations:1", 60, 100, False),
    ("80 views × 320², after 4 scans, against OctoMap castRay", "evaluation_fast/scans:4/side:320",
     "evaluation_octomap/scans:4/side:320/iterations:1/repeats:1", 5000, 12000, False),
    ("80 views × 320², after 4 scans, against OpenVDB's hierarchical DDA", "evaluation_fast/scans:4/side:320",
     "evaluation_openvdb/scans:4/side:320/iterations:1", 80, 130, False),
    ("80 views × 320², after 4 scans, against Embree on voxel faces", "evaluation_fast/scans:4/side:320",
     "evaluation_embree/scans:4/side:320/iterations:1", 18, 35, False),
    ("1,280 views × 320², 405³ map, 109³ enclosure, against Bresenham multi-resolution", "finest_exhaustive",
     "finest_bresenham_multi_resolution/iterations:1", 8, 15, False),
    ("integrate the first 320² scan, against exact rays", "integration_fast/scan:1", "integration_exact/scan:1", 3, 9, False),
    ("integrate the fourth 320² scan, against exact rays", "integration_fast/scan:4", "integration_exact/scan:4", 18, 30,
     False),
    ("integrate the first 320² scan, against OctoMap with misses", "integration_fast/scan:1",
     "integration_octomap/scan:1/iterations:1", 250, 600, False),
    ("integrate the fourth 320² scan, against OctoMap with misses", "integration_fast/scan:4",
     "integration_octomap/scan:4/iterations:1", 250, 600, False),
    ("1,932 cube views × 320×240, after 4 scans, against Bresenham", "cube_fast",
     "cube_bresenham_every_16th/iterations:1", 350, 600, False),
    ("separable convolution over 1,932 cube views, against direct", "convolution_separable",
     "convolution_direct/iterations:1", 150, 400, False),
    ("two threads against one, 1,280 views", "evaluation_threads/threads:2/real_time",
     "evaluation_threads/threads:1/real_time", 1.7, 1.95, True),
]

# Rows that do a part of the job: by how much the whole is more.
PARTS = {"cube_bresenham_every_16th/iterations:1": 1932 / 121}

RECONSTRUCTION_LIMIT = 1.0  # seconds

# file, title, axis, row, which argument is on the axis
PLOTS = [
    ("growth-views.svg", "80 views × 320² rays, 55³ voxels: growth with views", "views", "growth_with_views", "views"),
    ("growth-rays.svg", "80 views, 55³ voxels: growth with rays", "rays per side", "growth_with_rays", "side"),
    ("growth-voxels.svg", "80 views × 320² rays: growth with voxels", "voxels per side of the enclosure",
     "growth_with_voxels", "enclosure"),
]


def run(program, name_filter, repetitions, path):
    """Runs the program; its table of single rows goes to standard error."""
    command = [program, f"--benchmark_out={path}", "--benchmark_out_format=json"]
    if name_filter:
        command.append(f"--benchmark_filter={name_filter}")
    if repetitions:
        command.append(f"--benchmark_repetitions={repetitions}")
    return subprocess.run(command, stdout=sys.stderr, check=False).returncode


def medians(report):
    """Row name -> median aggregate; a single repetition is its own median."""
    found = {}
    for row in report["benchmarks"]:
        if row.get("aggregate_name") == "median" or (row["run_type"] == "iteration" and row.get("repetitions") == 1):
            found[row["run_name"]] = row
    return found


def failures(report):
    for row in report["benchmarks"]:
        if row.get("error_occurred"):
            yield f"{row['run_name']}: {row.get('error_message')}"
        elif row.get("aggregate_name") in (None, "median") and row.get("differing", 0) != 0:
            yield f"{row['run_name']}: {row['differing']:.0f} voxels differ"


def milliseconds(row, wall):
    scale = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}[row["time_unit"]]
    return row["real_time" if wall else "cpu_time"] * scale


def table(rows):
    """The Markdown lines, and the jobs that miss their must."""
    lines = ["| job | fast [ms] | baseline [ms] | ratio | must | aim |", "|---|---|---|---|---|---|"]
    missed = []
    for job, fast, baseline, must, aim, wall in ROWS:
        goals = [f"{goal:,}×" if goal else "–" for goal in (must, aim)]
        if fast not in rows or baseline not in rows:
            lines.append(f"| {job} | | | not run | {goals[0]} | {goals[1]} |")
            continue
        fast_ms = milliseconds(rows[fast], wall)
        baseline_ms = milliseconds(rows[baseline], wall) * PARTS.get(baseline, 1)
        ratio = baseline_ms / fast_ms
        shown = f"{ratio:,.0f}×" if ratio >= 10 else f"{ratio:.2f}×"
        lines.append(f"| {job} | {fast_ms:.3g} | {baseline_ms:,.4g} | {shown} | {goals[0]} | {goals[1]} |")
        if must and ratio < must:
            missed.append(f"{job}: {shown} misses {goals[0]}")
    return lines, missed


def reconstruction(program, repetitions=5):
    """Median seconds of a whole reconstruction of the mug without mesh and report, by the wall clock and of CPU time."""
    walls, cpus = [], []
    for _ in range(repetitions):
        with tempfile.TemporaryDirectory() as folder:
            before, start = os.times(), time.monotonic()
            subprocess.run([program, "reconstruct", "mug", "--quiet", "--no-report", "--out", folder + "/mug"], check=True,
                           stdout=subprocess.DEVNULL)
            walls.append(time.monotonic() - start)
            after = os.times()
            cpus.append(after.children_user + after.children_system - before.children_user - before.children_system)
    return statistics.median(walls), statistics.median(cpus)


def plot(title, axis, points):
    """A log-log line of (x, milliseconds) as SVG text."""
    import math
    width, height, left, bottom, top = 520, 300, 70, 50, 40
    xs, ys = [math.log10(x) for x, _ in points], [math.log10(y) for _, y in points]
    x_low, x_high, y_low, y_high = min(xs), max(xs), math.floor(min(ys)), math.ceil(max(ys))

    def at(x, y):
        return (left + (x - x_low) / (x_high - x_low) * (width - left - 30),
                height - bottom - (y - y_low) / max(y_high - y_low, 1) * (height - bottom - top))
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
             f'font-size="12"><rect width="{width}" height="{height}" fill="white"/>',
             f'<text x="{left}" y="20" font-size="14">{title}</text>',
             f'<text x="{width / 2}" y="{height - 10}" text-anchor="middle">{axis}</text>',
             f'<text x="16" y="{height / 2}" text-anchor="middle" transform="rotate(-90 16 {height / 2})">ms, one thread</text>']
    for y in range(y_low, y_high + 1):
        _, py = at(x_low, y)
        parts.append(f'<path d="M{left} {py:.1f}H{width - 30}" stroke="#ddd"/>'
                     f'<text x="{left - 6}" y="{py + 4:.1f}" text-anchor="end">{10.0 ** y:g}</text>')
    pixels = [at(x, y) for x, y in zip(xs, ys)]
    parts.append('<polyline fill="none" stroke="#06c" stroke-width="2" points="'
                 + " ".join(f"{px:.1f},{py:.1f}" for px, py in pixels) + '"/>')
    for (px, py), (x, y) in zip(pixels, points):
        parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="#06c"/>'
                     f'<text x="{px:.1f}" y="{py - 8:.1f}" text-anchor="middle">{y:.3g}</text>'
                     f'<text x="{px:.1f}" y="{height - bottom + 16}" text-anchor="middle">{x:g}</text>')
    return "\n".join(parts) + "</svg>\n"


def draw_plots(rows, folder):
    for name, title, axis, prefix, argument in PLOTS:
        points = []
        for run_name, row in rows.items():
            if run_name.startswith(prefix + "/"):
                values = dict(part.split(":") for part in run_name.split("/")[1:])
                points.append((int(values[argument]), milliseconds(row, False)))
        if len(points) > 1:
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(plot(title, axis, sorted(points)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--json")
    parser.add_argument("--read", action="store_true")
    parser.add_argument("--filter")
    parser.add_argument("--repetitions", type=int)
    parser.add_argument("--plots")
    parser.add_argument("--vantage")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = options.json or os.path.join(folder, "benchmarks.json")
        code = 0 if options.read else run(options.program, options.filter, options.repetitions, path)
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
    rows = medians(report)
    lines, problems = table(rows)
    if options.vantage:
        wall, cpu = reconstruction(options.vantage)
        lines.append(f"| whole reconstruction of the mug, to `summary.json` | {1000 * wall:,.0f} ({1000 * cpu:,.0f} of CPU) | | | "
                     f"below {RECONSTRUCTION_LIMIT:g} s | |")
        if wall > RECONSTRUCTION_LIMIT:
            problems.append(f"whole reconstruction of the mug: {wall:.2f} s, must be below {RECONSTRUCTION_LIMIT:g} s")
    print("\n".join(lines))
    if options.plots:
        draw_plots(rows, options.plots)
    problems = list(failures(report)) + problems
    for problem in problems:
        print(problem, file=sys.stderr)
    sys.exit(1 if problems or code != 0 else 0)


if __name__ == "__main__":
    main()
