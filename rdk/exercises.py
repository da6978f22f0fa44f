"""The exercises of the notebooks: how each is answered, which mistakes are typical, and what to say to them.

One block an exercise, grouped by notebook. Answers are computed here, independently of the notebooks; nothing
is stored. A hint names what went wrong and does not give the answer away.
"""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.integrate import trapezoid
from scipy.optimize import least_squares

from . import catalog, power, terramechanics, thermal, validation
from .course import exercise
from .design import DESIGN_SPACE, Design, Model, Scenario, Study
from .mass import mass_breakdown
from .mission import evaluate
from .report import requirements
from .rules import unit_cube
from .sampling import attribution, intervals, random_designs
from .tradespace import pareto_front


@cache
def _mare():
    return catalog.scenario("equatorial_mare_traverse")


@cache
def _rashid():
    return catalog.rover("Rashid-1")


def _first(values, flags):
    """The first of `values` at which `flags` holds."""
    return values[np.argmax(flags)]


# ---- 00 start here -----------------------------------------------------------------------------------------

def _drive_highland(**changes):
    """How many of the six rovers drive the highland mission, with some of it changed."""
    mission = replace(catalog.scenario("highland_slope_capability"), **changes)
    return sum(evaluate(catalog.rover(name), mission).range_km > 0 for name in catalog.rover_names())


@cache
def _loaded():
    payload_kg = np.linspace(0, 30, 3001)
    return payload_kg, evaluate(_rashid(), replace(_mare(), payload_mass_kg=payload_kg))


def _stall_payload():
    payload_kg, result = _loaded()
    return _first(payload_kg, result.stalled)


def _bus_factor():
    model = Model()
    return (1 + model.harness_fraction) * (1 + model.thermal_control_fraction) * (1 + model.growth_fraction)


def _structure_share():
    return _rashid().chassis_mass_kg / evaluate(_rashid(), _mare()).total_mass_kg


def _climbs_highland(design):
    cadre = catalog.rover("CADRE-unit")
    wheels = {"wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "peak_wheel_torque_nm"}
    kept = {n: getattr(design, n) == getattr(cadre, n) for n in cadre.numbers() if n not in wheels}
    if not all(kept.values()):
        return f"Only wheels and hubs may change; {next(n for n in kept if not kept[n])} did."
    result = evaluate(design, catalog.scenario("highland_slope_capability"))
    if result.stalled and result.wheel_torque_nm > design.peak_wheel_torque_nm:
        return "It stalls: the hub is too weak for the torque that this wheel needs."
    if result.stalled:
        return "It stalls for want of grip: more radius, width or grousers."
    if result.range_km < 10:
        return "It drives, but less than 10 km: the hub turns at a fixed rate, so the radius sets the speed."
    return "" if result.total_mass_kg < 15 else "It drives far enough, but weighs 15 kg or more."


exercise(
    "00.1", lambda: [_drive_highland(soil=_mare().soil), _drive_highland(slope_deg=0.0)],
    "Count the designs whose range is above 0: once with the soil replaced, once with the slope replaced.",
    {"That is the mission as it stands: replace the soil for the first number, the slope for the second.":
        lambda: [_drive_highland(), _drive_highland()],
     "The other way round: firm soil first, then flat ground.":
        lambda: [_drive_highland(slope_deg=0.0), _drive_highland(soil=_mare().soil)],
     "Firm soil does not save them all: one has another trouble.": lambda: [6, 6]}, within=0)

exercise(
    "00.2", _stall_payload, "Evaluate an array of payloads and take the first that stalls.",
    {"That is what must be added to the payload that the mission has already.":
        lambda: _stall_payload() - _mare().payload_mass_kg,
     "That is the mass of the whole rover there; the question asks for its payload.":
        lambda: _first(_loaded()[1].total_mass_kg, _loaded()[1].stalled)}, within=0.01)

exercise(
    "00.3", lambda: 1 / (1 - _structure_share() * _bus_factor()),
    "Close the loop by repetition, as in section 3, until the mass no longer changes.",
    {"That is the payload alone. The chassis grows too.": lambda: 1.0,
     "That is what comes on top of the payload's own kilogram; both make the rover heavier.":
        lambda: 1 / (1 - _structure_share() * _bus_factor()) - 1,
     "One round of the loop is not enough: the chassis grows again for what it has grown.":
        lambda: 1 + _structure_share() * _bus_factor(),
     "A kilogram of chassis makes more than a kilogram of rover: overheads and growth come on top.":
        lambda: 1 / (1 - _structure_share())}, within=0.008)

exercise(
    "00.4", lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.12, wheel_width_m=0.10,
                            grouser_count=20,
                            grouser_height_m=0.015, peak_wheel_torque_nm=0.4), "",
    {"for want of grip": lambda: replace(catalog.rover("CADRE-unit"), peak_wheel_torque_nm=5.0),
     "the hub is too weak": lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.12,
                                            wheel_width_m=0.10,
                                            grouser_count=20, peak_wheel_torque_nm=0.1),
     "Only wheels and hubs may change; chassis_mass_kg did": lambda: replace(catalog.rover("CADRE-unit"),
                                                                             chassis_mass_kg=1.0),
     "weighs 15 kg or more": lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.18,
                                             wheel_width_m=0.20,
                                             grouser_count=20, grouser_height_m=0.015,
                                             peak_wheel_torque_nm=2.0)},
    judge=_climbs_highland)


# ---- 01 wheel on soil --------------------------------------------------------------------------------------

_LOAD_N = 16 * 1.625 / 4                                 # on one wheel of the notebook's rover


def _ribbed(count=14, radius_m=0.10, height_m=0.015):
    return terramechanics.Wheel(radius_m, 0.08, height_m, count)


def _efficiency(slip, ideal=False):
    """Tractive efficiency of the notebook's wheel; `ideal` forgets that the slip takes speed away."""
    forces = terramechanics.wheel_forces(_ribbed(), catalog.soil("apollo-nominal"), _LOAD_N, slip)
    return forces.drawbar_pull_n * 0.10 * (1 - slip * (not ideal)) / forces.torque_nm


@cache
def _best(ideal=False):
    slip = np.linspace(0.1, 0.9, 801)
    efficiency = _efficiency(slip, ideal)
    return [slip[efficiency.argmax()], efficiency.max()]


