import os
from typing import Any, Callable, ClassVar, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.floating[Any]]
_Bytes = Union[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]
_Progress = Optional[Callable[[float], object]]
_Place = tuple[float, float]

class InputError(ValueError): ...

class Rover:
    centre_of_mass_height_m: float
    clearance_m: float
    gravity_m_s2: float
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
    cohesion_Pa: float
    cohesive_modulus: float
    friction_angle_rad: float
    frictional_modulus: float
    name: str
    shear_modulus_m: float
    sinkage_exponent: float
    def __init__(self, name: str) -> None: ...

class SoilEstimate:
    @property
    def cohesion_Pa(self) -> float: ...
    @property
    def covariance(self) -> npt.NDArray[np.float64]: ...
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

class Route:
    COLUMNS: ClassVar[tuple[str, ...]]
    def __getitem__(self, column: str) -> npt.NDArray[np.float64]: ...
    def __len__(self) -> int: ...
    @property
    def cost_J(self) -> float: ...
    @property
    def energy_J(self) -> float: ...
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
    def status(self) -> str: ...
    @property
    def time_s(self) -> float: ...

class Map:
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
        south_west: _Place = ...,
        allow_unknown: bool = False,
        threads: int = 1,
    ) -> None: ...
    def beliefs(self) -> dict[str, npt.NDArray[Any]]: ...
    def dangers(self, path: _Floats, quantile: float = 0.05) -> list[tuple[float, float, float, float, str]]: ...
    def layer(self, name: str) -> npt.NDArray[np.float32]: ...
    def learn(self, telemetry: Union[str, os.PathLike[str], dict[str, npt.NDArray[Any]]]) -> int: ...
    def moved(self, east: int, north: int) -> Map: ...
    def patch(
        self,
        heights: Optional[_Floats] = None,
        *,
        south_west: _Place,
        classes: Optional[_Bytes] = None,
        rocks: Optional[_Floats] = None,
        keep_out: Optional[_Bytes] = None,
    ) -> None: ...
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
        seed: int = 1,
        threads: int = 1,
        progress: _Progress = None,
    ) -> Route: ...
    @property
    def classes(self) -> npt.NDArray[np.uint8]: ...
    @property
    def heights(self) -> npt.NDArray[np.float32]: ...
    @property
    def resolution_m(self) -> float: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def south_west(self) -> _Place: ...
    @property
    def version(self) -> int: ...

class Simulation:
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
    def outcome(self) -> str: ...
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
    table: Union[str, os.PathLike[str]],
    *,
    method: str = "wong-reece",
    shear_modulus: str = "",
    prior: str = "",
    rover: str = "",
    model: str = "",
    progress: _Progress = None,
) -> SoilEstimate: ...
def heights_from_points(
    points: _Floats,
    shape: tuple[int, int],
    *,
    resolution_m: float,
    south_west: _Place,
    percentile: float = 1.0,
    least_points: int = 1,
) -> npt.NDArray[np.float32]: ...
def rovers() -> list[str]: ...
def simulate(
    map: Map,
    start: _Place,
    goal: _Place,
    *,
    true_soils: Union[dict[int, str], dict[int, Soil]] = ...,
    patches: Sequence[tuple[float, float, float, Union[str, Soil]]] = ...,
    belief: str = "online",
    seed: int = 1,
    progress: _Progress = None,
) -> Simulation: ...
def soils() -> list[str]: ...
