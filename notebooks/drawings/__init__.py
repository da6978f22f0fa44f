"""One function per figure of the notebooks: numbers in, a matplotlib Figure out.

Every figure reads without colour (dashes and markers differ too) and names its units. Each function takes what the
evaluator returned and computes nothing that a reader would want to check.
"""
from rdk.figures import (  # noqa: F401
    BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, STYLE, curves, panels)
from .wheel import (  # noqa: F401
    load_and_pull, power_split, pressure_sinkage, quadrature_error, shear_mobilisation,
    sinkage_against_load, stress_against_angle, stress_on_rim, wheel_against_size, wheel_against_slip)
from .mission import (  # noqa: F401
    EVALUATION_FLOW, EVALUATION_RESULTS, _PARTS, demand_chances, growth, load_transfer,
    mission_logs, pull_and_demand, rovers_on_missions, speed_limits, stall, step_convergence,
    sunk_wheel, system_diagram)
from .measurements import (  # noqa: F401
    _TESTS, _WHEELS, _test_titles, median_spread, resistance_against_slip, single_wheel_comparison,
    single_wheel_errors, sinkage_against_factor, sinkage_bias)
from .evidence import (  # noqa: F401
    HATCHES, day_of_power, efficiency_stack, fixed_overheads, mass_errors, mass_sensitivity,
    mass_shares, node_temperatures, panel_incidence, peak_solar, power_flows, sun_paths)
from .fronts import (  # noqa: F401
    SLOPE_BANDS, along_a_front, decoded_genes, dominated_designs, front_history, generation_budget,
    hub_speed_plateau, pareto_fronts, ranks_and_crowding, searches, seed_scatter, variation_operators,
    weighted_sums)
from .rules import (  # noqa: F401
    VERDICTS, battery_by_patience, battery_worth, capability_against_width, distance_by_patience,
    family_rules, front_points, frontiers_by_scale, ledger_filter, ledger_html, ledger_text,
    ledger_verdicts, pull_intervals, rediscovery_distances, rocker_bogie_share, sobol_bars,
    variables_on_fronts, verdict)
