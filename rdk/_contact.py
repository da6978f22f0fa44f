"""The paper's contact patch: stress integrals with their derivatives, and the solvers built on them.

Works on flat lanes, one wheel a lane. `terramechanics` is the public face and picks this kernel or that of `_arc`: both
have `carried`, `balance`, `capability` and `climb`.
"""
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ._roots import inner_surplus

NODES = 12                                               # Gauss-Legendre nodes on each of the two arcs
BRAKING_NODES = 60                                       # the shear of a braking wheel changes sign within an arc
BLOCK = 512                                              # lanes whose (2, NODES, lanes) arrays stay in cache


class Patch(NamedTuple):
    """What the stress integrals need, in SI: one array a row, one wheel a lane."""
    r: np.ndarray                                        # radius
    b: np.ndarray                                        # width
    A: np.ndarray                                        # k_eff r^n
    n: np.ndarray                                        # sinkage exponent
    c: np.ndarray                                        # gamma_g cohesion
    tan_phi: np.ndarray                                  # gamma_g tan(phi)
    K: np.ndarray                                        # shear modulus
    c1: np.ndarray                                       # theta_m = (c_1 + c_2 |s|) theta_1
    c2: np.ndarray

    def take(self, lanes):
        """Some lanes."""
        return Patch(*[row.take(lanes) for row in self])


def both(rows):
    """Sum over both arcs; as `sum(0)`, faster."""
    return rows[0] + rows[1]


def within(x, low, high):
    """As `np.clip`, faster."""
    return np.minimum(np.maximum(x, low), high)


