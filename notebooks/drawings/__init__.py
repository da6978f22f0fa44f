"""Pictures of the notebooks that are too long for a cell: numbers in, a matplotlib Figure out.

Every figure reads without colour (dashes and markers differ too) and names its units. Each function takes what the
evaluator returned and computes nothing that a reader would want to check; `sketches` come before a first formula.
"""
from rdk.figures import (  # noqa: F401
    BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, STYLE, curves, panels)
from .sketches import (  # noqa: F401
    heat_box, rover_on_slope, rover_parts, single_wheel_rig, sky_and_panel, wheel_in_soil)
from .wheel import (  # noqa: F401
    load_and_pull, median_spread, single_wheel_comparison, single_wheel_errors, stress_on_rim, sunk_wheel)
from .mission import (  # noqa: F401
    EVALUATION_FLOW, EVALUATION_RESULTS, demand_chances, mass_errors, mass_shares, mission_logs, peak_solar,
    power_flows, rovers_on_missions, system_diagram)
from .fronts import dominated_designs, ranks_and_crowding, weighted_sums  # noqa: F401
from .rules import (  # noqa: F401
    VERDICTS, ledger_filter, ledger_html, ledger_text, ledger_verdicts, pull_intervals, rediscovery_distances,
    sobol_bars, variables_on_fronts, verdict)
from .site import (  # noqa: F401
    line_of_sight, marches, polar_sun, shares_of_light, skyline_and_sun, slope_and_tilt, ways_on_a_map)
from .rovers import rovers  # noqa: F401
from .stand import loads_on_slope, mass_intervals  # noqa: F401
from .sizing import sizing_flow  # noqa: F401
