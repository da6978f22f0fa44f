"""How a rover stands on a slope: the load on each axle, the centre of mass, and where it tips over.

The rover drives straight up or down (x runs uphill from the middle of the wheelbase, h from the ground), and each wheel
pulls in proportion to its load: N tan(slope). Then the force of the ground on each wheel is vertical, and lever rules
over the horizontal distances x cos(slope) - h sin(slope) suffice.

Limits: rigid wheels on a plane; no soft suspension, no sinkage that tilts the body, no acceleration. Track and centre
of mass are orders of magnitude, good to about a quarter; outside rovers of 5 to 50 kg they extrapolate.
"""
from typing import NamedTuple

import numpy as np

from ._fields import Real, brief, check, together
from .terramechanics import Soil, Wheel, wheel_forces

LEAST_BODY_HEIGHT_M = 0.05                               # a warm box holds at least the height of a cell or a board
RIGID_BELLY_RADII, ROCKER_BELLY_RADII = 1.2, 2.0         # height of the belly above the ground, in wheel radii


class AxleLoads(NamedTuple):
    """Force of the ground normal to the slope on each pair of wheels, in newtons; `middle_n` is NaN on four wheels."""
    front_n: Real
    middle_n: Real
    rear_n: Real

    __repr__ = brief


class TipOver(NamedTuple):
    """Slopes in degrees at which a standing rover tips over: facing up, facing down, across the slope."""
    uphill_deg: Real
    downhill_deg: Real
    sideways_deg: Real

    __repr__ = brief


class Stance(NamedTuple):
    """Track, height of the belly (less the sinkage: the clearance) and of the centre of mass, in metres."""
    track_m: Real
    belly_height_m: Real
    centre_height_m: Real

    __repr__ = brief


def axle_loads(mass_kg: Real, wheelbase_m: Real, centre_height_m: Real, slope_deg: Real, *, wheel_count: Real,
               centre_offset_m: Real = 0.0, pivot_height_m: Real | None = None,
               gravity_m_s2: Real = 1.625) -> AxleLoads:
    """Load on each pair of wheels of a rover that faces up a slope: rigid on four wheels, rocker-bogie on six.

    Four wheels stand at the ends of the wheelbase; six on three axles, evenly spaced, the bogie on front and middle.
    The slope lies between -90 and 90 deg; where it is positive, the front is uphill. The centre of mass is zero or more
    above the ground and `centre_offset_m` ahead of the middle; the bogie's pivot is midway between its wheels and by
    default on the ground: there it always shares evenly.
    The loads add up to the weight's component normal to the slope. A negative one belongs to a pair that has lifted:
    the rover then stands otherwise than assumed here.

    Examples
    --------
    >>> loads = axle_loads(10.0, 0.5, 0.2, 20.0, wheel_count=4)
    >>> f"{loads.front_n:.2f} N uphill, {loads.rear_n:.2f} N downhill"
    '5.41 N uphill, 9.86 N downhill'
    """
    mass, length = check("mass_kg", mass_kg, above=0), check("wheelbase_m", wheelbase_m, above=0)
    height, offset = check("centre_height_m", centre_height_m, 0), check("centre_offset_m", centre_offset_m)
    slope = np.radians(check("slope_deg", slope_deg, above=-90, below=90))
    count, gravity = check("wheel_count", wheel_count, choices=(4, 6)), check("gravity_m_s2", gravity_m_s2, above=0)
    pivot = check("pivot_height_m", 0.0 if pivot_height_m is None else pivot_height_m, 0)
    together(mass_kg=np.shape(mass), wheelbase_m=np.shape(length), centre_height_m=np.shape(height),
             slope_deg=np.shape(slope), wheel_count=np.shape(count), centre_offset_m=np.shape(offset),
             pivot_height_m=np.shape(pivot), gravity_m_s2=np.shape(gravity))
    weight, cos, sin = mass * gravity, np.cos(slope), np.sin(slope)
    half = length * cos / 2                              # horizontal distance from the middle: of the end wheels,
    centre = offset * cos - height * sin                 # of the centre of mass,
    joint = length / 4 * cos - pivot * sin               # of the bogie's pivot
    with np.errstate(divide="ignore", invalid="ignore"):
        # four wheels: moments about the rear axle, then about the front one
        front, rear = weight * (centre + half) / (2 * half), weight * (half - centre) / (2 * half)
        # six: the bogie's pivot and the rear wheels carry the body, the bogie's wheels carry the pivot
        bogie = weight * (centre + half) / (joint + half)
        first = bogie * joint / half
        six = np.equal(count, 6)
        return AxleLoads(*(np.where(six, of_six, of_four) * cos for of_six, of_four in (
            (first, front), (bogie - first, np.nan), (weight - bogie, rear))))


