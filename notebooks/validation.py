"""The evidence: the models against measurement, as pandas tables.

Errors are signed, in percent of what was measured or published: positive where the model is above it. Every table is
computed when asked for, from the files in `data/`; nothing here is fitted to them.
"""
import dataclasses
import warnings

import numpy as np
import pandas as pd

from rdk import catalog, power
from rdk._fields import check, require, unknown
from rdk.design import DESIGN_SPACE, Model, single
from rdk.mass import MassBreakdown, mass_breakdown
from rdk.mission import evaluate
from rdk.terramechanics import Soil, Wheel, wheel_forces


def error_pct(model, reference):
    """Signed error in percent of the size of the reference; NaN where the reference is zero or missing."""
    reference = np.asarray(reference, float)
    return 100 * (np.asarray(model) - reference) / np.where(reference == 0, np.nan, abs(reference))


def constant(name):
    """The value of a row of `constants.csv`, those of studies included."""
    values = {row["name"]: row["value"] for row in catalog.rows("constants.csv")}
    if name not in values:
        raise unknown("constants.csv has no constant", name, list(values))
    return float(values[name])


# ---- wheels ---------------------------------------------------------------------------------------------------

QUANTITIES = {"drawbar_pull_n": "N", "sinkage_mm": "mm", "torque_nm": "N m"}
"""What a single-wheel test measures, with its unit."""
EXPERIMENTS = {"ding": "ding-2011", "hurrell": "hurrell-2025", "wang": "wang-han-2016"}
"""The experiments behind the paper's medians, by their short names."""


def single_wheel_conditions(points: pd.DataFrame | None = None) -> tuple[Wheel, Soil, np.ndarray, np.ndarray]:
    """Wheel, soil, load (N) and slip of single-wheel tests, one lane a row, ready for `wheel_forces(*conditions)`.

    Rows of `single_wheel.csv` (all of them by default) or of `single_wheel_more.csv`, which bring their soil.
    """
    points = catalog.table("single_wheel.csv") if points is None else points
    require(points=(points, pd.DataFrame))
    wheel = Wheel(points.wheel_radius_mm / 1000, points.wheel_width_mm / 1000, points.grouser_height_mm / 1000,
                  points.grouser_count)
    if "sinkage_exponent" in points:
        soil = Soil(**{name: points[name] for name in catalog.soil("apollo-nominal").numbers()})
    else:
        soils = {name: catalog.soil(name).numbers() for name in points.soil.unique()}
        soil = Soil(**{field: [soils[name][field] for name in points.soil] for field in next(iter(soils.values()))})
    return wheel, soil, points.vertical_load_n.to_numpy(float), points.slip.to_numpy(float)


def single_wheel(points: pd.DataFrame | None = None, **options) -> pd.DataFrame:
    """Model against measurement at every point of the single-wheel tests, with the options of `wheel_forces`.

    One row a point: experiment, wheel, soil, vertical_load_n, slip, and for each of drawbar_pull_n, sinkage_mm and
    torque_nm the measured value, the model's (such as `model_drawbar_pull_n`) and the signed error in percent (such as
    `sinkage_error_pct`; NaN where nothing, or zero, was measured).
    """
    points = catalog.table("single_wheel.csv") if points is None else points
    forces = wheel_forces(*single_wheel_conditions(points), **options)
    model = dict(zip(QUANTITIES, (forces.drawbar_pull_n, 1000 * forces.sinkage_m, forces.torque_nm)))
    table = points.reindex(columns=["experiment", "wheel", "soil", "vertical_load_n", "slip"])
    for quantity in QUANTITIES:
        table[quantity] = points[quantity] if quantity in points else np.nan
        table["model_" + quantity] = model[quantity]
        table[_stem(quantity) + "_error_pct"] = error_pct(model[quantity], table[quantity])
    return table


def _stem(quantity):
    """drawbar_pull, sinkage, torque."""
    return quantity.rpartition("_")[0]


def measured(points: pd.DataFrame):
    """Yield experiment, quantity and the points of a `single_wheel` table at which it was measured."""
    for experiment, group in points.groupby("experiment", sort=False):
        for quantity in QUANTITIES:
            known = group[group[_stem(quantity) + "_error_pct"].notna()]
            if len(known):
                yield experiment, quantity, known


