"""A reconstruction over hours from Python: depth images as arrays in, the next view out, and nothing lost in between.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/session_in_python.py [FOLDER]

# %% marks cells for editors that run a script piece by piece. The arm and its camera are simulated here.
"""

# %% What stands for the robot: go_to() moves the camera and returns what its driver would give, a uint16 image in
# millimetres. The pose that the arm reports is that of its hand; the camera sits 5 cm in front of it, turned by 90 degrees.
import pathlib
import sys
import tempfile

import numpy as np

import vantage

columns, rows = 160, 120
intrinsics = np.array([[190.0, 0, 79.5], [0, 190.0, 59.5], [0, 0, 1]])
hand_from_camera = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0.05], [0, 0, 0, 1]])
scanner = vantage.RangeScanner(vantage.make_object("mug"))
camera = vantage.RangeCamera.from_intrinsics(190, 190, 79.5, 59.5, (columns, rows))


def go_to(view):
    metres = scanner.scan(camera, view).depth
    millimetres = np.where(np.isfinite(metres), np.round(1000 * metres), 65535).astype(np.uint16)
    return millimetres, view @ np.linalg.inv(hand_from_camera)


# %% A session is a folder. What the files and arrays mean is said once.
folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()) / "mug"
(folder.parent / "hand_eye.txt").write_text("\n".join(" ".join(map(str, row)) for row in hand_from_camera) + "\n")
options = dict(box=[0, 0, 0, 1, 1, 1], voxel=0.02, radius=2, no_return=65535, hand_eye=folder.parent / "hand_eye.txt",
               workspace=[-3, -3, -0.5, 3, 3, 3])
with vantage.Session.new(folder, **options) as session:
    depth, hand = go_to(vantage.look_at([2, 0, 0.5], [0, 0, 0]))
    record = session.add_depth(depth, intrinsics, hand, name="first")
    print(f"first: {record.new_occupied} new occupied voxels")
    plan = session.next()
    print(f"view {plan.best.candidate} is {plan.explanation}")
    out_of_reach = plan.infeasible[0]
    print(f"{len(plan.infeasible)} views fell out, for example {out_of_reach.candidate}: {out_of_reach.reason}")

# %% The program may be started again at any time, here by opening the folder once more. A view that the arm cannot reach
# after all is skipped, and the next in rank is at hand.
with vantage.Session(folder) as session:
    session.skip(session.next().best.candidate, "the cable is too short")
    for scan in range(2, 5):
        best = session.next().best
        depth, hand = go_to(best.view)
        record = session.add_depth(depth, intrinsics, hand, name=f"scan {scan}", candidate=best.candidate)
        print(f"scan {scan} from view {best.candidate}: {record.new_occupied} new occupied voxels, {record.verdict}")
    status = session.status()
    print(f"{status.merged} of {status.stored} scans merged, {status.distance:.2f} m travelled, skipped: {status.skipped}")

    # %% The map as an array, and everything as files: map, model, mesh, views.csv, summary.json, report.html.
    labels = session.map.labels()
    print("occupied voxels:", (labels == int(vantage.Label.occupied)).sum())
    session.finish()
    print("written:", ", ".join(sorted(path.name for path in folder.iterdir() if path.is_file())))
