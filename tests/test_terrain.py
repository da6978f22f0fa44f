"""Height maps: places, slopes, skylines, files in the formats in which they are published, and made-up ground."""

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from rdk import catalog, sky, terrain
from rdk.terrain import Terrain

REPO = Path(__file__).parents[1]
SHARED = REPO.parent / "shared" / "facts" / "terrain"
real_maps = pytest.mark.skipif(not SHARED.exists(), reason="needs NASA's height maps in a folder beside the checkout")
R = terrain.RADIUS_M


def plane(east=0.0, north=0.0, cells=40, step_m=10.0, **place):
    """A tilted plane, x and y from the middle."""
    middle = (np.arange(cells) + 0.5 - cells / 2) * step_m
    edge = cells * step_m / 2
    return Terrain(100 + east * middle + north * -middle[:, None], step_m, -edge, edge, **place)


def targets(kind):
    with open(SHARED / "terrain_targets.csv", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if row["kind"] == kind]


# ---- places ------------------------------------------------------------------------------------------------

def test_the_south_pole_has_the_published_plane():
    latitude, longitude = np.array([-90.0, -85, -87.2]), np.array([0.0, 30, 200])
    rho = 2 * R * np.tan(np.radians(90 + latitude) / 2)
    x, y = plane().to_xy(latitude, longitude)
    np.testing.assert_allclose(x, rho * np.sin(np.radians(longitude)), atol=1e-6)          # micrometres
    np.testing.assert_allclose(y, rho * np.cos(np.radians(longitude)), atol=1e-6)


@given(st.floats(-90, 90), st.floats(0, 360), st.floats(-6, 6), st.floats(0, 360))
def test_places_come_back(latitude, longitude, away, direction):
    here = plane(latitude_deg=latitude, longitude_deg=longitude)
    x, y = 30e3 * away * np.sin(np.radians(direction)), 30e3 * away * np.cos(np.radians(direction))
    back = here.to_xy(*here.to_latlon(x, y))
    np.testing.assert_allclose(back, (x, y), atol=1e-2)  # arcsin near a pole loses digits: a centimetre
    north = here.to_xy(latitude + 0.01, longitude) if latitude < 89.9 else here.to_xy(latitude - 0.01, longitude + 180)
    np.testing.assert_allclose(north, (0, np.radians(0.01) * R), atol=0.01)      # y points north at the centre


def test_cells_and_places():
    ground = plane(cells=4)
    assert [int(i) for i in ground.cell(-19.9, 19.9)] == [0, 0] and [int(i) for i in ground.cell(19.9, -19.9)] == [3, 3]
    row, column = np.mgrid[0:4, 0:4]
    assert np.array_equal(ground.cell(*ground.place(row, column)), (row, column))
    np.testing.assert_allclose(ground.at(*ground.place(row, column)), ground.height_m, rtol=1e-14)
    with pytest.raises(ValueError, match="outside the map: x -20 to 20 m"):
        ground.cell(20.1, 0)


