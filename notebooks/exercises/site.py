"""Exercises of notebooks 14 and 15: light at a real site, and ways over the ground."""
from __future__ import annotations

from functools import cache

import numpy as np

from scipy.optimize import brentq

from rdk import catalog, power, route, sky
from rdk.mission import evaluate

from .judging import Exercise

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 14 polar site -----------------------------------------------------------------------------------------

@cache
def _hours(first="2026-01-01", last="2027-01-01"):
    return sky.julian_date(np.arange(first, last, dtype="datetime64[h]"))


@cache
def _sunlight(site="connecting_ridge_spot_1", height_m=2):
    """Elevation of the sun and share of its disc above the skyline, hour by hour of 2026."""
    seen = catalog.skyline(site, height_m)
    elevation, azimuth = sky.sun_position(seen.latitude_deg, seen.longitude_deg, _hours())
    return elevation, sky.lit_fraction(elevation, azimuth, seen)


@cache
def _brightest(height_m=2):
    hours = _hours("2015-12-24", "2034-12-24")[::6]
    shares = {}
    for site in catalog.skyline_sites():
        seen = catalog.skyline(site, height_m)
        sun = sky.sun_position(seen.latitude_deg, seen.longitude_deg, hours)
        shares[site] = sky.lit_fraction(*sun, seen).mean()
    return max(shares, key=shares.get)


def _low_sun_pct(least=0.5):
    elevation, lit = _sunlight()
    return 100 * np.mean((elevation < 0) & (lit >= least))


def _mean_power_w(start_utc="2026-05-01", days=45, skyline=True, **changes):
    seen = catalog.skyline("de_gerlache_rim")
    mission = catalog.scenario("polar_prospecting").replace(
        latitude_deg=seen.latitude_deg, longitude_deg=seen.longitude_deg, duration_earth_days=days,
        start_utc=start_utc, skyline=seen if skyline else None, **changes)
    return evaluate(catalog.rover("MoonRanger"), mission).average_solar_power_w


def _storage_wh(load_w, area_m2=0.3, height_m=2, losses=0.95):
    """Usable energy that carries a load through 2026 from a full pack, panel tilted by 80 deg and turned."""
    elevation, lit = _sunlight(height_m=height_m)
    net = power.panel_power(area_m2, np.cos(np.radians(elevation - 10)) * lit) - load_w
    need = most = 0.0
    for flow in np.where(net > 0, losses * net, net / losses):
        need = max(need - flow, 0.0)
        most = max(most, need)
    return most


EXERCISES["14.1"] = Exercise(
    "word", _brightest, "The share lit, averaged over the hours, at 2 m: which site has the largest?",
    {"That is the brightest one at another height.": lambda: _brightest(10),
     "No sun reaches that place.": lambda: "shackleton_floor"}, choices=tuple(catalog.skyline_sites()))

EXERCISES["14.2"] = Exercise(
    "number", _low_sun_pct, "Two conditions on the same hours: the sun's centre below level, and half of the disc lit.",
    {"That counts every hour with the sun below the level horizon, lit or not.":
        lambda: 100 * np.mean(_sunlight()[0] < 0),
     "That counts hours with any sun at all; at least half of the disc is asked for.":
        lambda: 100 * np.mean((_sunlight()[0] < 0) & (_sunlight()[1] > 0)),
     "That is the share of lit hours, wherever the sun stands.": lambda: 100 * np.mean(_sunlight()[1] >= 0.5)},
    within=0.01)

EXERCISES["14.3"] = Exercise(
    "number", _mean_power_w, "Replace latitude, longitude, skyline, start and duration; read average_solar_power_w.",
    {"That is the mission of the catalogue's length.": lambda: _mean_power_w(days=30),
     "Without the skyline the sun is below the horizon of a smooth sphere.": lambda: _mean_power_w(skyline=False),
     "Without a start date the sun is the paper's.": lambda: _mean_power_w(start_utc=None)}, within=0.005)

EXERCISES["14.4"] = Exercise(
    "number", lambda: _storage_wh(2.0), "Run the books of section 7 with the smaller load.",
    {"That is the need of the load awake.": lambda: _storage_wh(13.0),
     "The battery loses a part on the way in and out.": lambda: _storage_wh(2.0, losses=1.0),
     "That is the capacity with its floor; usable energy is asked for.": lambda: _storage_wh(2.0) / 0.85},
    within=0.01)


# ---- 15 route ----------------------------------------------------------------------------------------------

@cache
def _slow():
    return catalog.scenario("polar_prospecting").replace(maximum_speed_m_s=0.05)


def _climb_wh(slope_deg=10.0, standing=False):
    rover = catalog.rover("MoonRanger")
    wheel, second = route.per_metre(rover, _slow(), slope_deg)
    return (wheel + standing * second * (rover.avionics_power_w + _slow().payload_power_w)) * 1000 / 3600


def _rock_cover_pct(obstacle_m=0.05, longer=1.1):
    return 100 * brentq(lambda k: route.detour_factor(obstacle_m, 0.5, k) - longer, 1e-4, 0.6)


@cache
def _least_battery_wh():
    packs = np.arange(300.0, 501.0, 10.0)
    march = route.march(route.ridge(), catalog.rover("MoonRanger").replace(battery_capacity_wh=packs),
                        _slow().replace(start_utc="2026-03-15", duration_earth_days=30), follow_sun=True)
    lost = np.flatnonzero(np.isinf(march.arrival_h))
    return packs[lost[-1] + 1], packs[lost[-1]]


EXERCISES["15.1"] = Exercise(
    "word", lambda: "standing load", "Divide the power of everything on board by the speed, and compare.",
    {"At this speed a metre takes twenty seconds: what is drawn all the while?": lambda: "wheels"},
    choices=("wheels", "standing load"))

EXERCISES["15.2"] = Exercise(
    "number", _climb_wh, "The energy of the wheels for a metre at that slope, times a thousand metres.",
    {"That is on level ground.": lambda: _climb_wh(0.0), "That is downhill.": lambda: _climb_wh(-10.0),
     "That is the whole rover; only the wheels are asked for.": lambda: _climb_wh(standing=True)}, within=0.005)

EXERCISES["15.3"] = Exercise(
    "number", _rock_cover_pct, "Find the share of the ground at which the detour factor is a tenth above one.",
    {"That is for six wheels.": lambda: _rock_cover_pct(0.125),
     "Half the radius is climbed, not the whole.": lambda: _rock_cover_pct(0.1)}, within=0.01)

EXERCISES["15.4"] = Exercise(
    "number", lambda: _least_battery_wh()[0], "The step after the last battery with which the march is lost.",
    {"With that one the march is still lost.": lambda: _least_battery_wh()[1]}, within=0.001)
