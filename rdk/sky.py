"""The real sun: where it stands at a date, and how much of its disc a skyline of hills leaves.

Closed forms of Meeus (1998), chapters 25 and 53, so no ephemeris is loaded. Julian dates are terrestrial time, east
longitudes positive, azimuths clockwise from north.
"""
from dataclasses import dataclass, field
from datetime import UTC, datetime

import numpy as np
from numpy.typing import ArrayLike

from . import power
from ._fields import Real, Record, check, floats

SUN_RADIUS_DEG = 0.2666                                  # mean; 0.262 to 0.271 through the year
TT_MINUS_UTC_S = 69.184                                  # since 2017; one second less before
INCLINATION_DEG = 1.54242                                # of the Moon's equator to the ecliptic


@dataclass(frozen=True, eq=False)
class Skyline:
    """Elevation of the terrain around a point by azimuth, and by that it compares and hashes.

    The azimuths rise within one turn; an elevation is below 0 where the point looks down on its surroundings. Place
    and height above ground are a note: nothing is computed from them.
    """
    azimuth_deg: np.ndarray
    elevation_deg: np.ndarray
    latitude_deg: float = field(default=np.nan, compare=False)
    longitude_deg: float = field(default=np.nan, compare=False)
    height_m: float = field(default=np.nan, compare=False)
    name: str = field(default="", compare=False)

    _key, __eq__, __hash__ = Record._key, Record.__eq__, Record.__hash__
    __setstate__ = Record.__setstate__                   # a copy's arrays are read-only too

    def __post_init__(self):
        azimuth, elevation = check("azimuth_deg", self.azimuth_deg), check("elevation_deg", self.elevation_deg, -90, 90)
        if np.ndim(azimuth) != 1 or np.shape(azimuth) != np.shape(elevation) or len(azimuth) < 2:
            raise ValueError("a skyline needs azimuth_deg and elevation_deg of one length, two values or more; "
                             f"got shapes {np.shape(azimuth)} and {np.shape(elevation)}")
        if not (np.all(np.diff(azimuth) > 0) and azimuth[-1] - azimuth[0] < 360):
            raise ValueError(f"azimuth_deg must rise within one turn; got {azimuth[0]:g} to {azimuth[-1]:g}")
        vars(self).update(azimuth_deg=azimuth, elevation_deg=elevation)

    @classmethod
    def of(cls, value: "Skyline | ArrayLike") -> "Skyline":
        """A Skyline, from one or from elevations evenly spaced from north clockwise."""
        if isinstance(value, cls):
            return value
        try:
            return cls(np.arange(len(value)) * 360 / len(value), value)
        except (TypeError, ValueError) as error:
            raise ValueError("skyline must be a Skyline, such as rdk.skyline('shackleton_rim'), or elevations in "
                             f"degrees evenly spaced from north clockwise; got {value!r:.80}") from error

    def __repr__(self):
        low, high = self.elevation_deg.min(), self.elevation_deg.max()
        return f"<Skyline {self.name or 'unnamed'}: {low:.1f} to {high:.1f} deg>"

    def at(self, azimuth_deg: Real) -> Real:
        """Elevation (deg) at azimuths, linear in between."""
        return np.interp(floats("azimuth_deg", azimuth_deg), self.azimuth_deg, self.elevation_deg, period=360)


def julian_date(utc: str | np.datetime64 | np.ndarray) -> Real:
    """Julian date (TT) of a UTC date: an ISO string such as "2026-07-01T12:00", or numpy datetimes of any shape."""
    try:
        if isinstance(utc, str):
            when = datetime.fromisoformat(utc)
            utc = np.datetime64(when if when.tzinfo is None else when.astimezone(UTC).replace(tzinfo=None))
        seconds = (np.asarray(utc, "datetime64[ms]") - np.datetime64("2000-01-01T12")).astype(float) / 1000
    except (ValueError, TypeError):
        raise ValueError(f"a date must be UTC in ISO form, such as '2026-07-01T12:00'; got {utc!r:.80}") from None
    if not np.all(np.abs(seconds) < 1e10):               # NaT comes out as a huge number
        raise ValueError("a date must lie within three centuries of 2000; not-a-time is not allowed")
    return 2451545.0 + (seconds + TT_MINUS_UTC_S) / 86400