@given(st.floats(-195, 195), st.floats(-195, 195), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_heights_in_between_lie_on_the_plane(x, y, east, north):
    np.testing.assert_allclose(plane(east, north).at(x, y), 100 + east * x + north * y, atol=1e-9)


def test_nothing_is_known_outside_or_beside_a_hole():
    ground = plane()
    assert np.isnan(ground.at(np.array([196.0, -300, np.nan, 0]), np.array([0.0, 0, 0, 1e9]))).all()
    holed = ground.height_m.copy()
    holed[5, 7] = np.nan
    holed = Terrain(holed, 10, -200, 200)
    assert np.isnan(holed.at(*holed.place(5.4, 7.0)))
    assert np.isfinite(holed.at(*holed.place(7.0, 7.0)))
    with pytest.raises(ValueError, match="no height is known"):
        holed.skyline(*holed.place(5, 7))


@pytest.mark.parametrize("change, words", [
    (dict(height_m=np.zeros(5)), "grid of at least 2 x 2"), (dict(height_m=np.full((3, 3), np.nan)), "not NaN alone"),
    (dict(height_m=np.full((3, 3), np.inf)), "finite"), (dict(step_m=0.0), "step_m must be positive"),
    (dict(step_m=[1.0, 2.0]), "step_m must be one number"),
    (dict(latitude_deg=91), "latitude_deg must be at least -90")])
def test_bad_maps_are_refused(change, words):
    with pytest.raises(ValueError, match=words):
        Terrain(**dict(height_m=np.zeros((3, 3)), step_m=1.0) | change)


@pytest.mark.parametrize("call, words", [
    (lambda g: Terrain("x", 1.0), "height_m must be numbers; got 'x'"),
    (lambda g: Terrain([[1, 2], [3]], 1.0), "height_m must be numbers"),
    (lambda g: g.to_xy("x", 0.0), "latitude_deg must be .*'x'"), (lambda g: g.to_xy(-91.0, 0.0), "latitude_deg"),
    (lambda g: g.to_xy(-80.0, None), "longitude_deg"), (lambda g: g.to_latlon(0.0, np.nan), "y must be finite"),
    (lambda g: g.cell("x", 0.0), "x must be"), (lambda g: g.cell(0.0, np.nan), "y must be"),
    (lambda g: g.place("x", 0), "row must be"), (lambda g: g.at(0.0, [[1, 2], [3]]), "y must be numbers"),
    (lambda g: g.at({}, 0.0), "x must be numbers"), (lambda g: g.hillshade("x"), "azimuth_deg must be"),
    (lambda g: g.hillshade(10.0, [1.0, 2.0]), "elevation_deg must be one number"),
    (lambda g: g.skyline([0.0, 1.0], 0.0), "x must be one number"), (lambda g: g.skyline(0.0, 0.0, "x"), "height_m"),
    (lambda g: g.skyline(0.0, 0.0, farthest_m=[1e3, 2e3]), "farthest_m must be one number"),
    (lambda g: g.skyline(0.0, 0.0, beyond=["x"]), r"beyond\[0\] must be a Terrain; got 'x'"),
    (lambda g: g.skyline(0.0, 0.0, beyond=3), r"beyond\[0\] must be a Terrain; got int"),
    (lambda g: terrain.synthetic(1, like=None), "no map None"), (lambda g: terrain.synthetic("x"), "seed must be")])
def test_what_is_no_number_or_map_is_refused_by_name(call, words):
    with pytest.raises((ValueError, TypeError), match=words):
        call(plane())


def test_places_broadcast_and_a_single_map_beyond_will_do():
    ground = plane()
    latitude, longitude = ground.to_latlon([0.0, 10.0, 20.0], [[0.0], [5.0]])
    assert latitude.shape == longitude.shape == (2, 3)
    assert (latitude[1, 2], longitude[1, 2]) == ground.to_latlon(20.0, 5.0)
    wide = plane(0.3, cells=40, step_m=100.0)
    assert ground.skyline(0.0, 0.0, beyond=wide) == ground.skyline(0.0, 0.0, beyond=[wide])


# ---- slope and shade ---------------------------------------------------------------------------------------

@given(st.floats(-0.7, 0.7), st.floats(-0.7, 0.7))
def test_slope_and_shade_of_a_plane(east, north):
    ground = plane(east, north, cells=5)
    np.testing.assert_allclose(ground.slope(), np.degrees(np.arctan(np.hypot(east, north))), atol=1e-9)
    normal = np.array([-east, -north, 1]) / np.sqrt(1 + east**2 + north**2)
    sun = np.array([np.cos(0.3) * np.sin(2), np.cos(0.3) * np.cos(2), np.sin(0.3)])
    np.testing.assert_allclose(ground.hillshade(*np.degrees([2, 0.3])), max(normal @ sun, 0), atol=1e-12)


def test_slope_of_a_cone_is_the_same_all_round():
    x = (np.arange(101) - 50) * 10.0
    cone = Terrain(-0.3 * np.hypot(x[:, None], x), 10, -505, 505)
    away = np.hypot(x[:, None], x) > 200
    # central differences over 20 m where contours bend with 200 m: (h/r)^2 / 2; at the edge, one-sided, h/r / 2
    np.testing.assert_allclose(cone.slope()[away], np.degrees(np.arctan(0.3)), rtol=0.01)


# ---- skylines ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("latitude", [-90.0, -30.0, 89.0])
def test_a_bare_sphere_dips_by_its_curvature(latitude):
    sphere = Terrain(np.zeros((400, 400)), 500, -100e3, 100e3, latitude_deg=latitude)
    seen = sphere.skyline(5e3, -7e3, 10.0, farthest_m=50e3)
    # acos(R / (R + 10 m)) at a distance of 5.9 km; the search steps past the tangent point by 125 m at most
    np.testing.assert_allclose(seen.elevation_deg, -np.degrees(np.arccos(R / (R + 10))), rtol=5e-4)
    nothing = Terrain(np.zeros((20, 20)), 10).skyline(100.0, -100.0, 10.0)       # the map ends before the horizon
    assert nothing.elevation_deg.max() < -np.degrees(np.arccos(R / (R + 10))) + 1e-9


def test_a_wall_stands_as_high_as_geometry_says():
    height = np.zeros((400, 400))
    height[:, 300:] = 400.0                              # a cliff towards the right of the map, from x = 10,050 m on
    ground = Terrain(height, 100, -20e3, 20e3)
    seen = ground.skyline(0.0, 0.0, 2.0)
    arc = np.arange(9.9e3, 10.2e3, 5) / R
    expected = np.degrees(np.arctan(np.max((R + ground.at(arc * R, 0 * arc)) * np.cos(arc) - R - 2) / arc[30] / R))
    np.testing.assert_allclose(seen.at(90.0), expected, atol=0.03)               # steps of 1 %: 100 m of 10 km
    np.testing.assert_allclose(seen.at(45.0), np.degrees(np.arctan((400 - 2 - 58) / 14.2e3)), atol=0.03)
    assert seen.at(270.0) < 0                            # the plain dips


def test_azimuths_run_clockwise_from_north():
    height = np.zeros((200, 200))
    height[90:110, 150:155] = 50.0                       # a block towards x > 0, on the plane's y = 0
    for place, azimuth in ((dict(latitude_deg=20.0, longitude_deg=30.0), 90.0), (dict(latitude_deg=-88.0), 90.0)):
        seen = Terrain(height, 10, -1000, 1000, **place).skyline(0.0, 0.0)
        assert abs(seen.azimuth_deg[np.argmax(seen.elevation_deg)] - azimuth) < 12
    # near the south pole, on the meridian of 90 E: the same block now stands farther from the pole, to the north
    seen = Terrain(height, 10, 19_000, 1000).skyline(20_000.0, 0.0)
    block = seen.azimuth_deg[seen.elevation_deg > 2]
    assert len(block) and np.all((block < 12) | (block > 348))


@given(st.floats(0, 50), st.floats(0, 50), st.integers(0, 3))
def test_a_skyline_falls_as_the_eye_rises(low, more, seed):
    ground = HILLS[seed]
    seen, above = (ground.skyline(30.0, -50.0, height, directions=36, farthest_m=5e3) for height in (low, low + more))
    assert np.all(above.elevation_deg <= seen.elevation_deg + 1e-9)


HILLS = [terrain.synthetic(seed, cells=64) for seed in range(4)]


def test_nested_maps():
    rng = np.random.default_rng(1)
    rough = rng.normal(0, 300, (100, 100))
    smooth = sum(np.roll(rough, (i, k), (0, 1)) for i in range(6) for k in range(6)) / 36
    smooth[15:25, 40:60] += 3000.0                       # a massif 6 km away, of which the fine map knows nothing
    wide = Terrain(smooth, 200, -10e3, 10e3)
    middle = wide.at(*np.meshgrid((np.arange(20) - 9.5) * 100, -(np.arange(20) - 9.5) * 100))
    fine = Terrain(middle, 100, -1000, 1000)
    alone, nested = fine.skyline(0.0, 0.0, 5.0), fine.skyline(0.0, 0.0, 5.0, beyond=[wide])
    gained = nested.elevation_deg - alone.elevation_deg
    assert gained.min() >= 0 and gained.max() > 1
    # the fine map repeats what the wide one says: the same skyline as from one map, to the sampling of steep edges
    assert np.abs(nested.elevation_deg - wide.skyline(0.0, 0.0, 5.0).elevation_deg).mean() < 0.2
    twice = fine.skyline(0.0, 0.0, 5.0, beyond=[fine, wide])
    assert twice == nested
    for wrong, words in ((dict(height_m=-1), "height_m"), (dict(directions=2), "directions"),
                         (dict(farthest_m=5), "farthest_m"), (dict(x=5e3), "no height is known")):
        with pytest.raises(ValueError, match=words):
            fine.skyline(**dict(x=0.0, y=0.0) | wrong)


def test_the_search_ends_where_it_is_told_to():
    height = np.zeros((100, 100))
    height[:, 60:] = 500.0                               # a step up, 1 km from the middle
    ground = Terrain(height, 100, -5000, 5000)
    short, long = (ground.skyline(0.0, 0.0, farthest_m=reach).at(90.0) for reach in (800.0, 2000.0))
    assert short < 0 < 20 < long


# ---- files -------------------------------------------------------------------------------------------------

LABEL = '''PDS_VERSION_ID            = "PDS3"
/* a comment = not a key */
^IMAGE                    = "{name}.IMG"
OBJECT                    = IMAGE
  LINES                   = {rows}
  LINE_SAMPLES            = {columns}
  SAMPLE_TYPE             = {kind}
  SAMPLE_BITS             = {bits}
  UNIT                    = {unit}
  SCALING_FACTOR          = {scale}
  OFFSET                  = {offset}
END_OBJECT                = IMAGE
OBJECT                    = IMAGE_MAP_PROJECTION
  MAP_PROJECTION_TYPE          = "{projection}"
  A_AXIS_RADIUS                = {radius} <KM>
  POSITIVE_LONGITUDE_DIRECTION = "EAST"
  CENTER_LATITUDE              = -90. <DEG>
  CENTER_LONGITUDE             = 0. <DEG>
  MAP_SCALE                    = {step} <{per}>
  LINE_PROJECTION_OFFSET       = {line}
  SAMPLE_PROJECTION_OFFSET     = {sample}
END_OBJECT                = IMAGE_MAP_PROJECTION
END
'''


def write_pds(folder, raw, name="LDEM_TEST", **words):
    """A PDS image with its label, as the archive of LOLA has them; four rows and six columns around the pole."""
    kinds = {"<i2": ("LSB_INTEGER", 16), ">i2": ("MSB_INTEGER", 16), "<f4": ("PC_REAL", 32), ">f4": ("IEEE_REAL", 32)}
    kind, bits = kinds[raw.dtype.str]
    raw.tofile(folder / f"{name}.IMG")
    words = dict(name=name, rows=4, columns=6, kind=kind, bits=bits, unit="METER", scale=0.5, offset="1737400.",
                 projection="POLAR STEREOGRAPHIC", radius=1737.4, step=120.0, per="METERS/PIXEL",
                 line=1.5, sample=2.5) | words
    (folder / f"{name}.LBL").write_text(LABEL.format(**words), encoding="latin-1")
    return folder / f"{name}.IMG"


RAW = np.arange(24).reshape(4, 6) * 100 - 1000


@pytest.mark.parametrize("kind", ["<i2", ">i2"])
def test_pds_integers(tmp_path, kind):
    path = write_pds(tmp_path, RAW.astype(kind))
    for given_path in (path, str(path), path.with_suffix(".LBL")):
        ground = terrain.read(given_path)
        np.testing.assert_allclose(ground.height_m, RAW * 0.5, rtol=1e-15)
        assert (ground.step_m, ground.west_m, ground.north_m) == (120, -360, 240)        # the pole is in the middle
        assert (ground.latitude_deg, ground.radius_m, ground.name) == (-90, R, "LDEM_TEST")


@pytest.mark.parametrize("kind", ["<f4", ">f4"])
def test_pds_kilometres_and_holes(tmp_path, kind):
    raw = (RAW / 1000).astype(kind)
    raw[2, 3] = -9999
    path = write_pds(tmp_path, raw, unit="KILOMETER", scale=1, offset=0, step=0.12, per="KM/PIXEL")
    path.with_suffix(".LBL").write_text(path.with_suffix(".LBL").read_text().replace(
        "  UNIT ", "  MISSING_CONSTANT = -9999\n  UNIT "))
    ground = terrain.read(path)
    assert np.isnan(ground.height_m[2, 3]) and np.isnan(ground.height_m).sum() == 1
    # 32 bits of a kilometre
    np.testing.assert_allclose(np.delete(ground.height_m, 15), np.delete(RAW, 15), atol=1e-3)
    assert ground.step_m == 120


def test_pds_that_cannot_be_placed(tmp_path):
    raw = RAW.astype("<i2")
    for words, message in ((dict(projection="SIMPLE CYLINDRICAL"), "cannot be placed: projection must be POLAR"),
                           (dict(radius=6378.1), "radius_m must be at least 1.73e[+]06 .*; got 6378100.0"),
                           (dict(rows=5), "label says 5 x 6"),
                           (dict(step="many"), "MAP_SCALE must be a number; got 'MANY <"),
                           (dict(bits=12), "SAMPLE_BITS must be 16 or 32 or 64; got '12'"),
                           (dict(kind="VAX_REAL"), "sample type must be LSB_INTEGER")):
        with pytest.raises(ValueError, match=message):
            terrain.read(write_pds(tmp_path, raw, **words))
    path = write_pds(tmp_path, raw)
    label = path.with_suffix(".LBL")
    label.write_text(label.read_text().replace("MAP_SCALE", "SCALE_OF_MAP"))
    with pytest.raises(ValueError, match="MAP_SCALE must be a number; got None"):
        terrain.read(path)
    label.unlink()
    with pytest.raises(FileNotFoundError, match=r"LDEM_TEST.IMG needs LDEM_TEST.lbl beside it"):
        terrain.read(path)


def write_tiff(path, height, projection=15, latitude=-90.0, radius=R, area=1, step=(5.0, 5.0), nodata=None, drop=()):
    """A GeoTIFF as GDAL writes one: pixel scale, tie point, GeoKeys."""
    tifffile = pytest.importorskip("tifffile", reason="a GeoTIFF needs tifffile")
    doubles = (latitude, 0.0, 1.0, 0.0, 0.0, radius, radius)
    where = (3095, 3081) if projection == 15 else (3080, 3081)      # straight pole longitude, or origin longitude
    keys = [(1024, 0, 1, 1), (1025, 0, 1, area), (2057, 34736, 1, 5), (2058, 34736, 1, 6), (3075, 0, 1, projection),
            (3081, 34736, 1, 0), (where[0], 34736, 1, 1), (3082, 34736, 1, 3), (3083, 34736, 1, 4), (3092, 34736, 1, 2)]
    directory = [1, 1, 0, len(keys)] + [number for key in sorted(keys) for number in key]
    tags = [(33550, "d", 3, (*step, 0.0), True), (33922, "d", 6, (0, 0, 0, -10.0, 20.0, 0), True),
            (34735, "H", len(directory), tuple(directory), True), (34736, "d", len(doubles), doubles, True)]
    if nodata is not None:
        tags.append((42113, "s", 0, str(nodata), True))
    tifffile.imwrite(path, height, extratags=[tag for tag in tags if tag[0] not in drop], photometric="minisblack")
    return path


def test_geotiff(tmp_path):
    height = (RAW / 7).astype("f4")
    ground = terrain.read(write_tiff(tmp_path / "a.tif", height))
    assert np.array_equal(ground.height_m, height)
    assert (ground.step_m, ground.west_m, ground.north_m, ground.latitude_deg) == (5, -10, 20, -90)
    pixel = terrain.read(write_tiff(tmp_path / "b.tif", height, area=2))         # the tie point is the centre of a cell
    assert (pixel.west_m, pixel.north_m) == (-12.5, 22.5)
    height[1, 1] = -3e38
    assert np.isnan(terrain.read(write_tiff(tmp_path / "c.tif", height, nodata=float(height[1, 1]))).height_m[1, 1])
    oblique = terrain.read(write_tiff(tmp_path / "d.tiff", height, projection=16, latitude=25.0))
    np.testing.assert_allclose(oblique.to_latlon(0, 0), (25, 0), atol=1e-12)


@pytest.mark.parametrize("change, words", [
    (dict(projection=17), "projection must be .*polar stereographic.*got 17"),
    (dict(radius=6378137.0), "radius_m must be"), (dict(radius=np.nan), "radius_m must be .* finite; got nan"),
    (dict(drop=(34735, 34736)), "cannot be placed: a GeoTIFF needs"), (dict(drop=(33550,)), "needs a pixel scale"),
    (dict(step=(5.0, 6.0)), "cells must be square"), (dict(latitude=-71.0), "scale must be true at the centre"),
    (dict(projection=1, latitude=20.0, step=(50e3, 50e3)), "within 100 km")])
def test_geotiffs_that_cannot_be_placed(tmp_path, change, words):
    with pytest.raises(ValueError, match=words):
        terrain.read(write_tiff(tmp_path / "a.tif", RAW.astype("f4"), **change))


def test_geotiff_without_its_reader(tmp_path, monkeypatch):
    (tmp_path / "a.tif").write_bytes(b"II*\0")
    monkeypatch.setitem(__import__("sys").modules, "tifffile", None)
    with pytest.raises(ImportError, match="a.tif: reading a GeoTIFF needs tifffile: pip install tifffile"):
        terrain.read(tmp_path / "a.tif")


def test_png(tmp_path):
    raw = np.array([[0, 1, 65535], [300, 40000, 7]], np.uint16)
    Image.fromarray(raw).save(tmp_path / "a.png")
    geometry = dict(scale=0.1, offset=-600.0, west_m=-30.0, north_m=20.0, step_m=10.0)
    ground = terrain.read(tmp_path / "a.png", **geometry)
    np.testing.assert_allclose(ground.height_m, raw * 0.1 - 600, rtol=1e-15)
    assert (ground.west_m, ground.north_m, ground.step_m, ground.latitude_deg) == (-30, 20, 10, -90)
    assert terrain.read(tmp_path / "a.png", **geometry, latitude_deg=25.0).latitude_deg == 25
    for wrong, words in ((dict(scale="x"), "scale must be"), (dict(latitude_dg=5.0), "latitude_dg")):
        with pytest.raises((ValueError, TypeError), match=words):
            terrain.read(tmp_path / "a.png", **geometry | wrong)
    with pytest.raises(ValueError, match="give offset, west_m"):
        terrain.read(tmp_path / "a.png", scale=1.0, north_m=0.0, step_m=1.0)
    (tmp_path / "terrain.csv").write_text("file,scale,offset,west_m,north_m,step_m,projection\n"
                                          '"a.png",0.1,-600,-30,20,10,"oblique, centre 25.5 N -46.7 E"\n')
    beside = terrain.read(tmp_path / "a.png")
    assert np.array_equal(beside.height_m, ground.height_m) and (beside.west_m, beside.latitude_deg) == (-30, 25.5)
    assert beside.longitude_deg == -46.7
    Image.fromarray((raw % 256).astype(np.uint8)).save(tmp_path / "b.png")
    with pytest.raises(ValueError, match="one channel of 16 bits; got mode L"):
        terrain.read(tmp_path / "b.png", **geometry)


def test_other_files_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="no file"):
        terrain.read(tmp_path / "nothing.tif")
    (tmp_path / "map.jp2").write_bytes(b"")
    with pytest.raises(ValueError, match="a height map must be a .png, .tif, or .img"):
        terrain.read(tmp_path / "map.jp2")
    with pytest.raises(ValueError, match="says itself where it lies"):
        terrain.read(write_pds(tmp_path, RAW.astype("<i2")), scale=2.0)


