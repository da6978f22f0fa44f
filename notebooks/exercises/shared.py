"""What the exercises of several notebooks share: the rover and mission they use most, and small sums."""
from __future__ import annotations

from functools import cache

import numpy as np

from rdk import catalog
from rdk.design import Model


@cache
def _mare():
    return catalog.scenario("equatorial_mare_traverse")


@cache
def _rashid():
    return catalog.rover("Rashid-1")


def _first(values, flags):
    """The first of `values` at which `flags` holds."""
    return values[np.argmax(flags)]


def _bus_factor():
    model = Model()
    return (1 + model.harness_fraction) * (1 + model.thermal_control_fraction) * (1 + model.growth_fraction)
