"""Exercises of notebooks 03 to 05: mass, power and heat, and the mission."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import validation
from rdk import catalog, power, thermal
from rdk.design import Model
from rdk.mass import mass_breakdown
from rdk.mission import evaluate
from rdk.sampling import random_designs

from .judging import Exercise
from .shared import bus_factor, first, mare, rashid

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 03 mass -----------------------------------------------------------------------------------------------

def _bus_kg(**changes):
    """Mass of Rashid-1's design with 1.5 kg of payload and some of it changed."""
    values = rashid(**changes).numbers()
    del values["wheelbase_m"]
    return mass_breakdown(**values, payload_mass_kg=1.5)


@cache
def _class():
    return validation.published_masses().query("in_class").set_index("rover")


def _left_out(statistic="median", size=abs):
    """Lowest and highest statistic of the mass errors when one rover of the class is left out."""
    errors = size(_class().error_pct)
    values = [getattr(errors.drop(name), statistic)() for name in errors.index]
    return [min(values), max(values)]


@cache
def _fitted():
    """Median error of the five rovers with the best factor on the bus, and with factors fitted on four."""
    table = _class()
    bus = (table.predicted_mass_kg - table.payload_kg).to_numpy()
    factor = np.linspace(0.8, 1.2, 801)[:, None]
    error = abs(100 * ((factor * bus + table.payload_kg.to_numpy()) / table.published_mass_kg.to_numpy() - 1))
    unseen = [error[np.median(np.delete(error, k, 1), 1).argmin(), k] for k in range(5)]
    return [np.median(error, 1).min(), np.median(unseen)]


def _chassis_saving(linkage=True, share=True):
    """How much lighter the chassis must be when two wheels, two motors and the linkage come on."""
    model, four = Model(), _bus_kg()
    extra = (four.wheels_kg + four.motors_kg) / 2 + model.linkage_base_mass_kg * linkage
    chassis = rashid().chassis_mass_kg
    return chassis - (chassis - extra) / (1 + model.linkage_chassis_fraction * share)


def _room_wh(gross=True):
    start = _bus_kg(solar_area_m2=np.array([0.2, 0.4]), battery_capacity_wh=1.0).total_kg
    return 1 + (13.5 - start) * Model().battery_specific_energy_wh_kg / (bus_factor() if gross else 1)


EXERCISES["03.1"] = Exercise(
    "2 numbers", lambda: [200.0, 200 * bus_factor()],
    "Section 2: on what are cables, insulation and growth charged?",
    {"Harness, thermal control and growth are fractions of the hardware: saving hardware saves them too.":
        lambda: [200.0, 200.0],
     "The payload is added after growth: it saves itself and nothing else.":
        lambda: [200 * bus_factor(), 200 * bus_factor()],
     "The other way round: first the payload, then the chassis.": lambda: [200 * bus_factor(), 200.0],
     "Growth is not all: harness and thermal control are charged as well.": lambda: [200.0, 240.0]},
    within=0.005)

EXERCISES["03.2"] = Exercise(
    "2 numbers", _left_out, "Absolute errors of the five, without one; the median of four; five times.",
    {"Those are means; the paper reports the median.": lambda: _left_out("mean"),
     "Take the absolute value of each error before the median.": lambda: _left_out(size=lambda error: error)},
    within=0.01)

EXERCISES["03.3"] = Exercise(
    "number", _chassis_saving, "Write the mass of both rovers before overheads; the payload cancels.",
    {"That is the chassis which is left; the question asks by how much it is lighter.":
        lambda: rashid().chassis_mass_kg - _chassis_saving(),
     "Six wheels need a linkage, too.": lambda: _chassis_saving(linkage=False, share=False),
     "The linkage has a second part, in proportion to the chassis.": lambda: _chassis_saving(share=False)},
    within=0.005)

EXERCISES["03.4"] = Exercise(
    "2 numbers", _fitted,
    "One factor times (predicted less payload), plus payload; then the same with one rover left out.",
    {"The second must come from rovers that the fit has not seen.": lambda: [_fitted()[0], _fitted()[0]],
     "That is the error as published, without any fit.": lambda: [_class().error_pct.abs().median()] * 2,
     "First the error of the fit, then that of the unseen rovers.": lambda: _fitted()[::-1]}, within=0.1)

EXERCISES["03.5"] = Exercise(
    "2 numbers", _room_wh, "What is left of 13.5 kg, divided by what a watt-hour costs with its overheads.",
    {"A watt-hour costs more than its cells: harness, thermal control and growth come on top.":
        lambda: _room_wh(False),
     "The other way round: first 0.2 m2, then 0.4 m2.": lambda: _room_wh()[::-1]})


