"""The evidence: the models against measurement, and every number of the paper against ours, as pandas tables.

Errors are signed, in percent of what was measured or published: positive where the model is above it. Every table is
computed when asked for, from the files in `data/`; nothing here is fitted to them.
"""
from .flown import flown_rovers, peak_solar_power_w  # noqa: F401
from .ledger import accepts, paper_ledger  # noqa: F401
from .masses import (  # noqa: F401
    MASS_ITEMS, anchor_torque_nm, mass_sensitivity, published_masses, published_masses_summary)
from .tables import constant, error_pct  # noqa: F401
from .wheels import (  # noqa: F401
    QUANTITIES, bootstrap_medians, load_transfer, pull_shift, single_wheel, single_wheel_conditions,
    single_wheel_curves, single_wheel_summary)
