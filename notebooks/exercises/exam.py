"""Examination questions on notebooks 01 to 09: each student gets other numbers, and every answer is computed."""
from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rdk import catalog, terramechanics
from rdk.design import Model
from rdk.mission import evaluate

from .judging import Exercise
from .shared import bus_factor, mare


@dataclass(frozen=True)
class Question:
    """A question, the answer and typical mistakes as functions of its numbers, and what these are drawn from."""
    text: str
    answer: Callable
    mistakes: dict
    numbers: dict
    kind: str = "number"

    def variant(self, seed, student, number):
        """The numbers of one student: from the seed, the name and the question's number alone."""
        dice = random.Random(f"{seed}/{student}/{number}")
        return {name: dice.choice(values) for name, values in self.numbers.items()}

    def exercise(self, given):
        """The question with these numbers, to be judged."""
        return Exercise(self.kind, lambda: self.answer(**given), "Another value.",
                        {words: lambda wrong=wrong: wrong(**given) for words, wrong in self.mistakes.items()})


def _from(low, high, step):
    return tuple(round(low + step * i, 6) for i in range(round((high - low) / step) + 1))


def _wheel(radius_mm, width_mm, load_n, slip_pct, soil, of="drawbar_pull_n", grousers=12):
    wheel = terramechanics.Wheel(radius_mm / 1000, width_mm / 1000, 0.010, grousers)
    return getattr(terramechanics.wheel_forces(wheel, catalog.soil(soil), load_n, slip_pct / 100), of)


def _saved_kg(chassis_g, payload_g, chassis=True, payload=False):
    return (chassis_g * (bus_factor() if chassis else 1) + payload_g * (bus_factor() if payload else 1)) / 1000


def _night_wh(load_w, hours, losses=True, floor=True):
    model = Model()
    return load_w * hours / (model.discharge_efficiency if losses else 1) / (1 - model.soc_floor * floor)


def _steepest_deg(rover, payload_kg, soil, stalls=True):
    slope_deg = np.arange(0, 40, 0.1)
    result = evaluate(catalog.rover(rover), mare(payload_mass_kg=payload_kg, soil=catalog.soil(soil),
                                                 slope_deg=slope_deg))
    return slope_deg[~result.stalled].max(initial=0.0) if stalls else result.slope_capability_deg[0]


def _range_km(radius_mm, slip_pct, duty_pct, days, slips=True):
    speed_m_s = Model().hub_no_load_speed_rad_s * radius_mm / 1000 * (1 - slip_pct / 100 * slips)
    return speed_m_s * duty_pct / 100 * days * 86.4


def _shapley(neither, first, second, both):
    return [(first - neither + both - second) / 2, (second - neither + both - first) / 2]


