"""Height maps of the Moon: read what NASA publishes, take slopes and skylines, or make ground up.

A map is a square grid on a stereographic plane that touches a sphere at its centre: the poles' own projection, and
any small map's. Distances on the plane are taken as true; at 180 km from the centre they are 0.3 % too long.
"""
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from . import catalog
from ._fields import Real, Record, check, floats, generator, limits_of, listed, number, unknown, whole
from .sky import Skyline

RADIUS_M = 1_737_400.0                                   # the sphere of LOLA's heights
NEAREST_M, GROWTH = 15.0, 0.01                           # where a skyline's search begins; its steps by distance


def _vertical(latitude_deg, longitude_deg):
    """Unit vector straight up at places; the first axis has its three components."""
    lat, lon = np.broadcast_arrays(np.radians(latitude_deg), np.radians(longitude_deg))
    return np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])


def _axes(latitude_deg, longitude_deg):
    """Unit vectors east, north and up at a place."""
    up, east = _vertical(latitude_deg, longitude_deg), _vertical(0.0, longitude_deg + 90)
    return np.array([east, np.cross(up, east), up])


@dataclass(frozen=True, eq=False)
class Terrain:
    """Heights above a sphere on a square grid, row 0 at the top, values at the centres of cells, NaN for unknown.

    On the plane x runs to the right and y upwards; `west_m` and `north_m` are the outer edges of the top left cell. It
    touches the sphere at `latitude_deg`, `longitude_deg`, where y points north: at the south pole towards 0 E, at the
    north pole towards 180 E.
    """
    height_m: np.ndarray
    step_m: float = number(above=0, scalar=True)
    west_m: float = number(default=0.0, scalar=True)
    north_m: float = number(default=0.0, scalar=True)
    latitude_deg: float = number(-90, 90, default=-90.0, scalar=True)
    longitude_deg: float = number(default=0.0, scalar=True)
    radius_m: float = number(1.73e6, 1.745e6, default=RADIUS_M, scalar=True)      # the Moon's
    name: str = ""

    __setstate__ = Record.__setstate__                   # a copy's heights are read-only too

    def __post_init__(self):
        height = floats("height_m", self.height_m).copy()
        if height.ndim != 2 or min(height.shape) < 2 or np.isinf(height).any() or np.isnan(height).all():
            raise ValueError("height_m must be a grid of at least 2 x 2 cells with finite heights, NaN where there is "
                             f"none, and not NaN alone; got shape {height.shape}")
        height.flags.writeable = False
        numbers = {name: check(name, getattr(self, name), **limits) for name, limits in limits_of(Terrain).items()}
        vars(self).update(numbers, height_m=height, _axes=_axes(self.latitude_deg, self.longitude_deg))

    def __repr__(self):
        rows, columns = self.height_m.shape
        return (f"<Terrain {self.name or 'unnamed'}: {rows} x {columns} cells of {self.step_m:g} m, "
                f"{np.nanmin(self.height_m):.0f} to {np.nanmax(self.height_m):.0f} m>")

    def _from_axes(self, east, north, up):
        """Plane coordinates of a point of the unit sphere from its components along the axes of the centre."""
        return 2 * self.radius_m * east / (1 + up), 2 * self.radius_m * north / (1 + up)

    def to_xy(self, latitude_deg: Real, longitude_deg: Real) -> tuple[Real, Real]:
        """Plane coordinates x, y (m) of places in degrees."""
        up = _vertical(check("latitude_deg", latitude_deg, -90, 90), check("longitude_deg", longitude_deg))
        return self._from_axes(*np.tensordot(self._axes, up, 1))

    def to_latlon(self, x: Real, y: Real) -> tuple[Real, Real]:
        """Latitude and east longitude (deg) of plane coordinates in metres."""
        u, v = np.divide(np.broadcast_arrays(check("x", x), check("y", y)), 2 * self.radius_m)
        square = u * u + v * v
        p = np.tensordot(self._axes.T, np.array([2 * u, 2 * v, 1 - square]) / (1 + square), 1)
        return np.degrees(np.arcsin(np.clip(p[2], -1, 1))), np.degrees(np.arctan2(p[1], p[0])) % 360

    def cell(self, x: Real, y: Real) -> tuple[Real, Real]:
        """Row and column of the cell that holds a point of the plane; a point outside is refused."""
        row = np.floor((self.north_m - check("y", y)) / self.step_m).astype(int)
        column = np.floor((check("x", x) - self.west_m) / self.step_m).astype(int)
        (rows, columns), step = self.height_m.shape, self.step_m
        if not np.all((row >= 0) & (row < rows) & (column >= 0) & (column < columns)):
            raise ValueError(f"the point lies outside the map: x {self.west_m:g} to {self.west_m + columns * step:g} m,"
                             f" y {self.north_m - rows * step:g} to {self.north_m:g} m; got {x!r:.80}, {y!r:.80}")
        return row, column

    def place(self, row: Real, column: Real) -> tuple[Real, Real]:
        """Plane coordinates x, y (m) of the centres of cells."""
        return (self.west_m + (check("column", column) + 0.5) * self.step_m,
                self.north_m - (check("row", row) + 0.5) * self.step_m)

    def at(self, x: Real, y: Real) -> Real:
        """Height at points of the plane, bilinear between the centres of cells; NaN outside."""
        rows, columns = self.height_m.shape
        row = (self.north_m - floats("y", y)) / self.step_m - 0.5
        column = (floats("x", x) - self.west_m) / self.step_m - 0.5
        inside = (row >= 0) & (row <= rows - 1) & (column >= 0) & (column <= columns - 1)
        i = np.clip(np.where(inside, row, 0), 0, rows - 2).astype(np.intp)       # outside, any cell: it becomes NaN
        k = np.clip(np.where(inside, column, 0), 0, columns - 2).astype(np.intp)
        down, right = row - i, column - k
        flat, first = self.height_m.ravel(), i * columns + k
        top, bottom = (flat[n] * (1 - right) + flat[n + 1] * right for n in (first, first + columns))
        return np.where(inside, top * (1 - down) + bottom * down, np.nan)

    def slope(self) -> np.ndarray:
        """Steepest slope of each cell in degrees, over a baseline of two cells: shorter slopes are steeper."""
        return np.degrees(np.arctan(np.hypot(*np.gradient(self.height_m, self.step_m))))

    def hillshade(self, azimuth_deg: float = 315.0, elevation_deg: float = 30.0) -> np.ndarray:
        """Brightness 0 to 1 of each cell, lit from an azimuth clockwise from the top of the map; no cast shadows."""
        down, right = np.gradient(self.height_m, self.step_m)
        azimuth, elevation = np.radians([check(name, angle, scalar=True) for name, angle in (
            ("azimuth_deg", azimuth_deg), ("elevation_deg", elevation_deg))])
        facing = np.sin(elevation) - np.cos(elevation) * (np.sin(azimuth) * right - np.cos(azimuth) * down)
        return np.clip(facing / np.sqrt(1 + right**2 + down**2), 0, 1)

    def skyline(self, x: float, y: float, height_m: float = 2.0, *, beyond: Sequence["Terrain"] = (),
                directions: int = 720, farthest_m: float = 180e3) -> Skyline:
        """Skyline of an eye above the ground at x, y, by great circles with the Moon's curvature exact.

        Coarser maps `beyond` serve where this one ends: the first that covers a point gives its height; where all end,
        nothing more is seen. The search begins at 15 m, by half a cell, later by 1 % of the distance.
        """
        x, y = check("x", x, scalar=True), check("y", y, scalar=True)
        height_m = check("height_m", height_m, 0, scalar=True)
        check("farthest_m", farthest_m, above=NEAREST_M, scalar=True)
        azimuth = np.arange(whole("directions", directions, 4)) * 360 / directions
        (lat, lon), ground = self.to_latlon(x, y), float(self.at(x, y))
        if np.isnan(ground):
            raise ValueError(f"no height is known at x {x!r} m, y {y!r} m of {self!r}")
        turn = self.step_m / 2 / GROWTH
        s = np.arange(NEAREST_M, min(turn, farthest_m), self.step_m / 2)
        if farthest_m > turn:
            s = np.r_[s, np.geomspace(turn, farthest_m, max(int(np.log(farthest_m / turn) / GROWTH), 2))]
        arc, height = s / self.radius_m, np.full((directions, len(s)), np.nan)
        east, north, up = _axes(lat, lon)
        ahead = np.outer(np.cos(np.radians(azimuth)), north) + np.outer(np.sin(np.radians(azimuth)), east)
        for terrain in (self, *listed("beyond", beyond, Terrain)):       # of each only the stretch that it can add to
            corners = terrain.place(*([0, n - 1] for n in terrain.height_m.shape))
            away = abs(np.array(corners) - np.vstack(terrain.to_xy(lat, lon)))
            reach = np.hypot(*away.max(axis=1))
            k = np.flatnonzero(np.isnan(height).any(axis=0) & (s <= reach))
            rays = [np.outer(ahead @ axis, np.sin(arc[k])) + (up @ axis) * np.cos(arc[k]) for axis in terrain._axes]
            new = terrain.at(*terrain._from_axes(*rays))
            height[:, k] = np.where(np.isnan(height[:, k]), new, height[:, k])
        r, eye = self.radius_m + height, self.radius_m + ground + height_m
        # a point of radius r at the arc g stands at tan(elevation) = (r cos g - r_eye) / (r sin g)
        tangent = np.fmax.reduce((r * np.cos(arc) - eye) / (r * np.sin(arc)), axis=1)
        tangent = np.where(np.isnan(tangent), -np.sqrt(max((eye / self.radius_m)**2 - 1, 0)), tangent)   # a bare sphere
        return Skyline(azimuth, np.degrees(np.arctan(tangent)), float(lat), float(lon), height_m,
                       f"{self.name or 'terrain'} at {x:.0f}, {y:.0f} m, {height_m:g} m")


