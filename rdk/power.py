"""Sunlight, panel power and the battery of a rover on the Moon.

Closed-form solar geometry on a smooth sphere (Duffie & Beckman 2013). At the poles this keeps the low sun and leaves
out what the terrain does to it, which matters more: `rdk.sky` has the real sun and the share of it above a skyline.
Azimuths run from north, clockwise: 0 north, 90 east, 180 south.
"""
from itertools import pairwise

import numpy as np

from ._fields import Real

ROUNDING = 1e-12                                         # sin(elevation) below this share of its terms is no sunlight
FEW = 128                                                # lanes up to which sums over many steps are faster than steps


def hour_angle_deg(time_h: Real, synodic_day_h: Real = 708.734136) -> Real:
    """Hour angle at a time after local sunrise of a sun on the equator: -90 at 0, 0 at noon."""
    return 360 * np.asarray(time_h, float) / synodic_day_h - 90


def _sun_vector(latitude_deg, hour_angle, declination_deg):
    """East, north and up components of the direction to the sun, and the size of what `up` adds up."""
    lat, H, dec = np.radians(latitude_deg), np.radians(hour_angle), np.radians(declination_deg)
    along, across = np.sin(lat) * np.sin(dec), np.cos(lat) * np.cos(dec)
    east = -np.cos(dec) * np.sin(H)
    north = np.cos(lat) * np.sin(dec) - np.sin(lat) * np.cos(dec) * np.cos(H)
    up = along + across * np.cos(H)                      # eq. sun-elevation
    return east, north, up, abs(along) + abs(across)


def sun_position(latitude_deg: Real, hour_angle: Real, declination_deg: Real = 0.0) -> tuple[Real, Real]:
    """Elevation above the smooth horizon and azimuth of the sun, clockwise from north, 0 to 360; all in degrees.

    The hour angle is negative before noon: at noon, 0, the sun stands 70 deg high in the south at latitude 20.
    """
    east, north, up, _ = _sun_vector(latitude_deg, hour_angle, declination_deg)
    return np.degrees(np.arcsin(np.clip(up, -1, 1))), np.degrees(np.arctan2(east, north)) % 360


def incidence_factor(latitude_deg: Real, hour_angle: Real, tilt_deg: Real = 0.0, azimuth_deg: Real = 180.0,
                     declination_deg: Real = 0.0, lit: Real | None = None) -> Real:
    """cos(i) on a tilted panel, eq. solar-incidence, 0 to 1: 0 where the sun is down or behind the panel.

    Tilt from the horizontal and azimuth are the panel's, the other angles those of `sun_position`. `lit`, the share of
    the solar disc above the skyline from `rdk.sky.lit_fraction`, takes the place of the cut at the level horizon, below
    which a ridge still sees the sun.
    """
    east, north, up, size = _sun_vector(latitude_deg, hour_angle, declination_deg)
    tilt, azimuth = np.radians(tilt_deg), np.radians(azimuth_deg)
    cos_i = up * np.cos(tilt) + np.sin(tilt) * (north * np.cos(azimuth) + east * np.sin(azimuth))
    facing = np.maximum(cos_i, 0.0)
    if lit is not None:
        return (facing * lit)[()]
    # at a pole the sun circles on the horizon: what counts is the sign, as close to the pole as one likes
    return np.where(up > ROUNDING * size, facing, 0.0)[()]


def panel_power(area_m2: Real, incidence: Real, *, efficiency: Real = 0.28, dust_factor: Real = 0.9,
                solar_constant_w_m2: Real = 1361.0) -> Real:
    """Electrical power of the array in W, eq. solar-power: S_0 A eta d max(0, cos i), `incidence` being the last."""
    return solar_constant_w_m2 * efficiency * dust_factor * area_m2 * incidence


def march_battery(net_power_w: np.ndarray, time_step_h: Real, capacity_wh: Real, *, soc_initial: Real = 1.0,
                  soc_floor: Real = 0.15, charge_efficiency: Real = 0.95,
                  discharge_efficiency: Real = 0.95) -> np.ndarray:
    """Stored energy in Wh after each time step, eq. battery-update, clamped between the floor and a full pack.

    Surplus at full charge is discarded; demand on the floor is not served. The power into the pack, shape (steps, ...),
    is overwritten and returned as the result; the steps' length may have its shape, all else has (...).
    """
    energy = net_power_w
    energy *= np.where(energy >= 0, charge_efficiency, 1 / np.asarray(discharge_efficiency))
    energy *= time_step_h
    lanes = energy.shape[1:]
    floor = np.broadcast_to(np.asarray(soc_floor) * capacity_wh, lanes)
    full = np.broadcast_to(np.asarray(capacity_wh, float), lanes)
    stored = np.minimum(np.maximum(np.asarray(soc_initial) * capacity_wh, floor), full)
    if energy[0].size > FEW:
        for step in energy:                              # a running clamp: the one loop over time there is
            np.add(step, stored, out=step)
            np.maximum(step, floor, out=step)
            np.minimum(step, full, out=step)
            stored = step
        return energy
    # while no lane's power changes its sign, a sum that has passed a bound stays beyond it: it is clamped afterwards
    rising = energy >= 0
    turns = np.flatnonzero((rising[1:] != rising[:-1]).any(tuple(range(1, energy.ndim)))) + 1
    for start, end in pairwise([0, *turns.tolist(), len(energy)]):
        steps = energy[start:end]
        steps[:1] += stored
        np.add.accumulate(steps, out=steps)
        np.maximum(steps, floor, out=steps)
        np.minimum(steps, full, out=steps)
        stored = steps[-1]
    return energy
