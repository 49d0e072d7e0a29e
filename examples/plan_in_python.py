"""Plans views of a mug in simulation, step by step, then with a utility of one's own.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/plan_in_python.py

# %% marks cells for editors that run a script piece by piece.
"""

# %% What there is: an object, a camera, views to choose from. Metres; poses are 4x4 arrays, world from sensor.
import math

import numpy as np

import vantage

scanner = vantage.RangeScanner(vantage.make_object("mug"))
camera = vantage.RangeCamera.from_apertures(math.radians(45), math.radians(45), (320, 320))
candidates = vantage.Candidates.sphere(80, radius=2.0)
scene_map = vantage.VoxelMap(vantage.SceneOptions(voxel_length=0.02, enclosure_size=[55, 55, 55]))

# %% Scan, update the map, ask for the next view. A real robot would hand its depth image, a numpy array, to RangeImage.
planner = vantage.Planner(candidates, camera)
view = candidates.views[0]
for scan in range(1, 4):
    depth = np.array(scanner.scan(camera, view).depth)  # float32 (320, 320): what a driver would give
    report = vantage.integrate(scene_map, vantage.RangeImage(camera, depth), view)
    plan = planner.next_best_view(scene_map, view)
    print(f"scan {scan}: {report.new_occupied} new occupied voxels; view {plan.best.candidate} is {plan.explanation}")
    view = plan.best.view

# %% The map as an array, and what a view would see of it.
labels = scene_map.labels()  # uint8 (55, 55, 55), indexed x, y, z
print("occupied voxels per height:", (labels == int(vantage.Label.occupied)).sum(axis=(0, 1))[15:40])
seen = vantage.VisibilityEvaluator(scene_map).see(camera, view, (320, 320))
print(f"the next view would see {seen.occplane} occplane voxels")


# %% A utility of one's own: what a view would see and the paper's factors in, a number out.
def as_many_unknown(seen, factors):
    return seen.occplane if seen.occupied > 100 else 0.0


plan = vantage.Planner(candidates, camera, utility=as_many_unknown).next_best_view(scene_map, view)
print(f"as many occplane voxels as possible: view {plan.best.candidate} with {plan.best.seen.occplane}")