def _pull_error_ppm(points=100, n=1.1):
    """Relative error of the trapezoidal rule's pull at an entry angle of 0.35 rad and slip 0.2, times 1e6."""
    soil = replace(catalog.soil("apollo-nominal"), sinkage_exponent=n)

    def pull(angle):
        stress = terramechanics.contact_stress(_ribbed(), soil, 0.35, 0.2, angle)
        return trapezoid(stress.shear_stress_pa * np.cos(angle) - stress.normal_stress_pa * np.sin(angle),
                         angle)

    middle = (0.4 + 0.2 * 0.2) * 0.35
    exact = sum(pull(np.linspace(a, b, 200_001)) for a, b in ((0, middle), (middle, 0.35)))
    return 1e6 * abs(pull(np.linspace(0, 0.35, points)) / exact - 1)


@cache
def _radius_mm(height_m, count, soil):
    """The smallest radius that climbs 16 deg."""
    radius_m = np.linspace(0.03, 0.2, 3401)
    slope = terramechanics.slope_capability(_ribbed(count, radius_m, height_m), catalog.soil(soil), _LOAD_N)
    return 1000 * _first(radius_m, slope >= 16)


exercise(
    "01.1", lambda: 2 ** (2 / 3), "Section 10 has the power law: how does the sinkage depend on the load?",
    {"That would be proportion: twice the load, twice the rut. Sinkage is a weaker power of the load.":
        lambda: 2.0,
     "The exponent is upside down.": lambda: 2 ** (3 / 2),
     "That is the exponent; raise the ratio of the loads to it.": lambda: 2 / 3,
     "By so much it stands deeper; the question asks for the ratio.": lambda: 2 ** (2 / 3) - 1}, within=0.01)

exercise(
    "01.2", lambda: np.ceil(0.6 * 2 * np.pi * 0.10 / 0.015),
    "The gain is height times number over the circumference. At which whole number does it reach its cap?",
    {"At that number the cap is not quite reached: one more still helps.":
        lambda: np.floor(0.6 * 2 * np.pi * 0.10 / 0.015),
     "Grousers come whole: round up.": lambda: 0.6 * 2 * np.pi * 0.10 / 0.015,
     "That fills the whole circumference; the cap comes earlier.": lambda: np.ceil(2 * np.pi * 0.10 / 0.015),
     "The circumference is 2 π r, with the radius and not the diameter.":
        lambda: np.ceil(0.6 * 2 * np.pi * 0.20 / 0.015)}, within=0)

exercise(
    "01.3", _best, "Multiply pull and speed, divide by torque and angular speed: ω cancels, slip does not. "
    "Is the grid fine enough?",
    {"That is where the pull is largest. A wheel that pulls hard there hardly moves.":
        lambda: [0.9, float(_efficiency(0.9))],
     "The speed is ω r (1 - s): you left the slip out of it.": lambda: _best(True)}, within=0.04)

exercise(
    "01.4", _pull_error_ppm,
    "Take the pull with the trapezoid and 100 points, and with 200 Gauss points on each arc; n is 1.1 twice.",
    {"That is the error with the exponent of the notebook's soil: set n to 1.1 for both rules.":
        lambda: _pull_error_ppm(n=1.0),
     "That is the trapezoid with 101 points, that is with 100 intervals; the paper's has 100 points.":
        lambda: _pull_error_ppm(101)}, within=0.005)

exercise(
    "01.5", lambda: [_radius_mm(0.015, 14, "sourcebook-trafficability"),
                     _radius_mm(0.020, 24, "sourcebook-trafficability"),
                     _radius_mm(0.015, 14, "apollo-nominal")],
    "Evaluate the slope capability for an array of radii and take the first that reaches 16 deg.",
    {"The first two are with the friction angle of 46 deg; the question asks for the Sourcebook's there.":
        lambda: [_radius_mm(0.015, 14, "apollo-nominal"), _radius_mm(0.020, 24, "apollo-nominal"),
                 _radius_mm(0.015, 14, "apollo-nominal")],
     "The other way round: first 14 grousers of 15 mm, then 24 of 20 mm.":
        lambda: [_radius_mm(0.020, 24, "sourcebook-trafficability"),
                 _radius_mm(0.015, 14, "sourcebook-trafficability"),
                 _radius_mm(0.015, 14, "apollo-nominal")]},
    within=0.02)


# ---- 02 wheel measurements ---------------------------------------------------------------------------------

@cache
def _factor_of_shift(shift_pct, low, high):
    """The factor on the shear stress between two limits that moves the median pull by `shift_pct`."""
    scale = np.linspace(low, high, 401)
    shift = validation.pull_shift(scale).median_shift_pct.to_numpy()
    return scale[np.abs(shift - shift_pct).argmin()]


@cache
def _reading_interval(reading_error_n):
    """5 % and 95 % point of Ding's median pull error, in percent."""
    row = validation.bootstrap_medians(reading_error_n, 0.0, 0.0).iloc[0]
    return row.low_pct, row.high_pct


@cache
def _digging(wheel):
    """n_0 and n_1 of a sinkage exponent n_0 + n_1 s, fitted to Ding's sinkage of one wheel, or of both."""
    points = catalog.table("single_wheel.csv").query("experiment == 'ding-2011'").reset_index(drop=True)
    wheels, soil, load, slip = validation.single_wheel_conditions(points)
    used = points.wheel.str.contains(wheel).to_numpy()

    def misses(n):
        softer = replace(soil, sinkage_exponent=n[0] + n[1] * slip)
        sinkage_mm = 1000 * terramechanics.wheel_forces(wheels, softer, load, slip).sinkage_m
        return (sinkage_mm - points.sinkage_mm)[used]

    return least_squares(misses, (1.0, 0.2)).x


exercise(
    "02.1", lambda: [25.0, 10.0, 1.0, 4.0],
    "An error is model less measured; divide it by the measured pull, or by the load.",
    {"You divided by the model's pull; divide by the measured one.": lambda: [20.0, 100 / 11, 1.0, 4.0],
     "The last two are the errors in newtons of a load of 100 N; the load is 50 N.":
        lambda: [25.0, 10.0, 0.5, 2.0]})