def rule_of(nodes):
    """Gauss-Legendre nodes on [0, 1], as a column, and their weights."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    return (x[:, None] + 1) / 2, w / 2


DRIVING, BRAKING = rule_of(NODES), rule_of(BRAKING_NODES)
STEP_DONE = 1e-5                                         # Newton converges quadratically: what is left is ~1e-9
HALF_PI = np.pi / 2


def at_nodes(theta_1, s, patch, u):
    """Geometry, normal stress and mobilised share of the shear strength at the nodes u in [0, 1] of both arcs.

    theta = a theta_1 with a(u) from theta_m / theta_1 = kappa to 1 on the front arc and from kappa to 0 on the
    rear one. The rear's theta* at a node is then the front's theta at the same u: one stress serves both arcs.
    """
    kappa = patch.c1 + patch.c2 * np.abs(s)
    a = np.empty((2, len(u), theta_1.size))
    np.multiply(u, 1 - kappa, out=a[0])
    a[0] += kappa
    np.multiply(1 - u, kappa, out=a[1])
    theta = a * theta_1
    sin, sin_1 = np.sin(theta), np.sin(theta_1)
    # angles are 0 to 90 deg, so the cosine is a root; twice as fast as cos
    cos, cos_1 = np.sqrt(1 - sin * sin), np.sqrt(1 - sin_1 * sin_1)
    depth = cos[0] - cos_1                                               # below the entry point, over r
    sigma = patch.A * (depth if (patch.n == 1).all() else depth ** patch.n)                  # eq. sigma
    # how far the soil has been sheared since the entry point, over r; the chord is what the wheel rolled
    chord = sin_1 - sin
    j = (theta_1 - theta) - (1 - s) * chord
    decay = np.exp(np.abs(j) * (-patch.r / patch.K))
    return kappa, a, sin, sin_1, cos, cos_1, depth, sigma, chord, decay, np.copysign(1 - decay, j)


class Arcs:
    """Stresses on both contact arcs; what they add up to, and how that changes."""

    def __init__(self, theta_1, s, patch, rule=DRIVING):
        u, w = rule
        kappa, *self.nodes = at_nodes(theta_1, s, patch, u)
        _, sin, _, cos, _, _, sigma, _, _, mobilised = self.nodes
        self.strength = sigma * patch.tan_phi
        self.strength += patch.c
        self.tau = tau = self.strength * mobilised                       # eq. tau
        # per unit of area: upward and forward part of both stresses
        self.vertical, self.forward = sigma * cos + tau * sin, tau * cos - sigma * sin
        self.span = np.array((theta_1 * (1 - kappa), theta_1 * kappa)) * (patch.b * patch.r)     # area
        self.mean_vertical, self.mean_forward = w @ self.vertical, w @ self.forward
        self.load, self.pull = both(self.span * self.mean_vertical), both(self.span * self.mean_forward)
        self.given = theta_1, s, patch, rule

    @property
    def torque(self):
        return both(self.span * (self.given[3][1] @ self.tau)) * self.given[2].r

    @cached_property
    def rates(self):
        """d sigma / d depth, and d tau / d (j / r) at fixed sigma."""
        patch, (*_, depth, sigma, _, decay, _) = self.given[2], self.nodes
        return sigma * patch.n / depth, self.strength * decay * (patch.r / patch.K)

    def _derivative(self, theta_x, sigma_x, j_x, span_x):
        """Of load and pull by a variable x, from what x does to the nodes' angle, sigma and j / r and to the areas."""
        (_, _, patch, (_, w)), (_, sin, _, cos, *_, mobilised) = self.given, self.nodes
        tau_x = self.rates[1] * j_x
        tau_x += mobilised * (sigma_x * patch.tan_phi)
        v_x = sigma_x * cos
        v_x += tau_x * sin
        v_x += theta_x * self.forward                                    # the direction of the stresses turns
        p_x = tau_x * cos
        p_x -= sigma_x * sin
        p_x -= theta_x * self.vertical
        return (both(self.span * (w @ v_x) + span_x * self.mean_vertical),
                both(self.span * (w @ p_x) + span_x * self.mean_forward))

    def by_entry(self):
        """Derivatives of load and pull by theta_1."""
        (theta_1, s, _, _), (a, sin, sin_1, cos, cos_1, *_) = self.given, self.nodes
        return self._derivative(a, self.rates[0] * (sin_1 - a[0] * sin[0]), (1 - a) - (1 - s) * (cos_1 - a * cos),
                                self.span / theta_1)

    def by_slip(self):
        """Derivatives of load and pull by s, which moves theta_m and with it every node."""
        (theta_1, s, patch, (u, _)), (_, sin, _, cos, _, _, _, chord, *_) = self.given, self.nodes
        kappa_s = patch.c2 * np.copysign(1.0, s) * theta_1
        theta_s = (1 - u) * kappa_s                      # on both arcs
        return self._derivative(theta_s, -self.rates[0] * sin[0] * theta_s, chord - theta_s * (1 - (1 - s) * cos),
                                np.array((-kappa_s, kappa_s)) * (patch.b * patch.r))


def forces(theta_1, s, patch, rule=DRIVING):
    """Vertical load, drawbar pull and torque of the stress integrals."""
    arcs = Arcs(theta_1, s, patch, rule)
    return arcs.load, arcs.pull, arcs.torque


# ---- one solve: the entry angle -------------------------------------------------------------------------------