# ---- 04 power and thermal ----------------------------------------------------------------------------------

_DAY_ANGLES = power.hour_angle_deg(np.linspace(0, 708.734136, 721))


def _polar_means(azimuth_deg=0.0, sunlit=False):
    """Mean incidence at 85 deg south of panels tilted by 90, 0 and 80 deg."""
    factor = power.incidence_factor(-85.0, _DAY_ANGLES, np.array([[90.0], [0.0], [80.0]]), azimuth_deg)
    return factor[:, abs(_DAY_ANGLES) <= 90].mean(1) if sunlit else factor.mean(1)


def _box():
    """Area of Rashid-1's enclosure, and its heat at noon without heaters and avionics."""
    area = thermal.enclosure_area(rashid().chassis_mass_kg)
    return area, thermal.absorbed_sunlight(mare().latitude_deg, area) + mare().payload_power_w


def _insulated(sink_k=100.0, noon=True):
    """Emissivity at which 2 W keep the box at -30 degC, and its temperature at noon."""
    area, heat = _box()
    emissivity = 2.0 / (thermal.STEFAN_BOLTZMANN * area * (243.15**4 - sink_k**4))
    hot = thermal.node_temperature(heat + 15, area, 250.0, **({"emissivity": emissivity} if noon else {}))
    return [emissivity, hot]


def _heaters(heater_w=16.0, payload=True):
    """Heaters that keep Rashid-1 warm, those that leave it cool, and room for avionics with some."""
    area, heat = _box()
    night = 0.85 * thermal.STEFAN_BOLTZMANN * area * (243.15**4 - 100.0**4)
    noon = 0.85 * thermal.STEFAN_BOLTZMANN * area * (323.15**4 - 250.0**4) - heat
    noon += 0 if payload else mare().payload_power_w
    return [night - 2.0, noon - 15.0, noon - heater_w]


EXERCISES["04.1"] = Exercise(
    "2 numbers", lambda: power.incidence_factor(60.0, 0.0, np.array([0.0, 60.0])),
    "At noon at 60 deg the sun stands 30 deg high. Under which angle does it meet each panel?",
    {"A panel that faces the sun catches all of it, wherever it stands.": lambda: [0.5, 0.5],
     "That is the sine of the latitude. At the pole a flat panel would catch the most.":
        lambda: [np.sin(np.radians(60)), 1.0],
     "The other way round: first the flat panel, then the tilted one.": lambda: [1.0, 0.5]}, within=0.005)

EXERCISES["04.2"] = Exercise(
    "3 numbers", _polar_means, "Mean of the incidence factor over a whole lunar day; north is azimuth 0.",
    {"That is the mean over the sunlit half; the night belongs to the lunar day.":
        lambda: _polar_means(sunlit=True),
     "Those panels face south, and look away from the sun; north is azimuth 0.": lambda: _polar_means(180.0),
     "In the order of the question: upright, flat, tilted by 80 deg.": lambda: _polar_means()[[1, 2, 0]]},
    within=0.02)

EXERCISES["04.3"] = Exercise(
    "number", lambda: 100 * (1 - Model().charge_efficiency * Model().discharge_efficiency),
    "What comes out, over what went in, in percent lost.",
    {"Losses do not add: the second is taken from what the first has left.": lambda: 10.0,
     "That is one way; the energy goes in and comes out again.": lambda: 5.0,
     "That is what is left.": lambda: 100 * Model().charge_efficiency * Model().discharge_efficiency},
    within=0.01)

EXERCISES["04.4"] = Exercise(
    "2 numbers", _insulated, "Solve the balance at night for the emissivity, then take the noon heat with it.",
    {"The surroundings radiate, too: 100 K at night.": lambda: _insulated(0.0),
     "The noon temperature is with the old emissivity.": lambda: _insulated(noon=False)}, within=0.02)

EXERCISES["04.5"] = Exercise(
    "3 numbers", _heaters, "Balance at -30 degC and 100 K for the first, at 50 degC and 250 K for the others.",
    {"The hibernation power helps to keep warm: the heaters need not give all of it.":
        lambda: [_heaters()[0] + 2.0, *_heaters()[1:]],
     "The payload heats the box as well.": lambda: _heaters(payload=False),
     "The third is what is left for the avionics when the heaters give 16 W at noon, too.":
        lambda: _heaters(heater_w=0.0)}, within=0.03)


# ---- 05 mission --------------------------------------------------------------------------------------------

@cache
def _unlimited():
    """Range of Rashid-1 on the mare without a limit, and the day on which it passes 80 km."""
    result = evaluate(rashid(), mare(traverse_limit_km=np.inf))
    return [result.range_km, first(result.log.time_h, result.log.distance_km >= 80) / 24]


