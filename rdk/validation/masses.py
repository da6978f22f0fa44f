"""Masses: the bottom-up estimate against published rovers."""
from __future__ import annotations

import dataclasses

import numpy as np
import pandas as pd

from .. import catalog
from .._fields import check
from ..design import Model
from ..mass import mass_breakdown
from ..mission import _MASS_COEFFICIENTS as MASS_COEFFICIENTS
from .tables import constant, error_pct

MASS_ITEMS = ("chassis_kg", "wheels_kg", "motors_kg", "solar_array_kg", "battery_kg", "avionics_kg", "linkage_kg",
              "harness_kg", "thermal_control_kg", "growth_kg", "payload_kg")


def anchor_torque_nm(published_mass_kg, wheel_count, wheel_radius_m, gravity_m_s2=Model.gravity_m_s2):
    """Hub torque of a rover that publishes none: margin x pull coefficient x lunar weight per wheel x wheel radius."""
    return (constant("torque_anchor_margin") * constant("torque_anchor_coefficient") * published_mass_kg * gravity_m_s2
            / wheel_count * wheel_radius_m)


def _published(model):
    """Rows of the mass check and their mass breakdown; fields of `model` broadcast against the rovers (last axis)."""
    rovers = catalog.table("rovers.csv").query("use == 'mass check'").reset_index(drop=True)
    anchored = anchor_torque_nm(rovers.published_mass_kg, rovers.wheel_count, rovers.wheel_radius_m)
    rovers["peak_wheel_torque_nm"] = rovers.peak_wheel_torque_nm.fillna(anchored)
    sizes = ("wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "wheel_count", "chassis_mass_kg",
             "solar_area_m2", "battery_capacity_wh", "avionics_power_w", "peak_wheel_torque_nm", "payload_mass_kg")
    return rovers, mass_breakdown(**{name: rovers[name].to_numpy(float) for name in sizes},
                                  **{name: getattr(model, name) for name in MASS_COEFFICIENTS})


def published_masses(model=Model()):
    """Bottom-up mass against published mass, rover by rover, with the line items.

    Parameters
    ----------
    model : Model
        Its mass coefficients are used, each a single number.

    Returns
    -------
    pandas.DataFrame
        One row a rover: rover, in_class, wheel_count, published_mass_kg, predicted_mass_kg, error_pct, the line items
        in kg, peak_wheel_torque_nm (anchored where none is published), and fixed_overhead_kg and fixed_overhead_pct:
        what does not shrink with the rover (motor and avionics base masses, fixed linkage), grossed up by harness,
        thermal control and growth, in kg and in percent of the published mass.
    """
    rovers, mass = _published(model)
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


def published_masses_summary(masses=None):
    """Median and mean |error| of the predicted masses.

    Parameters
    ----------
    masses : pandas.DataFrame, optional
        As returned by `published_masses`.

    Returns
    -------
    pandas.DataFrame
        Rows "in class" (5 to 50 kg, the paper's figures) and "all": rovers, median_abs_error_pct, mean_abs_error_pct,
        mean_error_pct (signed), largest_abs_error_pct, and rank_correlation of signed error with published mass.
    """
    masses = published_masses() if masses is None else masses
    rows = []
    for label, group in ("in class", masses[masses.in_class.astype(bool)]), ("all", masses):
        size = group.error_pct.abs()
        rows.append(dict(rovers_included=label, rovers=len(group), median_abs_error_pct=size.median(),
                         mean_abs_error_pct=size.mean(), mean_error_pct=group.error_pct.mean(),
                         largest_abs_error_pct=size.max(),
                         rank_correlation=group.error_pct.rank().corr(group.published_mass_kg.rank())))
    return pd.DataFrame(rows)


def mass_sensitivity(change_pct=20.0, model=Model()):
    """What a change of one mass coefficient at a time does to the published-mass table.

    Parameters
    ----------
    change_pct : float
        Relative change of each coefficient, in percent, above -100.
    model : Model
        Where the changes start.

    Returns
    -------
    pandas.DataFrame
        One row a coefficient: coefficient, value, changed_value, median_abs_error_pct over the in-class rovers, and the
        change of each rover's total in percent, one column a rover.
    """
    change = check("change_pct", change_pct, above=-100, scalar=True) / 100
    names = MASS_COEFFICIENTS
    scale = 1 + change * np.vstack([np.zeros(len(names)), np.eye(len(names))])           # row 0: nothing changed
    rovers, mass = _published(dataclasses.replace(
        model, **{name: getattr(model, name) * scale[:, [k]] for k, name in enumerate(names)}))
    total, inside = mass.total_kg, rovers.in_class.to_numpy(bool)
    error = abs(error_pct(total, rovers.published_mass_kg))[1:, inside]
    value = np.array([getattr(model, name) for name in names])
    table = pd.DataFrame(dict(coefficient=names, value=value, changed_value=value * (1 + change),
                              median_abs_error_pct=np.median(error, 1)))
    return table.join(pd.DataFrame(100 * (total[1:] / total[0] - 1), columns=list(rovers.rover)))
