"""Designs, scenarios and models: what they accept, what they refuse and how, populations and their lanes."""

import copy
import dataclasses
import math
import operator
import pickle
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import rdk
import searches
from rdk.design import DESIGN_SPACE, Problem
from rdk.terramechanics import Soil, Wheel

VALUES = dict(wheel_radius_m=0.10, wheel_width_m=0.08, grouser_height_m=0.015, grouser_count=14,
              wheel_count=4, chassis_mass_kg=3.5, wheelbase_m=0.5, solar_area_m2=0.25, battery_capacity_wh=50,
              avionics_power_w=15, peak_wheel_torque_nm=0.5)
DESIGN, SCENARIO = rdk.Design(**VALUES), rdk.scenario("equatorial_mare_traverse")
MODEL, SOIL = rdk.Model(), SCENARIO.soil
MAY_BE_ZERO = {"grouser_height_m", "grouser_count"}
MAY_BE_INFINITE = {"traverse_limit_km", "hub_no_load_speed_rad_s", "maximum_speed_m_s"}
MAY_BE_NONE = {"transition_c1", "transition_c2"}


def numeric(record):
    return [f.name for f in dataclasses.fields(record) if "minimum" in f.metadata]


EVERY = [(record, name) for record in (DESIGN, SCENARIO, MODEL, SOIL, DESIGN.wheel)
         for name in numeric(record)]
IDS = [f"{type(record).__name__}.{name}" for record, name in EVERY]


# ---- refusals ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("record, name", EVERY, ids=IDS)
def test_no_field_takes_what_is_no_number(record, name):
    for value in (*(() if name in MAY_BE_NONE else (None,)), math.nan, -math.inf, "0.1", b"1", True, 1j,
                  [[1.0], [2.0, 3.0]],
                  np.array([0.1, None]), pd.Series(["a"]), {}, np.datetime64("2026-01-01")):
        with pytest.raises(ValueError) as refused:
            replace(record, **{name: value})
        message = str(refused.value)
        assert message.startswith(f"{name} must be ") and len(message) < 250
        assert message.endswith(f"; got {value!r}")


@pytest.mark.parametrize("record, name", EVERY, ids=IDS)
def test_infinity_is_refused_but_where_it_lifts_a_limit(record, name):
    if name in MAY_BE_INFINITE:
        assert getattr(replace(record, **{name: math.inf}), name) == math.inf
        return
    with pytest.raises(ValueError, match=rf"^{name} must be .*; got inf$"):
        replace(record, **{name: math.inf})


@pytest.mark.parametrize("name", VALUES)
def test_design_variables_are_positive(name):
    for value in -0.1, -3:
        with pytest.raises(ValueError, match=rf"^{name} must be .*; got {value}$"):
            replace(DESIGN, **{name: value})
    if name in MAY_BE_ZERO:
        assert getattr(replace(DESIGN, **{name: 0}), name) == 0
    else:
        with pytest.raises(ValueError, match=rf"^{name} must be .*; got 0$"):
            replace(DESIGN, **{name: 0})


