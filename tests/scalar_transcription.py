"""The paper's evaluator written out a second time: one design, one scenario, plain floats.

An independent yardstick for the vectorised engine. Nothing here is taken from ``rdk``; every function is
one published equation or rule of Reifschneider's "RoverDevKit" paper, in the paper's symbols and order, with
a root finder where the paper has one and a loop where the paper has one. It is slow on purpose: with
``quadrature="trapezoid"`` it does the same work as the original release (100 points on the contact arc,
Brent's method, an hourly loop), so that a benchmark against it measures the engine and not the machine.
``quadrature="gauss"`` integrates accurately, to tell a quadrature error from a modelling error.

Inputs are plain dicts with the public field names of Design, Scenario, Soil and Wheel.
"""
from math import acos, atan2, ceil, copysign, cos, exp, isnan, nan, pi, radians, sin, sqrt, tan

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

MODEL = {
    "gravity_m_s2": 1.625, "solar_constant_w_m2": 1361.0, "lunar_day_h": 708.734136,
    "c_1": 0.4, "c_2": 0.2, "gamma_g_max": 0.6, "shear_scale": 1.0,
    "slope_slip": 0.6, "slope_limit_deg": 35.0, "slip_min": -0.9, "slip_max": 0.95,
    "wheel_areal_density_kg_m2": 8.0, "grouser_thickness_m": 0.002, "grouser_density_kg_m3": 2700.0,
    "motor_base_kg": 0.15, "motor_kg_per_nm": 0.1, "array_kg_m2": 2.5, "battery_wh_kg": 120.0,
    "avionics_base_kg": 0.3, "avionics_kg_per_w": 0.05, "harness_fraction": 0.08, "thermal_fraction": 0.05,
    "growth_fraction": 0.2, "linkage_base_kg": 0.5, "linkage_fraction": 0.08,
    "panel_efficiency": 0.28, "dust_factor": 0.9, "drivetrain_efficiency": 0.8, "hub_speed_rad_s": 5.0,
    "charge_efficiency": 0.95, "discharge_efficiency": 0.95, "soc_floor": 0.15, "soc_start": 1.0,
    "emissivity": 0.85, "absorptivity": 0.3, "sunlit_fraction": 0.25, "hibernation_w": 2.0, "rhu_w": 0.0,
    "sink_hot_k": 250.0, "sink_cold_k": 100.0, "limit_cold_c": -30.0, "limit_hot_c": 50.0,
    "obstacle_rigid": 0.5, "obstacle_rocker": 1.25,
}
STEFAN_BOLTZMANN = 5.670374419e-8
GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(64)


# --- Terramechanics ---------------------------------------------------------------------------------------

def transition_angle(theta_1, slip, model):
    """theta_m = (c_1 + c_2 |s|) theta_1, where the normal stress peaks."""
    return (model["c_1"] + model["c_2"] * abs(slip)) * theta_1


def shear_displacement(theta, theta_1, slip, r):
    """j(theta) = r [(theta_1 - theta) - (1 - s)(sin theta_1 - sin theta)]."""
    return r * ((theta_1 - theta) - (1.0 - slip) * (sin(theta_1) - np.sin(theta)))


def normal_stress(theta, theta_1, theta_m, r, b, soil):
    """Eq. (sigma), in Pa: Bekker's law in front of theta_m, the front mirrored behind it."""
    n = soil["sinkage_exponent"]
    k_eff = 1e3 * (soil["cohesive_modulus_kn_m_n1"] / b + soil["frictional_modulus_kn_m_n2"])
    theta_star = np.where(theta >= theta_m, theta, theta_1 - theta / theta_m * (theta_1 - theta_m))
    return k_eff * r**n * np.maximum(np.cos(theta_star) - cos(theta_1), 0.0)**n


def grouser_factor(wheel, model):
    """Eq. (grouser): gamma_g = 1 + min(N_g h_g / (2 pi r), gamma_g_max)."""
    density = wheel["grouser_count"] * wheel["grouser_height_m"] / (2.0 * pi * wheel["radius_m"])
    return 1.0 + min(density, model["gamma_g_max"])


def shear_stress(sigma, j, wheel, soil, model):
    """Eq. (tau), in Pa: Mohr-Coulomb strength, Janosi-Hanamoto mobilisation, grouser factor, sign of j."""
    strength = 1e3 * soil["cohesion_kpa"] + sigma * np.tan(radians(soil["friction_angle_deg"]))
    mobilised = 1.0 - np.exp(-np.abs(j) / (1e-3 * soil["shear_modulus_mm"]))
    return model["shear_scale"] * grouser_factor(wheel, model) * strength * mobilised * np.sign(j)


