"""Wheel on soil: rigid-wheel Bekker-Wong contact with an engaged-grouser correction.

Equation names are those of the paper (Reifschneider, RoverDevKit): Bekker's pressure-sinkage law, the
Wong-Reece stress distribution, Janosi-Hanamoto shear, Mohr-Coulomb strength. Angles run from the downward
vertical, forward positive; the wheel touches soil from the exit at 0 to the entry angle theta_1.

Limits: rigid wheel, level homogeneous soil, steady state, no bulldozing, no rebound behind the wheel
(theta_2 = 0), no multi-pass. Checked against soft-soil tests only; on firm soil it sinks too far.

How it is solved. Each contact arc is mapped to [0, 1] and integrated by Gauss-Legendre, so that the nodes
move smoothly with entry angle and slip, and the exact derivatives of the forces come with the forces.
Entry angle, slip and slope capability are then Newton iterations over all lanes at once, with a bracket to
fall back on; a lane leaves the batch as soon as it has converged.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from . import _contact
from ._fields import Record, check, number, together

SLIP_MIN, SLIP_MAX = -0.9, 0.95                          # where the slip balance is sought
CAPABILITY_SLIP, CAPABILITY_LIMIT_DEG = 0.6, 35.0        # peak-pull convention; steepest slope reported


@dataclass(frozen=True)
class Soil(Record):
    """Bekker, Mohr-Coulomb and Janosi-Hanamoto parameters of a soil; each a number or an array.

    Parameters
    ----------
    sinkage_exponent : float or ndarray
        n of Bekker's law, positive, dimensionless.
    cohesive_modulus_kn_m_n1 : float or ndarray
        k_c in kN/m^(n+1). Fits to firm soil may be negative; k_c / b + k_phi must stay positive.
    frictional_modulus_kn_m_n2 : float or ndarray
        k_phi in kN/m^(n+2), positive.
    cohesion_kpa : float or ndarray
        c in kPa, zero or more.
    friction_angle_deg : float or ndarray
        phi in degrees, 0 to below 90.
    shear_modulus_mm : float or ndarray
        Shear-deformation modulus K in mm, positive.
    name : str
        A label; nothing is computed from it.

    Raises
    ------
    ValueError
        If a value is outside these limits or not finite, or if array lengths disagree.

    References
    ----------
    Bekker (1969); Janosi & Hanamoto (1961); Heiken et al. (1991), chapter 9.
    """
    sinkage_exponent: float = number(above=0, maximum=3)
    cohesive_modulus_kn_m_n1: float = number()
    frictional_modulus_kn_m_n2: float = number(above=0)
    cohesion_kpa: float = number(0)
    friction_angle_deg: float = number(0, below=90)
    shear_modulus_mm: float = number(above=0, default=18.0)
    name: str = ""


@dataclass(frozen=True)
class Wheel(Record):
    """A rigid wheel, smooth or with grousers; each field a number or an array.

    Parameters
    ----------
    radius_m, width_m : float or ndarray
        r and b in metres, positive.
    grouser_height_m : float or ndarray
        h_g in metres, zero or more.
    grouser_count : int or ndarray
        N_g, a whole number, zero or more.

    Raises
    ------
    ValueError
        If a value is outside these limits or not finite, or if array lengths disagree.
    """
    radius_m: float = number(above=0)
    width_m: float = number(above=0)
    grouser_height_m: float = number(0, default=0.0)
    grouser_count: int = number(0, whole=True, default=0)


class WheelForces(NamedTuple):
    """What a wheel does at given load and slip; NaN where the wheel is buried."""
    drawbar_pull_n: np.ndarray
    torque_nm: np.ndarray
    sinkage_m: np.ndarray
    entry_angle_rad: np.ndarray


class SlipBalance(NamedTuple):
    """Where the pull meets the demand; `stalled` where no slip can, `buried` where the soil cannot carry."""
    slip: np.ndarray
    drawbar_pull_n: np.ndarray
    torque_nm: np.ndarray
    sinkage_m: np.ndarray
    entry_angle_rad: np.ndarray
    stalled: np.ndarray
    buried: np.ndarray


class ContactStress(NamedTuple):
    """Stresses and soil displacement along the contact arc."""
    normal_stress_pa: np.ndarray
    shear_stress_pa: np.ndarray
    shear_displacement_m: np.ndarray
    transition_angle_rad: np.ndarray


def wheel_forces(wheel, soil, vertical_load_n, slip, *, transition_c1=0.4, transition_c2=0.2, grouser_lift_cap=0.6,
                 shear_scale=1.0):
    """Drawbar pull, torque and sinkage of one wheel at given load and slip.

    The entry angle is the one at which the soil's vertical reaction equals the load (the paper's force
    balance); forces follow from the stress integrals over the contact arc.

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    vertical_load_n : float or ndarray
        Load on the wheel in newtons, positive.
    slip : float or ndarray
        s = 1 - v / (omega r), eq. slip, from -1 to 1; negative when braking.
    transition_c1, transition_c2 : float or ndarray
        theta_m = (c_1 + c_2 |s|) theta_1 (Wong & Reece 1967).
    grouser_lift_cap : float or ndarray
        Largest relative gain in shear by grousers.
    shear_scale : float or ndarray
        Multiplies the shear stress: the paper's robustness study.

    Returns
    -------
    WheelForces
        `drawbar_pull_n` (N), `torque_nm` (N m), `sinkage_m` (m), `entry_angle_rad` (rad), each with the broadcast
        shape of all inputs, floats if every input is one. NaN where no entry angle in (0, 90 deg) carries the load.

    Raises
    ------
    ValueError
        If a load or slip is out of range or not finite, or if array lengths disagree.

    References
    ----------
    Wong & Reece (1967), doi:10.1016/0022-4898(67)90105-X; Janosi & Hanamoto (1961).

    Examples
    --------
    >>> soil = Soil(1.0, 1.4, 820.0, 0.17, 46.0, 18.0)
    >>> forces = wheel_forces(Wheel(0.10, 0.08, 0.015, 14), soil, vertical_load_n=6.0, slip=0.2)
    >>> f"{forces.drawbar_pull_n:.2f} N at {1000 * forces.sinkage_m:.1f} mm"
    '0.71 N at 5.7 mm'
    """
    load = check("vertical_load_n", vertical_load_n, above=0)
    slip = check("slip", slip, -1, 1)
    lanes, shape = _lanes(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale, load, slip)

    def solve(lanes):
        patch, (load, slip) = lanes[:9], lanes[9:]
        return _contact.carried(patch, slip, load)

    return WheelForces(*_contact.in_blocks(solve, lanes, shape))


def slip_balance(wheel, soil, vertical_load_n, required_pull_n, *, slip_min=SLIP_MIN, slip_max=SLIP_MAX,
                 transition_c1=0.4, transition_c2=0.2, grouser_lift_cap=0.6, shear_scale=1.0):
    """The slip at which the drawbar pull equals the pull that the slope demands.

    Two equations, vertical load and pull (eq. slip-balance), in two unknowns, entry angle and slip. Where the
    pull exceeds the demand at both ends of the slip interval, slip is 0; where it falls short at both ends,
    the wheel is stalled and slip is `slip_max`.

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    vertical_load_n, required_pull_n : float or ndarray
        Load on and pull demanded from one wheel, in newtons; the load positive.
    slip_min, slip_max : float or ndarray
        Ends of the slip interval.
    transition_c1, transition_c2, grouser_lift_cap, shear_scale : float or ndarray
        As in `wheel_forces`.

    Returns
    -------
    SlipBalance
        `slip`, forces and sinkage there, `stalled`, `buried`; NaN (and stalled) where the wheel is buried.

    Raises
    ------
    ValueError
        If an input is out of range or not finite, or if array lengths disagree.
    """
    load = check("vertical_load_n", vertical_load_n, above=0)
    pull = check("required_pull_n", required_pull_n)
    low = check("slip_min", slip_min, -1, 1)
    high = check("slip_max", slip_max, -1, 1)
    if np.any(np.asarray(low) >= high):
        raise ValueError(f"slip_min must be below slip_max; got {slip_min} and {slip_max}")
    lanes, shape = _lanes(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale, load, pull, low,
                          high)

    def solve(lanes):
        patch, (load, pull, low, high) = lanes[:9], lanes[9:]
        theta_high, _, pull_high = _contact.entry_angle(patch, high, load, np.zeros_like(load))
        return _contact.slip_balance(patch, load, pull, low, high, theta_high, pull_high, np.full_like(load, 0.3))

    return SlipBalance(*_contact.in_blocks(solve, lanes, shape))


def slope_capability(wheel, soil, weight_n, *, capability_slip=CAPABILITY_SLIP,
                     capability_limit_deg=CAPABILITY_LIMIT_DEG, transition_c1=0.4, transition_c2=0.2,
                     grouser_lift_cap=0.6, shear_scale=1.0):
    """Steepest slope that a wheel climbs at the slip of peak pull.

    On a slope alpha a wheel of weight w carries w cos(alpha) and must pull w sin(alpha). At fixed slip both are
    functions of the entry angle alone, so F_z^2 + DP^2 = w^2 fixes it and alpha = atan2(DP, F_z).

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    weight_n : float or ndarray
        Weight on one wheel (not its normal component) in newtons, positive.
    capability_slip : float or ndarray
        Slip at which the pull is taken; 0.6 by the peak-pull convention (Wong 2008).
    capability_limit_deg : float or ndarray
        Steeper slopes are reported as this one.
    transition_c1, transition_c2, grouser_lift_cap, shear_scale : float or ndarray
        As in `wheel_forces`.

    Returns
    -------
    float or ndarray
        Slope in degrees: 0 where the wheel cannot move on the flat or is buried.

    Raises
    ------
    ValueError
        If an input is out of range or not finite, or if array lengths disagree.
    """
    weight = check("weight_n", weight_n, above=0)
    slip = check("capability_slip", capability_slip, -1, 1)
    limit = check("capability_limit_deg", capability_limit_deg, 0, below=90)
    lanes, shape = _lanes(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale, weight, slip, limit)

    def solve(lanes):
        patch, (weight, slip, limit) = lanes[:9], lanes[9:]
        at_slip = _contact.entry_angle(patch, slip, weight, np.ones_like(weight))
        return (_contact.slope(patch, slip, *at_slip, limit),)

    return _contact.in_blocks(solve, lanes, shape)[0]


def climb(wheel, soil, weight_n, slope_deg, *, slip_min=SLIP_MIN, slip_max=SLIP_MAX, capability_slip=CAPABILITY_SLIP,
          capability_limit_deg=CAPABILITY_LIMIT_DEG, transition_c1=0.4, transition_c2=0.2, grouser_lift_cap=0.6,
          shear_scale=1.0):
    """Slip balance on a slope and slope capability in one call: what a mission needs of the wheel.

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    weight_n : float or ndarray
        Weight on one wheel in newtons, positive.
    slope_deg : float or ndarray
        Slope to climb, in degrees, above -90 and below 90.
    slip_min, slip_max, capability_slip, capability_limit_deg : float or ndarray
        As in `slip_balance` and `slope_capability`.
    transition_c1, transition_c2, grouser_lift_cap, shear_scale : float or ndarray
        As in `wheel_forces`.

    Returns
    -------
    SlipBalance
        At load weight * cos(slope) and required pull weight * sin(slope).
    float or ndarray
        Slope capability in degrees.

    Raises
    ------
    ValueError
        If an input is out of range or not finite, or if array lengths disagree.
    """
    weight = check("weight_n", weight_n, above=0)
    slope = np.radians(check("slope_deg", slope_deg, above=-90, below=90))
    low, high = check("slip_min", slip_min, -1, 1), check("slip_max", slip_max, -1, 1)
    slip = check("capability_slip", capability_slip, -1, 1)
    limit = check("capability_limit_deg", capability_limit_deg, 0, below=90)
    lanes, shape = _lanes(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale, weight, slope, low,
                          high, slip, limit)

    def solve(lanes):
        patch, (weight, slope, low, high, slip, limit) = lanes[:9], lanes[9:]
        load, count = weight * np.cos(slope), weight.size                # eq. required-dp
        # both entry angles in one batch: a batch twice as long costs less than two batches
        ends = _contact.entry_angle(np.tile(patch, 2), np.concatenate([high, slip]), np.concatenate([load, weight]),
                                   np.repeat([0.0, 1.0], count))
        (theta_high, _, pull_high), at_slip = ends[:, :count], ends[:, count:]
        # slip grows almost alike in all wheels and soils with the demand's share of the pull at the capability slip
        demand = np.tan(slope) * at_slip[1] / at_slip[2]
        guess = np.nan_to_num(slip * np.clip(demand, 0.1, 1.5) ** 1.25, nan=0.5)
        return (*_contact.slip_balance(patch, load, weight * np.sin(slope), low, high, theta_high, pull_high, guess),
                _contact.slope(patch, slip, *at_slip, limit))

    *balance, capability = _contact.in_blocks(solve, lanes, shape)
    return SlipBalance(*balance), capability


def contact_stress(wheel, soil, entry_angle_rad, slip, angle_rad, *, transition_c1=0.4, transition_c2=0.2,
                   grouser_lift_cap=0.6, shear_scale=1.0):
    """Normal and shear stress under the wheel at given angles, from the paper's stress distribution.

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    entry_angle_rad : float or ndarray
        theta_1 in radians, in (0, pi/2].
    slip : float or ndarray
        From -1 to 1.
    angle_rad : float or ndarray
        theta in radians from the downward vertical; outside [0, theta_1] the stresses are 0.
    transition_c1, transition_c2, grouser_lift_cap, shear_scale : float or ndarray
        As in `wheel_forces`.

    Returns
    -------
    ContactStress
        `normal_stress_pa`, `shear_stress_pa` (Pa), `shear_displacement_m` (m), `transition_angle_rad` (rad), with the
        broadcast shape of all inputs.

    Raises
    ------
    ValueError
        If an input is out of range or not finite, or if array lengths disagree.
    """
    entry = check("entry_angle_rad", entry_angle_rad, above=0, maximum=np.pi / 2)
    slip = check("slip", slip, -1, 1)
    angle = check("angle_rad", angle_rad)
    lanes, shape = _lanes(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale, entry, slip, angle)

    def stresses(lanes):
        r, _, A, n, c, tan_phi, K, c1, c2, theta_1, s, theta = lanes
        theta_m = (c1 + c2 * abs(s)) * theta_1                           # transition angle
        theta_star = np.where(theta < theta_m, theta_1 - theta / theta_m * (theta_1 - theta_m), theta)
        inside = (theta >= 0) & (theta <= theta_1)
        sigma = A * np.maximum(np.cos(theta_star) - np.cos(theta_1), 0) ** n        # eq. sigma
        j = r * ((theta_1 - theta) - (1 - s) * (np.sin(theta_1) - np.sin(theta)))   # shear displacement
        tau = (c + sigma * tan_phi) * -np.expm1(-abs(j) / K) * np.sign(j)           # eq. tau, gamma_g inside c, tan_phi
        return sigma * inside, tau * inside, j * inside, theta_m

    return ContactStress(*_contact.in_blocks(stresses, lanes, shape))


def grouser_lift(wheel, grouser_lift_cap=0.6):
    """Factor gamma_g by which engaged grousers raise the shear stress, eq. grouser; 1 for a smooth wheel.

    Parameters
    ----------
    wheel : Wheel
    grouser_lift_cap : float or ndarray
        Largest gain, dimensionless; beyond it the shear planes of neighbouring grousers interfere.

    Returns
    -------
    float or ndarray
        1 + min(N_g h_g / (2 pi r), cap).
    """
    return 1 + np.minimum(wheel.grouser_count * wheel.grouser_height_m / (2 * np.pi * wheel.radius_m),
                          grouser_lift_cap)


def compaction_resistance(wheel, soil, sinkage_m):
    """Force that compacting the rut costs: the work of Bekker's pressure down to the sinkage, per metre driven.

    A diagnostic: the kernel's drawbar pull already contains it.

    Parameters
    ----------
    wheel : Wheel
    soil : Soil
    sinkage_m : float or ndarray
        Rut depth in metres, zero or more.

    Returns
    -------
    float or ndarray
        b (k_c / b + k_phi) z^(n+1) / (n+1) in newtons.
    """
    z, n = check("sinkage_m", sinkage_m, 0), soil.sinkage_exponent
    return wheel.width_m * _k_eff(wheel, soil) * z ** (n + 1) / (n + 1)


# ---- the kernel -----------------------------------------------------------------------------------------------

def _k_eff(wheel, soil):
    """k_c / b + k_phi in Pa/m^n, eq. bekker; NaN where a fit's negative k_c makes it meaningless."""
    k = 1000 * (np.asarray(soil.cohesive_modulus_kn_m_n1) / wheel.width_m + soil.frictional_modulus_kn_m_n2)
    return np.where(k > 0, k, np.nan)[()]