# ---- made-up ground ----------------------------------------------------------------------------------------

@pytest.mark.parametrize("like", [name.removesuffix("_pct") for name in catalog.rows("slope_histograms.csv")[0]
                                  if name.endswith("_pct")])
def test_synthetic_slopes_are_those_of_the_real_map(like):
    real = np.cumsum([float(row[f"{like}_pct"]) for row in catalog.rows("slope_histograms.csv")])
    ground = terrain.synthetic(5, like=like, cells=128)
    ours = 100 * np.cumsum(np.histogram(ground.slope(), np.arange(46))[0]) / ground.height_m.size
    # the edges repeat, but are differenced to one side: 3 % of the cells; and ten rounds do not converge fully
    assert np.abs(ours - real).max() < 1.5


def test_synthetic_ground_is_the_seeds_own():
    one, same, other = (terrain.synthetic(seed, cells=64) for seed in (3, 3, 4))
    assert np.array_equal(one.height_m, same.height_m) and not np.allclose(one.height_m, other.height_m)
    assert one.step_m == 10 and terrain.synthetic(3, cells=64, step_m=5).step_m == 5
    np.testing.assert_allclose(terrain.synthetic(3, cells=64, step_m=5).slope(), one.slope(), rtol=1e-9)
    np.testing.assert_allclose(one.to_latlon(0, 0), (-85, 0), atol=1e-9)
    for wrong, words in ((dict(like="connecting_ridge"), "nearest are .*connecting_ridge_10m"),
                         (dict(cells=8), "cells"), (dict(seed=-1), "seed"), (dict(step_m=0), "step_m")):
        with pytest.raises(ValueError, match=words):
            terrain.synthetic(**dict(seed=1) | wrong)