def shear_reversal_angle(theta_1, slip, r):
    """Angle inside (0, theta_1) where j changes sign, or None; there is at most one, and only if s < 0."""
    if slip >= 0.0 or (1.0 - slip) * cos(theta_1) >= 1.0:
        return None                                  # j has one sign on the whole arc
    theta_peak = float(np.arccos(1.0 / (1.0 - slip)))        # dj/dtheta = 0
    if shear_displacement(0.0, theta_1, slip, r) >= 0.0:
        return None
    return brentq(shear_displacement, 0.0, theta_peak, args=(theta_1, slip, r), xtol=1e-14)


def arc_points(theta_1, theta_m, slip, r, quadrature):
    """Angles and weights on [0, theta_1]; "gauss" puts a panel end at every kink of the integrand."""
    if quadrature == "trapezoid":
        theta = np.linspace(0.0, theta_1, 100)
        weights = np.full(100, theta_1 / 99.0)
        weights[[0, -1]] *= 0.5
        return theta, weights
    kinks = {0.0, theta_m, theta_1, shear_reversal_angle(theta_1, slip, r)} - {None}
    edges = sorted(kinks)
    halves = [((b - a) / 2.0, (a + b) / 2.0) for a, b in zip(edges, edges[1:])]
    return (np.concatenate([mid + half * GAUSS_NODES for half, mid in halves]),
            np.concatenate([half * GAUSS_WEIGHTS for half, _ in halves]))


def contact_integrals(theta_1, wheel, soil, slip, model, quadrature):
    """Vertical load F_z, drawbar pull DP (N) and driving torque T (N m) at a given entry angle."""
    r, b = wheel["radius_m"], wheel["width_m"]
    theta_m = transition_angle(theta_1, slip, model)
    theta, weights = arc_points(theta_1, theta_m, slip, r, quadrature)
    sigma = normal_stress(theta, theta_1, theta_m, r, b, soil)
    tau = shear_stress(sigma, shear_displacement(theta, theta_1, slip, r), wheel, soil, model)
    load = r * b * float(weights @ (sigma * np.cos(theta) + tau * np.sin(theta)))
    pull = r * b * float(weights @ (tau * np.cos(theta) - sigma * np.sin(theta)))
    torque = r * r * b * float(weights @ tau)
    return load, pull, torque


def wheel_forces(wheel, soil, vertical_load_n, slip, model=MODEL, quadrature="trapezoid"):
    """Solve F_z(theta_1) = F_z* over (0, pi/2) by Brent's method; NaN where the wheel is buried."""
    def surplus(theta_1):
        return contact_integrals(theta_1, wheel, soil, slip, model, quadrature)[0] - vertical_load_n
    try:
        theta_1 = brentq(surplus, 1e-4, pi / 2.0 - 1e-4, xtol=1e-9 if quadrature == "trapezoid" else 1e-14)
    except ValueError:                               # no change of sign: nothing carries this load
        return {"drawbar_pull_n": nan, "torque_nm": nan, "sinkage_m": nan, "entry_angle_rad": nan}
    _, pull, torque = contact_integrals(theta_1, wheel, soil, slip, model, quadrature)
    return {"drawbar_pull_n": pull, "torque_nm": torque,
            "sinkage_m": wheel["radius_m"] * (1.0 - cos(theta_1)),       # z_0 = r (1 - cos theta_1)
            "entry_angle_rad": theta_1}


