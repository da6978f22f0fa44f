"""Wheel on soil: rigid-wheel Bekker-Wong contact with an engaged-grouser correction.

Equation names are those of the paper (Reifschneider, RoverDevKit): Bekker's pressure-sinkage law, the Wong-Reece stress
distribution, Janosi-Hanamoto shear, Mohr-Coulomb strength. Angles run from the downward vertical, forward positive; the
wheel touches soil from the exit at 0 to the entry angle theta_1.

Limits: rigid wheel, level homogeneous soil, steady state, no bulldozing, no rebound behind the wheel (theta_2 = 0), no
multi-pass. Checked against soft-soil tests only; on firm soil it sinks too far. At slips near -1 on soil of high
cohesion (10 kPa) and small K (below 3 mm) the integrals are good to 0.4 % of the load, and more than one entry angle
may carry it: do not trust the pull there.

Arrays broadcast; a float comes back where every input is one.
"""
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _arc, _contact
from ._fields import Record, brief, check, described, in_rows, number, require, together, unknown

SLIP_MIN, SLIP_MAX = -0.9, 0.95                          # where the slip balance is sought
CAPABILITY_SLIP, CAPABILITY_LIMIT_DEG = 0.6, 35.0        # peak-pull convention; steepest slope reported
KERNELS = {"paper": _contact, "imposed-arc": _arc}
SINKAGE = {"carried": 2, "balance": 3, "climb": 3}       # its place among what a solver of a kernel finds
TRANSITIONS = {"paper": (0.4, 0.2), "imposed-arc": (0.18, 0.32)}         # c_1 and c_2 (Wong & Reece 1967)


@dataclass(frozen=True)
class Soil(Record):
    """Bekker, Mohr-Coulomb and Janosi-Hanamoto parameters of a soil.

    Bekker (1969); Janosi & Hanamoto (1961); Heiken et al. (1991), chapter 9.
    """
    example = "rdk.soil('apollo-nominal')"
    sinkage_exponent: float = number(above=0, maximum=3, doc="n of Bekker's law.")
    cohesive_modulus_kn_m_n1: float = number(doc="k_c. Fits to firm soil may be negative; k_c / b + k_phi is not.")
    frictional_modulus_kn_m_n2: float = number(above=0, doc="k_phi.")
    cohesion_kpa: float = number(0, doc="c.")
    friction_angle_deg: float = number(0, below=90, doc="phi.")
    shear_modulus_mm: float = number(above=0, default=18.0, doc="Shear-deformation modulus K.")
    name: str = described("A label; nothing is computed from it.", default="")


@dataclass(frozen=True)
class Wheel(Record):
    """A rigid wheel, smooth or with grousers."""
    example = "rdk.rover('Rashid-1').wheel"
    radius_m: float = number(above=0, doc="r.")
    width_m: float = number(above=0, doc="b.")
    grouser_height_m: float = number(0, default=0.0, doc="h_g.")
    grouser_count: int = number(0, whole=True, default=0, doc="N_g.")