def entry_angle(patch, s, target, with_pull=0.0, rule=DRIVING):
    """Entry angle where F_z = target, or sqrt(F_z^2 + DP^2) = target in lanes with `with_pull` = 1; F_z and DP there.

    NaN where there is none. Newton in log-log coordinates, where the load is close to a line in the entry angle.
    """
    r, b, A, n = patch[:4]
    # Bekker's closed form for a smooth free-rolling wheel, z^(n + 1/2) = 3 W / ((3 - n) b k_eff sqrt(2 r)), starts it
    z = (3 * target / (np.maximum(3 - n, 0.5) * b * r * A * np.sqrt(2))) ** (2 / (2 * n + 1))
    theta = np.minimum(np.sqrt(2 * z), 1.2)
    with_pull = with_pull + np.zeros_like(target)
    result = np.full((3, target.size), np.nan)
    lane = np.flatnonzero(np.isfinite(theta))
    if lane.size < theta.size:
        patch, s, target, with_pull, theta = patch.take(lane), s[lane], target[lane], with_pull[lane], theta[lane]
    low, high = np.zeros_like(theta), np.full_like(theta, HALF_PI)
    for _ in range(60):                                  # bisection alone needs 50; Newton needs 4 or 5
        if not lane.size:
            break
        arcs = Arcs(theta, s, patch, rule)
        load, pull, (load_t, pull_t) = arcs.load, arcs.pull, arcs.by_entry()
        del arcs                                         # its arrays are the next step's: they stay in cache
        held = np.sqrt(load * load + with_pull * pull * pull)
        slope = (load * load_t + with_pull * pull * pull_t) / held * theta
        held = np.where(load > 0, held, 0.0)
        low = np.where(held < target, theta, low)
        high = np.where(held < target, high, theta)
        miss = np.log(target / held)
        step = held / slope * miss
        newton = theta * np.exp(within(step, -1, 1))
        done = (np.abs(step) < STEP_DONE) & (np.abs(miss) < 10 * STEP_DONE)
        inside = (newton > low) & (newton < high)
        new, gone = newton, np.zeros_like(done)
        if not inside.all():
            # beyond the far end: look there once, since a wheel that does not hold there is buried
            new = np.where(inside, newton, np.where((newton >= high) & (high == HALF_PI) & (low < HALF_PI), HALF_PI,
                                                    (low + high) / 2))
            shut = high - low < 1e-14
            gone = (low == HALF_PI) | (shut & (high == HALF_PI))           # not carried below 90 degrees: buried
            done = (done | shut) & ~gone
        out = done | gone
        if out.any():
            last, to = np.where(inside, newton - theta, 0.0), lane[done]
            for row, value in zip(result, (theta + last, load + load_t * last, pull + pull_t * last)):
                row[to] = value[done]
            keep = np.flatnonzero(~out)
            lane, patch, s, target, with_pull, low, high, new = (
                kept.take(keep) for kept in (lane, patch, s, target, with_pull, low, high, new))
        theta = new
    return result


def braked(found, slip, function, *lanes):
    """What a function of lanes found by the rule for driving, the lanes that brake found anew by that for braking."""
    brakes = np.flatnonzero(slip < 0)
    if brakes.size:
        for whole, part in zip(found, function(*(a.take(brakes) for a in lanes), BRAKING)):
            whole[brakes] = part
    return found


def carried(patch, s, load):
    """Pull, torque, sinkage, entry angle and stress level of wheels that carry `load` at slip s."""
    theta = np.empty_like(load)
    for lane, rule in ((s >= 0, DRIVING), (s < 0, BRAKING)):
        if lane.any():
            lane = np.flatnonzero(lane)
            theta[lane] = entry_angle(patch.take(lane), s[lane], load[lane], rule=rule)[0]
    _, pull, torque = braked(forces(theta, s, patch), s, forces, theta, s, patch)
    return pull, torque, patch.r * (1 - np.cos(theta)), theta, np.where(np.isnan(theta), np.nan, 1.0)


# ---- slope capability -----------------------------------------------------------------------------------------

def capability(patch, weight, slip, limit_deg):
    """Slope in degrees on which the pull at a slip balances the weight's component along the slope."""
    return (_slope(patch, slip, *entry_angle(patch, slip, weight, 1.0), limit_deg),)


def _slope(patch, slip, theta_1, load, pull, limit_deg):
    """Slope from entry angle and forces at the capability slip; 0 for buried lanes and where nothing pulls."""
    load = load.copy()
    deep = np.flatnonzero(theta_1 > 0.7)                 # might be buried on the flat, where the load is largest
    if deep.size:
        flat = Arcs(np.full(deep.size, HALF_PI), slip[deep], patch.take(deep)).load
        load[deep[flat < np.hypot(load[deep], pull[deep])]] = np.nan
    return np.where(load > 0, np.clip(np.degrees(np.arctan2(pull, load)), 0, limit_deg), 0.0)


