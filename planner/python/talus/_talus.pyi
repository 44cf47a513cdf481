import os
from typing import Any, Callable, ClassVar, Mapping, Optional, Sequence, TypedDict, Union

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.floating[Any]]
_Bytes = Union[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]
_Progress = Optional[Callable[[float], object]]
_Point = tuple[float, float]
_Place = Union[tuple[float, float], str]
_Path = Union[str, os.PathLike[str]]
_Table = Union[str, os.PathLike[str], Mapping[str, npt.NDArray[Any]]]
_CATEGORIES: tuple[tuple[str, int], ...]
__version__: str

class _Thresholds(TypedDict, total=False):
    slope_margin_rad: float
    sinkage_threshold: float
    sinkage_critical: float
    max_immobilisation: float
    time_weight_W: float
    risk_weight_J: float
    entrapment: float
    pose_error_m: float
    allow_marginal: bool
    allow_dangerous: bool
    allow_unknown: bool
    unmonitored: bool

class _Cause(TypedDict):
    name: str
    value: float
    std: float
    source: str
    remark: str

class _Explanation(TypedDict):
    category: str
    probability: float
    verdict: str
    x_m: float
    y_m: float
    column: int
    row: int
    causes: list[_Cause]

class _WheelForces(TypedDict):
    sinkage_m: float
    entry_angle_rad: float
    torque_Nm: float
    drawbar_pull_N: float
    side_force_N: float

class InputError(ValueError): ...

class Rover:
    """A rover of the library by name, or of a YAML file. SI units."""
    centre_of_mass_height_m: float
    clearance_m: float
    gravity_m_s2: float
    grouser_count: int
    grouser_height_m: float
    hotel_power_W: float
    mass_kg: float
    max_pitch_rad: float
    max_roll_rad: float
    max_speed_mps: float
    max_torque_Nm: float
    name: str
    track_m: float
    turning_radius_m: float
    wheel_count: int
    wheel_radius_m: float
    wheel_width_m: float
    wheelbase_m: float
    def __init__(self, name: str) -> None: ...

class Soil:
    """Mean soil of the library by name, or of a YAML file. SI units."""
    c1: float
    c2: float
    cohesion_Pa: float
    cohesive_modulus: float
    density_kg_m3: float
    friction_angle_rad: float
    frictional_modulus: float
    name: str
    shear_modulus_m: float
    sinkage_exponent: float
    def __init__(self, name: str) -> None: ...

class SoilEstimate:
    """Soil from telemetry; NaN where the method gives no number."""
    @property
    def cohesion_Pa(self) -> float: ...
    @property
    def covariance(self) -> npt.NDArray[np.float64]:
        """of (c, tan phi)"""
    @property
    def friction_angle_rad(self) -> float: ...
    @property
    def rows_rejected(self) -> int: ...
    @property
    def rows_used(self) -> int: ...
    @property
    def shear_modulus_m(self) -> float: ...
    @property
    def sinkage_exponent(self) -> float: ...
    @property
    def warnings(self) -> list[str]: ...