def test_craters_are_holes():
    ground = terrain.synthetic(1, cells=128)
    # a field of Gaussian hills has no sense of up and down; bowls with rims make the curvature skew
    bend = sum(np.roll(ground.height_m, shift, axis) for shift in (1, -1) for axis in (0, 1)) - 4 * ground.height_m
    assert ((bend - bend.mean())**3).mean() / bend.std()**3 < -0.3


# ---- the real maps -----------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def maps():
    return [terrain.read(SHARED / f"{name}.png") for name in ("connecting_ridge_10m", "connecting_ridge_20m",
                                                              "south_pole_240m", "south_pole_480m")]


@real_maps
def test_skylines_of_the_real_ridge(maps):
    rows, seen = targets("reference skyline"), {}
    for row in rows:
        place = float(row["latitude_deg"]), float(row["longitude_deg"])
        if place not in seen:
            seen[place] = maps[0].skyline(*maps[0].to_xy(*place), float(row["height_m"]), beyond=maps[1:])
        azimuth = float(row["quantity"].split("_")[2])
        np.testing.assert_allclose(seen[place].at(azimuth), float(row["value"]), atol=float(row["tolerance"]))
    assert len(rows) >= 30


@real_maps
def test_light_on_the_real_ridge(maps):
    hours = sky.julian_date(np.arange("2027-01-01", "2028-01-01", dtype="datetime64[h]"))
    rows, lit = targets("reference illumination"), {}
    for row in rows:
        place = float(row["latitude_deg"]), float(row["longitude_deg"])
        if place not in lit:
            seen = maps[0].skyline(*maps[0].to_xy(*place), float(row["height_m"]), beyond=maps[1:])
            lit[place] = sky.lit_fraction(*sky.sun_position(*place, hours), seen)
        ours = dict(mean_lit=100 * lit[place].mean(), dark_time=100 * (lit[place] <= 0).mean(),
                    longest_dark=sky.longest_run(lit[place] <= 0) / 24)[row["quantity"]]
        np.testing.assert_allclose(ours, float(row["value"]), atol=float(row["tolerance"]))
    assert len(rows) >= 10