# ---- slip balance ---------------------------------------------------------------------------------------------

def balance(patch, load, required, low, high):
    """Slip balance from a plain first guess; what a `SlipBalance` holds."""
    theta_high, _, pull_high = entry_angle(patch, high, load)
    return _slip_balance(patch, load, required, low, high, theta_high, pull_high, np.full_like(load, 0.3))


def climb(patch, weight, slope_deg, low, high, slip, limit_deg):
    """Slip balance on a slope and slope capability in degrees."""
    slope, count = np.radians(slope_deg), weight.size
    load = weight * np.cos(slope)                        # eq. required-dp
    # both entry angles in one batch: a batch twice as long costs less than two batches
    twice = patch.take(np.tile(np.arange(count), 2))
    ends = entry_angle(twice, np.concatenate([high, slip]), np.concatenate([load, weight]),
                       np.repeat([0.0, 1.0], count))
    (theta_high, _, pull_high), at_slip = ends[:, :count], ends[:, count:]
    # slip grows almost alike in all wheels and soils with the demand's share of the pull at the capability slip
    demand = np.tan(slope) * at_slip[1] / at_slip[2]
    guess = np.where(np.isnan(demand), 0.5, slip * within(demand, 0.1, 1.5) ** 1.25)
    return (*_slip_balance(patch, load, weight * np.sin(slope), low, high, theta_high, pull_high, guess),
            _slope(patch, slip, *at_slip, limit_deg))


def _brakes(patch, load, low):
    """Lanes whose pull at the low end of the slip interval is surely negative: the exact pull would take a solve."""
    # where (1 - s) cos(theta_1) > 1 the soil slides forward under the whole arc, so shear only brakes
    theta_limit = np.arccos(np.minimum(1 / (1 - low), 1))
    return Arcs(theta_limit, low, patch).load > load


def _slip_balance(patch, *lanes):
    found = _balanced(patch, *lanes, DRIVING)
    return braked(found, found[0], _balanced, patch, *lanes)


def _balanced(patch, load, required, low, high, theta_high, pull_high, guess, rule):
    """Slip balance by one rule, from angle and pull at the high end of the slip interval and a first guess of slip."""
    unsure = np.flatnonzero(~((required >= 0) & _brakes(patch, load, low)))
    theta_low, surplus_low = np.full(load.shape, np.nan), np.zeros(load.shape, bool)
    if unsure.size:
        theta_low[unsure], _, pull_low = entry_angle(patch.take(unsure), low[unsure], load[unsure], rule=rule)
        surplus_low[unsure] = pull_low > required[unsure]
    buried, short = np.isnan(pull_high), pull_high < required
    crossing = ~buried & (surplus_low == short)
    stalled = ~buried & ~crossing & short                # a deficit at both ends
    slides = ~buried & ~crossing & ~short & (low <= 0)   # a surplus at both ends: the wheel cannot brake enough
    slip = np.where(buried | stalled, high, np.where(slides, low, 0.0))
    theta = np.where(buried | stalled, theta_high, np.where(slides, theta_low, np.nan))
    lane = np.flatnonzero(stalled | slides)
    if lane.size:                                        # both ends alike, but the pull may peak or dip between them
        found = _inner_balance(*(a.take(lane) for a in (patch, load, required, low, high, stalled, theta)), rule)
        kept = np.isfinite(found[0])
        lane, found = lane[kept], found[:, kept]
        slip[lane], theta[lane] = found
        stalled[lane] = slides[lane] = False
    lane = np.flatnonzero(crossing)
    if lane.size:
        slip[lane], theta[lane] = newton_balance(
            *(a.take(lane) for a in (patch, load, required, low, high, theta_high, guess)), rule)
    free = np.flatnonzero(~buried & ~crossing & ~short & (low > 0))
    if free.size:                                        # not even the lowest slip of a driving interval is needed
        theta[free], _, _ = entry_angle(patch.take(free), slip[free], load[free], rule=rule)
    _, pull, torque = forces(theta, slip, patch, rule)
    buried = np.isnan(pull)                              # also where the soil gives way inside the slip interval
    slip[buried] = np.nan
    return slip, pull, torque, patch.r * (1 - np.cos(theta)), theta, stalled | slides | buried, buried, slides & ~buried


