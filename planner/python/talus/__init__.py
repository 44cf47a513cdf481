"""Safe routes for rovers over soft, sloping ground."""

from talus._html import map_html as _map_html, route_html as _route_html
from talus._talus import (
    InputError as InputError,
    Map as Map,
    Route as Route,
    Rover as Rover,
    Score as Score,
    Simulation as Simulation,
    Soil as Soil,
    SoilEstimate as SoilEstimate,
    Trace as Trace,
    TracedEffect as TracedEffect,
    __version__ as __version__,
    estimate as estimate,
    heights_from_points as heights_from_points,
    rovers as rovers,
    simulate as simulate,
    soils as soils,
    trace as trace,
    wheel as wheel,
)

setattr(Map, "_repr_html_", _map_html)
setattr(Route, "_repr_html_", _route_html)