class TracedEffect:
    """An effect that residuals show and the base model lacks."""
    @property
    def alternatives(self) -> list[str]:
        """names of others that explain it about as well"""
    @property
    def channel(self) -> str:
        """where it shows most"""
    @property
    def covariate(self) -> str:
        """the column that explains it"""
    @property
    def curve(self) -> tuple[list[float], list[float]]:
        """(knots, values) where it matches no known form"""
    @property
    def formula(self) -> str: ...
    @property
    def log_likelihood_gain(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def p_value(self) -> float: ...
    @property
    def parameters(self) -> dict[str, float]:
        """of a known form, by name; SI units"""

class Trace:
    """What a wheel model lacks. Errors are root mean squares by channel, as shares of load, of load times radius
    (torque) or of radius (sinkage)."""
    def model_text(self) -> str:
        """The refined model as a YAML file has it, for base= and `talus predict --model`."""
    @property
    def applies(self) -> bool:
        """whether a rigid wheel on soil, with physical effects, describes the rows"""
    @property
    def applies_reason(self) -> str: ...
    @property
    def base_rmse(self) -> dict[str, float]: ...
    @property
    def beyond_axle(self) -> int:
        """rows left out because the wheel is sunk to its axle"""
    @property
    def effects(self) -> list[TracedEffect]: ...
    @property
    def held_out_base_rmse(self) -> dict[str, float]: ...
    @property
    def held_out_refined_rmse(self) -> dict[str, float]: ...
    @property
    def held_out_scheme(self) -> str:
        """what was held out together"""
    @property
    def noise_floor(self) -> dict[str, float]: ...
    @property
    def refined_rmse(self) -> dict[str, float]: ...
    @property
    def rows_rejected(self) -> int: ...
    @property
    def rows_used(self) -> int: ...
    @property
    def verdict(self) -> str:
        """explained, nothing_missing or unexplained"""

class Route:
    """A route, or why there is none. route['x_m'] is a column, one value a vertex."""
    COLUMNS: ClassVar[tuple[str, ...]]
    def __getitem__(self, column: str) -> npt.NDArray[np.float64]:
        """A column, read-only, without a copy."""
    def __len__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    @property
    def cost_J(self) -> float: ...
    @property
    def energy_J(self) -> float: ...
    @property
    def energy_p90_J(self) -> float: ...
    @property
    def time_p90_s(self) -> float: ...
    @property
    def gap(self) -> float: ...
    @property
    def found(self) -> bool: ...
    @property
    def immobilisation_risk(self) -> float: ...
    @property
    def length_m(self) -> float: ...
    @property
    def lower_bound_J(self) -> float: ...
    @property
    def max_slip(self) -> float: ...
    @property
    def max_slope_rad(self) -> float: ...
    @property
    def planner(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def status(self) -> str:
        """found, no_route, none_found, start_invalid, goal_invalid, timed_out or cancelled"""
    @property
    def time_s(self) -> float: ...

class Score(Route):
    """What a polyline costs: a route, and where and why it may not be driven."""
    @property
    def best(self) -> Optional[Route]:
        """With prove: the best route between the ends, else None."""
    @property
    def status(self) -> str:
        """found, or infeasible: its cost is then infinite"""
    @property
    def violations(self) -> list[tuple[float, float, str]]:
        """(x_m, y_m, reason) each"""

class Map:
    """What is known of the ground, estimates of its strength, and routes over it. Arrays have row 0 in the south."""
    def __init__(
        self,
        heights: _Floats,
        *,
        resolution_m: float,
        rover: Union[str, Rover],
        soils: Union[str, Soil, dict[int, str], dict[int, Soil]],
        classes: Optional[_Bytes] = None,
        rocks: Optional[_Floats] = None,
        keep_out: Optional[_Bytes] = None,
        layers: dict[str, npt.NDArray[np.floating[Any]]] = ...,
        south_west: _Point = ...,
        crs: str = "",
        thresholds: _Thresholds = ...,
        allow_unknown: bool = False,
        threads: int = 1,
    ) -> None:
        """heights: float32 or float64, NaN where not observed. soils: a name or Soil, or a dict of class numbers
        to them. layers: joules a metre to add by name; inf is refused, NaN not known. crs: EPSG code or WKT;
        without it x and y are local metres. thresholds: as in a mission file."""
    def _repr_html_(self) -> str: ...
    def beliefs(self) -> dict[str, npt.NDArray[Any]]:
        """Columns by cell: pull_mean, pull_std, sinkage_mean, sinkage_std, evidence, category, hazards."""
    def categories(self) -> npt.NDArray[np.uint8]:
        """Category of each cell in its worst heading: 0 safe, 1 marginal, 2 dangerous, 3 unknown."""
    def dangers(self, path: _Floats, quantile: float = 0.05) -> list[tuple[float, float, float, float, str]]:
        """Where a path of shape (n, 2) is not safe: (x_m, y_m, along_m, probability, reason) each."""
    def explain(self, place: _Place, heading_rad: Optional[float] = None) -> _Explanation:
        """Category of a cell and its causes, as `talus explain`; without a heading in the worst one."""
    @staticmethod
    def from_files(
        elevation: _Path,
        *,
        rover: str = "",
        soil: str = "",
        soils: str = "",
        model: str = "",
        classes: str = "",
        rocks: str = "",
        keep_out: Sequence[str] = ...,
        layers: Mapping[str, str] = ...,
        resolution_m: Optional[float] = None,
        window: str = "",
        band: Optional[int] = None,
        nodata: Optional[float] = None,
        vertical_scale: Optional[float] = None,
        keep_holes: bool = False,
        ignore_crs: bool = False,
        allow_vrt: bool = False,
        below_m: Optional[float] = None,
        cost_curve: str = "",
        footprint_m: float = 0.0,
        thresholds: _Thresholds = ...,
        threads: int = 1,
    ) -> Map:
        """A map from the files that `talus costmap` reads, with its options: any GDAL raster, .npz or OctoMap of
        heights; rasters of classes and rocks, vector files keep_out, layers by name, rover, soil, soils, model
        by name or YAML file. What is assumed is a UserWarning."""
    def layer(self, name: str) -> npt.NDArray[np.float32]:
        """Joules a metre that a layer adds; a read-only view."""
    def learn(self, telemetry: _Table) -> int:
        """Wheel telemetry: the path of a CSV, or a dict of its columns as arrays, whole moments in order of time,
        NaN where not measured. Returns how many rows taught something."""
    def move(self, east: int, north: int) -> None:
        """Moves the window by so many tiles of 64 cells further east and north; the drive under way goes on."""
    def patch(
        self,
        heights: Optional[_Floats] = None,
        *,
        south_west: _Point,
        classes: Optional[_Bytes] = None,
        rocks: Optional[_Floats] = None,
        keep_out: Optional[_Bytes] = None,
    ) -> None:
        """New ground in a window on the map's cells: NaN, or class 255, leaves a cell as it is."""
    def plan(
        self,
        start: _Place,
        goal: _Place,
        *,
        planner: str = "",
        tolerance_m: float = 0.0,
        via: Sequence[_Place] = ...,
        start_heading_rad: Optional[float] = None,
        goal_heading_rad: Optional[float] = None,
        max_risk: Optional[float] = None,
        time_limit_s: Optional[float] = None,
        prove: bool = False,
        seed: int = 1,
        threads: int = 1,
        progress: _Progress = None,
    ) -> Route:
        """A route over all that is known now; the GIL is released, Ctrl-C ends it. Places: (x_m, y_m), or a text
        as in `talus plan`. progress: called with 0 to 1. prove: also the best lower bound and a search over
        points of cells, which takes longer."""
    @staticmethod
    def read(path: _Path, *, threads: int = 1) -> Map:
        """A map that `talus costmap`, `talus update` or save() wrote, with its rover, soils and evidence."""
    def save(self, path: _Path) -> None:
        """Writes the map for read() and `talus plan --map`: the whole file or none."""
    def score(
        self, path: _Floats, *, prove: bool = False, threads: int = 1, progress: _Progress = None
    ) -> Score:
        """What a path of shape (n, 2) costs under the planners' cost function, as `talus score`. prove: also the
        best route between its ends. The GIL is released, Ctrl-C ends it."""
    def settle(self) -> None:
        """Judges all rows learned since the map was made or read again, by what all of them say of the sensors:
        the map is then that of one file of these rows."""
    def write_route(self, route: Route, path: _Path) -> None:
        """Writes a route that plan() found here, as `talus plan -o`: .geojson, .gpkg, .gpx, .kml or .csv."""
    @property
    def body(self) -> Optional[str]:
        """Earth, Moon, Mars, ...; None without a coordinate reference system."""
    @property
    def crs(self) -> str:
        """Name of the coordinate reference system; local: x and y are local metres."""
    @property
    def thresholds(self) -> _Thresholds:
        """Thresholds and weights, by the names of a mission file."""
    @property
    def classes(self) -> npt.NDArray[np.uint8]:
        """Class numbers, 255 where unknown; a read-only view, of shape (0, 0) where the map has no classes."""
    @property
    def heights(self) -> npt.NDArray[np.float32]:
        """Heights [m], row 0 in the south; a read-only view that shows later patches."""
    @property
    def resolution_m(self) -> float: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def south_west(self) -> _Point: ...
    @property
    def version(self) -> int: ...

class Simulation:
    """A simulated drive; its track as columns without a copy."""
    @property
    def alarms(self) -> int: ...
    @property
    def cause(self) -> str: ...
    @property
    def energy_J(self) -> float: ...
    @property
    def length_m(self) -> float: ...
    @property
    def max_slip(self) -> float: ...
    @property
    def outcome(self) -> str:
        """reached, immobilised, tipped, gave_up or slid"""
    @property
    def replans(self) -> int: ...
    @property
    def sinkage_m(self) -> npt.NDArray[np.float64]: ...
    @property
    def slip(self) -> npt.NDArray[np.float64]: ...
    @property
    def time_s(self) -> npt.NDArray[np.float64]: ...
    @property
    def x_m(self) -> npt.NDArray[np.float64]: ...
    @property
    def y_m(self) -> npt.NDArray[np.float64]: ...

def estimate(
    table: _Table,
    *,
    method: str = "wong-reece",
    shear_modulus: str = "",
    prior: str = "",
    rover: str = "",
    model: str = "",
    progress: _Progress = None,
) -> SoilEstimate:
    """Soil from a telemetry CSV or a dict of its columns, as `talus estimate`. Ctrl-C ends it."""
def heights_from_points(
    points: _Floats,
    shape: tuple[int, int],
    *,
    resolution_m: float,
    south_west: _Point,
    percentile: float = 1.0,
    least_points: int = 1,
) -> npt.NDArray[np.float32]:
    """Heights on a grid from a point cloud of shape (n, 3): in each cell the percentile of its points by height,
    NaN where it has fewer than least_points."""
def rovers() -> list[str]:
    """Names of the built-in rovers."""
def simulate(
    map: Map,
    start: _Point,
    goal: _Point,
    *,
    true_soils: Union[dict[int, str], dict[int, Soil]] = ...,
    patches: Sequence[tuple[float, float, float, Union[str, Soil]]] = ...,
    belief: str = "online",
    seed: int = 1,
    progress: _Progress = None,
) -> Simulation:
    """Drives over true soils that the map does not know; true_soils: class number to soil where it differs,
    patches: (x_m, y_m, radius_m, soil). The map itself learns nothing."""
def soils() -> list[str]:
    """Names of the built-in soils."""
def trace(
    table: _Table,
    *,
    base: str = "",
    rover: str = "",
    significance: float = 0.05,
    seed: int = 1,
    progress: _Progress = None,
) -> Trace:
    """Effects that a wheel model lacks, from a telemetry CSV or a dict of its columns, as `talus trace`. base: a
    soil or model file, without it a soil is fitted; rover: supplies wheel dimensions missing from the file. The
    GIL is released, Ctrl-C ends it. progress: called with 0 to 1."""
def wheel(
    soil: Union[str, Soil],
    rover: Union[str, Rover],
    *,
    slip: float,
    load_N: Optional[float] = None,
    slip_angle_rad: float = 0.0,
) -> _WheelForces:
    """Sinkage, entry angle, torque, drawbar pull and side force of a wheel, as `talus wheel`. load_N: that of the
    rover on level ground where it is None."""
