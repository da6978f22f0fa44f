"""Rovers that flew: peak solar power, survival of the night and range against record."""
from __future__ import annotations

import dataclasses
import warnings

import numpy as np
import pandas as pd

from .. import catalog, power
from ..design import Model
from ..mission import evaluate
from .tables import constant, error_pct


def peak_solar_power_w(panel_area_m2, latitude_deg, cell_efficiency=None, clean_array=True):
    """Noon power of a new horizontal array, by the paper's stack of panel factors.

    Parameters
    ----------
    panel_area_m2, latitude_deg : float or ndarray
    cell_efficiency : float or ndarray, optional
        `flown_cell_efficiency` of `constants.csv` (0.30) by default.
    clean_array : bool
        Count the optical loss of a clean array (0.98).

    Returns
    -------
    float or ndarray
        In W.
    """
    cell = constant("flown_cell_efficiency") if cell_efficiency is None else cell_efficiency
    stack = [constant("flown_" + name) for name in ("packing_factor", "electrical_efficiency", "temperature_derate")]
    return power.panel_power(panel_area_m2, power.incidence_factor(latitude_deg, 0.0), efficiency=cell * np.prod(stack),
                             dust_factor=constant("flown_clean_array_factor") if clean_array else 1.0)


def flown_rovers():
    """Peak solar power, survival of the lunar night and range envelope of the rovers that flew, against record.

    The panel lies flat. Power is given with and without the optical loss of a clean array: the paper counts it for
    Pragyan and leaves it out for Yutu-2. The enclosure (area, absorptivity, heaters, limits) is that of `flown.csv`,
    largely imputed. The range stops at the scenario's traverse limit; `unlimited_range_km` lifts that limit.

    Returns
    -------
    pandas.DataFrame
        One row a rover: rover; published_peak_w with its band published_low_w, published_high_w; peak_w (no optical
        loss), clean_peak_w and its sweep over cell efficiency, clean_peak_low_w and clean_peak_high_w;
        clean_error_pct; implied_derate (published / peak_w); hot_temperature_c, cold_temperature_c,
        survives (model), survived (record); range_m, published_traverse_m, unlimited_range_km.
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
            result = evaluate(catalog.rover(row.rover), limits, model)
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