def imposed_arc_forces(wheel, soil, vertical_load_n, slip, model=MODEL):
    """The second kernel, one wheel, by adaptive quadrature: static sinkage, slip-sinkage factor, level from balance."""
    r, b, n = wheel["radius_m"], wheel["width_m"], soil["sinkage_exponent"]
    k_r = 1e3 * (soil["cohesive_modulus_kn_m_n1"] / b + soil["frictional_modulus_kn_m_n2"]) * r**n

    def integral(f, edges):
        return sum(quad(f, *pair, epsabs=1e-11, epsrel=1e-10, limit=200)[0] for pair in zip(edges, edges[1:]))

    def static_surplus(theta_s):
        held = integral(lambda t: (cos(t) - cos(theta_s))**n * cos(t), [0.0, theta_s])
        return 2 * b * r * k_r * held - vertical_load_n

    nothing = dict.fromkeys(("drawbar_pull_n", "torque_nm", "sinkage_m", "entry_angle_rad", "stress_level"), nan)
    if static_surplus(pi / 2) < 0:
        return nothing
    theta_s = brentq(static_surplus, 1e-6, pi / 2, xtol=1e-14)
    z = r * (1 - cos(theta_s)) * (1 + abs(slip)) / (1 - 0.5 * abs(slip))
    if z >= r:
        return nothing
    theta_1 = acos(1 - z / r)
    theta_m = (0.18 + 0.32 * abs(slip)) * theta_1
    edges = sorted({0.0, theta_m, theta_1, shear_reversal_angle(theta_1, slip, r)} - {None})
    gamma_g, c = grouser_factor(wheel, model), 1e3 * soil["cohesion_kpa"]
    tan_phi, k_mm = tan(radians(soil["friction_angle_deg"])), soil["shear_modulus_mm"]

    def sigma(t):
        return float(normal_stress(t, theta_1, theta_m, r, b, soil))

    def mu(t):
        j = float(shear_displacement(t, theta_1, slip, r))
        return gamma_g * (1 - exp(-abs(j) / (1e-3 * k_mm))) * copysign(1, j)

    i_1 = r * b * integral(lambda t: sigma(t) * (cos(t) + tan_phi * mu(t) * sin(t)), edges)
    i_2 = r * b * integral(lambda t: mu(t) * sin(t), edges)
    level = (vertical_load_n - c * i_2) / i_1

    def tau(t):
        return mu(t) * (c + level * sigma(t) * tan_phi)

    return {"drawbar_pull_n": r * b * integral(lambda t: tau(t) * cos(t) - level * sigma(t) * sin(t), edges),
            "torque_nm": r * r * b * integral(tau, edges), "sinkage_m": z, "entry_angle_rad": theta_1,
            "stress_level": level}


# --- Mobility ---------------------------------------------------------------------------------------------

def wheel_of(design):
    return {"radius_m": design["wheel_radius_m"], "width_m": design["wheel_width_m"],
            "grouser_height_m": design["grouser_height_m"], "grouser_count": design["grouser_count"]}


def slip_balance(wheel, soil, load_n, pull_n, model=MODEL, quadrature="trapezoid"):
    """Eq. (slip-balance): the slip at which the wheel pulls DP*. Returns (slip, pull is enough).

    More pull than needed over the whole interval: slip 0. Never enough: slip pinned at its upper end.
    """
    def surplus(slip):
        return wheel_forces(wheel, soil, load_n, slip, model, quadrature)["drawbar_pull_n"] - pull_n
    low, high = model["slip_min"], model["slip_max"]
    at_low, at_high = surplus(low), surplus(high)
    if isnan(at_low) or isnan(at_high):
        return nan, False
    if at_low > 0.0 and at_high > 0.0:
        return 0.0, True
    if at_low < 0.0 and at_high < 0.0:
        return high, False
    return brentq(surplus, low, high, xtol=1e-4 if quadrature == "trapezoid" else 1e-12), True


def slope_capability_deg(wheel, soil, weight_n, model=MODEL, quadrature="trapezoid"):
    """Steepest slope on which the pull at slip 0.6 carries the weight component; weight_n is per wheel."""
    slip = model["slope_slip"]

    def surplus(slope_deg):
        load, pull = weight_n * cos(radians(slope_deg)), weight_n * sin(radians(slope_deg))
        return wheel_forces(wheel, soil, load, slip, model, quadrature)["drawbar_pull_n"] - pull
    if not surplus(0.0) > 0.0:                       # also where the wheel is buried
        return 0.0
    if surplus(model["slope_limit_deg"]) >= 0.0:
        return model["slope_limit_deg"]
    return brentq(surplus, 0.0, model["slope_limit_deg"], xtol=0.01 if quadrature == "trapezoid" else 1e-10)


def obstacle_capability_m(design, model=MODEL):
    ratio = model["obstacle_rocker"] if design["wheel_count"] == 6 else model["obstacle_rigid"]
    return ratio * design["wheel_radius_m"]


# --- Mass -------------------------------------------------------------------------------------------------

