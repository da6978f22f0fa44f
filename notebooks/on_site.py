"""What a rover meets on its site: the pressure of its wheels at rest, rocks, the longest dark, a way along a ridge."""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import exp1

from rdk import catalog
from rdk._fields import Real, check
from rdk.route import Way
from rdk.sky import Skyline
from rdk.terramechanics import Soil, Wheel, wheel_forces


def static_pressure_kpa(wheel: Wheel, soil: Soil, load_n: Real) -> Real:
    """Mean vertical pressure under a wheel at rest: its load over width and chord, W / (2 b r sin(theta_s)).

    The arc theta_s on either side is that of the imposed-arc kernel, which gets sinkage at rest right where it can be
    checked; `Performance.ground_pressure_kpa` is that of the kernel in use, on the move. NaN where the wheel is buried.
    """
    angle = wheel_forces(wheel, soil, load_n, 0.0, kernel="imposed-arc").entry_angle_rad
    return load_n / (2 * wheel.width_m * wheel.radius_m * np.sin(angle)) / 1000


def rocks_per_m2(diameter_m: Real, area_fraction: Real) -> Real:
    """Rocks wider than `diameter_m` on a square metre, where rocks cover `area_fraction` of the ground.

    Golombek & Rapp (1997): those wider than D cover k exp(-q D), q = 1.79 + 0.152 / k. One covers pi D^2 / 4, so
    N(> D) is the integral of 4 k q exp(-q x) / (pi x^2) from D on.
    """
    k, diameter = check("area_fraction", area_fraction, 0, 1), check("diameter_m", diameter_m, above=0)
    with np.errstate(all="ignore"):
        q = 1.79 + np.divide(0.152, k)
        return np.where(k > 0, 4 * k * q / np.pi * (np.exp(-q * diameter) / diameter - q * exp1(q * diameter)), 0.0)[()]


def detour_factor(obstacle_m: Real, width_m: Real, area_fraction: Real) -> Real:
    """Length driven over length gained, where rocks too tall to climb are driven around one by one.

    A rover of this width climbs rocks as tall as `obstacle_m` (`Performance.obstacle_capability_m`), half as tall as
    they are wide. A metre of its swath meets those whose middle lies within its width and their diameter, and passing
    one costs about that length.
    """
    diameter = 2 * check("obstacle_m", obstacle_m, above=0)
    return 1 + rocks_per_m2(diameter, area_fraction) * (check("width_m", width_m, above=0) + diameter) ** 2


def longest_run(flags: ArrayLike, step: float = 1.0) -> float:
    """Length of the longest unbroken run of true `flags` (one dimension), in units of `step`."""
    if np.ndim(flags) != 1:
        raise ValueError(f"flags must have one dimension; got {np.ndim(flags)}")
    edges = np.flatnonzero(np.diff(np.r_[0, np.asarray(flags, bool).astype(np.int8), 0]))
    return (edges[1::2] - edges[::2]).max(initial=0) * step


def ridge() -> Way:
    """The tabulated Way along Connecting Ridge, 1.9 km near the south pole, with its skylines 1 m above ground."""
    way, seen = catalog.table("ridge_route.csv"), catalog.table("ridge_route_skylines.csv").set_index("azimuth_deg")
    slope = np.degrees(np.arctan2(np.diff(way.height_m), np.diff(way.distance_m)))
    return Way(way.distance_m, slope, way.latitude_deg, way.longitude_deg, [float(name[3:-1]) for name in seen],
               [Skyline(seen.index, seen[name]) for name in seen])