@dataclass(frozen=True)
class KernelOptions(Record):
    """The options that every solver here takes by keyword, and part of `Model`: how the soil answers.

    "paper": the entry angle is the one whose stresses carry the load. "imposed-arc": static sinkage and a factor for
    slip fix the entry angle, and the load fixes how hard the arc presses. Its sinkage errs half as much on the measured
    wheels, its pull does not err less: a second opinion. Smooth wheels above slip 0.6 sink too far in it; near
    slip 0 its stress level is near 2, since a rolling wheel's arc has one side and a static one two; where cohesion
    alone more than carries the load the level is negative.

    Wong & Reece (1967), doi:10.1016/0022-4898(67)90105-X; Yoshida et al. (2003); Lyasko (2010).
    """
    kernel: str = described('"paper" or "imposed-arc".', default="paper")
    transition_c1: float | None = number(
        above=0, maximum=1, default=None, optional=True, doc="theta_m = (c_1 + c_2 |s|) theta_1. None is the kernel's "
        "own: 0.4 in the paper's, 0.18 in the other (loose sand).")
    transition_c2: float | None = number(0, 1, default=None, optional=True, doc="None is 0.2 and 0.32.")
    grouser_lift_cap: float = number(0, default=0.6, doc="Largest relative gain in shear by grousers.")
    shear_scale: float = number(above=0, default=1.0, doc="Multiplies the shear stress: the paper's robustness study.")
    sinkage_scale: float = number(above=0, default=1.0, doc="Multiplies the sinkage reported; the forces stay.")

    def __post_init__(self):
        if not isinstance(self.kernel, str) or self.kernel not in TRANSITIONS:
            raise unknown("unknown kernel", self.kernel, list(TRANSITIONS))
        super().__post_init__()
        c1, c2 = self.transition
        if np.any(np.asarray(c1) + c2 > 1):
            raise ValueError(f"transition_c1 + transition_c2 must be at most 1; got {c1} + {c2}")

    @property
    def transition(self):
        """The transition coefficients c_1 and c_2 in use: the kernel's own where none is given."""
        own = TRANSITIONS[self.kernel]
        return (own[0] if self.transition_c1 is None else self.transition_c1,
                own[1] if self.transition_c2 is None else self.transition_c2)


OPTIONS = tuple(f.name for f in fields(KernelOptions))


class WheelForces(NamedTuple):
    """What a wheel does at given load and slip; NaN where the wheel is buried.

    `stress_level` is the factor on the normal stress: 1 in the paper's kernel.
    """
    drawbar_pull_n: np.ndarray
    torque_nm: np.ndarray
    sinkage_m: np.ndarray
    entry_angle_rad: np.ndarray
    stress_level: np.ndarray

    __repr__ = brief


class SlipBalance(NamedTuple):
    """Where the pull meets the demand; NaN and stalled where the wheel is buried, stalled where it slides."""
    slip: np.ndarray
    drawbar_pull_n: np.ndarray
    torque_nm: np.ndarray
    sinkage_m: np.ndarray
    entry_angle_rad: np.ndarray
    stalled: np.ndarray
    buried: np.ndarray
    sliding: np.ndarray

    __repr__ = brief


class ContactStress(NamedTuple):
    """Stresses and soil displacement along the contact arc."""
    normal_stress_pa: np.ndarray
    shear_stress_pa: np.ndarray
    shear_displacement_m: np.ndarray
    transition_angle_rad: np.ndarray

    __repr__ = brief


def wheel_forces(wheel: Wheel, soil: Soil, vertical_load_n: ArrayLike, slip: ArrayLike, **options) -> WheelForces:
    """Drawbar pull, torque and sinkage of one wheel at given load and slip.

    NaN where no entry angle in (0, 90 deg) carries the load, which is positive. The slip s = 1 - v / (omega r), eq.
    slip, is -1 to 1 and negative when braking; the options are those of `KernelOptions`.

    Examples
    --------
    >>> soil = Soil(1.0, 1.4, 820.0, 0.17, 46.0, 18.0)
    >>> forces = wheel_forces(Wheel(0.10, 0.08, 0.015, 14), soil, vertical_load_n=6.0, slip=0.2)
    >>> f"{forces.drawbar_pull_n:.2f} N at {1000 * forces.sinkage_m:.1f} mm"
    '0.71 N at 5.7 mm'
    """
    return WheelForces(*_solve("carried", wheel, soil, options, slip=slip, vertical_load_n=vertical_load_n))


def slip_balance(wheel: Wheel, soil: Soil, vertical_load_n: ArrayLike, required_pull_n: ArrayLike, *,
                 slip_min: ArrayLike = SLIP_MIN, slip_max: ArrayLike = SLIP_MAX, **options) -> SlipBalance:
    """The slip at which the drawbar pull equals the pull that the slope demands.

    Two equations, vertical load and pull (eq. slip-balance), in two unknowns, entry angle and slip. Where the pull
    falls short of the demand throughout the slip interval the wheel is stalled, at `slip_max`; where it exceeds it
    throughout, the wheel slides, at `slip_min` (in an interval above 0 it rolls instead, without slip). Where the pull
    peaks inside the interval and meets the demand twice, the lower slip is the answer. Load (positive) and demand are
    those of one wheel.
    """
    return SlipBalance(*_solve("balance", wheel, soil, options, vertical_load_n=vertical_load_n,
                               required_pull_n=required_pull_n, slip_min=slip_min, slip_max=slip_max))