def total_mass_kg(design, scenario, model=MODEL):
    n_w, r, b = design["wheel_count"], design["wheel_radius_m"], design["wheel_width_m"]
    grousers = (design["grouser_count"] * b * design["grouser_height_m"]
                * model["grouser_thickness_m"] * model["grouser_density_kg_m3"])
    m_w = n_w * (model["wheel_areal_density_kg_m2"] * 2.0 * pi * r * b + grousers)      # Eq. (mass-wheels)
    m_m = n_w * (model["motor_base_kg"] + model["motor_kg_per_nm"] * design["peak_wheel_torque_nm"])
    m_s = model["array_kg_m2"] * design["solar_area_m2"]              # Eq. (mass-power-avionics)
    m_b = design["battery_capacity_wh"] / model["battery_wh_kg"]
    m_a = model["avionics_base_kg"] + model["avionics_kg_per_w"] * design["avionics_power_w"]
    m_c = design["chassis_mass_kg"]
    m_arch = model["linkage_base_kg"] + model["linkage_fraction"] * m_c if n_w == 6 else 0.0
    m_sub = m_c + m_w + m_m + m_s + m_b + m_a + m_arch                     # Eq. (mass-subsystems)
    with_harness = m_sub + model["harness_fraction"] * m_sub
    m_dry = with_harness + model["thermal_fraction"] * with_harness                     # Eq. (mass-dry)
    return m_dry + model["growth_fraction"] * m_dry + scenario["payload_mass_kg"]       # Eq. (mass-total)


# --- Power ------------------------------------------------------------------------------------------------

def panel_power_w(time_h, design, scenario, model=MODEL):
    """Eqs. (sun-elevation), (solar-incidence), (solar-power): declination 0, sunrise at t = 0."""
    latitude, tilt = radians(scenario["latitude_deg"]), radians(scenario["panel_tilt_deg"])
    hour_angle = 2.0 * pi * time_h / model["lunar_day_h"] - pi / 2.0
    sin_e = cos(latitude) * cos(hour_angle)
    if sin_e <= 1e-12:                               # cos(90 deg) is 6e-17 in floats: the sun rises at 0
        return 0.0
    azimuth = atan2(-sin(hour_angle), -sin(latitude) * cos(hour_angle))  # clockwise from north, towards east
    cos_i = (sin_e * cos(tilt) + sqrt(1.0 - sin_e**2) * sin(tilt)
             * cos(azimuth - radians(scenario["panel_azimuth_deg"])))
    return (model["solar_constant_w_m2"] * design["solar_area_m2"] * model["panel_efficiency"]
            * model["dust_factor"] * max(0.0, cos_i))


def battery_step(energy_wh, net_w, dt_h, capacity_wh, model=MODEL):
    """Eq. (battery-update), clamped between the floor and full charge."""
    gain = model["charge_efficiency"] if net_w >= 0.0 else 1.0 / model["discharge_efficiency"]
    return min(max(energy_wh + gain * net_w * dt_h, model["soc_floor"] * capacity_wh), capacity_wh)


# --- Thermal ----------------------------------------------------------------------------------------------

def enclosure_temperatures_c(design, scenario, model=MODEL):
    """Eq. (thermal-node) for the hot and the cold case."""
    area = 0.05 + 0.02 * design["chassis_mass_kg"] ** (2.0 / 3.0)
    sun = (model["absorptivity"] * model["solar_constant_w_m2"] * cos(radians(scenario["latitude_deg"]))
           * model["sunlit_fraction"] * area)
    q_hot = sun + design["avionics_power_w"] + scenario["payload_power_w"] + model["rhu_w"]
    q_cold = model["hibernation_w"] + model["rhu_w"]

    def node(sink_k, q_in):
        return (sink_k**4 + q_in / (model["emissivity"] * STEFAN_BOLTZMANN * area)) ** 0.25 - 273.15
    return node(model["sink_hot_k"], q_hot), node(model["sink_cold_k"], q_cold)


# --- Mission ----------------------------------------------------------------------------------------------

def mean_panel_power_w(design, scenario, model=MODEL):
    """Plain mean of 200 samples over the mission, both ends included."""
    hours = 24.0 * scenario["duration_earth_days"]
    return sum(panel_power_w(t, design, scenario, model) for t in np.linspace(0.0, hours, 200)) / 200.0


def cruise_speed_m_s(design, scenario, slip, torque_nm, model=MODEL):
    """Eq. (energy-balance-speed) under the hub no-load speed; returns (speed, whether the hub limits it)."""
    surplus_w = (mean_panel_power_w(design, scenario, model)
                 - design["avionics_power_w"] - scenario["payload_power_w"])
    duty = min(max(scenario["duty_cycle"], 0.0), 1.0)
    v_hub = model["hub_speed_rad_s"] * design["wheel_radius_m"] * (1.0 - slip)
    if surplus_w <= 0.0:
        return 0.0, False
    resisted_w = duty * design["wheel_count"] * torque_nm    # per rad/s of the wheel
    if resisted_w <= 0.0:
        return v_hub, True                           # driving costs nothing: only the hub limits it
    v_eb = surplus_w * design["wheel_radius_m"] * (1.0 - slip) * model["drivetrain_efficiency"] / resisted_w
    return min(v_eb, v_hub), v_eb > v_hub