def _inner_balance(patch, load, required, low, high, short, theta_end, rule):
    """Slip and entry angle of a balance between two ends of one sign; NaN where there is none.

    `short` lanes pull too little at both ends and may peak between them: theirs is the root below the peak. The others
    pull too much and may dip: theirs is the root above the dip.
    """
    result = np.full((2, load.size), np.nan)
    arcs = Arcs(theta_end, np.where(short, high, low), patch, rule)
    (load_t, pull_t), (load_s, pull_s) = arcs.by_entry(), arcs.by_slip()
    # the pull falls with slip, per unit of it, and most at the end of a single peak: enough for what is missing there?
    fall = pull_t * load_s / load_t - pull_s
    lane = np.flatnonzero(fall * (high - low) > np.abs(required - arcs.pull))
    if not lane.size:
        return result
    patch, load, required, low, high, short = (a.take(lane) for a in (patch, load, required, low, high, short))

    def surplus(s, i):
        gap = entry_angle(patch.take(i), s, load[i], rule=rule)[2] - required[i]
        return np.where(short[i], gap, -gap)

    s = inner_surplus(surplus, low, high)
    has = np.flatnonzero(np.isfinite(s))
    if has.size:
        low, high = np.where(short, low, s)[has], np.where(short, s, high)[has]
        result[:, lane[has]] = bracketed_balance(patch.take(has), load[has], required[has], low, high, rule)
    return result


def newton_balance(patch, load, required, low, high, theta, guess, rule):
    """Slip and entry angle of lanes whose balance is bracketed: Newton on both, bisection on slip for the rest."""
    s = np.clip(guess, low, high)
    result = np.full((2, load.size), np.nan)
    lane = np.arange(load.size)
    everything = patch, load, required, low, high
    for _ in range(12):
        if not lane.size:
            break
        arcs = Arcs(theta, s, patch, rule)
        (fz_t, dp_t), (fz_s, dp_s) = arcs.by_entry(), arcs.by_slip()
        f, g = load - arcs.load, required - arcs.pull
        del arcs
        det = fz_t * dp_s - fz_s * dp_t
        d_theta, d_s = (f * dp_s - g * fz_s) / det, (g * fz_t - f * dp_t) / det
        new_theta = within(theta + d_theta, theta / 2, np.minimum(theta * 1.5, HALF_PI))
        new_s = within(s + within(d_s, -0.3, 0.3), low, high)
        done = (np.abs(d_theta) < STEP_DONE) & (np.abs(d_s) < STEP_DONE) & (np.abs(new_s - s - d_s) < STEP_DONE)
        if done.any():
            result[:, lane[done]] = new_s[done], new_theta[done]
            keep = np.flatnonzero(~done)
            lane, patch, load, required, low, high, new_theta, new_s = (
                kept.take(keep) for kept in (lane, patch, load, required, low, high, new_theta, new_s))
        theta, s = new_theta, new_s
    lost = np.flatnonzero(np.isnan(result[0]))
    if lost.size:
        result[:, lost] = bracketed_balance(*(a.take(lost) for a in everything), rule)
    return result


def bracketed_balance(patch, load, required, low, high, rule):
    """Slip and entry angle by a bracketing root finder on slip alone, the entry angle solved anew at each slip."""
    from scipy.optimize.elementwise import find_root

    def surplus(s, index):
        i = index.astype(int)
        return entry_angle(patch.take(i), s, load[i], rule=rule)[2] - required[i]

    s = find_root(surplus, (low, high), args=(np.arange(load.size),), tolerances={"xatol": 1e-12}).x
    return s, entry_angle(patch, s, load, rule=rule)[0]