def slope_capability(wheel: Wheel, soil: Soil, weight_n: ArrayLike, *, capability_slip: ArrayLike = CAPABILITY_SLIP,
                     capability_limit_deg: ArrayLike = CAPABILITY_LIMIT_DEG, **options) -> float | np.ndarray:
    """Steepest slope in degrees that a wheel climbs at the slip of peak pull; 0 where it is buried or cannot move.

    On a slope alpha a wheel of weight w (positive, not its normal component) carries w cos(alpha) and must pull
    w sin(alpha). At fixed slip - 0.6 by the peak-pull convention (Wong 2008) - both are functions of the entry angle
    alone, so F_z^2 + DP^2 = w^2 fixes it and alpha = atan2(DP, F_z). Steeper slopes than the limit are reported as it.
    """
    return _solve("capability", wheel, soil, options, weight_n=weight_n, capability_slip=capability_slip,
                  capability_limit_deg=capability_limit_deg)[0]


def climb(wheel: Wheel, soil: Soil, weight_n: ArrayLike, slope_deg: ArrayLike, *, slip_min: ArrayLike = SLIP_MIN,
          slip_max: ArrayLike = SLIP_MAX, capability_slip: ArrayLike = CAPABILITY_SLIP,
          capability_limit_deg: ArrayLike = CAPABILITY_LIMIT_DEG, **options) -> tuple[SlipBalance, float | np.ndarray]:
    """Slip balance on a slope and slope capability in one call: what a mission needs of the wheel.

    The balance is that of load weight * cos(slope) and required pull weight * sin(slope), eq. required-dp, with the
    slope above -90 and below 90 degrees.
    """
    return climbed(wheel, soil, options, weight_n=weight_n, slope_deg=slope_deg, slip_min=slip_min, slip_max=slip_max,
                   capability_slip=capability_slip, capability_limit_deg=capability_limit_deg)


def climbed(wheel, soil, options, **arrays):
    """What `climb` returns; `options` may be a KernelOptions, such as a Model: then no number is checked again."""
    *balance, capability = _solve("climb", wheel, soil, options, **arrays)
    return SlipBalance(*balance), capability


def contact_stress(wheel: Wheel, soil: Soil, entry_angle_rad: ArrayLike, slip: ArrayLike, angle_rad: ArrayLike, *,
                   stress_level: ArrayLike = 1.0, **options) -> ContactStress:
    """Normal and shear stress under the wheel at given angles, from the paper's stress distribution.

    Angles run from the downward vertical; outside 0 to the entry angle, itself in (0, pi/2], the stresses are 0. The
    stress level multiplies the normal stress, as `wheel_forces` returns it.
    """
    def stresses(patch, theta_1, s, theta, level):
        theta_m = (patch.c1 + patch.c2 * abs(s)) * theta_1               # transition angle
        theta_star = np.where(theta < theta_m, theta_1 - theta / theta_m * (theta_1 - theta_m), theta)
        inside = (theta >= 0) & (theta <= theta_1)
        depth = np.maximum(np.cos(theta_star) - np.cos(theta_1), 0)
        sigma = level * (patch.A * depth ** patch.n)                     # eq. sigma
        # shear displacement
        j = patch.r * ((theta_1 - theta) - (1 - s) * (np.sin(theta_1) - np.sin(theta)))
        # eq. tau, gamma_g inside c and tan_phi
        tau = (patch.c + sigma * patch.tan_phi) * -np.expm1(-abs(j) / patch.K) * np.sign(j)
        return sigma * inside, tau * inside, j * inside, theta_m

    return ContactStress(*_solve(stresses, wheel, soil, options, entry_angle_rad=entry_angle_rad, slip=slip,
                                 angle_rad=angle_rad, stress_level=stress_level))