def traverse(design, scenario, mobility_w, speed_m_s, model=MODEL):
    """The hourly loop: returns range (m), final state of charge and energy balance (%).

    ``mobility_w`` is the power while driving, before the duty cycle. Each step takes the sun at its end. A
    mission that is no whole number of hours ends with a shorter step (our choice: the paper has none).
    """
    duty = min(max(scenario["duty_cycle"], 0.0), 1.0)
    base_w = design["avionics_power_w"] + scenario["payload_power_w"]
    capacity_wh, floor_wh = design["battery_capacity_wh"], model["soc_floor"] * design["battery_capacity_wh"]
    hours, limit_m = 24.0 * scenario["duration_earth_days"], 1e3 * scenario["traverse_limit_km"]
    energy_wh, position_m = model["soc_start"] * capacity_wh, 0.0
    # The release's log starts with a row of zeros; its energy balance counts that row.
    time_h, generated_w, consumed_w = [0.0], [0.0], [0.0]
    for step in range(1, ceil(hours - 1e-9) + 1):
        now_h = min(float(step), hours)
        dt_h = now_h - time_h[-1]
        solar_w = panel_power_w(now_h, design, scenario, model)
        share = duty
        if energy_wh <= floor_wh * (1.0 + 1e-12) and solar_w < base_w + duty * mobility_w:
            share = min(duty, max(0.0, solar_w - base_w) / mobility_w) if mobility_w > 0.0 else 0.0
        load_w = base_w + share * mobility_w
        energy_wh = battery_step(energy_wh, solar_w - load_w, dt_h, capacity_wh, model)
        position_m = min(position_m + speed_m_s * share * 3600.0 * dt_h, limit_m)
        time_h.append(now_h)
        generated_w.append(solar_w)
        consumed_w.append(load_w)
    generated, consumed = np.trapezoid(generated_w, time_h), np.trapezoid(consumed_w, time_h)
    return position_m, energy_wh / capacity_wh, float(100.0 * (generated - consumed) / consumed)


def evaluate(design, scenario, model=MODEL, quadrature="trapezoid"):
    """The whole chain, one design in one scenario. A buried wheel has NaN mobility and is stalled."""
    n_w, wheel, soil = design["wheel_count"], wheel_of(design), scenario["soil"]
    mass = total_mass_kg(design, scenario, model)
    weight_n, slope = mass * model["gravity_m_s2"] / n_w, radians(scenario["slope_deg"])
    load_n, pull_n = weight_n * cos(slope), weight_n * sin(slope)                       # Eq. (required-dp)
    slip, pulls = slip_balance(wheel, soil, load_n, pull_n, model, quadrature)
    forces = wheel_forces(wheel, soil, load_n, slip, model, quadrature)
    torque = forces["torque_nm"]
    stalled = not pulls or not torque <= design["peak_wheel_torque_nm"]
    speed, hub_limited = ((0.0, False) if stalled
                          else cruise_speed_m_s(design, scenario, slip, torque, model))
    # omega = v / (r (1 - s)); a wheel that has to be held back returns no energy to the pack
    omega = speed / (wheel["radius_m"] * (1.0 - slip)) if speed > 0.0 else 0.0
    mobility_w = max(0.0, n_w * torque * omega / model["drivetrain_efficiency"]) if speed > 0.0 else 0.0
    range_m, soc, balance_pct = traverse(design, scenario, mobility_w, speed, model)
    hot_c, cold_c = enclosure_temperatures_c(design, scenario, model)
    return {
        "range_km": range_m / 1e3, "total_mass_kg": mass,
        "slope_capability_deg": slope_capability_deg(wheel, soil, weight_n, model, quadrature),
        "energy_balance_pct": balance_pct, "stalled": stalled,
        "thermal_survival": hot_c <= model["limit_hot_c"] and cold_c >= model["limit_cold_c"],
        "slip": slip, "sinkage_m": forces["sinkage_m"], "wheel_torque_nm": torque,
        "cruise_speed_m_s": speed, "hub_speed_limited": hub_limited, "final_soc": soc,
        "hot_temperature_c": hot_c, "cold_temperature_c": cold_c,
        "obstacle_capability_m": obstacle_capability_m(design, model),
    }