REFUSED = [
    (DESIGN, dict(wheel_radius_m=-0.1), "wheel_radius_m must be positive and finite; got -0.1"),
    (DESIGN, dict(wheel_radius_m=[0.1, 0.2, -0.1]),
     "wheel_radius_m must be positive and finite; got -0.1 at index 2"),
    (DESIGN, dict(wheel_radius_m=[[0.1, 0.2], [0.0, 0.1]]),
     "wheel_radius_m must be positive and finite; got 0.0 at index (1, 0)"),
    (DESIGN, dict(wheel_count=5), "wheel_count must be one of 4, 6; got 5"),
    (DESIGN, dict(wheel_count=np.array([4, 6, 8])), "wheel_count must be one of 4, 6; got 8.0 at index 2"),
    (DESIGN, dict(grouser_count=2.5), "grouser_count must be a whole number, zero or more; got 2.5"),
    (DESIGN, dict(grouser_count=1e300), "grouser_count must be a whole number, zero or more; got 1e+300"),
    (SCENARIO, dict(latitude_deg=90.5),
     "latitude_deg must be at least -90 and at most 90 and finite; got 90.5"),
    (SCENARIO, dict(slope_deg=-90), "slope_deg must be above -90 and below 90 and finite; got -90"),
    (SCENARIO, dict(duty_cycle=1.2), "duty_cycle must be at least 0 and at most 1 and finite; got 1.2"),
    (SCENARIO, dict(duty_cycle=-0.1), "duty_cycle must be at least 0 and at most 1 and finite; got -0.1"),
    (SCENARIO, dict(traverse_limit_km=-1), "traverse_limit_km must be zero or more; got -1"),
    (SCENARIO, dict(payload_mass_kg=-1), "payload_mass_kg must be zero or more and finite; got -1"),
    (SCENARIO, dict(duration_earth_days=0),
     "duration_earth_days must be above 0 and at most 3660 and finite; got 0"),
    (SCENARIO, dict(duration_earth_days=[7, 14]),
     "duration_earth_days must be one number, not an array; got 2 values"),
    (MODEL, dict(drivetrain_efficiency=0),
     "drivetrain_efficiency must be above 0 and at most 1 and finite; got 0"),
    (MODEL, dict(slip_max=1.0), "slip_max must be at least -1 and below 1 and finite; got 1.0"),
    (MODEL, dict(slip_min=0.5, slip_max=0.5), "slip_min must be below slip_max; got 0.5 and 0.5"),
    (MODEL, dict(transition_c1=0.7, transition_c2=0.4),
     "transition_c1 + transition_c2 must be at most 1; got 0.7 + 0.4"),
    (MODEL, dict(enclosure_area_base_m2=0, enclosure_area_coefficient_m2=0),
     "enclosure_area_base_m2 and enclosure_area_coefficient_m2 must not both be 0"),
    (MODEL, dict(time_step_h=[1, 2]), "time_step_h must be one number, not an array; got 2 values"),
    (MODEL, dict(hub_no_load_speed_rad_s=0), "hub_no_load_speed_rad_s must be positive; got 0"),
    (SOIL, dict(friction_angle_deg=-1),
     "friction_angle_deg must be at least 0 and below 90 and finite; got -1"),
]


@pytest.mark.parametrize("record, change, message", REFUSED, ids=[message[:50] for *_, message in REFUSED])
def test_a_refusal_names_argument_value_and_what_is_allowed(record, change, message):
    with pytest.raises(ValueError) as refused:
        replace(record, **change)
    assert str(refused.value) == message


def test_arrays_must_agree_or_broadcast():
    with pytest.raises(ValueError,
                       match=r"array lengths must agree .* wheel_radius_m \(2,\), wheel_width_m \(3,\)"):
        rdk.Design(**VALUES | dict(wheel_radius_m=[0.1, 0.2], wheel_width_m=[0.1, 0.2, 0.3]))
    with pytest.raises(ValueError, match=r"latitude_deg \(2,\), soil\.cohesion_kpa \(3,\)"):
        replace(SCENARIO, latitude_deg=[0, 10], soil=replace(SOIL, cohesion_kpa=[0.1, 0.2, 0.3]))
    assert rdk.Design(**VALUES | dict(wheel_radius_m=[0.1, 0.2],
                                      wheel_width_m=[[0.1], [0.2], [0.3]])).shape == (3, 2)


def test_a_field_that_is_missing_or_unknown_is_named():
    with pytest.raises(TypeError, match="peak_wheel_torque_nm"):
        rdk.Design(**{name: value for name, value in VALUES.items() if name != "peak_wheel_torque_nm"})
    with pytest.raises(TypeError, match="colour"):
        rdk.Design(**VALUES, colour="red")


# ---- the design space --------------------------------------------------------------------------------------

def test_design_space_is_the_papers_table():
    assert list(DESIGN_SPACE) == list(VALUES)
    assert DESIGN_SPACE["wheel_width_m"][:2] == (0.03, 0.20)
    assert DESIGN_SPACE["battery_capacity_wh"].unit == "Wh"
    for name, variable in DESIGN_SPACE.items():
        assert variable.low < variable.high and variable.symbol and variable.label
        for edge in variable.low, variable.high:         # the bounds themselves are inside, and allowed
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                rdk.evaluate(replace(DESIGN, **{name: edge}), SCENARIO)