def _polar_sunlight(**changes):
    return evaluate(rashid(), replace(catalog.scenario("polar_prospecting"),
                                       **changes)).average_solar_power_w


@cache
def _hub_speeds(which="moving"):
    """The wheel speeds that the energy pays for, of 2,000 random designs on the mare: moving, not stalled or all."""
    designs = random_designs(2000, seed=1)
    result = evaluate(designs, mare())
    speeds = result.energy_balance_speed_m_s / (designs.wheel_radius_m * (1 - result.slip))
    return speeds[{"moving": result.cruise_speed_m_s > 0, "not stalled": ~result.stalled, "all": slice(None)}[which]]


@cache
def _morning_battery_wh(heavier=True):
    """The battery with which Rashid-1 drives through its first morning."""
    capacity_wh = np.arange(50.0, 501.0)
    # a battery that weighs nothing shows what the growing mass does
    model = Model() if heavier else Model(battery_specific_energy_wh_kg=1e9)
    mission = mare(duration_earth_days=3.0)
    result = evaluate(rashid(battery_capacity_wh=capacity_wh), mission, model=model)
    return first(capacity_wh, result.minimum_soc > model.soc_floor)


def _far_at_the_pole(design):
    if design.avionics_power_w != rashid().avionics_power_w:
        return "The avionics power may not change."
    result = evaluate(design, catalog.scenario("polar_prospecting"))
    if result.total_mass_kg > 20:
        return "It is heavier than 20 kg."
    if result.stalled:
        return "It stalls: look at torque and grip."
    if result.average_solar_power_w < design.avionics_power_w + 8:
        return "It has no sunlight to spare for driving."
    return "" if result.range_km >= 20 else (
        "It drives less than 20 km: the hub holds it back, and a larger wheel goes further with each turn."
        if result.hub_speed_limited else "It drives less than 20 km: sunlight holds it back.")


EXERCISES["05.1"] = Exercise(
    "2 numbers", _unlimited, "Lift the limit with `traverse_limit_km=np.inf`; find 80 km in the log's distance.",
    {"That is the range with the limit; lift it.": lambda: [80.0, _unlimited()[1]],
     "First the km, then the day.": lambda: _unlimited()[::-1],
     "The day, please, not the hour.": lambda: [_unlimited()[0], 24 * _unlimited()[1]],
     "The second is rounded too far: days since sunrise, to a tenth.":
        lambda: [_unlimited()[0], np.ceil(_unlimited()[1])],
     "Not in proportion: the first morning goes by with hardly any driving.":
        lambda: [_unlimited()[0], 14 * 80 / _unlimited()[0]]}, within=0.01)

EXERCISES["05.2"] = Exercise(
    "number", lambda: _polar_sunlight(panel_tilt_deg=0.0),
    "Replace the tilt by 0, evaluate, read average_solar_power_w.",
    {"That is with the panel tilted, as in the catalogue.": _polar_sunlight,
     "That is a panel which faces away from the noon sun.": lambda: _polar_sunlight(panel_azimuth_deg=180.0)})

EXERCISES["05.3"] = Exercise(
    "number", lambda: np.median(_hub_speeds()),
    "Speed over r (1 - s) for each design that moves; then the middle one.",
    {"That is the mean; a few fast ones pull it up. Half of the designs lie below the median.":
        lambda: _hub_speeds().mean(),
     "Stalled designs have speed 0 and count for nothing: leave them out.": lambda: np.median(_hub_speeds("all")),
     "Some do not stall and yet have no power to spare for driving: they do not move either.":
        lambda: np.median(_hub_speeds("not stalled"))},
    within=0.01)

EXERCISES["05.4"] = Exercise(
    "number", _morning_battery_wh,
    "An array of capacities; the first whose lowest charge stays above the floor.",
    {"The heavier battery makes the rover heavier, and the load grows with it.":
        lambda: _morning_battery_wh(False)},
    within=0.003)

EXERCISES["05.5"] = Exercise(
    "Design", lambda: rashid(wheel_radius_m=0.15, wheel_width_m=0.06, peak_wheel_torque_nm=1.0), "",
    {"the hub holds it back": rashid,
     "It stalls": lambda: rashid(wheel_radius_m=0.15, wheel_width_m=0.06,
                                  peak_wheel_torque_nm=0.3),
     "heavier than 20 kg": lambda: rashid(battery_capacity_wh=500),
     "The avionics power may not change": lambda: rashid(avionics_power_w=5.0),
     "no sunlight to spare": lambda: rashid(solar_area_m2=0.1)}, judge=_far_at_the_pole)