exercise(
    "02.2", lambda: _factor_of_shift(27.0, 0.80, 0.95), "A finer list of factors between 0.85 and 0.9.",
    {"That is the factor above 1; the question asks for the one below.":
        lambda: _factor_of_shift(27.0, 1.05, 1.20),
     "Pull is grip less resistance: it does not shrink in proportion to the shear stress, but faster.":
        lambda: 0.73,
     "That is the paper's factor. It moves the pull by a little more than the error.": lambda: 0.85},
    within=0.004)

exercise(
    "02.3", lambda: float(np.subtract(*_reading_interval(1.0)[::-1])),
    "`high_pct` less `low_pct` of Ding's row.",
    {"That is the upper end of the interval; its width is asked for.": lambda: _reading_interval(1.0)[1],
     "That is the interval for a reading error of 0.5 N.":
        lambda: float(np.subtract(*_reading_interval(0.5)[::-1])),
     "That is the interval for a reading error of 2 N.":
        lambda: float(np.subtract(*_reading_interval(2.0)[::-1]))},
    within=0.03)

exercise(
    "02.4", lambda: _digging("smooth"), "Fit the sinkage, in mm, at the points of the smooth wheel only.",
    {"That fits both wheels at once. Fit the smooth one, then predict the other.":
        lambda: _digging("smooth|grousered"),
     "That fits the grousered wheel. Fit the smooth one.": lambda: _digging("grousered"),
     "First the exponent at slip 0, then its growth with slip.": lambda: _digging("smooth")[::-1]},
    within=0.03)


# ---- 03 mass -----------------------------------------------------------------------------------------------

def _bus_kg(**changes):
    """Mass of Rashid-1's design with 1.5 kg of payload and some of it changed."""
    values = replace(_rashid(), **changes).numbers()
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
    chassis = _rashid().chassis_mass_kg
    return chassis - (chassis - extra) / (1 + model.linkage_chassis_fraction * share)


def _room_wh(gross=True):
    start = _bus_kg(solar_area_m2=np.array([0.2, 0.4]), battery_capacity_wh=1.0).total_kg
    return 1 + (13.5 - start) * Model().battery_specific_energy_wh_kg / (_bus_factor() if gross else 1)


exercise(
    "03.1", lambda: [200.0, 200 * _bus_factor()],
    "Section 2: on what are cables, insulation and growth charged?",
    {"Harness, thermal control and growth are fractions of the hardware: saving hardware saves them too.":
        lambda: [200.0, 200.0],
     "The payload is added after growth: it saves itself and nothing else.":
        lambda: [200 * _bus_factor(), 200 * _bus_factor()],
     "The other way round: first the payload, then the chassis.": lambda: [200 * _bus_factor(), 200.0],
     "Growth is not all: harness and thermal control are charged as well.": lambda: [200.0, 240.0]},
    within=0.005)

exercise(
    "03.2", _left_out, "Absolute errors of the five, without one; the median of four; five times.",
    {"Those are means; the paper reports the median.": lambda: _left_out("mean"),
     "Take the absolute value of each error before the median.": lambda: _left_out(size=lambda error: error)},
    within=0.01)

exercise(
    "03.3", _chassis_saving, "Write the mass of both rovers before overheads; the payload cancels.",
    {"That is the chassis which is left; the question asks by how much it is lighter.":
        lambda: _rashid().chassis_mass_kg - _chassis_saving(),
     "Six wheels need a linkage, too.": lambda: _chassis_saving(linkage=False, share=False),
     "The linkage has a second part, in proportion to the chassis.": lambda: _chassis_saving(share=False)},
    within=0.005)

exercise(
    "03.4", _fitted,
    "One factor times (predicted less payload), plus payload; then the same with one rover left out.",
    {"The second must come from rovers that the fit has not seen.": lambda: [_fitted()[0], _fitted()[0]],
     "That is the error as published, without any fit.": lambda: [_class().error_pct.abs().median()] * 2,
     "First the error of the fit, then that of the unseen rovers.": lambda: _fitted()[::-1]}, within=0.1)