def single_wheel_summary(points: pd.DataFrame | None = None, **options) -> pd.DataFrame:
    """What the errors of the single-wheel tests, as returned by `single_wheel`, come to, per experiment and quantity.

    The paper's medians are those of |error| in percent over all points of an experiment, both wheels together, the
    points at zero slip and of negative pull included: that choice reproduces its six figures. `over_predicted` counts
    points; `median_abs_error_of_load_pct` is of pull only, in percent of the load.
    """
    points = single_wheel(**options) if points is None else points
    require(points=(points, pd.DataFrame))
    rows = []
    for experiment, quantity, known in measured(points):
        error, unit = known[_stem(quantity) + "_error_pct"], QUANTITIES[quantity]
        residual = known["model_" + quantity] - known[quantity]
        of_load = (100 * residual / known.vertical_load_n).abs().median() if unit == "N" else np.nan
        rows.append(dict(
            experiment=experiment, quantity=_stem(quantity), points=len(known),
            median_abs_error_pct=error.abs().median(), median_error_pct=error.median(),
            over_predicted=int((error > 0).sum()), largest_abs_error_pct=error.abs().max(),
            median_abs_error=residual.abs().median(), unit=unit, median_abs_error_of_load_pct=of_load))
    return pd.DataFrame(rows)


def single_wheel_curves(slip, **options) -> pd.DataFrame:
    """The kernel's curves through the single-wheel tests, one row a test and slip (n,), as in `single_wheel`."""
    tests = catalog.table("single_wheel.csv").drop_duplicates(["experiment", "wheel"])
    slip = np.atleast_1d(check("slip", slip, -1, 1))
    lanes = tests.loc[tests.index.repeat(len(slip))].assign(slip=np.tile(slip, len(tests))).reset_index(drop=True)
    columns = ["experiment", "wheel", "soil", "slip", *("model_" + quantity for quantity in QUANTITIES)]
    return single_wheel(lanes, **options)[columns]


def pull_shift(shear_scale=(0.70, 0.85, 1.15, 1.30), **options) -> pd.DataFrame:
    """How far the pull of the tested wheels moves when the kernel's shear stress is scaled by factors of shape (n,).

    Taken over the points of the paper's three experiments with positive slip and positive nominal pull, as its
    robustness study does: `median_shift_pct` is that of |DP(scale) / DP - 1|.
    """
    scale = np.atleast_1d(check("shear_scale", shear_scale, above=0))
    points = catalog.table("single_wheel.csv")
    conditions = single_wheel_conditions(points[points.experiment.isin(EXPERIMENTS.values())])
    pull = wheel_forces(*conditions, shear_scale=np.append(1.0, scale)[:, None], **options).drawbar_pull_n
    used = (conditions[3] > 0) & (pull[0] > 0)
    shift = 100 * abs(pull[1:, used] / pull[0, used] - 1)
    return pd.DataFrame(dict(shear_scale=scale, median_shift_pct=np.median(shift, 1), points=int(used.sum())))


# ---- masses ---------------------------------------------------------------------------------------------------

MASS_ITEMS = tuple(f.name for f in dataclasses.fields(MassBreakdown) if f.name != "total_kg")


def anchor_torque_nm(published_mass_kg, wheel_count, wheel_radius_m, gravity_m_s2=Model.gravity_m_s2):
    """Hub torque of a rover that publishes none: margin x pull coefficient x lunar weight per wheel x wheel radius."""
    return (constant("torque_anchor_margin") * constant("torque_anchor_coefficient") * published_mass_kg * gravity_m_s2
            / wheel_count * wheel_radius_m)


def published_masses(model: Model = Model()) -> pd.DataFrame:
    """Bottom-up mass against published mass, rover by rover, with the line items.

    One row a rover: rover, in_class, wheel_count, published_mass_kg, predicted_mass_kg, error_pct, the line items in
    kg, peak_wheel_torque_nm (anchored where none is published), and fixed_overhead_kg and fixed_overhead_pct: what does
    not shrink with the rover (motor and avionics base masses, fixed linkage), grossed up by harness, thermal control
    and growth, in kg and in percent of the published mass.
    """
    single(model=model)
    rovers = catalog.table("rovers.csv").query("use == 'mass check'").reset_index(drop=True)
    anchored = anchor_torque_nm(rovers.published_mass_kg, rovers.wheel_count, rovers.wheel_radius_m)
    rovers["peak_wheel_torque_nm"] = rovers.peak_wheel_torque_nm.fillna(anchored)
    sizes = [name for name in (*DESIGN_SPACE, "payload_mass_kg") if name != "wheelbase_m"]
    mass = mass_breakdown(**{name: rovers[name].to_numpy(float) for name in sizes}, coefficients=model)
    table = rovers[["rover", "in_class", "wheel_count", "published_mass_kg"]].copy()
    table["predicted_mass_kg"] = mass.total_kg
    table["error_pct"] = error_pct(mass.total_kg, rovers.published_mass_kg)
    for item in MASS_ITEMS:
        table[item] = getattr(mass, item)
    table["peak_wheel_torque_nm"] = rovers.peak_wheel_torque_nm
    gross = (1 + model.harness_fraction) * (1 + model.thermal_control_fraction) * (1 + model.growth_fraction)
    table["fixed_overhead_kg"] = gross * (
        rovers.wheel_count * model.motor_base_mass_kg + model.avionics_base_mass_kg
        + (rovers.wheel_count == 6) * model.linkage_base_mass_kg)
    table["fixed_overhead_pct"] = 100 * table.fixed_overhead_kg / rovers.published_mass_kg
    return table


