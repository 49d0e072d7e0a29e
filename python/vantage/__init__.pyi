"""Type stubs of vantage, made by python/make_stubs.py; a test compares them with the module."""

import enum
import pathlib
from typing import Any, Callable, Dict, List, Optional, Tuple, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str


class Error(RuntimeError):
    """What went wrong at run time: an unreadable file, a full disk. The text is that of the program `vantage`."""


class InputError(Error, ValueError):
    """Misuse or bad input: the text names the field, file or line, the value and what would be right. An Error too."""

def look_at(position: ArrayLike, target: ArrayLike) -> NDArray[numpy.float64]:
    """The 4x4 pose (world from sensor, metres) of a sensor at `position` that looks at `target`; up is +z."""


class RangeCamera:
    """A pinhole depth camera: its field of view, its pixels and its depth limits. Sensor axes: x right, y down, z forward; depths are along z. Build one with from_apertures, from_intrinsics or from_text."""
    @staticmethod
    def from_apertures(horizontal: float, vertical: float, resolution: Tuple[int, int], min_depth: float = 0.0, max_depth: float = 4.5, max_incidence: Optional[float] = None) -> RangeCamera:
        """A symmetric camera from its full apertures in radians and its resolution (columns, rows). Depth limits in metres; max_incidence is the largest angle between a surface's normal and the way to the sensor, radians."""
    @staticmethod
    def from_intrinsics(fx: float, fy: float, cx: float, cy: float, resolution: Tuple[int, int], min_depth: float = 0.0, max_depth: float = 4.5, max_incidence: Optional[float] = None) -> RangeCamera:
        """A camera from pinhole intrinsics in pixels; pixel centres lie at whole numbers. resolution = (columns, rows)."""
    @staticmethod
    def from_text(text: str) -> RangeCamera:
        """A camera as on the command line: 'HxV:COLUMNSxROWS', apertures in degrees, e.g. '45x45:320x320'."""
    @property
    def resolution(self) -> Tuple[int, int]:
        """(columns, rows) in pixels."""
    @property
    def min_depth(self) -> float:
        """Nearest depth, metres."""
    @min_depth.setter
    def min_depth(self, value: float) -> None: ...
    @property
    def max_depth(self) -> float:
        """Farthest depth, metres."""
    @max_depth.setter
    def max_depth(self, value: float) -> None: ...
    @property
    def max_incidence(self) -> Optional[float]:
        """Radians, or None for no limit."""
    @max_incidence.setter
    def max_incidence(self, value: Optional[float]) -> None: ...
    @property
    def horizontal_aperture(self) -> float:
        """Full aperture, radians."""
    @property
    def vertical_aperture(self) -> float:
        """Full aperture, radians."""
    def ideal_resolution(self, voxel_length: float, distance: float) -> Tuple[int, int]:
        """Eq. 14 of the paper: (columns, rows) at which neighbouring rays are one voxel apart at `distance` metres."""


class RangeImage:
    """Depth along the viewing axis per pixel, metres. 0 is unknown, infinity means that nothing is there up to the camera's far limit."""
    @overload
    def __init__(self, camera: RangeCamera, depth: ArrayLike, *, depth_scale: float = 0.001, no_return: Optional[int] = None) -> None: ...
    @overload
    def __init__(self, camera: RangeCamera, depth: ArrayLike) -> None: ...
    @property
    def camera(self) -> RangeCamera: ...
    @property
    def depth(self) -> NDArray[numpy.float32]:
        """float32 (rows, columns), metres: a view of the image, no copy."""
    def normals(self) -> NDArray[numpy.float32]:
        """Unit normals in the sensor frame, facing the sensor: float32 (rows, columns, 3); zero where there is none."""


class Label(enum.Enum):
    """What is known of a voxel; the numbers are those of labels() and map files."""
    unmarked = 0
    occupied = 1
    empty = 2
    occluded = 3
    occplane = 4


class SceneOptions:
    """The voxels of a scene and the object's enclosure in its middle."""
    def __init__(self, center: ArrayLike = ..., voxel_length: float = 0.02, scene_size: ArrayLike = ..., enclosure_size: ArrayLike = ...) -> None:
        """center (3,) and voxel_length in metres, sizes (3,) in voxels."""
    @property
    def center(self) -> NDArray[numpy.float64]:
        """(3,), metres."""
    @property
    def voxel_length(self) -> float:
        """Metres."""
    @property
    def scene_size(self) -> NDArray[numpy.int32]:
        """(3,) int32, voxels."""
    @property
    def enclosure_size(self) -> NDArray[numpy.int32]:
        """(3,) int32, voxels."""


class VoxelMap:
    """The scene with five labels per voxel. Only the enclosure is stored; everything outside it is empty for ever. Not to be changed while another thread uses it."""
    @overload
    def __init__(self, scene: SceneOptions) -> None: ...
    @overload
    def __init__(self, map: VoxelMap) -> None: ...
    @staticmethod
    def read(path: Union[str, pathlib.Path]) -> VoxelMap:
        """From NAME.nrrd and the NAME.ply beside it."""
    def write(self, path: Union[str, pathlib.Path]) -> None:
        """To NAME.nrrd (labels) and NAME.ply beside it (occupied voxels with normal and quality)."""
    @property
    def voxel_length(self) -> float:
        """Metres."""
    @property
    def origin(self) -> NDArray[numpy.float64]:
        """The corner of the enclosure's first voxel: (3,), metres. Voxel [i, j, k] of labels() covers origin + voxel_length * [i, j, k] to one voxel further."""
    @property
    def box(self) -> NDArray[numpy.float64]:
        """The enclosure's least and greatest corner: (2, 3), metres."""
    @property
    def enclosure(self) -> Tuple[NDArray[numpy.int32], NDArray[numpy.int32]]:
        """The first and the last voxel of the enclosure in scene indices, both (3,) int32."""
    @property
    def scene_size(self) -> NDArray[numpy.int32]:
        """Voxels of the scene: (3,) int32."""
    def labels(self) -> NDArray[numpy.uint8]:
        """Labels of the enclosure: uint8 (nx, ny, nz), indexed [x, y, z], x fastest in memory; the numbers are those of Label. A copy: the map itself packs its labels into bits."""
    def set_labels(self, labels: ArrayLike) -> None:
        """Replaces all labels of the enclosure: uint8 (nx, ny, nz). Voxels that are newly occupied have no normal."""
    def surface(self) -> dict:
        """The occupied voxels, x fastest: a dict of voxels (n, 3) int32 scene indices, centers (n, 3) metres, normals (n, 3) unit vectors or zero, quality (n,) cosines."""
    def count(self, label: Label) -> int:
        """Voxels of the whole scene with this label."""
    def mean_quality(self) -> float:
        """Mean over all occupied voxels, in [0, 1]; 0 where there are none."""