exercise(
    "03.5", _room_wh, "What is left of 13.5 kg, divided by what a watt-hour costs with its overheads.",
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
    area = thermal.enclosure_area(_rashid().chassis_mass_kg)
    return area, thermal.absorbed_sunlight(_mare().latitude_deg, area) + _mare().payload_power_w


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
    noon += 0 if payload else _mare().payload_power_w
    return [night - 2.0, noon - 15.0, noon - heater_w]


exercise(
    "04.1", lambda: power.incidence_factor(60.0, 0.0, np.array([0.0, 60.0])),
    "At noon at 60 deg the sun stands 30 deg high. Under which angle does it meet each panel?",
    {"A panel that faces the sun catches all of it, wherever it stands.": lambda: [0.5, 0.5],
     "That is the sine of the latitude. At the pole a flat panel would catch the most.":
        lambda: [np.sin(np.radians(60)), 1.0],
     "The other way round: first the flat panel, then the tilted one.": lambda: [1.0, 0.5]}, within=0.005)

exercise(
    "04.2", _polar_means, "Mean of the incidence factor over a whole lunar day; north is azimuth 0.",
    {"That is the mean over the sunlit half; the night belongs to the lunar day.":
        lambda: _polar_means(sunlit=True),
     "Those panels face south, and look away from the sun; north is azimuth 0.": lambda: _polar_means(180.0),
     "In the order of the question: upright, flat, tilted by 80 deg.": lambda: _polar_means()[[1, 2, 0]]},
    within=0.02)

exercise(
    "04.3", lambda: 100 * (1 - Model().charge_efficiency * Model().discharge_efficiency),
    "What comes out, over what went in, in percent lost.",
    {"Losses do not add: the second is taken from what the first has left.": lambda: 10.0,
     "That is one way; the energy goes in and comes out again.": lambda: 5.0,
     "That is what is left.": lambda: 100 * Model().charge_efficiency * Model().discharge_efficiency},
    within=0.01)

exercise(
    "04.4", _insulated, "Solve the balance at night for the emissivity, then take the noon heat with it.",
    {"The surroundings radiate, too: 100 K at night.": lambda: _insulated(0.0),
     "The noon temperature is with the old emissivity.": lambda: _insulated(noon=False)}, within=0.02)

exercise(
    "04.5", _heaters, "Balance at -30 degC and 100 K for the first, at 50 degC and 250 K for the others.",
    {"The hibernation power helps to keep warm: the heaters need not give all of it.":
        lambda: [_heaters()[0] + 2.0, *_heaters()[1:]],
     "The payload heats the box as well.": lambda: _heaters(payload=False),
     "The third is what is left for the avionics when the heaters give 16 W at noon, too.":
        lambda: _heaters(heater_w=0.0)}, within=0.03)


# ---- 05 mission --------------------------------------------------------------------------------------------

@cache
def _unlimited():
    """Range of Rashid-1 on the mare without a limit, and the day on which it passes 80 km."""
    result = evaluate(_rashid(), replace(_mare(), traverse_limit_km=np.inf))
    return [result.range_km, _first(result.log.time_h, result.log.distance_km >= 80) / 24]


def _polar_sunlight(**changes):
    return evaluate(_rashid(), replace(catalog.scenario("polar_prospecting"),
                                       **changes)).average_solar_power_w


@cache
def _hub_speeds(stalled=False):
    """The wheel speeds that the energy pays for, of 2,000 random designs on the mare."""
    designs = random_designs(2000, seed=1)
    result = evaluate(designs, _mare())
    speeds = result.energy_balance_speed_m_s / (designs.wheel_radius_m * (1 - result.slip))
    return speeds if stalled else speeds[~result.stalled]


@cache
def _morning_battery_wh(heavier=True):
    """The battery with which Rashid-1 drives through its first morning."""
    capacity_wh = np.arange(50.0, 501.0)
    # a battery that weighs nothing shows what the growing mass does
    model = Model() if heavier else Model(battery_specific_energy_wh_kg=1e9)
    mission = replace(_mare(), duration_earth_days=3.0)
    result = evaluate(replace(_rashid(), battery_capacity_wh=capacity_wh), mission, model)
    return _first(capacity_wh, result.minimum_soc > model.soc_floor)


def _far_at_the_pole(design):
    if design.avionics_power_w != _rashid().avionics_power_w:
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


exercise(
    "05.1", _unlimited, "Lift the limit with `traverse_limit_km=np.inf`; find 80 km in the log's distance.",
    {"That is the range with the limit; lift it.": lambda: [80.0, _unlimited()[1]],
     "The day, please, not the hour.": lambda: [_unlimited()[0], 24 * _unlimited()[1]],
     "The second is rounded too far: days since sunrise, to a tenth.":
        lambda: [_unlimited()[0], np.ceil(_unlimited()[1])],
     "Not in proportion: the first morning goes by with hardly any driving.":
        lambda: [_unlimited()[0], 14 * 80 / _unlimited()[0]]}, within=0.01)

exercise(
    "05.2", lambda: _polar_sunlight(panel_tilt_deg=0.0),
    "Replace the tilt by 0, evaluate, read average_solar_power_w.",
    {"That is with the panel tilted, as in the catalogue.": _polar_sunlight,
     "That is a panel which faces away from the noon sun.": lambda: _polar_sunlight(panel_azimuth_deg=180.0)})

exercise(
    "05.3", lambda: np.median(_hub_speeds()),
    "Speed over r (1 - s) for each design that moves; then the middle one.",
    {"That is the mean; a few fast ones pull it up. Half of the designs lie below the median.":
        lambda: _hub_speeds().mean(),
     "Stalled designs have speed 0 and count for nothing: leave them out.":
        lambda: np.median(_hub_speeds(True))},
    within=0.01)

exercise(
    "05.4", _morning_battery_wh,
    "An array of capacities; the first whose lowest charge stays above the floor.",
    {"The heavier battery makes the rover heavier, and the load grows with it.":
        lambda: _morning_battery_wh(False)},
    within=0.003)

exercise(
    "05.5", lambda: replace(_rashid(), wheel_radius_m=0.15, wheel_width_m=0.06, peak_wheel_torque_nm=1.0), "",
    {"the hub holds it back": _rashid,
     "It stalls": lambda: replace(_rashid(), wheel_radius_m=0.15, wheel_width_m=0.06,
                                  peak_wheel_torque_nm=0.3),
     "heavier than 20 kg": lambda: replace(_rashid(), battery_capacity_wh=500),
     "The avionics power may not change": lambda: replace(_rashid(), avionics_power_w=5.0),
     "no sunlight to spare": lambda: replace(_rashid(), solar_area_m2=0.1)}, judge=_far_at_the_pole)


# ---- 06 point design ---------------------------------------------------------------------------------------

_BINDS = ("soil", "traction", "torque", "hub speed", "sun", "battery", "range limit")


@cache
def _polar_slopes():
    slopes_deg = np.arange(36.0)
    return slopes_deg, evaluate(_rashid(), replace(catalog.scenario("polar_prospecting"),
                                                   slope_deg=slopes_deg))


def _missed_pct(metric, limit):
    return 100 * np.mean(getattr(intervals(_rashid(), _mare(), draws=200).draws, metric) < limit)


@cache
def _torque_shares(swapped=False):
    """What the torque of Yutu-2 gets in its difference to Rashid-1 at the pole, and what it brings alone."""
    polar, pair = catalog.scenario("polar_prospecting"), (catalog.rover("Yutu-2"), _rashid())
    large, small = pair[::-1] if swapped else pair
    shares = attribution(large, small, polar).contributions["range_km"]
    alone = evaluate(replace(small, peak_wheel_torque_nm=large.peak_wheel_torque_nm), polar)
    return [shares[list(DESIGN_SPACE).index("peak_wheel_torque_nm")],
            alone.range_km - evaluate(small, polar).range_km]


def _tenacious_mended(design):
    tenacious = catalog.rover("Tenacious")
    changed = [name for name in DESIGN_SPACE if getattr(design, name) != getattr(tenacious, name)]
    if len(changed) > 2:
        return "You changed " + ", ".join(changed) + "."
    result = evaluate(design, _mare())
    if result.stalled:
        return "It stalls: " + ("the hub is too weak."
                                if result.wheel_torque_nm > design.peak_wheel_torque_nm else "no grip.")
    if result.total_mass_kg > 11.5:
        return f"It weighs {result.total_mass_kg:.2f} kg."
    return "" if result.range_km >= 50 else f"It drives {result.range_km:.0f} km: what binds now?"


exercise(
    "06.1", lambda: "sun", "The bold line at the top of the answers names it.",
    {"The pack is empty for hours, but more of it would not help: there is nothing to fill it.":
        lambda: "battery",
     "It stands still, yet its wheels could climb: look at 'stalled'.": lambda: "traction",
     "The read-outs show that the hub gives enough.": lambda: "torque"}, choices=_BINDS)

exercise(
    "06.2", lambda: _first(_polar_slopes()[0], _polar_slopes()[1].stalled),
    "Move the slope until 'stalled' says yes.",
    {"That is the slope capability, rounded up; it is taken at slip 0.6, and the rover may slip more.":
        lambda: np.ceil(_polar_slopes()[1].slope_capability_deg[0]),
     "There it still drives, if slowly.": lambda: _first(_polar_slopes()[0], _polar_slopes()[1].stalled) - 1},
    within=0.005)

exercise(
    "06.3", lambda: _missed_pct("slope_capability_deg", 15), "The share of draws below the limit, times 100.",
    {"That is the tail of the interval, not the share below the limit.": lambda: 5.0,
     "Those that make it; the question is about those that miss.":
        lambda: 100 - _missed_pct("slope_capability_deg", 15),
     "Those that stall; slope capability is judged at slip 0.6.":
        lambda: 100 * intervals(_rashid(), _mare(), draws=200).low["stalled"]})

exercise(
    "06.4", _torque_shares,
    "The bar of the view 'why', then the change of range when torque alone is changed.",
    {"From Rashid-1 to Yutu-2, not back: Rashid-1 is the baseline.": lambda: _torque_shares(True),
     "First the share, then the gain alone.": lambda: _torque_shares()[::-1]}, within=0.05)

exercise(
    "06.5", lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.08, peak_wheel_torque_nm=0.2), "",
    {"the hub is too weak": lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.1),
     "what binds now": lambda: replace(catalog.rover("Tenacious"), peak_wheel_torque_nm=0.3),
     "It weighs": lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.12, peak_wheel_torque_nm=0.4),
     "no grip": lambda: replace(catalog.rover("Tenacious"), grouser_height_m=0.0, peak_wheel_torque_nm=0.4),
     "You changed": lambda: replace(_rashid(), wheel_radius_m=0.08)}, judge=_tenacious_mended)


