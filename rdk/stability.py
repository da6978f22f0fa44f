"""How a rover stands on a slope: the load on each axle, the centre of mass, and where it tips over.

The rover drives straight up or down (x runs uphill from the middle of the wheelbase, h from the ground), and each wheel
pulls in proportion to its load: N tan(slope). Then the force of the ground on each wheel is vertical, and lever rules
over the horizontal distances x cos(slope) - h sin(slope) suffice.

Limits: rigid wheels on a plane; no soft suspension, no sinkage that tilts the body, no acceleration. Track and centre
of mass are orders of magnitude, good to about a quarter; outside rovers of 5 to 50 kg they extrapolate.
"""
from typing import NamedTuple

import numpy as np

from ._fields import brief, check, together

Values = float | np.ndarray
LEAST_BODY_HEIGHT_M = 0.05                               # a warm box holds at least the height of a cell or a board
RIGID_BELLY_RADII, ROCKER_BELLY_RADII = 1.2, 2.0         # height of the belly above the ground, in wheel radii


class AxleLoads(NamedTuple):
    """Force of the ground normal to the slope on each pair of wheels, in newtons; `middle_n` is NaN on four wheels."""
    front_n: Values
    middle_n: Values
    rear_n: Values

    __repr__ = brief


class TipOver(NamedTuple):
    """Slopes in degrees at which a standing rover tips over: facing up, facing down, across the slope."""
    uphill_deg: Values
    downhill_deg: Values
    sideways_deg: Values

    __repr__ = brief


class Stance(NamedTuple):
    """Track, height of the belly (less the sinkage: the clearance) and of the centre of mass, in metres."""
    track_m: Values
    belly_height_m: Values
    centre_height_m: Values

    __repr__ = brief


def axle_loads(mass_kg: Values, wheelbase_m: Values, centre_height_m: Values, slope_deg: Values, *, wheel_count: Values,
               centre_offset_m: Values = 0.0, pivot_height_m: Values | None = None,
               gravity_m_s2: Values = 1.625) -> AxleLoads:
    """Load on each pair of wheels of a rover that faces up a slope: rigid on four wheels, rocker-bogie on six.

    Parameters
    ----------
    mass_kg, wheelbase_m : float or ndarray
        Positive.
    slope_deg : float or ndarray
        Between -90 and 90; positive: the front is uphill.
    wheel_count : int or ndarray
        4, two axles at the ends of the wheelbase; 6, three evenly spaced, with the bogie on front and middle.
    centre_height_m, centre_offset_m : float or ndarray
        Of the centre of mass above the ground (zero or more) and ahead of the middle of the wheelbase.
    pivot_height_m : float or ndarray, optional
        Of the bogie's pivot, midway between its wheels; by default on the ground: there it always shares evenly.

    Returns
    -------
    AxleLoads
        They add up to the weight's component normal to the slope. A negative load belongs to a pair that has lifted:
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

    def horizontal(x, h):                                # distance uphill as gravity sees it
        return x * cos - h * sin

    half = length * cos / 2                              # horizontal distance of the end wheels from the middle
    centre = horizontal(offset, height)
    with np.errstate(divide="ignore", invalid="ignore"):
        # four wheels: moments about the rear axle, then about the front one
        front, rear = weight * (centre + half) / (2 * half), weight * (half - centre) / (2 * half)
        # six: the bogie's pivot and the rear wheels carry the body, the bogie's wheels carry the pivot
        joint = horizontal(length / 4, pivot)
        bogie = weight * (centre + half) / (joint + half)
        first = bogie * joint / half
        six = np.equal(count, 6)
        return AxleLoads(*(np.where(six, of_six, of_four) * cos for of_six, of_four in (
            (first, front), (bogie - first, np.nan), (weight - bogie, rear))))


def tip_over(wheelbase_m: Values, track_m: Values, centre_height_m: Values, *,
             centre_offset_m: Values = 0.0) -> TipOver:
    """Slopes at which a standing rover tips over, in each direction.

    Facing up, the load of the uphill pair (on six wheels: of the whole bogie) vanishes there; across the slope, that of
    the uphill side. A bogie's front wheel lifts before its load does where the pivot is higher than half the centre of
    mass: that is no tip-over yet. Wheelbase and track are those of the outer wheels' centres; the centre of mass is at
    `centre_height_m` (zero or more), `centre_offset_m` ahead of the middle and inside the wheelbase.

    Examples
    --------
    >>> f"{tip_over(0.5, 0.4, 0.2).sideways_deg:.0f} deg"
    '45 deg'
    """
    length, track = check("wheelbase_m", wheelbase_m, above=0), check("track_m", track_m, above=0)
    height, offset = check("centre_height_m", centre_height_m, 0), check("centre_offset_m", centre_offset_m)
    together(wheelbase_m=np.shape(length), track_m=np.shape(track), centre_height_m=np.shape(height),
             centre_offset_m=np.shape(offset))
    if np.any(np.abs(offset) >= np.asarray(length) / 2):
        raise ValueError(f"centre_offset_m must lie inside the wheelbase of {wheelbase_m!r} m; got {centre_offset_m!r}")
    return TipOver(*(np.degrees(np.arctan2(lever, height))[()] for lever in (
        length / 2 + offset, length / 2 - offset, np.asarray(track) / 2)))


def stance(total_mass_kg: Values, wheels_mass_kg: Values, wheel_radius_m: Values, wheel_width_m: Values,
           wheelbase_m: Values, wheel_count: Values, *, track_ratio: Values = 0.9,
           envelope_density_kg_m3: Values = 145.0) -> Stance:
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