def tip_over(wheelbase_m: Real, track_m: Real, centre_height_m: Real, *, centre_offset_m: Real = 0.0) -> TipOver:
    """Slopes at which a standing rover tips over, in each direction.

    Facing up, the load of the uphill pair (on six wheels: of the whole bogie) vanishes there; across the slope, that of
    the uphill side. A bogie's front wheel lifts before its load does where the pivot is higher than half the centre of
    mass: that is no tip-over yet. Wheelbase and track are those of the outer wheels' centres; the centre of mass is at
    `centre_height_m` (zero or more), `centre_offset_m` ahead of the middle and inside the wheelbase.
    """
    length, track = check("wheelbase_m", wheelbase_m, above=0), check("track_m", track_m, above=0)
    height, offset = check("centre_height_m", centre_height_m, 0), check("centre_offset_m", centre_offset_m)
    together(wheelbase_m=np.shape(length), track_m=np.shape(track), centre_height_m=np.shape(height),
             centre_offset_m=np.shape(offset))
    if np.any(np.abs(offset) >= np.asarray(length) / 2):
        raise ValueError(f"centre_offset_m must lie inside the wheelbase of {wheelbase_m!r} m; got {centre_offset_m!r}")
    return TipOver(*(np.degrees(np.arctan2(lever, height))[()] for lever in (
        length / 2 + offset, length / 2 - offset, np.asarray(track) / 2)))


def stance(total_mass_kg: Real, wheels_mass_kg: Real, wheel_radius_m: Real, wheel_width_m: Real, wheelbase_m: Real,
           wheel_count: Real, *, track_ratio: Real = 0.9, envelope_density_kg_m3: Real = 145.0) -> Stance:
    """Track and centre of mass that a rover of these sizes would have, from what published rovers have in common.

    The rover fills an envelope of wheelbase and two radii, by track (`track_ratio` times the wheelbase: 0.65 to 1.3 on
    published rovers) and one width, at the density of published envelopes (110 to 230 kg/m3). The body reaches from the
    belly (1.2 radii up on a rigid rover, 2 under a rocker-bogie) to its top, at least 5 cm higher. The mass of all
    wheels sits at the axles, all else in the middle of the body. Nothing is checked here: `Design` and `Model` are.
    """
    radius = np.asarray(wheel_radius_m)
    track = track_ratio * wheelbase_m
    belly = radius * np.where(np.equal(wheel_count, 6), ROCKER_BELLY_RADII, RIGID_BELLY_RADII)
    footprint = (wheelbase_m + 2 * radius) * (track + wheel_width_m)
    top = np.maximum(total_mass_kg / (envelope_density_kg_m3 * footprint), belly + LEAST_BODY_HEIGHT_M)
    share = wheels_mass_kg / np.asarray(total_mass_kg)
    return Stance(track, belly[()], (share * radius + (1 - share) * (belly + top) / 2)[()])


def static_pressure_kpa(wheel: Wheel, soil: Soil, load_n: Real) -> Real:
    """Mean vertical pressure under a wheel at rest: its load over width and chord, W / (2 b r sin(theta_s)).

    The arc theta_s on either side is that of the imposed-arc kernel, which gets sinkage at rest right where it can be
    checked; `Performance.ground_pressure_kpa` is that of the kernel in use, on the move. NaN where the wheel is buried.
    """
    angle = wheel_forces(wheel, soil, load_n, 0.0, kernel="imposed-arc").entry_angle_rad
    return load_n / (2 * wheel.width_m * wheel.radius_m * np.sin(angle)) / 1000
