"""Safe routes for rovers over soft, sloping ground."""

from talus._talus import (
    InputError as InputError,
    Map as Map,
    Route as Route,
    Rover as Rover,
    Simulation as Simulation,
    Soil as Soil,
    SoilEstimate as SoilEstimate,
    Trace as Trace,
    TracedEffect as TracedEffect,
    estimate as estimate,
    heights_from_points as heights_from_points,
    rovers as rovers,
    simulate as simulate,
    soils as soils,
    trace as trace,
)