def read(path: str | Path, **geometry: float) -> Terrain:
    """A height map from a file, with its place on the Moon.

    A PDS image (`.img` with its label `.lbl` beside it) and a GeoTIFF (`.tif`, with `tifffile` installed) say
    themselves where they are. A 16-bit PNG does not: give `scale` and `offset` (height in metres = value * scale +
    offset), `west_m`, `north_m`, `step_m` and, away from the south pole, `latitude_deg` and `longitude_deg` as in
    `Terrain`, or put a `terrain.csv` beside it with a row that has them as columns and the file's name in `file`.
    What cannot be placed (another projection, another body, no geometry) is refused.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f"no file {path}")
    kind, readers = path.suffix.lower(), {".png": _png, ".img": _pds, ".lbl": _pds, ".tif": _geotiff, ".tiff": _geotiff}
    if kind not in readers:
        raise ValueError(f"{path.name}: a height map must be a .png, .tif, or .img with its .lbl; got {kind or 'none'}")
    if geometry and kind != ".png":
        raise ValueError(f"{path.name} says itself where it lies: give scale, offset and geometry for a PNG only")
    return readers[kind](path, **geometry)


def _number(path, header, *names, default=None):
    """The first of these entries that a header has, as a number; in metres where it is like 1737.4 <KM>."""
    value = next((header[name] for name in names if name in header), default)
    figure, _, unit = str(value).partition("<")
    try:
        return float(figure) * (1000 if unit.startswith("K") else 1)
    except ValueError:
        raise ValueError(f"{path.name} cannot be placed: {names[0]} must be a number; got {value!r}") from None


def _expect(path, what, value, allowed):
    if value not in allowed:
        raise ValueError(f"{path.name} cannot be placed: {what} must be {' or '.join(allowed)}; got {value!r}")
    return value


def _png(path, **given):
    from PIL import Image
    table, needed = path.with_name("terrain.csv"), ("scale", "offset", "west_m", "north_m", "step_m")
    if not given and table.exists():
        with open(table, encoding="utf-8", newline="") as file:
            row = next((row for row in csv.DictReader(file) if row.get("file") == path.name), {})
        given = {name: _number(path, row, name) for name in needed if row.get(name)}
        if centre := re.search(r"centre ([\d.]+) ([NS]) (-?[\d.]+) E", row.get("projection", "")):
            north = float(centre[1])
            given |= dict(latitude_deg=north if centre[2] == "N" else -north, longitude_deg=float(centre[3]))
    if missing := [name for name in needed if name not in given]:
        raise ValueError(f"{path.name}: a PNG does not say where it lies; give {', '.join(missing)}")
    with Image.open(path) as image:
        if not image.mode.startswith("I"):
            raise ValueError(f"{path.name}: heights need one channel of 16 bits; got mode {image.mode}")
        raw = np.asarray(image).astype(float)
    scale, offset = (check(name, given.pop(name), scalar=True) for name in needed[:2])
    return Terrain(raw * scale + offset, name=path.stem, **given)


def _pds(path):
    found = {p.suffix.lower(): p for p in path.parent.iterdir() if p.stem == path.stem}
    if missing := {".lbl", ".img"} - set(found):
        raise FileNotFoundError(f"{path.name} needs {path.stem}{missing.pop()} beside it")
    text = re.sub(r"/\*.*?\*/", "", found[".lbl"].read_text(encoding="latin-1").upper(), flags=re.S)
    label = dict(re.findall(r"""^\s*(\^?\w+)\s*=[ \t"']*(.*?)[ \t"']*$""", text, re.M))
    entry = partial(_number, path, label)
    kinds = {"LSB_INTEGER": "<i", "MSB_INTEGER": ">i", "PC_REAL": "<f", "IEEE_REAL": ">f"}
    _expect(path, "projection", label.get("MAP_PROJECTION_TYPE", "").replace("_", " "),
            ("POLAR STEREOGRAPHIC", "STEREOGRAPHIC"))
    _expect(path, "direction of longitude", label.get("POSITIVE_LONGITUDE_DIRECTION"), ("EAST",))
    sample = kinds[_expect(path, "sample type", label.get("SAMPLE_TYPE"), kinds)]
    bits = _expect(path, "SAMPLE_BITS", label.get("SAMPLE_BITS"), ("16", "32", "64"))
    radius, rows, columns = entry("A_AXIS_RADIUS"), int(entry("LINES")), int(entry("LINE_SAMPLES"))
    raw = np.fromfile(found[".img"], np.dtype(f"{sample}{int(bits) // 8}"))
    if raw.size != rows * columns:
        raise ValueError(f"{found['.img'].name} holds {raw.size} samples; its label says {rows} x {columns}")
    height = raw.reshape(rows, columns).astype(float)
    if re.match(r"[-+.\d]+(E[-+]?\d+)?$", label.get("MISSING_CONSTANT", "")):     # not N/A, nor a bit pattern
        height[height == entry("MISSING_CONSTANT")] = np.nan
    unit = 1000 if label.get("UNIT", "").startswith("K") else 1
    height = (height * entry("SCALING_FACTOR", default=1) + entry("OFFSET", default=0)) * unit
    if np.nanmedian(height) > radius / 2:                # the label counts from the Moon's centre
        height -= radius
    step = entry("MAP_SCALE")                            # offsets count samples from the middle of the first one
    west = -(entry("SAMPLE_PROJECTION_OFFSET") + 0.5) * step
    north = (entry("LINE_PROJECTION_OFFSET") + 0.5) * step
    return Terrain(height, step, west, north, entry("CENTER_LATITUDE"), entry("CENTER_LONGITUDE"), radius, path.stem)


def _geotiff(path):
    try:
        import tifffile
    except ImportError:
        raise ImportError(f"{path.name}: reading a GeoTIFF needs tifffile: pip install tifffile") from None
    with tifffile.TiffFile(path) as file:
        page = file.pages[0]
        height, keys, nodata = page.asarray().astype(float), page.geotiff_tags or {}, page.tags.get("GDAL_NODATA")
    if not {"ModelPixelScale", "ModelTiepoint", "ProjCoordTransGeoKey"} <= set(keys):
        raise ValueError(f"{path.name} cannot be placed: a GeoTIFF needs a pixel scale, a tie point and a projection")
    if nodata is not None:
        height[height == float(nodata.value.strip("\0 "))] = np.nan
    entry, number = partial(_number, path, keys, default=0.0), int(keys["ProjCoordTransGeoKey"])
    names = {1: "transverse Mercator", 14: "stereographic", 15: "polar stereographic", 16: "oblique stereographic",
             21: "orthographic"}
    projection = _expect(path, "projection", names.get(number, number), names.values())
    step, step_y = keys["ModelPixelScale"][:2]
    if not np.isclose(step, step_y, rtol=1e-6):
        raise ValueError(f"{path.name}: cells must be square; got {step:g} x {step_y:g} m")
    latitude = entry("ProjNatOriginLatGeoKey", "ProjCenterLatGeoKey")
    longitude = entry("ProjStraightVertPoleLongGeoKey", "ProjNatOriginLongGeoKey", "ProjCenterLongGeoKey")
    if number == 15 and abs(latitude) != 90 or entry("ProjScaleAtNatOriginGeoKey", default=1.0) != 1:
        raise ValueError(f"{path.name}: the scale must be true at the centre of the projection")
    i, k, _, x, y = keys["ModelTiepoint"][:5]
    middle = 0.5 if entry("GTRasterTypeGeoKey", default=1) == 2 else 0.0     # 2: the tie point is a cell's centre
    west = x - (i + middle) * step - entry("ProjFalseEastingGeoKey", "ProjFalseOriginEastingGeoKey")
    north = y + (k + middle) * step - entry("ProjFalseNorthingGeoKey", "ProjFalseOriginNorthingGeoKey")
    far = max(abs(west), abs(north), abs(west + height.shape[1] * step), abs(north - height.shape[0] * step))
    if number in (1, 21) and far > 100e3:                # near its centre every such plane is the tangent one
        raise ValueError(f"{path.name}: {projection} is read within 100 km of its centre; it reaches {far:.0f} m")
    return Terrain(height, step, west, north, latitude, longitude,
                   entry("GeogSemiMajorAxisGeoKey", default=np.nan), path.stem)


def synthetic(seed: int, *, like: str = "connecting_ridge_10m", cells: int = 256, step_m: float | None = None,
              latitude_deg: float = -85.0, longitude_deg: float = 0.0) -> Terrain:
    """Made-up ground around a place: a fractal with craters, its slopes those of a real map. It repeats at its edges.

    `like` is a map of `data/slope_histograms.csv`, whose name ends in the length of its cells; `step_m` is that length
    unless given. Slopes belong to this baseline. The same seed makes the same ground.
    """
    table = catalog.table("slope_histograms.csv")
    known = [name.removesuffix("_pct") for name in table.filter(like="_pct")]
    if like not in known:
        raise unknown("no map", like, known)
    cells = whole("cells", cells, 32)
    step = check("step_m", float(re.search(r"_(\d+)m", like)[1]) if step_m is None else step_m, above=0, scalar=True)
    rng = generator(seed)
    frequency = np.fft.fftfreq(cells)
    wave = np.hypot(frequency[:, None], frequency)
    wave[0, 0] = np.inf                                  # amplitude falls as the wavelength to the power 2.5
    height = np.fft.ifft2(np.fft.fft2(rng.standard_normal((cells, cells))) / wave**2.5).real
    height *= 0.03 * cells / height.std()
    grid = np.arange(cells)
    for diameter in 5 / np.sqrt(rng.uniform((16 / cells)**2, 1, cells)):     # craters in cells: N(> D) as D^-2
        away = [np.minimum(abs(grid - middle), cells - abs(grid - middle)) for middle in rng.random(2) * cells]
        r = np.hypot(away[0][:, None], away[1]) / (diameter / 2)
        depth = rng.uniform(0.02, 0.2) * diameter       # worn bowls to fresh ones, with a rim a fifth as high
        height += depth * np.where(r < 1, 1.2 * np.minimum(r, 1)**2 - 1, 0.2 / np.maximum(r, 1)**3)
    # scale each gradient so that the slopes are the map's, integrate to the nearest surface, and again
    shares = np.cumsum(np.r_[0, table[f"{like}_pct"]])
    slopes = np.interp((np.arange(cells**2) + 0.5) / cells**2, shares / shares[-1], np.r_[0, table.slope_to_deg])
    wave = np.sin(2 * np.pi * frequency)                 # of central differences
    square = wave[:, None]**2 + wave**2
    square[square < 1e-12] = np.inf                      # level and checkerboard, which have no slope
    for _ in range(10):
        down, right = ((np.roll(height, -1, axis) - np.roll(height, 1, axis)) / 2 for axis in (0, 1))
        steep = np.hypot(down, right)
        factor = np.empty(height.size)
        factor[np.argsort(steep, axis=None, kind="stable")] = np.tan(np.radians(slopes))
        factor = factor.reshape(height.shape) / np.maximum(steep, 1e-12)
        spectrum = -1j * (wave[:, None] * np.fft.fft2(down * factor) + wave * np.fft.fft2(right * factor)) / square
        height = np.fft.ifft2(spectrum).real
    return Terrain(height * step, step, -cells * step / 2, cells * step / 2, latitude_deg, longitude_deg,
                   name=f"synthetic {seed}, like {like}")