@pytest.mark.parametrize("name", [name for name in VALUES if name != "wheel_count"])
def test_beyond_the_design_space_there_is_one_warning(name):
    variable = DESIGN_SPACE[name]
    beyond = [2 * variable.high] + ([variable.low / 2] if variable.low > 0 else [])
    for value in (*beyond, np.array([variable.high, 2 * variable.high])):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = rdk.evaluate(replace(DESIGN, **{name: value}), SCENARIO)
        assert len(caught) == 1 and issubclass(caught[0].category, UserWarning)
        assert f"{name} ({variable.low:g} to {variable.high:g} {variable.unit})" in str(caught[0].message)
        assert np.all(np.isfinite(result.range_km)) and np.all(np.isfinite(result.total_mass_kg))


def test_no_population_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert rdk.evaluate(replace(DESIGN, wheel_radius_m=np.array([])), SCENARIO).range_km.shape == (0,)


# ---- records -----------------------------------------------------------------------------------------------

def test_records_are_frozen_and_keep_their_own_numbers():
    with pytest.raises(dataclasses.FrozenInstanceError):
        DESIGN.wheel_radius_m = 0.2
    radius = np.array([0.1, 0.2])
    design = replace(DESIGN, wheel_radius_m=radius)
    radius[0] = -1.0
    assert design.wheel_radius_m.tolist() == [0.1, 0.2]


@pytest.mark.parametrize("value",
                         [[0.1, 0.2], (0.1, 0.2), np.array([0.1, 0.2]), np.array([0.1, 0.2], dtype=object),
                                   pd.Series([0.1, 0.2], index=[5, 3])], ids=lambda v: type(v).__name__)
def test_numbers_come_in_many_forms(value):
    if isinstance(value, np.ndarray) and value.dtype == object:
        with pytest.raises(ValueError, match="wheel_radius_m must be positive and finite; got array"):
            replace(DESIGN, wheel_radius_m=value)
        return
    design = replace(DESIGN, wheel_radius_m=value)
    assert type(design.wheel_radius_m) is np.ndarray and design.wheel_radius_m.tolist() == [0.1, 0.2]


@pytest.mark.parametrize("value", [1, np.int32(1), np.float64(1.0), np.array(1), np.array(1.0), np.uint8(1)],
                         ids=repr)
def test_one_number_is_a_plain_float(value):
    design = replace(DESIGN, wheel_radius_m=value)
    assert type(design.wheel_radius_m) is float and design.shape == ()


def test_lanes_of_a_population():
    population = rdk.random_designs(7, seed=3)
    assert population.shape == (7,) and len(population) == 7 and len(list(population)) == 7
    one = population[2]
    assert one.shape == () and type(one.wheel_radius_m) is float
    assert one.wheel_radius_m == population.wheel_radius_m[2]
    assert population[[1, 2]].wheel_radius_m.tolist() == population.wheel_radius_m[1:3].tolist()
    assert population[population.wheel_count == 6].shape == ((population.wheel_count == 6).sum(),)
    mixed = replace(DESIGN, wheel_radius_m=np.array([0.1, 0.2]))  # scalar fields belong to every lane
    assert mixed[1] == replace(DESIGN, wheel_radius_m=0.2)
    grid = replace(DESIGN, wheel_radius_m=np.array([[0.1], [0.2]]),
                   wheel_width_m=np.array([0.05, 0.06, 0.07]))
    assert grid.shape == (2, 3) and grid[1, 2] == replace(DESIGN, wheel_radius_m=0.2, wheel_width_m=0.07)
    with pytest.raises(TypeError, match="this Design is a single one and has no length"):
        len(DESIGN)
    with pytest.raises(TypeError, match="this Design is a single one and cannot be indexed"):
        DESIGN[0]
    with pytest.raises(IndexError):
        population[7]


def test_scenario_lanes_pick_the_soil_too():
    soils = replace(SOIL, friction_angle_deg=np.array([30.0, 40.0]))
    scenario = replace(SCENARIO, soil=soils)
    assert scenario.shape == (2,) and scenario[1].soil == replace(SOIL, friction_angle_deg=40.0)
    assert scenario[1] == replace(SCENARIO, soil=scenario[1].soil)


