"""What the exercises of several notebooks share: the rover and mission they use most, and small sums."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from rdk import catalog
from rdk.design import Model


def mare(**changes):
    """The mare mission, with some of it changed."""
    return replace(catalog.scenario("equatorial_mare_traverse"), **changes)


def rashid(**changes):
    """Rashid-1, with some of it changed."""
    return replace(catalog.rover("Rashid-1"), **changes)


def first(values, flags):
    """The first of `values` at which `flags` holds."""
    return values[np.argmax(flags)]


def bus_factor():
    """Kilograms of rover for a kilogram of hardware."""
    model = Model()
    return (1 + model.harness_fraction) * (1 + model.thermal_control_fraction) * (1 + model.growth_fraction)