@real_maps
def test_tabulated_skylines_come_out_of_the_real_maps(maps):
    for site, start in (("connecting_ridge_spot_1", 0), ("shackleton_floor", 2), ("malapert_massif", 3)):
        table = catalog.skyline(site)
        first = maps[start]
        ours = first.skyline(*first.to_xy(table.latitude_deg, table.longitude_deg), 2.0, beyond=maps[start + 1:])
        # the table rounds to 0.01 deg, and samples the far terrain at other points: 0.3 deg of 0.5 deg directions
        np.testing.assert_allclose(ours.at(table.azimuth_deg), table.elevation_deg, atol=0.3)
        assert np.abs(ours.at(table.azimuth_deg) - table.elevation_deg).mean() < 0.02


@real_maps
def test_slopes_of_the_real_maps_are_the_tabulated_ones():
    for name in ("connecting_ridge_10m", "shoemaker_rim_5m", "aristarchus_imp_5m_height",
                 "aristarchus_peak_214m_height"):
        ground = terrain.read(SHARED / f"{name}.png")
        shares = 100 * np.histogram(ground.slope(), np.arange(46))[0] / ground.height_m.size
        table = [float(row[f"{name}_pct"]) for row in catalog.rows("slope_histograms.csv")]
        np.testing.assert_allclose(shares, table, atol=0.002)                    # printed with three decimals


@real_maps
def test_published_light_near_the_summit_between_shackleton_and_slater(maps):
    (row,) = [row for row in catalog.rows("published_light.csv") if row["site"] == "shackleton_slater_summit"]
    hours = sky.julian_date(np.arange(row["from_utc"], row["to_utc"], dtype="datetime64[h]"))
    polar = maps[2]
    x, y = polar.place(*np.mgrid[0:500, 0:500])
    there = polar.to_xy(float(row["latitude_deg"]), float(row["longitude_deg"]))
    near = np.hypot(x - there[0], y - there[1]) <= 2400  # the summit moved by 2 km from one laser altimeter to the next
    best = 0.0
    for i, k in np.argwhere(near & (polar.height_m > 1550)):         # only the heights can be lit so long
        seen = polar.skyline(x[i, k], y[i, k], 0.0, beyond=maps[3:], directions=240)
        lit = sky.lit_fraction(*sky.sun_position(*polar.to_latlon(x[i, k], y[i, k]), hours[::6]), seen)
        best = max(best, 100 * lit.mean())
    np.testing.assert_allclose(best, float(row["value"]), atol=float(row["tolerance"]))