def test_to_frame_has_one_row_a_lane_in_c_order():
    grid = replace(DESIGN, wheel_radius_m=np.array([[0.1], [0.2]]),
                   wheel_width_m=np.array([0.05, 0.06, 0.07]))
    frame = grid.to_frame()
    assert list(frame.columns) == list(VALUES) and len(frame) == 6
    assert frame.wheel_radius_m.tolist() == [0.1] * 3 + [0.2] * 3
    assert frame.wheel_width_m.tolist() == [0.05, 0.06, 0.07] * 2
    assert len(DESIGN.to_frame()) == 1 and "soil_cohesion_kpa" in SCENARIO.to_frame().columns


def test_a_design_knows_its_wheel():
    assert DESIGN.wheel == Wheel(0.10, 0.08, 0.015, 14)
    assert rdk.random_designs(5, seed=1).wheel.shape == (5,)


def test_defaults():
    assert Soil(1.0, 1.4, 820.0, 0.17, 46.0).shear_modulus_mm == 18.0
    plain = rdk.Scenario(name="x", latitude_deg=0, soil=SOIL, duration_earth_days=1, slope_deg=0,
                         duty_cycle=0.1)
    assert plain.traverse_limit_km == math.inf and plain.payload_mass_kg == plain.panel_tilt_deg == 0
    assert plain.problem == Problem() and rdk.Model() == rdk.Model() != rdk.Model(dust_factor=0.8)


# ---- random designs ----------------------------------------------------------------------------------------