# ---- 07 Pareto fronts --------------------------------------------------------------------------------------

@cache
def _front(scenario="equatorial_mare_traverse", seed=13, six=False, goals=None, least_slope_deg=None):
    """A front of the notebook's budget."""
    return pareto_front(
        catalog.scenario(scenario), seed=seed, bounds={"wheel_count": (6, 6)} if six else None,
        objectives=dict(goals) if goals else None,
        constraints=[("slope_capability_deg", ">=", least_slope_deg)] if least_slope_deg else None)


def _mass_at(front, slope_deg=34):
    p = front.performance
    order = np.argsort(p.slope_capability_deg)
    return np.interp(slope_deg, p.slope_capability_deg[order], p.total_mass_kg[order])


@cache
def _late_polar():
    """Lightest mass and median battery when five polar fronts are merged and searched on."""
    five = [_front("polar_prospecting", seed).designs for seed in (12, 13, 14, 15, 112)]
    merged = Design(**{name: np.concatenate([getattr(design, name) for design in five])
                       for name in DESIGN_SPACE})
    late = pareto_front(catalog.scenario("polar_prospecting"), population=80, seed=1, start=merged)
    return [late.performance.total_mass_kg.min(), np.median(late.designs.battery_capacity_wh)]


def _settled(answer):
    lightest_kg, battery_wh = answer
    if not 8 < lightest_kg < 10.5:
        return "The first number should be the mass of the lightest design, in kg, after the merged search."
    return "" if 5 <= battery_wh < 75 else (
        "The second number should be the median battery after the long search; it has not come down yet.")


_FLOAT = (("range_km", "max"), ("total_mass_kg", "min"), ("sinkage_m", "min"))


def _floaters(goals=_FLOAT):
    """Mass of the heaviest design, in kg, and width of the widest wheel, in mm."""
    front = _front(goals=goals, least_slope_deg=25)
    return [front.performance.total_mass_kg.max(), 1000 * front.designs.wheel_width_m.max()]


exercise(
    "07.1", lambda: 85 - _mare().traverse_limit_km,
    "Read the message: it says how close the nearest design came.",
    {"So far the nearest design came; by how much did it miss?": lambda: _mare().traverse_limit_km,
     "That is what you asked for.": lambda: 85.0,
     "No design meets the demand; the question is by how much the nearest missed it.": lambda: 0.0},
    within=0.001)

exercise(
    "07.2", lambda: _front().history[-1],
    "The share of the darts that land in the dominated part, times the box.",
    {"That is the share of the darts; the box is larger than 1.": lambda: _front().history[-1] / 1.05**3,
     "That is the part of the box that is not dominated.": lambda: 1.05**3 - _front().history[-1]},
    within=0.03)

exercise(
    "07.3", lambda: [_mass_at(_front()), _mass_at(_front(six=True))],
    "Sort each front by slope capability and interpolate its mass at 34 deg.",
    {"Those are the lightest of each front; they do not climb alike.":
        lambda: [_front().performance.total_mass_kg.min(), _front(six=True).performance.total_mass_kg.min()],
     "The other way round: first four wheels, then six.":
        lambda: [_mass_at(_front(six=True)), _mass_at(_front())]}, within=0.1)

exercise(
    "07.4", _late_polar, "",
    {"the mass of the lightest design": lambda: [12.0, 6.0],
     "it has not come down yet": lambda: [9.5, 150.0]}, judge=_settled)

exercise(
    "07.5", _floaters, "Objectives range, mass and sinkage; the slope is a constraint now.",
    {"That is the front with slope capability as an objective: ballast buys slope there.":
        lambda: _floaters((("range_km", "max"), ("total_mass_kg", "min"), ("slope_capability_deg", "max"))),
     "First the mass, then the width.": lambda: _floaters()[::-1]}, within=0.15)