def published_masses_summary(masses: pd.DataFrame | None = None) -> pd.DataFrame:
    """Errors of the predicted masses, as returned by `published_masses`: "in class" (5 to 50 kg) and "all".

    `rank_correlation` is that of the signed error with the published mass.
    """
    masses = published_masses() if masses is None else masses
    require(masses=(masses, pd.DataFrame))
    rows = []
    for label, group in ("in class", masses[masses.in_class.astype(bool)]), ("all", masses):
        size = group.error_pct.abs()
        rows.append(dict(rovers_included=label, rovers=len(group), median_abs_error_pct=size.median(),
                         mean_abs_error_pct=size.mean(), mean_error_pct=group.error_pct.mean(),
                         largest_abs_error_pct=size.max(),
                         rank_correlation=group.error_pct.rank().corr(group.published_mass_kg.rank())))
    return pd.DataFrame(rows)


# ---- flown rovers ---------------------------------------------------------------------------------------------

def peak_solar_power_w(panel_area_m2, latitude_deg, cell_efficiency=None, clean_array=True):
    """Noon power of a new horizontal array, by the paper's stack of panel factors.

    `cell_efficiency` is `flown_cell_efficiency` of `constants.csv` (0.30) by default; `clean_array` counts the optical
    loss of a clean array (0.98). Returns W.
    """
    cell = constant("flown_cell_efficiency") if cell_efficiency is None else cell_efficiency
    stack = [constant("flown_" + name) for name in ("packing_factor", "electrical_efficiency", "temperature_derate")]
    return power.panel_power(panel_area_m2, power.incidence_factor(latitude_deg, 0.0), efficiency=cell * np.prod(stack),
                             dust_factor=constant("flown_clean_array_factor") if clean_array else 1.0)


def flown_rovers() -> pd.DataFrame:
    """Peak solar power, survival of the lunar night and range envelope of the rovers that flew, against record.

    The panel lies flat. Power is given without (`peak_w`) and with (`clean_peak_w`, its sweep over cell efficiency in
    `clean_peak_low_w` and `clean_peak_high_w`) the optical loss of a clean array: the paper counts it for Pragyan and
    leaves it out for Yutu-2. `implied_derate` is published over `peak_w`. The enclosure (area, absorptivity, heaters,
    limits) is that of `flown.csv`, largely imputed. The range stops at the scenario's traverse limit, the
    `unlimited_range_km` does not. `survives` is the model's word, `survived` that of the record.
    """
    flown = catalog.table("flown.csv")
    rows = []
    for row in flown.itertuples():                       # missions of different length cannot share one march
        model = Model(enclosure_area_base_m2=row.enclosure_area_m2, enclosure_area_coefficient_m2=0.0,
                      enclosure_absorptivity=row.absorptivity, radioisotope_heater_power_w=row.rhu_power_w,
                      hibernation_power_w=row.hibernation_power_w,
                      operating_temperature_max_c=row.max_operating_temp_c)
        mission = dataclasses.replace(catalog.scenario(row.mission), panel_tilt_deg=0.0)
        limits = dataclasses.replace(mission, traverse_limit_km=[mission.traverse_limit_km, np.inf])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)             # Yutu-2 is outside the class, and meant to be
            result = evaluate(catalog.rover(row.rover), limits, model=model)
        site = row.panel_area_m2, row.landing_latitude_deg
        peak, clean = peak_solar_power_w(*site, clean_array=False), peak_solar_power_w(*site)
        low, high = (peak_solar_power_w(*site, constant("flown_cell_efficiency_" + end)) for end in ("low", "high"))
        rows.append(dict(
            rover=row.rover, published_peak_w=row.peak_solar_w, published_low_w=row.peak_solar_low_w,
            published_high_w=row.peak_solar_high_w, peak_w=peak, clean_peak_w=clean, clean_peak_low_w=low,
            clean_peak_high_w=high, clean_error_pct=error_pct(clean, row.peak_solar_w).item(),
            implied_derate=row.peak_solar_w / peak, hot_temperature_c=result.hot_temperature_c[0],
            cold_temperature_c=result.cold_temperature_c[0], survives=bool(result.thermal_survival[0]),
            survived=bool(row.survives_lunar_night), range_m=1000 * result.range_km[0],
            published_traverse_m=row.traverse_published_m, unlimited_range_km=result.range_km[1]))
    return pd.DataFrame(rows)