class Visibility:
    """What a view would see: numbers of distinct voxels that end a ray."""
    @property
    def rays(self) -> int: ...
    @property
    def occupied(self) -> int:
        """n_oc of the paper."""
    @property
    def occplane(self) -> int:
        """n_op of the paper."""
    @property
    def unmarked(self) -> int:
        """n_um of the paper."""
    @property
    def occluded(self) -> int:
        """Occluded but not occplane; they count in nothing."""


class VisibilityEvaluator:
    """What many views would see of one state of a map, prepared once. Make a new one after the map has changed. Exact: the voxels are those that rays would meet."""
    def __init__(self, map: VoxelMap) -> None: ...
    def see(self, camera: RangeCamera, view: ArrayLike, resolution: Tuple[int, int]) -> Visibility:
        """What the camera would see from a view (4x4, world from sensor) with rays of that resolution (columns, rows)."""
    def see_all(self, camera: RangeCamera, views: List[ArrayLike], resolution: Tuple[int, int]) -> List[Visibility]:
        """The same for many views, (N, 4, 4), in parallel; the same for any number of threads."""
    def visible_voxels(self, camera: RangeCamera, view: ArrayLike, resolution: Tuple[int, int]) -> NDArray[numpy.int32]:
        """The voxels that are counted: (n, 3) int32 scene indices, x fastest."""

def see_exactly(map: VoxelMap, camera: RangeCamera, view: ArrayLike, resolution: Tuple[int, int]) -> Visibility:
    """The slow definition of VisibilityEvaluator.see: one exact ray after the other."""


class PointCloud:
    """Surface points with unit normals, metres, in one frame."""
    def __init__(self, points: ArrayLike, normals: Optional[ArrayLike] = None) -> None:
        """points and normals: (n, 3), copied."""
    @property
    def points(self) -> NDArray[numpy.float64]:
        """float64 (n, 3), metres: a view, no copy."""
    @property
    def normals(self) -> NDArray[numpy.float64]:
        """float64 (n, 3), zero where unknown: a view, no copy."""
    def __len__(self) -> int: ...


class Scan:
    """One scan of any depth sensor, in its own frame."""
    def __init__(self, image: RangeImage) -> None:
        """A range image; the normals of its points are computed."""
    @staticmethod
    def from_points(points: ArrayLike, origins: ArrayLike, normals: Optional[ArrayLike] = None, axis: ArrayLike = ...) -> Scan:
        """A sensor without a pinhole: points (n, 3) and the origins of their sight lines (1 or n, 3), metres, sensor frame; normals (n, 3) facing the sensor; axis (3,) is the viewing direction."""
    @property
    def image(self) -> Optional[RangeImage]:
        """The RangeImage (a copy), or None for a sensor without a pinhole."""
    def points(self) -> PointCloud:
        """The measured points with their normals, sensor frame: a PointCloud."""


class IntegrationReport:
    """What a scan changed in the map."""
    @property
    def points_in_enclosure(self) -> int: ...
    @property
    def new_occupied(self) -> int:
        """Voxels."""

@overload
def integrate(map: VoxelMap, scan: Scan, view: ArrayLike, quality: str = 'axis') -> IntegrationReport: ...
@overload
def integrate(map: VoxelMap, image: RangeImage, view: ArrayLike, normals: Optional[ArrayLike] = None, quality: str = 'axis') -> IntegrationReport: ...


class Factors:
    """The factors of a view's utility (section 5 of the paper)."""
    @property
    def x_oc(self) -> float:
        """Share of occupied voxels among the visible ones."""
    @property
    def x_op(self) -> float:
        """Share of occplane voxels among the visible ones."""
    @property
    def f_area(self) -> float:
        """Eq. 7."""
    @property
    def f_navigation(self) -> float:
        """Eq. 10."""
    @property
    def f_quality(self) -> float:
        """Eq. 11."""
    @property
    def f_occlusion(self) -> float:
        """Eq. 12."""

def factors(seen: Visibility, normalised_distance: float, *, alpha_oc: float = 0.2, alpha_op: float = 0.8, rho: float = 0.2, navigation: bool = True) -> Factors:
    """The factors of a view that sees this, normalised_distance (0 to 1, eq. 10) from the current one."""

def combined_utility(factors: Factors) -> float:
    """Eq. 13."""

def gua_utility(factors: Factors) -> float:
    """Eq. 21, the greatest unknown area."""

def utility_names() -> List[str]:
    """Names of the utilities that Planner knows."""