def subsolar_point(julian_date: Real) -> tuple[Real, Real]:
    """Latitude and longitude (0 to 360 deg) of the Moon's point with the sun overhead, in the mean-Earth frame.

    At 21 dates from 2015 to 2043 it is within 0.01 deg in latitude and 0.06 deg in longitude of DE440.
    """
    t = (check("julian_date", julian_date) - 2451545.0) / 36525      # Julian centuries

    def angle(start_deg, rate_deg):
        return np.radians(start_deg + rate_deg * t)

    sun_anomaly = angle(357.52911, 35999.05029)
    moon, node = angle(218.316448, 481267.881234), angle(125.044548, -1934.136289)
    moon_anomaly, moon_latitude = angle(134.963411, 477198.867631), angle(93.272099, 483202.017527)
    sun = angle(280.46646, 36000.76983) + np.radians(             # true longitude: mean and equation of the centre
        (1.914602 - 0.004817 * t) * np.sin(sun_anomaly) + 0.019993 * np.sin(2 * sun_anomaly))
    # the sun seen from the Moon: opposite to the Earth's view, less the parallax of the Moon's distance over the sun's
    parallax = 0.00257
    longitude = sun + np.pi - parallax * np.sin(moon - sun)
    latitude = parallax * np.radians(5.145) * np.sin(moon_latitude)
    # into the Moon's mean equator (Cassini's laws): w runs from the node, a along the equator
    tilt, w = np.radians(INCLINATION_DEG), longitude - node
    a = np.arctan2(np.sin(w) * np.cos(tilt) - latitude * np.sin(tilt), np.cos(w))
    b = np.arcsin(-np.sin(w) * np.sin(tilt) - latitude * np.cos(tilt))
    # physical libration, its largest terms in degrees: rho and sigma tilt the pole, tau turns the Moon
    rho = -0.02752 * np.cos(moon_anomaly) - 0.02245 * np.sin(moon_latitude) + 0.00684 * np.cos(
        moon_anomaly - 2 * moon_latitude) - 0.00293 * np.cos(2 * moon_latitude)
    sigma = -0.02816 * np.sin(moon_anomaly) + 0.02244 * np.cos(moon_latitude) - 0.00682 * np.sin(
        moon_anomaly - 2 * moon_latitude) - 0.00279 * np.sin(2 * moon_latitude)
    tau = 0.0252 * np.sin(sun_anomaly)
    l_deg = np.degrees(a - moon_latitude) - tau
    b_deg = np.degrees(b) + sigma * np.cos(a) - rho * np.sin(a)
    # from the principal to the mean-Earth axes: 67.85" in longitude, 78.69" about the axis towards 90 E
    return b_deg - 0.02186 * np.cos(np.radians(l_deg)), (l_deg + 0.01885) % 360


def sun_position(latitude_deg: Real, longitude_deg: Real, julian_date: Real) -> tuple[Real, Real]:
    """Elevation and azimuth of the sun's centre at a place and date, in degrees, as `rdk.power.sun_position`."""
    latitude_deg, longitude_deg = check("latitude_deg", latitude_deg, -90, 90), check("longitude_deg", longitude_deg)
    declination_deg, noon_deg = subsolar_point(julian_date)
    return power.sun_position(latitude_deg, longitude_deg - noon_deg, declination_deg)


def lit_fraction(elevation_deg: Real, azimuth_deg: Real, skyline: Skyline | ArrayLike | None = None) -> Real:
    """Share of the disc, its centre at this place in the sky, above a skyline that is taken as level across it.

    The skyline is what `Skyline.of` knows; None is the level horizon.
    """
    edge = 0.0 if skyline is None else Skyline.of(skyline).at(azimuth_deg)
    u = np.clip((floats("elevation_deg", elevation_deg) - edge) / SUN_RADIUS_DEG, -1, 1)
    return 0.5 + (np.arcsin(u) + u * np.sqrt(1 - u * u)) / np.pi


def longest_run(flags: ArrayLike, step: float = 1.0) -> float:
    """Length of the longest unbroken run of true `flags` (one dimension), in units of `step`."""
    if np.ndim(flags) != 1:
        raise ValueError(f"flags must have one dimension; got {np.ndim(flags)}")
    edges = np.flatnonzero(np.diff(np.r_[0, np.asarray(flags, bool).astype(np.int8), 0]))
    return (edges[1::2] - edges[::2]).max(initial=0) * step