def _patch(wheel, soil, transition_c1, transition_c2, grouser_lift_cap, shear_scale):
    """What the stress integrals need, in SI: r, b, k_eff r^n, n, gamma c, gamma tan(phi), K, c_1, c_2."""
    r, n = np.asarray(wheel.radius_m), soil.sinkage_exponent
    gamma = grouser_lift(wheel, grouser_lift_cap) * shear_scale
    return (r, wheel.width_m, _k_eff(wheel, soil) * r ** n, n, gamma * soil.cohesion_kpa * 1000,
            gamma * np.tan(np.radians(soil.friction_angle_deg)), np.asarray(soil.shear_modulus_mm) / 1000,
            transition_c1, transition_c2)


def _lanes(wheel, soil, c1, c2, cap, shear_scale, *arrays):
    """All inputs as rows of flat lanes, and the shape to give back."""
    c1 = check("transition_c1", c1, 0, 1)
    c2 = check("transition_c2", c2, 0, 1)
    if np.any(np.asarray(c1) + c2 > 1) or np.any(np.asarray(c1) <= 0):
        raise ValueError(f"transition_c1 must be above 0 and transition_c1 + transition_c2 at most 1; got {c1} and {c2}")
    cap = check("grouser_lift_cap", cap, 0)
    shear_scale = check("shear_scale", shear_scale, above=0)
    shape = together(wheel=wheel.shape, soil=soil.shape, transition_c1=np.shape(c1), transition_c2=np.shape(c2),
                     grouser_lift_cap=np.shape(cap), shear_scale=np.shape(shear_scale),
                     **{f"argument {i + 1}": np.shape(a) for i, a in enumerate(arrays)})
    rows = (*_patch(wheel, soil, c1, c2, cap, shear_scale), *arrays)
    return np.stack([np.broadcast_to(a, shape).ravel() for a in rows]), shape