# ---- 08 design rules ---------------------------------------------------------------------------------------

_NIGHT_WH = 13.0 * Model().synodic_day_h / 2             # avionics and payload through half a lunar day

exercise(
    "08.1", lambda: 0.15 * Model().rigid_obstacle_ratio,
    "Obstacle height is the wheel radius times a ratio that depends on the suspension.",
    {"That is for a rocker-bogie; the question is about a rigid chassis on four wheels.":
        lambda: 0.15 * Model().rocker_bogie_obstacle_ratio,
     "A rigid rover does not climb as high as its wheel's radius.": lambda: 0.15,
     "That is for the largest wheel of the search; this lander leaves room for a smaller one.": lambda: 0.1},
    within=0.005)

exercise(
    "08.2", lambda: _NIGHT_WH / (1 - Model().soc_floor) / Model().discharge_efficiency,
    "Energy is power times hours; then allow for what may not be used and for what is lost on the way out.",
    {"That is what the rover uses. The battery may not be emptied, and loses a part in discharging.":
        lambda: _NIGHT_WH,
     "The discharge loses a part, too.": lambda: _NIGHT_WH / (1 - Model().soc_floor),
     "Only the part above the floor may be used.": lambda: _NIGHT_WH / Model().discharge_efficiency,
     "The night is half of the lunar day.":
        lambda: 2 * _NIGHT_WH / (1 - Model().soc_floor) / Model().discharge_efficiency,
     "Losses and floor make the battery larger than the energy used, not smaller: divide.":
        lambda: _NIGHT_WH * (1 - Model().soc_floor) * Model().discharge_efficiency}, within=0.01)


@cache
def _indifferent_k_mm():
    """The shear modulus at which wheels of 30 and 80 mm climb the same slope."""
    from scipy.optimize import brentq
    wheel = terramechanics.Wheel(0.2, [0.03, 0.08], 0.02, 24)

    def lead(k_mm):
        soil = replace(catalog.soil("apollo-nominal"), shear_modulus_mm=k_mm)
        narrow, wide = terramechanics.slope_capability(wheel, soil, 5.0, capability_limit_deg=80)
        return narrow - wide

    return brentq(lead, 2, 18)


exercise(
    "08.3", _indifferent_k_mm,
    "Compute both slope capabilities over shear moduli from 2 to 18 mm and look for the sign change.",
    {"In millimetres, please.": lambda: _indifferent_k_mm() / 1000,
     "That is the modulus of the mare soil itself, where narrow wins.": lambda: 18.0,
     "That soil's modulus was measured, but it is not where the two wheels are equal.": lambda: 11.0})


def _presses_softly(design):
    """What the design of exercise 08.4 still misses, or ""."""
    p = evaluate(design, catalog.scenario("equatorial_mare_traverse"))
    if p.stalled or p.range_km < 80 - 1e-9:
        return f"It drives {p.range_km:.1f} km" + (" because it stalls." if p.stalled
                                                   else ", short of the limit.")
    if p.ground_pressure_kpa > 2:
        return f"It presses too hard, {p.ground_pressure_kpa:.2f} kPa: wider or larger wheels, or less mass."
    if p.slope_capability_deg < 30:
        return f"It climbs {p.slope_capability_deg:.1f} deg only: grousers and radius are cheap traction."
    return "" if p.total_mass_kg <= 15 else f"It weighs {p.total_mass_kg:.1f} kg: look at the mass breakdown."


def _soft():
    return Design(wheel_radius_m=0.2, wheel_width_m=0.055, grouser_height_m=0.02, grouser_count=24,
                  wheel_count=4,
                  chassis_mass_kg=0.5, wheelbase_m=0.6, solar_area_m2=0.12, battery_capacity_wh=10,
                  avionics_power_w=6, peak_wheel_torque_nm=1.0)


exercise(
    "08.4", _soft, "",
    {"It presses too hard": lambda: replace(_soft(), wheel_width_m=0.03),
     "It climbs": lambda: replace(_soft(), grouser_height_m=0.01),
     "because it stalls": lambda: replace(_soft(), peak_wheel_torque_nm=0.1),
     "short of the limit": lambda: replace(_soft(), avionics_power_w=40.0),
     "look at the mass breakdown": lambda: replace(_soft(), wheel_width_m=0.09, chassis_mass_kg=3.0)},
    judge=_presses_softly)


# ---- 09 sensitivity ----------------------------------------------------------------------------------------

exercise(
    "09.1", lambda: np.tan(np.radians(35)) / np.tan(np.radians(46)),
    "The normal stress is the same; only the tangent of the friction angle changes.",
    {"Strength goes with the tangent of the angle, not with the angle.": lambda: 35 / 46,
     "The other way round: from the larger angle to the smaller.":
        lambda: np.tan(np.radians(46)) / np.tan(np.radians(35)),
     "Degrees went into a function that takes radians.": lambda: np.tan(35) / np.tan(46),
     "The tangent, not the sine.": lambda: np.sin(np.radians(35)) / np.sin(np.radians(46))}, within=0.01)

exercise(
    "09.2", lambda: 0.9**17, "All of them must be inside: multiply.",
    {"That is the chance of one.": lambda: 0.9,
     "That is the chance that at least one is outside.": lambda: 1 - 0.9**17,
     "That is the chance that all are outside.": lambda: 0.1**17}, within=0.02)


def _capabilities(*angles_deg):
    """Slope capability of Rashid-1 on the mare at friction angles."""
    soil = replace(_mare().soil, friction_angle_deg=np.array(angles_deg, float))
    return evaluate(_rashid(), replace(_mare(), soil=soil)).slope_capability_deg


exercise(
    "09.3", lambda: _capabilities(46, 35, 41),
    "Replace the friction angle in the scenario's soil and read slope_capability_deg.",
    {"In the order of the question, not by size.": lambda: _capabilities(35, 41, 46),
     "Not in proportion to the angle, nor to its tangent: pull is grip less resistance.":
        lambda: _capabilities(46) * np.tan(np.radians([46, 35, 41])) / np.tan(np.radians(46))}, within=0.01)