def test_random_designs_fill_the_design_space():
    population = rdk.random_designs(20_000, seed=5)
    for name, variable in DESIGN_SPACE.items():
        values = getattr(population, name)
        assert np.all((values >= variable.low) & (values <= variable.high))
        # 20,000 draws give the mean to 0.2 % of the range (0.4 % for a choice), the ends to 1e-3
        span = variable.high - variable.low
        assert np.mean(values) == pytest.approx((variable.low + variable.high) / 2, abs=0.02 * span)
        assert np.min(values) <= variable.low + 1e-3 * span
    assert set(population.wheel_count) == {4, 6}
    assert np.array_equal(population.grouser_count, population.grouser_count // 1)
    again = rdk.random_designs(20_000, seed=5)
    assert np.array_equal(population.wheel_radius_m, again.wheel_radius_m)
    assert not np.array_equal(population.wheel_radius_m, rdk.random_designs(20_000, seed=6).wheel_radius_m)


@pytest.mark.parametrize("count", [0, -1, 2.5, "5", [3], math.nan])
def test_random_designs_refuse_a_senseless_count(count):
    with pytest.raises(ValueError, match="^count must be"):
        rdk.random_designs(count)


# ---- records as values --------------------------------------------------------------------------------------

RECORDS = [DESIGN, SCENARIO, MODEL, SOIL, DESIGN.wheel, rdk.evaluate(DESIGN, SCENARIO), Problem(traverse_limit_km=1.0)]
POPULATION = rdk.random_designs(5, seed=1)


@pytest.mark.parametrize("record", [*RECORDS, POPULATION, rdk.evaluate(POPULATION, SCENARIO), POPULATION[:0]],
                         ids=lambda record: f"{type(record).__name__}{record.shape}")
def test_records_are_values(record):
    again = copy.deepcopy(record)
    assert record is not again and record == again and hash(record) == hash(again) and bool(record) is True
    assert pickle.loads(pickle.dumps(record)) == record
    assert record != "a record" and record is not None and (record == 1) is False
    assert len({record, again}) == 1


def test_records_that_differ_are_unequal_whatever_their_shapes():
    assert (POPULATION == POPULATION.replace(wheel_radius_m=POPULATION.wheel_radius_m * 1.01)) is False
    assert (POPULATION == DESIGN) is False and (POPULATION[:2] == POPULATION) is False and (DESIGN == SCENARIO) is False
    assert SCENARIO != SCENARIO.replace(name="other") and SCENARIO != SCENARIO.replace(soil=rdk.soil("apollo-loose"))
    assert SCENARIO != SCENARIO.replace(problem=Problem(seed=9)) and {SCENARIO: 1}[rdk.scenario(SCENARIO.name)] == 1
    assert SOIL.replace(cohesive_modulus_kn_m_n1=[0.0, 1.0]) == SOIL.replace(cohesive_modulus_kn_m_n1=[-0.0, 1.0])
    buried = rdk.evaluate(DESIGN, SCENARIO.replace(soil=SOIL.replace(frictional_modulus_kn_m_n2=1e-6,
                                                                     cohesive_modulus_kn_m_n1=0.0)))
    assert math.isnan(buried.slip) and buried == copy.deepcopy(buried)


@pytest.mark.parametrize("record", RECORDS, ids=lambda record: type(record).__name__)
def test_every_record_can_be_replaced_and_offers_the_nearest_field(record):
    name = next(f.name for f in dataclasses.fields(record) if isinstance(getattr(record, f.name), float))
    assert record.replace() == record and getattr(record.replace(**{name: 0.125}), name) == 0.125
    with pytest.raises(ValueError, match=f"{type(record).__name__} has no field '{name[:-1]}'; nearest are .*{name}"):
        record.replace(**{name[:-1]: 1.0})


def test_a_stack_is_a_population_of_its_parts():
    parts = [DESIGN, DESIGN.replace(wheel_radius_m=0.2, wheel_count=6), rdk.rover("Tenacious")]
    stacked = rdk.Design.stack(parts)
    assert stacked.shape == (3,) and list(stacked) == parts and stacked.wheel_count.tolist() == [4, 6, 4]
    assert rdk.Design.stack([POPULATION, DESIGN]).shape == (2, 5)
    soils = [rdk.soil(name) for name in rdk.soil_names()]
    assert rdk.evaluate(DESIGN, SCENARIO.replace(soil=Soil.stack(soils))).shape == (len(soils),)
    missions = [SCENARIO, SCENARIO.replace(slope_deg=3.0, name="gentle", soil=soils[0])]
    both = rdk.Scenario.stack(missions)
    assert both.slope_deg.tolist() == [15.0, 3.0] and both.name == "equatorial_mare_traverse, gentle"
    assert both[1].soil.replace(name="") == soils[0].replace(name="")
    found = [rdk.evaluate(DESIGN, mission) for mission in missions]
    assert rdk.Performance.stack(found).range_km.tolist() == [one.range_km for one in found]
    for records, error, message in (([], ValueError, "at least one Design; got none"),
                                    (["Rashid-1"], TypeError, r"records\[0\] must be a Design, such as rdk.rover"),
                                    ([DESIGN, SOIL], TypeError, r"records\[1\] must be a Design.*; got Soil"),
                                    ([POPULATION, POPULATION[:2]], ValueError, r"records\[1\] \(2,\)")):
        with pytest.raises(error, match=message):
            rdk.Design.stack(records)
    with pytest.raises(ValueError, match="duration_earth_days must be the same in all records; got 14.0 and others"):
        rdk.Scenario.stack([SCENARIO, rdk.scenario("polar_prospecting")])


def test_what_a_record_holds_cannot_be_written():
    mine = np.array([0.1, 0.2])
    design = DESIGN.replace(wheel_radius_m=mine)
    mine[0] = -1                                         # the record has its own
    assert design.wheel_radius_m.tolist() == [0.1, 0.2] and mine.flags.writeable
    found = rdk.evaluate(design, SCENARIO)
    for array in (design.wheel_radius_m, POPULATION.battery_capacity_wh, found.range_km, found.mass.total_kg,
                  found.arrival_h, rdk.evaluate(DESIGN, SCENARIO).log.soc, design[:1].wheel_radius_m):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = -50
    with pytest.raises(dataclasses.FrozenInstanceError):
        design.wheel_radius_m = 0.1


@pytest.mark.parametrize("again", [copy.deepcopy, lambda record: pickle.loads(pickle.dumps(record))],
                         ids=["deepcopy", "pickle"])
def test_nor_can_what_a_copy_holds(again):
    one, many = rdk.evaluate(DESIGN, SCENARIO), rdk.evaluate(POPULATION, SCENARIO)
    skyline, ground = rdk.skyline("shackleton_rim"), rdk.terrain.synthetic(1, cells=32)
    mission = SCENARIO.replace(slope_deg=[1.0, 2.0], soil=SOIL.replace(cohesion_kpa=[0.1, 0.2]), skyline=skyline)
    for record, fields in ((POPULATION, rdk.DESIGN_SPACE), (many, ("range_km", "arrival_h", "mass.total_kg")),
                           (one, ("log.soc",)), (mission, ("slope_deg", "soil.cohesion_kpa", "skyline.elevation_deg")),
                           (skyline, ("azimuth_deg",)), (ground, ("height_m",))):
        for name in fields:
            with pytest.raises(ValueError, match="read-only"):
                operator.attrgetter(name)(again(record))[0] = -50


@pytest.mark.parametrize("value", [[True, 0.1], [0.1, False], [[0.1], [True]], (np.True_, 0.1), [True, 4]],
                         ids=range(5))
def test_a_truth_value_among_numbers_is_refused(value):
    with pytest.raises(ValueError, match="wheel_radius_m must be positive and finite; got"):
        DESIGN.replace(wheel_radius_m=value)
    with pytest.raises(ValueError, match="slope_deg must be .*; got"):
        rdk.sweep(DESIGN, SCENARIO, {"slope_deg": value})


def test_a_sweep_refuses_masked_values():
    with pytest.raises(ValueError, match="slope_deg must be .*masked"):
        rdk.sweep(DESIGN, SCENARIO, {"slope_deg": np.ma.array([1.0, 2.0], mask=[False, True])})


def test_a_refusal_stays_short():
    with pytest.raises(ValueError) as error:
        DESIGN.replace(wheel_radius_m=["0.1"] * 10_000)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize("name", [5, None, b"x", ["a"]], ids=str)
def test_a_name_is_text(name):
    for record in (SOIL, SCENARIO):
        with pytest.raises(TypeError, match="name must be a str; got"):
            record.replace(name=name)


@pytest.mark.parametrize("change, message", [
    (dict(objectives="range_km"), "objectives must be a dictionary like"),
    (dict(objectives={"range_km": "maximum"}), "objectives must be"), (dict(constraints="abc"), "constraints must be"),
    (dict(constraints=[("range_km",)]), "constraints must be"), (dict(constraints=[("range_km", ">", 1)]), "constr"),
    (dict(constraints=[("range_km", ">=", math.nan)]), "limit of range_km must be a number; got nan"),
    (dict(constraints=[("range_km", ">=", "1")]), "limit of range_km"), (dict(seed=1.5), "seed must be a whole"),
    (dict(traverse_limit_km=-1), "traverse_limit_km must be zero or more")], ids=str)
def test_a_problem_is_checked_when_it_is_posed(change, message):
    with pytest.raises(ValueError, match=message):
        Problem(**change)


def test_a_problem_is_a_value_and_a_mission_takes_nothing_else():
    asked = Problem({"range_km": "max"}, [["total_mass_kg", "<=", np.float64(20)]], np.float64(5), np.int64(3))
    assert asked == Problem({"range_km": "max"}, (("total_mass_kg", "<=", 20.0),), 5.0, 3) and hash(asked)
    assert SCENARIO.replace(slope_deg=[1.0, 2.0], problem=asked)[1].problem == asked
    with pytest.raises(TypeError, match=r"problem must be a Problem, such as rdk.Problem\(\); got 'polar'"):
        SCENARIO.replace(problem="polar")
    with pytest.raises(ValueError, match=r"soil must be a Soil, such as rdk.soil\('apollo-nominal'\); got 'apollo"):
        SCENARIO.replace(soil="apollo-nominal")


def test_results_of_long_arrays_show_their_ends():
    load = np.linspace(5.0, 50.0, 200)
    for result in (rdk.terramechanics.wheel_forces(DESIGN.wheel, SOIL, load, 0.1),
                   rdk.terramechanics.slip_balance(DESIGN.wheel, SOIL, load, 1.0), rdk.route.ridge(),
                   rdk.stability.axle_loads(load, 0.5, 0.2, 5.0, wheel_count=4)):
        text = repr(result)
        assert text.startswith(type(result).__name__ + "(") and len(text) < 1200 and "..." in text


@pytest.mark.parametrize("value", [
    np.ma.array([0.1, 0.2], mask=[False, True]), np.ma.masked, np.ma.array(0.1, mask=True),
    [np.ma.array([0.1], mask=[True]), np.ma.array([0.2])], np.ma.array([0.1, 0.2])], ids=range(5))
def test_masked_values_are_refused(value):
    with pytest.raises(ValueError, match="wheel_radius_m must be positive and finite; got a masked array"):
        DESIGN.replace(wheel_radius_m=value)


@pytest.mark.parametrize("record", [*RECORDS, POPULATION, rdk.evaluate(POPULATION, SCENARIO), rdk.Model.engineering(),
                                    rdk.random_designs(20_000, seed=1), POPULATION[:0],
                                    rdk.evaluate(DESIGN, SCENARIO).mass, rdk.evaluate(DESIGN, SCENARIO).log],
                         ids=lambda record: f"{type(record).__name__}{record.shape}")
def test_a_record_shows_itself_as_a_short_table(record):
    text, table = repr(record), record._repr_html_()
    assert text.startswith(type(record).__name__) and len(text.splitlines()) < 20 and len(text) < 1500
    assert table.startswith("<p>" + type(record).__name__) and "<table" in table and table.count("<tr") < 20


def test_names_are_text_in_a_table():
    mission = SCENARIO.replace(name="<b>it's $x$\n")
    assert "<p>Scenario &lt;b&gt;it&#x27;s $x$" in mission._repr_html_() and "it's" in repr(mission)


def test_the_kernel_brings_its_own_transition():
    assert MODEL.transition == (0.4, 0.2) and rdk.Model(kernel="imposed-arc").transition == (0.18, 0.32)
    assert rdk.Model(kernel="imposed-arc", transition_c2=0.1).transition == (0.18, 0.1)
    with pytest.raises(ValueError, match="unknown kernel 'papers'; nearest are paper"):
        rdk.Model(kernel="papers")


@pytest.mark.parametrize("call, message", [
    (lambda: rdk.sweep("Rashid-1", SCENARIO, {"slope_deg": [1]}), r"design .*rdk.rover\('Rashid-1'\); got 'Rashid-1'"),
    (lambda: rdk.sweep(DESIGN, "mare", {"slope_deg": [1]}), r"scenario .*rdk.scenario\(.*\); got 'mare'"),
    (lambda: rdk.intervals("Rashid-1", SCENARIO), r"design .*rdk.rover"),
    (lambda: rdk.intervals(DESIGN, "mare"), r"scenario .*rdk.scenario"),
    (lambda: rdk.attribution(DESIGN, "Pragyan", SCENARIO), r"baseline .*rdk.rover"),
    (lambda: rdk.evaluate("Rashid-1", SCENARIO), r"design .*rdk.rover"),
    (lambda: rdk.pareto_front("mare"), r"scenario .*rdk.scenario"),
    (lambda: searches.fronts(["mare"]), r"scenarios\[0\] .*rdk.scenario"),
    (lambda: searches.fronts([SCENARIO], model="paper"), r"model .*rdk.Model"),
    (lambda: rdk.terramechanics.wheel_forces("Rashid-1", SOIL, 5, 0.1), r"wheel .*rdk.rover\('Rashid-1'\).wheel"),
    (lambda: rdk.terramechanics.slip_balance(DESIGN, SOIL, 5, 1), r"wheel .*; got Design"),
    (lambda: rdk.terramechanics.slope_capability(DESIGN.wheel, "apollo-nominal", 5), r"soil .*rdk.soil\('apollo"),
    (lambda: rdk.terramechanics.grouser_lift("Rashid-1"), r"wheel .*\.wheel"),
    (lambda: rdk.stability.static_pressure_kpa(DESIGN.wheel, "apollo", 5), r"soil .*rdk.soil"),
    (lambda: rdk.route.per_metre("Rashid-1", SCENARIO, 3), r"design .*rdk.rover"),
    (lambda: rdk.route.cost(DESIGN, "mare"), r"scenario .*rdk.scenario"),
    (lambda: rdk.route.march(rdk.route.ridge(), "Rashid-1", SCENARIO), r"design .*rdk.rover"),
    (lambda: rdk.sampling.uncertain_inputs("mare"), r"scenario .*rdk.scenario"),
    (lambda: rdk.catalog.to_csv(DESIGN, "fast"), "performance must be a Record; got 'fast'"),
    (lambda: rdk.catalog.at_latitude("mare", 5.0), r"scenario .*rdk.scenario")], ids=range(20))
def test_a_name_where_a_record_is_due_is_answered_with_how_to_get_one(call, message):
    with pytest.raises(TypeError, match=message):
        call()