class ViewToJudge:
    """A feasible view that a utility is asked about."""
    @property
    def candidate(self) -> int:
        """Index among the candidates."""
    @property
    def view(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor, metres."""
    @property
    def resolution(self) -> Tuple[int, int]:
        """(columns, rows) of the rays that it was seen with."""
    @property
    def ideal(self) -> Tuple[int, int]:
        """Eq. 14: (columns, rows) at which rays are one voxel apart."""
    @property
    def travel(self) -> float:
        """From the current view: x of eq. 10, in [0, 1]."""
    @property
    def seen(self) -> Visibility:
        """Visibility."""
    @property
    def factors(self) -> Factors:
        """Factors."""


class Choice:
    """The moment at which a view is to be chosen; to be looked at only while the utility is called."""
    @property
    def map(self) -> VoxelMap:
        """The VoxelMap that is planned on."""
    @property
    def camera(self) -> RangeCamera:
        """RangeCamera; a copy."""
    @property
    def current(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor."""
    @property
    def scanned(self) -> List[NDArray[numpy.float64]]:
        """Views from which scans were merged, in their order: a list of (4, 4)."""
    @property
    def seed(self) -> int:
        """For utilities that draw."""
    @property
    def views(self) -> List[ViewToJudge]:
        """The feasible views: a list of ViewToJudge."""
    def visible_voxels(self, view: int) -> NDArray[numpy.int32]:
        """What views[view] sees: (n, 3) int32 scene indices, x fastest."""


class SetUtility:
    """A utility that scores all views at once: function(choice) takes a Choice and returns one finite number for each of choice.views, in their order; higher is better, 0 or less is not worth a scan."""
    def __init__(self, function: function, *, needs_all_views: bool = False, skips_scanned_views: bool = False) -> None:
        """needs_all_views: it compares views, so it is asked once per plan, and multi-resolution search refuses it. skips_scanned_views: never choose a view twice."""


class Candidates:
    """The views to choose from; the index of a view is its identity."""
    def __init__(self, views: List[ArrayLike], center: ArrayLike) -> None:
        """Views of one's own, (N, 4, 4) world from sensor, around center (3,)."""
    @staticmethod
    def sphere(count: int, radius: float, center: ArrayLike = ...) -> Candidates:
        """View sphere: count = 20 * 4**k views at `radius` metres from center (3,), looking at it."""
    @staticmethod
    def cube(n: int, side: ArrayLike, inner_radius: float, outer_radius: float, center: ArrayLike = ...) -> Candidates:
        """View cube: the centres of n**3 cells of a box with edges side (3,), kept where they lie within the radii of center (3,), looking at it. Metres."""
    @staticmethod
    def from_text(text: str, center: ArrayLike = ...) -> Candidates:
        """As on the command line: 'sphere:80:2' or 'cube:17:4.1:0.82:1.9'."""
    @property
    def views(self) -> NDArray[numpy.float64]:
        """(N, 4, 4), world from sensor, metres."""
    @property
    def center(self) -> NDArray[numpy.float64]:
        """(3,), metres."""
    def __len__(self) -> int: ...


class Evaluation:
    """A candidate view with all that was found out about it."""
    @property
    def candidate(self) -> int:
        """Index among the candidates."""
    @property
    def view(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor, metres."""
    @property
    def feasible(self) -> bool: ...
    @property
    def reason(self) -> str:
        """Why it is not feasible; empty where it is."""
    @property
    def resolution(self) -> Tuple[int, int]:
        """(columns, rows) of the rays; (0, 0): not evaluated."""
    @property
    def seen(self) -> Visibility: ...
    @property
    def factors(self) -> Factors: ...
    @property
    def utility(self) -> float: ...
    @property
    def score(self) -> float:
        """What the ranking goes by: the utility, or the expected one under positioning error."""


class Plan:
    """The next best view with all that led to it."""
    @property
    def best(self) -> Evaluation: ...
    @property
    def ranking(self) -> List[Evaluation]:
        """Views that were evaluated to the end, best first."""
    @property
    def infeasible(self) -> List[Evaluation]:
        """Candidates that fell out, with the reason."""
    @property
    def explanation(self) -> str:
        """One sentence for people."""


class Planner:
    """Plans one view after the other.
    utility: the name of one, or a function that takes (Visibility, Factors) of a view and returns a number, higher is better (it may be asked more than once about a view), or a SetUtility.
    Options by keyword, as on the command line:
        body_radius = 0 [m]: radius of the robot's body around the sensor
        workspace = none [m]: box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given
        obstacles = none [m]: solid boxes cx,cy,cz,sx,sy,sz separated by ';'
        robot = none: YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md
        package = none: folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'
        travel = none: what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight
        search = exhaustive: exhaustive or multi-resolution
        rays = sensor: rays of the exhaustive search: sensor, ideal or COLUMNSxROWS
        multi_resolution_b = 10: b of eq. 16
        multi_resolution_stages = none: k; by default the smallest with b^k >= |V|
        multi_resolution_columns = 40: columns of the coarsest stage, R_min
        scan_time = 3 [s]: of tours: what a scan takes
        speed = 0.5 [m/s]: of tours: how fast the robot moves
        alpha_oc = 0.2: desired share of occupied voxels, eq. 7
        alpha_op = 0.8: desired share of occplane voxels, eq. 7
        rho = 0.2: navigation factor of the farthest view, eq. 10
        navigation = true: use the navigation factor
        believed_error = none [m]: standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at first; that of the robot if not given
        believed_orientation_error = none [degrees]: standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given
        believed_mean = none [m, degrees]: mean error that the planner assumes: x,y,z,pan,tilt,roll
        believed_covariance = none [m^2]: of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error
        believed_growth = none [m/m, degrees/m]: growth of the error that the planner assumes
        convolve = off: planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen from sampled poses, position and orientation)
        error_candidates = 12: strongest views that poses are sampled around
        error_samples = 32: poses around each of them, an even number
        least_overlap = 0.1: share of known surface in a view from which its scan counts as one that can be registered
        stop_occplane = 0 [voxels]: stop when no view sees more occplane voxels than this
        deadline = 0 [ms]: longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; 0: no deadline"""
    def __init__(self, candidates: Candidates, camera: RangeCamera, utility: Union[str, SetUtility, Callable[[Visibility, Factors], Any]] = 'combined', **options: Any) -> None:
        """See the class for the options."""
    def next_best_view(self, map: VoxelMap, current: ArrayLike) -> Optional[Plan]:
        """The Plan for the view to take next from `current` (4x4, world from sensor), or None where nothing is left to see; why_finished then says so."""
    def discard(self, candidate: int, reason: str) -> None:
        """The robot cannot reach this candidate: it is not planned again."""
    def set_aside(self, candidate: int, reason: str) -> None:
        """This candidate's scan could not be used: it is not planned again until map_changed()."""
    def scanned(self, view: ArrayLike, candidate: int = -1) -> None:
        """A scan from this view (4x4) was merged: for utilities that look at the views so far. -1: no candidate."""
    def map_changed(self) -> None:
        """Views that were set aside may be planned again."""
    @property
    def why_finished(self) -> str:
        """Why there is no next view."""
    @property
    def candidates(self) -> Candidates:
        """Candidates; a copy."""
    @property
    def camera(self) -> RangeCamera:
        """RangeCamera; a copy."""

def why_infeasible(map: VoxelMap, view: ArrayLike, *, body_radius: float = 0.0, workspace: Optional[ArrayLike] = None, obstacles: List[ArrayLike] = ...) -> Optional[str]:
    """Why the robot cannot be at a view (4x4), or None. body_radius in metres; boxes (2, 3): least, greatest corner."""

def convolve(utilities: ArrayLike, candidates: Candidates, *, sigma: Optional[ArrayLike] = None, covariance: Optional[ArrayLike] = None, mean: ArrayLike = ..., normalise: bool = False, truncate_sigmas: Optional[float] = None) -> NDArray[numpy.float64]:
    """Convolution after evaluation (section 7 of the paper): the expected utility (N,) of each candidate when the robot errs by sigma (3,) metres per axis or a covariance (3, 3), around mean (3,)."""


class RegistrationOptions:
    """How scans are registered; None means: by the sensor's noise."""
    def __init__(self, **options: Any) -> None:
        """Attributes by keyword, e.g. RegistrationOptions(starts=48)."""
    @property
    def starts(self) -> int:
        """Poses drawn from what is believed that the search begins at."""
    @starts.setter
    def starts(self, value: int) -> None: ...
    @property
    def outlier_share(self) -> float:
        """Share of what the sensor measures that may be wrong by more than its noise."""
    @outlier_share.setter
    def outlier_share(self, value: float) -> None: ...
    @property
    def largest_misplacement(self) -> Optional[float]:
        """How far surfaces may be put off by what remains unknown of the pose, metres."""
    @largest_misplacement.setter
    def largest_misplacement(self, value: Optional[float]) -> None: ...
    @property
    def ambiguity(self) -> float:
        """Largest probability that another pose is the right one."""
    @ambiguity.setter
    def ambiguity(self, value: float) -> None: ...


class Registration:
    """What registration found. Merge only a scan that succeeded."""
    @property
    def world_from_sensor(self) -> NDArray[numpy.float64]:
        """(4, 4), metres."""
    @property
    def overlap(self) -> float:
        """Share of the scan that lies on the model, 0 to 1."""
    @property
    def residual(self) -> float:
        """RMS distance of the overlap to the model, metres."""
    @property
    def verdict(self) -> str:
        """'registered', or why not."""
    @property
    def covariance(self) -> NDArray[numpy.float64]:
        """(6, 6): of the position (world axes, metres) and the rotation vector (world axes, radians)."""
    @property
    def misplacement(self) -> float:
        """Metres: standard deviation of 95 % of the scan's surface along its normals."""
    @property
    def undetermined_directions(self) -> int: ...
    @property
    def explanation(self) -> str:
        """One sentence for people."""
    @property
    def succeeded(self) -> bool: ...


class ModelSurface:
    """All merged scans, to register the next scan against."""
    def __init__(self, spacing: float, depth_noise: Optional[Tuple[float, float]] = None) -> None:
        """spacing: distance between the points of cloud(), metres. depth_noise: (A, B), the standard deviation of a depth z is A + B z^2 metres."""
    @overload
    def merge(self, scan: Scan, world_from_sensor: ArrayLike) -> None: ...
    @overload
    def merge(self, cloud: PointCloud, world_from_sensor: ArrayLike) -> None: ...
    def cloud(self) -> PointCloud:
        """The fused PointCloud, world frame; a copy."""

@overload
def register_scan(model: ModelSurface, scan: Scan, believed: ArrayLike, pose_error: float = 0.05, pose_angle_error: float = 5, options: RegistrationOptions = ...) -> Registration: ...
@overload
def register_scan(model: ModelSurface, scan: PointCloud, believed: ArrayLike, pose_error: float = 0.05, pose_angle_error: float = 5, options: RegistrationOptions = ...) -> Registration: ...


class TriangleMesh:
    """A surface as triangles, counter-clockwise seen from outside."""
    def __init__(self, vertices: ArrayLike, triangles: ArrayLike) -> None:
        """vertices (n, 3) metres, triangles (m, 3) indices; copied."""
    @staticmethod
    def read(path: Union[str, pathlib.Path]) -> TriangleMesh:
        """From a PLY, OBJ, STL or OFF file."""
    def write(self, path: Union[str, pathlib.Path]) -> None:
        """As binary PLY."""
    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """float64 (n, 3), metres; a copy."""
    @property
    def triangles(self) -> NDArray[numpy.int32]:
        """int32 (m, 3); a copy."""

def object_names() -> List[str]:
    """Names of the built-in objects."""

def make_object(name: str) -> TriangleMesh:
    """A built-in object at its default size, a TriangleMesh."""


class ScanRecord:
    """One scan of a reconstruction: where from, why, and what it brought."""
    @property
    def scan(self) -> int:
        """From 0."""
    @property
    def candidate(self) -> int:
        """-1: none of the candidates."""
    @property
    def commanded(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor."""
    @property
    def believed(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor."""
    @property
    def registered(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor."""
    @property
    def planned(self) -> Optional[Evaluation]:
        """The Evaluation that led here, or None."""
    @property
    def reason(self) -> str: ...
    @property
    def new_occupied(self) -> int:
        """Voxels."""
    @property
    def mean_quality(self) -> float: ...
    @property
    def distance(self) -> float:
        """Travelled so far, metres."""
    @property
    def coverage(self) -> Optional[float]:
        """Of the visible surface, 0 to 1; None where not simulated."""
    @property
    def coverage_all(self) -> Optional[float]:
        """Of the whole surface."""
    @property
    def merged(self) -> bool:
        """False where registration failed."""
    @property
    def merged_after(self) -> Optional[int]:
        """The scan after which it came into the map, or None."""
    @property
    def true_view(self) -> Optional[NDArray[numpy.float64]]:
        """(4, 4), world from sensor; None where not simulated."""
    @property
    def pose_error(self) -> Optional[float]:
        """Mean distance of its points from where they should be, metres; None where not simulated."""
    @property
    def overlap(self) -> float: ...
    @property
    def residual(self) -> float:
        """Metres."""
    @property
    def verdict(self) -> str: ...
    @property
    def labels(self) -> dict:
        """Voxels of the enclosure by label after the scan."""


class SimulatedRun:
    """What a reconstruction in simulation came to."""
    @property
    def map(self) -> VoxelMap: ...
    @property
    def scans(self) -> List[ScanRecord]:
        """List of ScanRecord."""
    def cloud(self) -> PointCloud:
        """The fused PointCloud; a copy."""
    @property
    def stop_reason(self) -> str: ...


class RangeScanner:
    """A noise-free range camera in front of a triangle mesh."""
    def __init__(self, mesh: TriangleMesh) -> None: ...
    def scan(self, camera: RangeCamera, view: ArrayLike) -> RangeImage:
        """The RangeImage that the camera takes from a view (4x4, world from sensor)."""
    def distance(self, point: ArrayLike) -> float:
        """From a point (3,) to the surface, metres."""


class SimulatedRobot:
    """A free flyer with a range camera that may err: it believes to be where it was sent."""
    def __init__(self, scanner: RangeScanner, camera: RangeCamera, *, positioning_error: ArrayLike = ..., depth_noise: List[float] = ..., sensor: str = 'ideal', seed: int = 1) -> None:
        """positioning_error (3,): standard deviation per axis, metres; depth_noise: A, B[, C] of A + B z^2 + C tan^2(incidence), instead of the deviation of the sensor, one of sensor_names, where it is not 0."""
    def move_to(self, view: ArrayLike) -> bool:
        """False where it cannot get there."""
    def take_range_image(self) -> RangeImage: ...
    @property
    def view(self) -> NDArray[numpy.float64]:
        """(4, 4), where the robot believes to be."""
    @property
    def true_view(self) -> NDArray[numpy.float64]:
        """(4, 4), where it is."""

def simulate(object: Union[str, TriangleMesh], on_scan: Optional[Callable[[ScanRecord, VoxelMap], None]] = None, utility: Union[str, SetUtility, Callable[[Visibility, Factors], Any]] = 'combined', **options: Any) -> SimulatedRun:
    """A whole reconstruction in simulation: a SimulatedRun.
    object: the name of a built-in object (object_names) or a TriangleMesh. on_scan(record, map): called after every scan with its record and a copy of the map. utility: as for Planner.
    Options by keyword, as on the command line; the same options give the same bits:
        size = none [m]: largest side of the object; default 0.815, built-in objects have their own
        seed = 1: seed of everything random
        initial_view = 0: index of the candidate that the first scan is taken from
        voxel = 0.02 [m]: edge of a voxel
        scene = 205,205,205 [voxels]: size of the scene
        enclosure = 55,55,55 [voxels]: size of the object's enclosure in the middle of the scene
        center = 0,0,0 [m]: center of the scene in the world
        camera = 45x45:320x320: apertures in degrees and pixels, HxV:COLUMNSxROWS
        depth_range = 0,4.5 [m]: nearest and farthest depth along the axis
        max_incidence = none [degrees]: largest angle between a surface's normal and the way back to the sensor; unlimited if not given
        sensor = ideal: how the sensor errs: ideal, primesense, realsense-d435, realsense-l515, azure-kinect, structured-light
        depth_noise = 0,0 [m, 1/m, m]: A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence); where not 0, instead of the sensor's
        mixed_pixels = none: share of the pixels at depth edges that measure something in between; the sensor's if not given
        flying_pixels = keep: pixels that no surface around them explains: remove or keep
        map = paper: how voxels become occupied: paper (by a point, for ever) or evidence
        quality = axis: what a point's quality is measured against: axis or ray
        candidates = sphere:80:2: candidate views: sphere:N:RADIUS or cube:N:SIDE:INNER:OUTER (metres)
        body_radius = 0 [m]: radius of the robot's body around the sensor
        workspace = none [m]: box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given
        obstacles = none [m]: solid boxes cx,cy,cz,sx,sy,sz separated by ';'
        robot = none: YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md
        package = none: folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'
        travel = none: what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight
        search = exhaustive: exhaustive or multi-resolution
        rays = sensor: rays of the exhaustive search: sensor, ideal or COLUMNSxROWS
        multi_resolution_b = 10: b of eq. 16
        multi_resolution_stages = none: k; by default the smallest with b^k >= |V|
        multi_resolution_columns = 40: columns of the coarsest stage, R_min
        utility = combined: how views are judged: combined, gua, gain, tour, oa, uv, rsv, rse, pc, ae, kriegel, massios-fisher, sanchiz-fisher, blaer-allen, apora, random, uniform
        plan = view: view: the next view by the utility; tour: the fastest tour over the rest of the scan, of which the first view is next, as the utility tour
        scan_time = 3 [s]: of tours: what a scan takes
        speed = 0.5 [m/s]: of tours: how fast the robot moves
        alpha_oc = 0.2: desired share of occupied voxels, eq. 7
        alpha_op = 0.8: desired share of occplane voxels, eq. 7
        rho = 0.2: navigation factor of the farthest view, eq. 10
        navigation = true: use the navigation factor
        positioning_error = 0,0,0 [m]: standard deviation of the robot's position per axis
        orientation_error = 0,0,0 [degrees]: standard deviation of the robot's pan, tilt and roll
        error_mean = 0,0,0,0,0,0 [m, degrees]: mean of the robot's error: x,y,z,pan,tilt,roll
        error_covariance = none [m^2]: of the robot's position: xx,xy,xz,yy,yz,zz; instead of positioning-error
        error_growth = 0,0,0,0,0,0 [m/m, degrees/m]: what the deviations x,y,z,pan,tilt,roll of the robot grow by with every metre of a move
        turntable_error = none [degrees, m]: deviations of azimuth, elevation and reach of an arm around a turntable; instead of the errors above
        believed_error = none [m]: standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at first; that of the robot if not given
        believed_orientation_error = none [degrees]: standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given
        believed_mean = none [m, degrees]: mean error that the planner assumes: x,y,z,pan,tilt,roll
        believed_covariance = none [m^2]: of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error
        believed_growth = none [m/m, degrees/m]: growth of the error that the planner assumes
        convolve = off: planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen from sampled poses, position and orientation)
        error_candidates = 12: strongest views that poses are sampled around
        error_samples = 32: poses around each of them, an even number
        least_overlap = 0.1: share of known surface in a view from which its scan counts as one that can be registered
        registrable = 0.5: where scans are registered: probability, planned from the overlap's information, that a view's scan ends up less than half a voxel off; views below come last; 0: do not plan for it
        registration = truth: pose of a scan: truth, none (the believed one) or icp
        max_views = 40: stop after this many scans
        max_distance = none: stop when this much has been travelled, as moves are counted: metres, or radians of an arm's joints
        max_time = none [s]: stop after this long
        stop_occplane = 0 [voxels]: stop when no view sees more occplane voxels than this
        deadline = 0 [ms]: longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; 0: no deadline"""

def reconstruct_options() -> list:
    """The options of simulate(): a list of dicts with name, default, unit and meaning."""


class ScanFile:
    """One scan of a set: where it was taken, as far as is believed."""
    @property
    def name(self) -> str: ...
    @property
    def view(self) -> NDArray[numpy.float64]:
        """(4, 4), world from sensor, metres."""
    def read(self) -> Scan:
        """Opens the file: a Scan."""


class ScanSet:
    """The scans of a folder, by name."""
    @property
    def scans(self) -> List[ScanFile]:
        """List of ScanFile."""
    @property
    def camera(self) -> Optional[RangeCamera]:
        """RangeCamera of depth images, or None."""
    def __len__(self) -> int: ...

def open_scans(path: Union[str, pathlib.Path], **options: Any) -> ScanSet:
    """Opens a folder of depth frames or clouds with poses, or a Stanford .conf: a ScanSet. Images and clouds are read on demand.
    Options by keyword, as on the command line:
        depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
        depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
        no_return = none: value of a depth image that says that nothing is there
        unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
        depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
        depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
        poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
        match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
        intrinsics = : file with the intrinsics; one of the usual names if not given
        masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
        confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
        unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
        hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
        crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
        cloud_frame = sensor: frame of the points of clouds: sensor, or world
        topic = : topic of a bag with depth images or clouds; the only one if not given
        frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
        every = 1: takes every n-th frame of a bag
        scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)"""

def read_pose(path: Union[str, pathlib.Path]) -> NDArray[numpy.float64]:
    """A pose (4, 4), camera to world, from a .txt or .json file."""

def write_pose(path: Union[str, pathlib.Path], pose: ArrayLike) -> None:
    """Writes a pose (4, 4) as text."""

def write_depth_png(path: Union[str, pathlib.Path], image: RangeImage, depth_scale: float = 0.001) -> None:
    """Writes a RangeImage as 16-bit PNG; 65535 stands for no return."""


class ScanModel:
    """What real scans, merged one after the other, come to, and what to scan next; the same as `vantage plan`.
    box: (2, 3), least and greatest corner of where the object is, metres.
    Options by keyword, as on the command line of `vantage plan`:
        box = none [m]: where the object is: cx,cy,cz,sx,sy,sz; around all points if not given
        voxel = none [m]: edge of a voxel; the longest side of the box over 55 if not given
        radius = none [m]: of the view sphere; the sensor's median distance from the box at merged scans if not given
        views = 80: candidates on the view sphere: 20*4^k
        registration = icp: icp, or none to take the poses as they are
        pose_error = 0.05 [m]: how far off the poses may be at most
        pose_angle_error = 5 [degrees]: how far turned the poses may be at most
        surroundings = 0.5 [box sides]: how far around the box things stand still, so that registration may use them
        sensor = none: how the sensor errs: ideal, primesense, realsense-d435, realsense-l515, azure-kinect, structured-light; estimated from the scans if neither this nor depth-noise is given
        depth_noise = none [m, 1/m, m]: A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence), instead of the sensor's
        flying_pixels = remove: pixels of depth images that no surface around them explains: remove (they become unknown) or keep
        map = evidence: how voxels become occupied: evidence (points against rays through them) or paper (by a point, for ever)
        depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
        depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
        no_return = none: value of a depth image that says that nothing is there
        unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
        depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
        depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
        poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
        match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
        intrinsics = : file with the intrinsics; one of the usual names if not given
        masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
        confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
        unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
        hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
        crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
        cloud_frame = sensor: frame of the points of clouds: sensor, or world
        topic = : topic of a bag with depth images or clouds; the only one if not given
        frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
        every = 1: takes every n-th frame of a bag
        scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)
        camera = 45x45:320x320: apertures in degrees and pixels, HxV:COLUMNSxROWS
        max_incidence = none [degrees]: largest angle between a surface's normal and the way back to the sensor; unlimited if not given
        body_radius = 0 [m]: radius of the robot's body around the sensor
        workspace = none [m]: box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given
        obstacles = none [m]: solid boxes cx,cy,cz,sx,sy,sz separated by ';'
        robot = none: YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md
        package = none: folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'
        travel = none: what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight
        search = exhaustive: exhaustive or multi-resolution
        rays = sensor: rays of the exhaustive search: sensor, ideal or COLUMNSxROWS
        multi_resolution_b = 10: b of eq. 16
        multi_resolution_stages = none: k; by default the smallest with b^k >= |V|
        multi_resolution_columns = 40: columns of the coarsest stage, R_min
        utility = combined: how views are judged: combined, gua, gain, tour, oa, uv, rsv, rse, pc, ae, kriegel, massios-fisher, sanchiz-fisher, blaer-allen, apora, random, uniform
        plan = view: view: the next view by the utility; tour: the fastest tour over the rest of the scan, of which the first view is next, as the utility tour
        scan_time = 3 [s]: of tours: what a scan takes
        speed = 0.5 [m/s]: of tours: how fast the robot moves
        alpha_oc = 0.2: desired share of occupied voxels, eq. 7
        alpha_op = 0.8: desired share of occplane voxels, eq. 7
        rho = 0.2: navigation factor of the farthest view, eq. 10
        navigation = true: use the navigation factor
        stop_occplane = 0 [voxels]: stop when no view sees more occplane voxels than this
        deadline = 0 [ms]: longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; 0: no deadline
        believed_error = none [m]: standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at first; that of the robot if not given
        believed_orientation_error = none [degrees]: standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given
        believed_mean = none [m, degrees]: mean error that the planner assumes: x,y,z,pan,tilt,roll
        believed_covariance = none [m^2]: of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error
        believed_growth = none [m/m, degrees/m]: growth of the error that the planner assumes
        convolve = off: planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen from sampled poses, position and orientation)
        error_candidates = 12: strongest views that poses are sampled around
        error_samples = 32: poses around each of them, an even number
        least_overlap = 0.1: share of known surface in a view from which its scan counts as one that can be registered"""
    def __init__(self, box: ArrayLike, **options: Any) -> None:
        """See the class for the options."""
    def add(self, scan: Scan, believed: ArrayLike, name: str = '', commanded: Optional[ArrayLike] = None) -> ScanRecord:
        """Registers a Scan from where the robot believes the sensor to be (4x4) and merges it where that succeeds: a ScanRecord. commanded: where the sensor was sent (4x4), from which believed_error='learn' learns."""
    def next_best_view(self) -> Optional[Plan]:
        """The Plan for the next scan, or None where nothing is left to see."""
    @property
    def why_finished(self) -> str:
        """Why next_best_view gives none; empty where it gives one."""
    @property
    def map(self) -> VoxelMap:
        """The VoxelMap; it changes with every scan."""
    @property
    def current(self) -> NDArray[numpy.float64]:
        """(4, 4), where the last scan was taken."""
    @property
    def scans(self) -> List[ScanRecord]:
        """List of ScanRecord."""
    def cloud(self) -> PointCloud:
        """The fused PointCloud, world frame; a copy."""

def read_scans(path: Union[str, pathlib.Path], on_scan: Optional[Callable[[ScanRecord], None]] = None, **options: Any) -> ScanModel:
    """The ScanModel of all scans of a folder or a Stanford .conf; where no box is given it lies around all points.
    box here is cx,cy,cz,sx,sy,sz. on_scan(record): called after every scan.
    Options by keyword, as on the command line of `vantage plan`:
        box = none [m]: where the object is: cx,cy,cz,sx,sy,sz; around all points if not given
        voxel = none [m]: edge of a voxel; the longest side of the box over 55 if not given
        radius = none [m]: of the view sphere; the sensor's median distance from the box at merged scans if not given
        views = 80: candidates on the view sphere: 20*4^k
        registration = icp: icp, or none to take the poses as they are
        pose_error = 0.05 [m]: how far off the poses may be at most
        pose_angle_error = 5 [degrees]: how far turned the poses may be at most
        surroundings = 0.5 [box sides]: how far around the box things stand still, so that registration may use them
        sensor = none: how the sensor errs: ideal, primesense, realsense-d435, realsense-l515, azure-kinect, structured-light; estimated from the scans if neither this nor depth-noise is given
        depth_noise = none [m, 1/m, m]: A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence), instead of the sensor's
        flying_pixels = remove: pixels of depth images that no surface around them explains: remove (they become unknown) or keep
        map = evidence: how voxels become occupied: evidence (points against rays through them) or paper (by a point, for ever)
        depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
        depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
        no_return = none: value of a depth image that says that nothing is there
        unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
        depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
        depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
        poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
        match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
        intrinsics = : file with the intrinsics; one of the usual names if not given
        masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
        confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
        unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
        hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
        crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
        cloud_frame = sensor: frame of the points of clouds: sensor, or world
        topic = : topic of a bag with depth images or clouds; the only one if not given
        frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
        every = 1: takes every n-th frame of a bag
        scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)
        camera = 45x45:320x320: apertures in degrees and pixels, HxV:COLUMNSxROWS
        max_incidence = none [degrees]: largest angle between a surface's normal and the way back to the sensor; unlimited if not given
        body_radius = 0 [m]: radius of the robot's body around the sensor
        workspace = none [m]: box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given
        obstacles = none [m]: solid boxes cx,cy,cz,sx,sy,sz separated by ';'
        robot = none: YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md
        package = none: folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'
        travel = none: what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight
        search = exhaustive: exhaustive or multi-resolution
        rays = sensor: rays of the exhaustive search: sensor, ideal or COLUMNSxROWS
        multi_resolution_b = 10: b of eq. 16
        multi_resolution_stages = none: k; by default the smallest with b^k >= |V|
        multi_resolution_columns = 40: columns of the coarsest stage, R_min
        utility = combined: how views are judged: combined, gua, gain, tour, oa, uv, rsv, rse, pc, ae, kriegel, massios-fisher, sanchiz-fisher, blaer-allen, apora, random, uniform
        plan = view: view: the next view by the utility; tour: the fastest tour over the rest of the scan, of which the first view is next, as the utility tour
        scan_time = 3 [s]: of tours: what a scan takes
        speed = 0.5 [m/s]: of tours: how fast the robot moves
        alpha_oc = 0.2: desired share of occupied voxels, eq. 7
        alpha_op = 0.8: desired share of occplane voxels, eq. 7
        rho = 0.2: navigation factor of the farthest view, eq. 10
        navigation = true: use the navigation factor
        stop_occplane = 0 [voxels]: stop when no view sees more occplane voxels than this
        deadline = 0 [ms]: longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; 0: no deadline
        believed_error = none [m]: standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at first; that of the robot if not given
        believed_orientation_error = none [degrees]: standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given
        believed_mean = none [m, degrees]: mean error that the planner assumes: x,y,z,pan,tilt,roll
        believed_covariance = none [m^2]: of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error
        believed_growth = none [m/m, degrees/m]: growth of the error that the planner assumes
        convolve = off: planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen from sampled poses, position and orientation)
        error_candidates = 12: strongest views that poses are sampled around
        error_samples = 32: poses around each of them, an even number
        least_overlap = 0.1: share of known surface in a view from which its scan counts as one that can be registered"""

def scan_from_depth(depth: ArrayLike, intrinsics: ArrayLike, pose: ArrayLike, distortion: List[float] = ..., mask: Optional[ArrayLike] = None, **options: Any) -> Tuple[Scan, NDArray[numpy.float64]]:
    """A Scan and the pose (4, 4) of its sensor from arrays as a driver and a robot give them.
    depth: (rows, columns), uint16 in units of depth_scale, or floating-point numbers in `unit` (infinite: nothing there; 0, negative or NaN: unknown). intrinsics: (3, 3), pixels. pose: (4, 4), world from sensor, or from the robot's hand with hand_eye; its position in `unit`. distortion: k1 k2 p1 p2 k3 k4 k5 k6, or fewer. mask: (rows, columns), zero where a pixel does not count.
    Options by keyword, as on the command line:
        depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
        depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
        no_return = none: value of a depth image that says that nothing is there
        unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
        depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
        depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
        poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
        match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
        intrinsics = : file with the intrinsics; one of the usual names if not given
        masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
        confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
        unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
        hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
        crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
        cloud_frame = sensor: frame of the points of clouds: sensor, or world
        topic = : topic of a bag with depth images or clouds; the only one if not given
        frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
        every = 1: takes every n-th frame of a bag
        scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)"""


class SessionStatus:
    """How a session stands."""
    @property
    def stored(self) -> int:
        """Scans that are safe on disk."""
    @property
    def integrated(self) -> int:
        """Scans that were registered, with or without success."""
    @property
    def merged(self) -> int:
        """Scans that are in the map."""
    @property
    def removed(self) -> Set[int]:
        """Numbers of the scans that were taken out."""
    @property
    def skipped(self) -> Dict[int, str]:
        """Candidates that are not planned: {index: reason}."""
    @property
    def dropped(self) -> List[str]:
        """What opening the session left out, a sentence each."""
    @property
    def warnings(self) -> List[str]:
        """What could not be written since, a sentence each."""
    @property
    def radius(self) -> float:
        """Of the sphere of candidate views, metres."""
    @property
    def distance(self) -> float:
        """Travelled so far, metres."""
    @property
    def learned_error(self) -> Optional[dict]:
        """What the scans from planned views have taught of the robot's error, where believed_error is 'learn', else None: a dict of observations, left_out (taken for registrations that went wrong), mean (6,) and covariance (6, 6) of x, y, z, pan, tilt and roll, metres and radians."""