def _climbs_on_35(design):
    """What the design of exercise 09.4 still misses, or ""."""
    scenario = replace(_mare(), soil=catalog.soil("sourcebook-trafficability"))
    p = evaluate(design, scenario)
    if p.total_mass_kg > 15:
        return f"It weighs {p.total_mass_kg:.1f} kg."
    if not p.feasible:
        return "It does not drive the mission itself on that soil: " + ("it stalls." if p.stalled
                                                                        else "too little sun.")
    low = intervals(design, scenario, level=0.8).low["slope_capability_deg"]
    return "" if low >= 14 else f"Nine of ten draws climb {low:.1f} degrees only: too little margin."


def _climber():
    return Design(wheel_radius_m=0.2, wheel_width_m=0.035, grouser_height_m=0.02, grouser_count=24,
                  wheel_count=4,
                  chassis_mass_kg=1.5, wheelbase_m=0.6, solar_area_m2=0.15, battery_capacity_wh=20,
                  avionics_power_w=6, peak_wheel_torque_nm=2.0)


exercise(
    "09.4", _climber, "",
    {"It weighs": lambda: replace(_climber(), chassis_mass_kg=5.0),
     "it stalls": lambda: replace(_climber(), peak_wheel_torque_nm=0.1),
     "too little sun": lambda: replace(_climber(), avionics_power_w=32.0),
     "too little margin": lambda: replace(_climber(), grouser_count=20)}, judge=_climbs_on_35)


# ---- 10 rediscovery ----------------------------------------------------------------------------------------

exercise(
    "10.1", lambda: np.sqrt(8 / 6),
    "Mean of (x - y)^2 for uniform x and y, times the dimensions; then the root.",
    {"That is the mean square; take the root.": lambda: 8 / 6,
     "That is the variance of one number; the difference of two has twice as much.": lambda: np.sqrt(8 / 12),
     "That is the diagonal, the largest distance there is.": lambda: np.sqrt(8.0),
     "That is the mean distance, from a simulation; the root mean square has a closed form.": lambda: 1.128},
    within=0.005)

exercise(
    "10.2", lambda: 0.28**2 * 6,
    "Each dimension is worth one sixth; how many sixths are in the square of the distance?",
    {"The square of the distance, not the distance.": lambda: 0.28 * 6,
     "Divide by 1/6, do not multiply.": lambda: 0.28**2 / 6,
     "That is the share of the eight dimensions, not their number.": lambda: 0.28**2 * 6 / 8}, within=0.01)


@cache
def _steepest(payload_kg=0.5):
    """The steepest slope that the CADRE unit drives on its polar mission, in degrees."""
    slope_deg = np.arange(0, 20, 0.01)
    mission = replace(catalog.scenario("polar_micro"), payload_mass_kg=payload_kg, slope_deg=slope_deg)
    return slope_deg[~evaluate(catalog.rover("CADRE-unit"), mission).stalled].max()


exercise(
    "10.3", _steepest, "Evaluate over an array of slopes; the last one that is not stalled.",
    {"That is the slope capability, taken at a slip of 0.6. A rover may drive on until it stalls.":
        lambda: evaluate(catalog.rover("CADRE-unit"), replace(
            catalog.scenario("polar_micro"), payload_mass_kg=0.5)).slope_capability_deg,
     "That is the slope of the mission, where it stalls.": lambda: 20.0}, within=0.01)


def _pragyans_neighbour(design):
    """What the design of exercise 10.4 still misses, or ""."""
    pragyan, mission = catalog.rover("Pragyan"), replace(catalog.scenario("polar_micro"), payload_mass_kg=3.5)
    old, new = evaluate(pragyan, mission), evaluate(design, mission)
    if np.linalg.norm(unit_cube(design) - unit_cube(pragyan)) > 0.25:
        return "It is further than 0.25 from Pragyan."
    if new.total_mass_kg > old.total_mass_kg:
        return f"It is heavier by {new.total_mass_kg - old.total_mass_kg:.2f} kg."
    if new.range_km < old.range_km or new.slope_capability_deg < old.slope_capability_deg:
        return "It loses range or slope capability."
    same = (new.range_km, new.total_mass_kg, new.slope_capability_deg) == (
        old.range_km, old.total_mass_kg, old.slope_capability_deg)
    return "It is no better in any of the three." if same else ""


def _better_pragyan(**changes):
    return replace(catalog.rover("Pragyan"), **changes)


exercise(
    "10.4", lambda: _better_pragyan(grouser_height_m=0.011, grouser_count=18, chassis_mass_kg=9.5), "",
    {"It is further than": lambda: _better_pragyan(wheel_radius_m=0.15),
     "It is heavier by": lambda: _better_pragyan(grouser_height_m=0.011, grouser_count=18),
     "It loses range": lambda: _better_pragyan(grouser_count=10),
     "no better in any": lambda: _better_pragyan(wheelbase_m=0.6)}, judge=_pragyans_neighbour)


# ---- 11 the paper's ledger ---------------------------------------------------------------------------------

exercise(
    "11.1", lambda: 100 * (0.792 - 0.764) / 0.778, "Width over value, in percent.",
    {"That is half of the width, the distance from the middle.": lambda: 100 * 0.014 / 0.778,
     "In percent of the value, not in units of the hypervolume.": lambda: 0.028,
     "In percent: times one hundred.": lambda: 0.028 / 0.778}, within=0.01)

exercise(
    "11.2", lambda: [39 * 0.1, 0.9**39], "First the mean number of failures, then the chance of none.",
    {"The first is the number that should agree; the question asks for those that differ.":
        lambda: [39 * 0.9, 0.9**39],
     "The second is the chance that at least one differs.": lambda: [39 * 0.1, 1 - 0.9**39],
     "All of them must hold, so the chances multiply.": lambda: [39 * 0.1, 0.9]}, within=0.03)

exercise(
    "11.3", lambda: all(
        validation.accepts(catalog.table("paper_targets.csv").set_index("id").accept[row], pair)
        for row, pair in (("front_mare_range_km", (0.2, 80.0)), ("front_mare_mass_kg", (9.9, 61.0)))),
    "Read both bands: what do they ask of the smallest value, what of the largest, and what not at all?")


@cache
def _polar_batteries():
    """Median battery of the polar front at three shifts of its seed."""
    polar = catalog.scenario("polar_prospecting")
    return [float(np.median(pareto_front(polar, seed=polar.study.seed + shift).designs.battery_capacity_wh))
            for shift in (0, 100, 200)]