def grouser_lift(wheel: Wheel, grouser_lift_cap: ArrayLike = 0.6) -> float | np.ndarray:
    """Factor 1 + min(N_g h_g / (2 pi r), cap) by which engaged grousers raise the shear stress, eq. grouser.

    Beyond the cap the shear planes of neighbouring grousers interfere.
    """
    require(wheel=(wheel, Wheel))
    return 1 + np.minimum(wheel.grouser_count * wheel.grouser_height_m / (2 * np.pi * wheel.radius_m),
                          grouser_lift_cap)


# ---- from records to lanes ------------------------------------------------------------------------------------

def _k_eff(wheel, soil):
    """k_c / b + k_phi in Pa/m^n, eq. bekker; NaN where a fit's negative k_c makes it meaningless."""
    k = 1000 * (np.asarray(soil.cohesive_modulus_kn_m_n1) / wheel.width_m + soil.frictional_modulus_kn_m_n2)
    return np.where(k > 0, k, np.nan)[()]


_LIMITS = {"vertical_load_n": dict(above=0), "weight_n": dict(above=0), "slope_deg": dict(above=-90, below=90),
           "capability_limit_deg": dict(minimum=0, below=90), "entry_angle_rad": dict(above=0, maximum=np.pi / 2)} | {
    name: dict(minimum=-1, maximum=1) for name in ("slip", "slip_min", "slip_max", "capability_slip")}


def patch_of(wheel, soil, options, **arrays):
    """The patch and the arrays as flat lanes, and the shape to give back."""
    require(wheel=(wheel, Wheel), soil=(soil, Soil))
    shape = together(wheel=wheel.shape, soil=soil.shape, **{
        name: np.shape(value) for name, value in (arrays | {n: getattr(options, n) for n in OPTIONS[1:]}).items()
        if isinstance(value, np.ndarray)})
    r, n = np.asarray(wheel.radius_m), soil.sinkage_exponent
    gamma = grouser_lift(wheel, options.grouser_lift_cap) * options.shear_scale
    lanes = in_rows((
        r, wheel.width_m, _k_eff(wheel, soil) * r ** n, n, gamma * soil.cohesion_kpa * 1000,
        gamma * np.tan(np.radians(soil.friction_angle_deg)), np.asarray(soil.shear_modulus_mm) / 1000,
        *options.transition, *arrays.values()), shape)
    count = len(_contact.Patch._fields)
    return _contact.Patch(*lanes[:count]), lanes[count:], shape


def _solve(solver, wheel, soil, options, **arrays):
    """A solver of the kernel (or a function) on blocks of lanes that fit the cache; floats for one lane."""
    if isinstance(options, dict):
        for name in options:
            if name not in OPTIONS:
                raise TypeError(str(unknown("unexpected keyword argument", name, OPTIONS)))
        options = KernelOptions(**options)
        arrays = {name: check(name, value, **_LIMITS.get(name, {})) for name, value in arrays.items()}
        if np.any(np.asarray(arrays.get("slip_min", -1)) >= arrays.get("slip_max", 1)):
            raise ValueError(f"slip_min must be below slip_max; got {arrays['slip_min']} and {arrays['slip_max']}")
    patch, lanes, shape = patch_of(wheel, soil, options, **arrays)
    solve, count = solver if callable(solver) else getattr(KERNELS[options.kernel], solver), lanes.shape[1]
    with np.errstate(all="ignore"):                      # a lane without a solution is NaN, not a warning
        blocks = [slice(i, i + _contact.BLOCK) for i in range(0, max(count, 1), _contact.BLOCK)]
        parts = [solve(_contact.Patch(*[row[block] for row in patch]), *lanes[:, block]) for block in blocks]
    joined = [(np.concatenate(part) if part[1:] else part[0]).reshape(shape) for part in zip(*parts)]
    if solver in SINKAGE:
        joined[SINKAGE[solver]] = joined[SINKAGE[solver]] * options.sinkage_scale
    return [a if shape else a.item() for a in joined]