QUESTIONS = {
    "01.a": Question(
        "A wheel of radius {radius_mm} mm and width {width_mm} mm carries 12 grousers of 10 mm and a load of "
        "{load_n} N on `{soil}`. What is its drawbar pull at a slip of {slip_pct} %, in N?", _wheel,
        {"That is the torque.": lambda **g: _wheel(**g, of="torque_nm"),
         "That is without grousers.": lambda **g: _wheel(**g, grousers=0)},
        {"radius_mm": _from(60, 180, 10), "width_mm": _from(50, 150, 10), "load_n": _from(5, 25, 1),
         "slip_pct": _from(20, 60, 5), "soil": ("apollo-nominal", "apollo-loose", "fjs-1", "grc-1")}),
    "01.b": Question(
        "A plate meets {low_kpa} kPa at a depth of {shallow_mm} mm in a soil, and {high_kpa} kPa at {deep_mm} mm. What "
        "is the sinkage exponent n of the soil?",
        lambda low_kpa, high_kpa, shallow_mm, deep_mm: math.log(high_kpa / low_kpa) / math.log(deep_mm / shallow_mm),
        {"Take the logarithms of both ratios.":
            lambda low_kpa, high_kpa, shallow_mm, deep_mm: high_kpa / low_kpa / (deep_mm / shallow_mm)},
        {"low_kpa": _from(6, 9, 0.2), "high_kpa": _from(26, 48, 0.5), "shallow_mm": _from(5, 10, 1),
         "deep_mm": _from(20, 40, 2)}),
    "02.a": Question(
        "A wheel under {load_n} N was measured to pull {measured_n} N; the model says {model_n} N. What is the error "
        "of the model in percent of the measured pull, and what in percent of the load?",
        lambda load_n, measured_n, model_n: [100 * (model_n / measured_n - 1), 100 * (model_n - measured_n) / load_n],
        {"The error was divided by the model's pull.": lambda load_n, measured_n, model_n: [
            100 * (1 - measured_n / model_n), 100 * (model_n - measured_n) / load_n]},
        {"load_n": _from(30, 80, 2), "measured_n": _from(6, 10, 0.2), "model_n": _from(10.5, 15, 0.1)}, "2 numbers"),
    "03.a": Question(
        "The chassis loses {chassis_g} g and the payload {payload_g} g. With the default coefficients, by how many kg "
        "does the rover become lighter?", _saved_kg,
        {"The chassis saves its overheads and growth as well.": lambda **g: _saved_kg(**g, chassis=False),
         "The payload carries no overheads and no growth.": lambda **g: _saved_kg(**g, payload=True)},
        {"chassis_g": _from(100, 900, 25), "payload_g": _from(50, 600, 25)}),
    "04.a": Question(
        "A load of {load_w} W runs for {hours} hours without sun, from a full battery. With the default losses and "
        "floor of the charge, how many Wh must the battery hold?", _night_wh,
        {"The discharge loses a part.": lambda **g: _night_wh(**g, losses=False),
         "The floor must remain.": lambda **g: _night_wh(**g, floor=False)},
        {"load_w": _from(2, 12, 0.25), "hours": _from(10, 40, 1)}),
    "05.a": Question(
        "{rover} drives `equatorial_mare_traverse` with a payload of {payload_kg} kg on the soil `{soil}`. Up to which "
        "slope, in degrees to a tenth, does it drive without a stall?", _steepest_deg,
        {"That is the slope capability, taken at slip 0.6.": lambda **g: _steepest_deg(**g, stalls=False)},
        {"rover": ("Rashid-1", "Pragyan", "MoonRanger"), "payload_kg": _from(0.5, 6, 0.25),
         "soil": ("apollo-nominal", "sourcebook-trafficability", "fjs-1", "grc-3")}),
    "05.b": Question(
        "A hub turns at its default no-load speed; its wheel of {radius_mm} mm radius slips by {slip_pct} %. The rover "
        "drives {duty_pct} % of {days} Earth days, and nothing else holds it back. How many km is that?", _range_km,
        {"The slip takes its part of the speed.": lambda **g: _range_km(**g, slips=False)},
        {"radius_mm": _from(60, 180, 5), "slip_pct": _from(5, 50, 5), "duty_pct": _from(2, 20, 1),
         "days": _from(5, 14, 1)}),
    "06.a": Question(
        "Design A drives {neither} km, design B {both} km; they differ in wheel and array. A with B's wheel drives "
        "{first} km, A with B's array {second} km. What are the Shapley values of wheel and array, in km?", _shapley,
        {"That is what each adds alone.": lambda neither, first, second, both: [first - neither, second - neither],
         "First the wheel, then the array.": lambda **g: _shapley(**g)[::-1]},
        {"neither": _from(5, 15, 0.5), "first": _from(18, 26, 0.5), "second": _from(16, 30, 0.5),
         "both": _from(32, 50, 0.5)}, "2 numbers"),
    "07.a": Question(
        "Two objectives are to be small. A front holds the points (1, {a}), (3, {b}) and (6, {c}). What is its "
        "hypervolume with the reference point (10, 10)?", lambda a, b, c: 2 * (10 - a) + 3 * (10 - b) + 4 * (10 - c),
        {"What lies in two boxes counts once.": lambda a, b, c: 9 * (10 - a) + 7 * (10 - b) + 4 * (10 - c)},
        {"a": _from(7, 9.5, 0.1), "b": _from(4, 6.5, 0.1), "c": _from(1, 3.5, 0.1)}),
    "08.a": Question(
        "A rover gives up {battery_wh} Wh of battery. With the default coefficients, by how many m2 may its array grow "
        "at the same total mass?",
        lambda battery_wh: battery_wh / Model().battery_specific_energy_wh_kg / Model().solar_areal_density_kg_m2,
        {"That is the mass in kg.": lambda battery_wh: battery_wh / Model().battery_specific_energy_wh_kg},
        {"battery_wh": _from(20, 220, 1)}),
    "09.a": Question(
        "In {draws} independent draws a demand holds in {p} %. What is the standard error of that share, in percentage "
        "points?", lambda draws, p: 100 * math.sqrt(p / 100 * (1 - p / 100) / draws),
        {"That is the variance.": lambda draws, p: p * (1 - p / 100) / draws},
        {"draws": _from(200, 5000, 100), "p": _from(70, 98, 0.5)}),
}