class Session:
    """A reconstruction in a folder, over hours and across restarts: scans are added to it and views asked of it. Every scan is safe on disk before add() returns, and the same scans give the same map and plans as `vantage plan` and `vantage session`, which may go on with the folder. One process at a time. Any thread may call any member.
    Session(folder) opens one that is there, Session.new(folder, box=..., ...) makes one; `with` closes it."""
    def __init__(self, folder: Union[str, pathlib.Path]) -> None:
        """Opens a session."""
    @staticmethod
    def new(folder: Union[str, pathlib.Path], **options: Any) -> Session:
        """Makes a session of a folder and opens it. Options by keyword, as those of `vantage session new`; box is required:
            box = none [m]: where the object is: cx,cy,cz,sx,sy,sz; around all points if not given
            voxel = none [m]: edge of a voxel; the longest side of the box over 55 if not given
            radius = none [m]: of the view sphere; the sensor's median distance from the box at merged scans if not given
            views = 80: candidates on the view sphere: 20*4^k
            registration = icp: icp, or none to take the poses as they are
            pose_error = 0.05 [m]: how far off the poses may be at most
            pose_angle_error = 5 [degrees]: how far turned the poses may be at most
            surroundings = 0.5 [box sides]: how far around the box things stand still, so that registration may use them
            sensor = none: how the sensor errs: ideal, primesense, realsense-d435, realsense-l515, azure-kinect, structured-light; estimated from the scans if neither this nor depth-noise is given
            depth_noise = none [m, 1/m, m]: A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence), instead of the sensor's
            flying_pixels = remove: pixels of depth images that no surface around them explains: remove (they become unknown) or keep
            map = evidence: how voxels become occupied: evidence (points against rays through them) or paper (by a point, for ever)
            depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
            depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
            no_return = none: value of a depth image that says that nothing is there
            unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
            depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
            depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
            poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
            match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
            intrinsics = : file with the intrinsics; one of the usual names if not given
            masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
            confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
            unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
            hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
            crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
            cloud_frame = sensor: frame of the points of clouds: sensor, or world
            topic = : topic of a bag with depth images or clouds; the only one if not given
            frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
            every = 1: takes every n-th frame of a bag
            scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)
            camera = 45x45:320x320: apertures in degrees and pixels, HxV:COLUMNSxROWS
            max_incidence = none [degrees]: largest angle between a surface's normal and the way back to the sensor; unlimited if not given
            body_radius = 0 [m]: radius of the robot's body around the sensor
            workspace = none [m]: box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given
            obstacles = none [m]: solid boxes cx,cy,cz,sx,sy,sz separated by ';'
            robot = none: YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md
            package = none: folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'
            travel = none: what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight
            search = exhaustive: exhaustive or multi-resolution
            rays = sensor: rays of the exhaustive search: sensor, ideal or COLUMNSxROWS
            multi_resolution_b = 10: b of eq. 16
            multi_resolution_stages = none: k; by default the smallest with b^k >= |V|
            multi_resolution_columns = 40: columns of the coarsest stage, R_min
            utility = combined: how views are judged: combined, gua, gain, tour, oa, uv, rsv, rse, pc, ae, kriegel, massios-fisher, sanchiz-fisher, blaer-allen, apora, random, uniform
            plan = view: view: the next view by the utility; tour: the fastest tour over the rest of the scan, of which the first view is next, as the utility tour
            scan_time = 3 [s]: of tours: what a scan takes
            speed = 0.5 [m/s]: of tours: how fast the robot moves
            alpha_oc = 0.2: desired share of occupied voxels, eq. 7
            alpha_op = 0.8: desired share of occplane voxels, eq. 7
            rho = 0.2: navigation factor of the farthest view, eq. 10
            navigation = true: use the navigation factor
            stop_occplane = 0 [voxels]: stop when no view sees more occplane voxels than this
            deadline = 0 [ms]: longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; 0: no deadline
            believed_error = none [m]: standard deviation per axis that the planner assumes; or learn, or learn:SX,SY,SZ with what to assume at first; that of the robot if not given
            believed_orientation_error = none [degrees]: standard deviation of pan, tilt and roll that the planner assumes; that of the robot if not given
            believed_mean = none [m, degrees]: mean error that the planner assumes: x,y,z,pan,tilt,roll
            believed_covariance = none [m^2]: of the position, as the planner assumes: xx,xy,xz,yy,yz,zz; instead of believed-error
            believed_growth = none [m/m, degrees/m]: growth of the error that the planner assumes
            convolve = off: planning with the believed error: off, on (convolution after evaluation), normalised, or samples (what is seen from sampled poses, position and orientation)
            error_candidates = 12: strongest views that poses are sampled around
            error_samples = 32: poses around each of them, an even number
            least_overlap = 0.1: share of known surface in a view from which its scan counts as one that can be registered"""
    def add(self, scan: Scan, believed: ArrayLike, name: str = '', candidate: Optional[int] = None, commanded: Optional[ArrayLike] = None) -> ScanRecord:
        """Adds a Scan from where the robot believes the sensor to be (4x4, world from sensor, metres): it is stored, then registered and merged where that succeeds. candidate: index of the planned view that it was taken from; commanded: where the sensor was sent (4x4), by default that view. Returns its ScanRecord once it is safe on disk."""
    def add_depth(self, depth: ArrayLike, intrinsics: ArrayLike, pose: ArrayLike, distortion: List[float] = ..., mask: Optional[ArrayLike] = None, name: str = '', candidate: Optional[int] = None) -> ScanRecord:
        """Adds a depth image as scan_from_depth() reads it, by the session's options (depth_scale, unit, hand_eye, crop, ...): depth (rows, columns), uint16 or floating-point; intrinsics (3, 3); pose (4, 4) as the robot reports it; mask (rows, columns), zero where a pixel does not count. Returns its ScanRecord once it is safe on disk."""
    def add_files(self, path: Union[str, pathlib.Path], candidate: Optional[int] = None, **options: Any) -> List[ScanRecord]:
        """Adds scans as `vantage session add` does: a depth frame or cloud with its pose beside it, a folder of them, or a Stanford .conf. Those that are there already with the same measurements and pose are left out, with a warning. candidate: index of the planned view that this one scan was taken from. A list of ScanRecord.
        The session's options of reading, which keywords change for these scans alone:
            depth_scale = none [m]: what one unit of a depth image means; what the data set says, else 0.001, if not given
            depth_range = 0,4.5 [m]: nearest and farthest depth to trust; beyond is free space up to the limit
            no_return = none: value of a depth image that says that nothing is there
            unknown = none: value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf
            depth_along = axis: what depths are measured along: axis (z), or ray (distance from the sensor)
            depth = : pattern of the depth images below the folder, like depth/*.png; recognised if not given
            poses = : folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given
            match = auto: how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto
            intrinsics = : file with the intrinsics; one of the usual names if not given
            masks = : folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given
            confidence = : FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown
            unit = m: unit of poses, clouds and floating-point depths: m, cm, mm or inch
            hand_eye =  [unit]: pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's
            crop = none [m]: box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing
            cloud_frame = sensor: frame of the points of clouds: sensor, or world
            topic = : topic of a bag with depth images or clouds; the only one if not given
            frame = : frame of a bag's /tf that is the world; the root of the sensor's tree if not given
            every = 1: takes every n-th frame of a bag
            scanner_origin = 0.18,1.3 [m]: y,z of the sight lines' origin of a line scanner (.conf)"""
    def next(self) -> Optional[Plan]:
        """The Plan for the next scan, its views in rank with their factors and what fell out with the reason; None where there is none, why_finished then says so. Does not wait for a registration in another thread."""
    @property
    def why_finished(self) -> str:
        """Why next() gives none; empty where it gives one."""
    def skip(self, candidate: int, reason: str) -> None:
        """This candidate is not planned again: it could not be reached, or nobody wants it."""
    def unskip(self, candidate: int) -> None:
        """Takes skip() back."""
    def remove(self, number: int) -> None:
        """Takes a scan out, as if it had never come: those after it are registered again. Its file is kept."""
    def restore(self, number: int) -> None:
        """Takes remove() back."""
    def status(self) -> SessionStatus:
        """How it stands: SessionStatus."""
    @property
    def map(self) -> VoxelMap:
        """The VoxelMap after the last integrated scan; a copy."""
    @property
    def scans(self) -> List[ScanRecord]:
        """List of ScanRecord, in the order of the scans."""
    @property
    def current(self) -> NDArray[numpy.float64]:
        """(4, 4), where the last scan was taken."""
    def cloud(self) -> PointCloud:
        """The fused PointCloud in the box, world frame; a copy."""
    def finish(self, conclude: bool = False) -> None:
        """Writes map.nrrd, map.ply, model.ply, mesh.ply, views.csv, summary.json and report.html into the folder. conclude: refused scans are tried again and all poses improved together before. Scans may be added afterwards."""
    @property
    def folder(self) -> Union[str, pathlib.Path]:
        """Path of the session."""
    @property
    def is_open(self) -> bool:
        """False after close()."""
    def close(self) -> None:
        """Lets others open the session; this one can no longer be used."""
    def __enter__(self) -> Session: ...
    def __exit__(self, *args: Any) -> None: ...
