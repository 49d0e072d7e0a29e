"""An external planner for `vantage experiment compare --external`: takes the view that meets most occplane voxels and
lies nearest, in ten lines. Reads one JSON object per line from standard input, answers {"index": N} per line.

    vantage experiment compare --utilities combined,gain --external "python3 examples/external_planner.py"
"""

import json
import sys

for line in sys.stdin:
    choice = json.loads(line)  # choice["map"] names a NRRD file with the labels of all voxels
    best = max(choice["candidates"], key=lambda view: (view["n_op"] * (1 - 0.5 * view["travel"]), -view["index"]))
    print(json.dumps({"index": best["index"]}), flush=True)