exercise(
    "11.4", lambda: [100 * int(np.argmax(_polar_batteries())), max(_polar_batteries())],
    "One search for each shift; the median battery of its designs; the largest of the three.",
    {"That is the smallest of the three.":
        lambda: [100 * int(np.argmin(_polar_batteries())), min(_polar_batteries())],
     "First the shift, then the battery.": lambda: [max(_polar_batteries()),
                                                    100 * int(np.argmax(_polar_batteries()))],
     "That is the paper's own figure, of one seed.": lambda: [0, 150.0]}, within=0.02)


# ---- 12 design your rover ----------------------------------------------------------------------------------

SWIRL = Scenario(
    name="reiner_gamma_swirl", latitude_deg=7.5, soil=catalog.soil("apollo-nominal"), duration_earth_days=13,
    slope_deg=12, duty_cycle=0.1, traverse_limit_km=20, payload_mass_kg=4, payload_power_w=12,
    required_obstacle_height_m=0.06, panel_tilt_deg=0,
    study=Study(constraints=(("range_km", ">=", 10), ("slope_capability_deg", ">=", 18),
                             ("minimum_soc", ">=", 0.2),
                             ("total_mass_kg", "<=", 19))))
"""The mission brief of notebook 12."""
SWIRL_LIMITS = {"wheel_radius_m": (0.05, 0.15), "wheel_width_m": (0.05, 0.20),
                "grouser_height_m": (0.0, 0.015),
                "chassis_mass_kg": (3.0, 12.0), "solar_area_m2": (0.1, 0.5), "avionics_power_w": (10.0, 10.0)}
"""Limits that the brief sets on the design."""


@cache
def swirl_guess():
    """The first guess of notebook 12: Rashid-1 with larger wheels, array and battery."""
    return replace(catalog.rover("Rashid-1"), wheel_radius_m=0.12, avionics_power_w=10, solar_area_m2=0.4,
                   battery_capacity_wh=200)


@cache
def _first_morning():
    """Hour by hour on the swirl, standing still, with 0.45 m2 of array and a battery that never runs low."""
    standing = replace(SWIRL, duty_cycle=0.0)
    return evaluate(replace(swirl_guess(), solar_area_m2=0.45, battery_capacity_wh=500), standing).log


def _drained_wh():
    return 500 - _first_morning().stored_wh.min()


def _accepts(design):
    """What the brief of notebook 12 still misses in a design, or ""."""
    limits = {name: getattr(design, name) for name in SWIRL_LIMITS}
    if not all(low <= limits[name] <= high for name, (low, high) in SWIRL_LIMITS.items()):
        return "A variable is outside the limits of the brief: hold each one against `limits`."
    demands = requirements(design, SWIRL)
    for demand in demands:
        if not demand.met:
            return f"A demand is missed before any uncertainty comes in: {demand.words}."
    weakest = min(demands, key=lambda demand: demand.share)
    if weakest.share < 0.9:
        return f"Too little margin: “{weakest.words}” holds in fewer than 90 % of the draws."
    if not evaluate(design, replace(SWIRL, soil=catalog.soil("sourcebook-trafficability"))).feasible:
        return "On the soil with the Sourcebook's friction angle the rover does not drive the mission."
    return ""


exercise(
    "12.1", lambda: SWIRL.required_obstacle_height_m / Model().rigid_obstacle_ratio,
    "The obstacle that a rover climbs is a multiple of its wheel radius; the suspension decides which.",
    {"That is the radius for six wheels on a rocker-bogie; the question asks for four on a rigid chassis.":
        lambda: SWIRL.required_obstacle_height_m / Model().rocker_bogie_obstacle_ratio,
     "A rigid chassis does not climb an obstacle as high as its wheel's radius.": lambda: 0.06,
     "The ratio is height over radius, not radius over height: divide.": lambda: 0.06 * 0.5,
     "In metres, please, and the radius rather than the diameter.": lambda: 0.24}, within=0.005)

exercise(
    "12.2", lambda: _drained_wh() / (1 - 0.2),
    "Read `stored_wh` of the log with a battery large enough never to run low, at duty cycle 0.",
    {"That is the energy which leaves the battery. One fifth of it must still be there in the end.":
        _drained_wh,
     "That adds a fifth of the drained energy; a fifth of the whole battery must remain.":
        lambda: _drained_wh() * 1.2,
     "The discharge loses a part: the battery gives up more than the load receives.":
        lambda: _drained_wh() * Model().discharge_efficiency / (1 - 0.2),
     "The array helps before it carries the whole load: the drain is not constant all morning.":
        lambda: 22 * (_first_morning().solar_w < 22).sum() / Model().discharge_efficiency / (1 - 0.2)},
        within=0.004)

exercise(
    "12.3", lambda: evaluate(swirl_guess(), replace(
        SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
    "Replace the soil of the mission, evaluate the first guess on it, and read slope_capability_deg.",
    {"That is the capability in the mission's own soil: replace the soil first.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg,
     "That is the loss, or gain, and not the capability itself.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg - evaluate(swirl_guess(), replace(
            SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
     "apollo-loose is another soil: looser, and not only weaker in friction.":
        lambda: evaluate(swirl_guess(), replace(SWIRL,
                                                soil=catalog.soil("apollo-loose"))).slope_capability_deg})


def _accepted():
    return replace(swirl_guess(), wheel_radius_m=0.14, wheel_width_m=0.05, grouser_count=22,
                   chassis_mass_kg=3.0,
                   solar_area_m2=0.45, battery_capacity_wh=270, peak_wheel_torque_nm=0.8)


exercise(
    "12.4", _accepted, "",
    {"outside the limits of the brief": lambda: replace(_accepted(), wheel_radius_m=0.16),
     "before any uncertainty comes in: lowest state of charge": swirl_guess,
     "Too little margin: “lowest state of charge": lambda: replace(_accepted(), battery_capacity_wh=240),
     "Too little margin: “total mass": lambda: replace(_accepted(), battery_capacity_wh=340),
     "Too little margin: “slope capability": lambda: replace(_accepted(), grouser_count=10)}, judge=_accepts)
