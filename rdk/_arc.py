"""The imposed arc: static sinkage and a factor for slip fix the contact arc, the load fixes how hard it presses.

The static wheel sinks until the stress under both halves of its arc carries the load (Yoshida et al. 2003, eq. 10).
Slip deepens that by (1 + |s|) / (1 - 0.5 |s|) (Lyasko 2010). On the arc so given the normal stress has the paper's
shape, times a level that the vertical balance gives in closed form. Same lanes and same functions as `_contact`.
"""
import numpy as np

from ._contact import HALF_PI, at_nodes, both, rule_of, within
from ._roots import inner_surplus, root

NODES, BRAKING_NODES = 12, 16                            # on each arc; on each of the four parts of a braking wheel's


def graded(nodes):
    """Nodes on [0, 1], crowded at both ends where stress and shear begin as powers, and their weights."""
    u, w = rule_of(nodes)
    return u * u * (3 - 2 * u), 6 * u[:, 0] * (1 - u[:, 0]) * w


(DRIVING, WEIGHT), (BRAKING, BRAKING_WEIGHT) = graded(NODES), graded(BRAKING_NODES)


# ---- the arc --------------------------------------------------------------------------------------------------

def static_load(theta_s, patch):
    """Load that a wheel at rest carries on an arc of theta_s on either side, and d ln(load) / d ln(theta_s)."""
    t = DRIVING * theta_s
    sin, cos = np.sin(t), np.cos(t)
    depth = cos - np.cos(theta_s)
    pressure = depth if (patch.n == 1).all() else depth ** patch.n
    held = WEIGHT @ (pressure * cos)
    # the nodes move with theta_s: depth, direction and arc length change
    change = WEIGHT @ (pressure * (patch.n / depth * (np.sin(theta_s) - DRIVING * sin) * cos - DRIVING * sin))
    return 2 * patch.b * patch.r * patch.A * theta_s * held, 1 + theta_s * change / held


def static_angle(patch, load):
    """theta_s that carries `load` at rest; NaN where 90 degrees do not. Newton in log-log coordinates."""
    r, b, A, n = patch[:4]
    # twice the load of Bekker's closed form for the front half alone
    z = (3 * load / (2 * np.maximum(3 - n, 0.5) * b * r * A * np.sqrt(2))) ** (2 / (2 * n + 1))
    theta = np.minimum(np.sqrt(2 * z), HALF_PI)
    for _ in range(40):
        held, power = static_load(theta, patch)
        step = np.log(load / held) / power
        theta, last = np.minimum(theta * np.exp(within(step, -2, 2)), HALF_PI), theta
        if not np.any(np.abs(theta - last) > 1e-6 * theta):      # converges quadratically: what is left is ~1e-12
            break
    return np.where((theta < HALF_PI) & (np.abs(step) < 1e-5), theta, np.nan)


def entry_angle(theta_s, s):
    """theta_1 at slip s from the static angle; NaN where the wheel sinks to its axle."""
    deeper = (1 + np.abs(s)) / (1 - 0.5 * np.abs(s))     # z / z_0
    half = np.sin(theta_s / 2) * np.sqrt(deeper)         # z / (2 r) = sin^2(theta_1 / 2)
    return 2 * np.arcsin(np.where(2 * half * half < 1, half, np.nan))


def reversal(theta_1, s):
    """Angle at which the shear of a braking wheel changes sign; 0 where it has one sign on the whole arc."""
    theta, k = np.zeros_like(theta_1), 1 - s
    if not (theta_1 < k * np.sin(theta_1)).any():
        return theta
    for _ in range(9):                                   # j is concave and starts below 0: Newton comes from one side
        j = (theta_1 - theta) - k * (np.sin(theta_1) - np.sin(theta))
        theta = theta - np.minimum(j, 0) / (k * np.cos(theta) - 1)
    return np.where((theta_1 < k * np.sin(theta_1)) & (k * np.cos(theta_1) < 1), theta, 0.0)


def shares(theta_1, s, patch):
    """Load, pull and torque of the normal stress at level 1 with its friction, then those of cohesion alone."""
    brakes = np.flatnonzero(s < 0)
    if not brakes.size:
        return _shares(theta_1, s, patch, 0.0, 1.0, DRIVING, WEIGHT)
    whole, lane = np.empty((6, theta_1.size)), np.flatnonzero(s >= 0)
    if lane.size:
        whole[:, lane] = _shares(theta_1[lane], s[lane], patch.take(lane), 0.0, 1.0, DRIVING, WEIGHT)
    theta_1, s, patch = theta_1[brakes], s[brakes], patch.take(brakes)
    # both arcs are cut where the shear changes sign on one of them: nothing that the nodes see has a kink
    kappa, at = patch.c1 + patch.c2 * np.abs(s), reversal(theta_1, s) / theta_1
    cut = np.where(at > kappa, (at - kappa) / (1 - kappa), 1 - at / kappa)
    whole[:, brakes] = sum(_shares(theta_1, s, patch, *part, BRAKING, BRAKING_WEIGHT)
                           for part in ((0.0, cut), (cut, 1.0)))
    return whole


def _shares(theta_1, s, patch, start, end, nodes, weight):
    """From the part of both arcs between the nodes' u = start and end."""
    r, c = patch.r, patch.c
    kappa, _, sin, _, cos, _, _, sigma, *_, mobilised = at_nodes(theta_1, s, patch, start + nodes * (end - start))
    friction = sigma * mobilised * patch.tan_phi                         # eq. tau at level 1, less cohesion
    span = np.array((1 - kappa, kappa)) * ((end - start) * theta_1 * patch.b * r)        # area of each arc
    v, p, t, v_c, p_c, t_c = [both(span * (weight @ f)) for f in (
        sigma * cos + friction * sin, friction * cos - sigma * sin, friction,
        mobilised * sin, mobilised * cos, mobilised)]
    return np.stack([v, p, r * t, c * v_c, c * p_c, r * c * t_c])


def state(patch, s, load, theta_s):
    """Pull, torque, entry angle and stress level at slip s; NaN where the wheel sinks to its axle."""
    theta_1 = entry_angle(theta_s, s)
    v, p, t, v_c, p_c, t_c = shares(theta_1, s, patch)
    # no level carries where braking shear drags a wheel down by more than the normal stress lifts it
    theta_1, v = np.where(v > 0, [theta_1, v], np.nan)
    level = (load - v_c) / v                                             # vertical balance
    return level * p + p_c, level * t + t_c, theta_1, level


# ---- the solvers, as in `_contact` ----------------------------------------------------------------------------

def carried(patch, s, load):
    """Pull, torque, sinkage, entry angle and stress level of wheels that carry `load` at slip s."""
    pull, torque, theta_1, level = state(patch, s, load, static_angle(patch, load))
    return pull, torque, patch.r * (1 - np.cos(theta_1)), theta_1, level


def capability(patch, weight, slip, limit_deg):
    """Slope in degrees on which the pull at a slip balances the weight's component along the slope."""
    return (_slope(patch, weight, slip, limit_deg, static_angle(patch, weight)),)


def _slope(patch, weight, slip, limit_deg, theta_w):
    """From the static angle under the whole weight: load and pull are explicit in the static angle, so one root."""
    flat = state(patch, slip, weight, theta_w)[0]
    alpha = np.zeros_like(weight)
    lane = np.flatnonzero(flat > 0)                      # neither buried nor without pull on the flat
    if not lane.size:
        return alpha
    patch, weight, slip, theta_w, flat = patch.take(lane), weight[lane], slip[lane], theta_w[lane], flat[lane]

    def pulled(x, i):
        theta_s, part = np.exp(x), patch.take(i)
        load, _ = static_load(theta_s, part)
        return load, state(part, slip[i], load, theta_s)[0]

    def miss(x, i):
        return np.log(np.hypot(*pulled(x, i)) / weight[i])

    high, every = np.log(theta_w), np.arange(lane.size)
    at_high = np.log(np.hypot(weight, flat) / weight)
    low = high - 2 * at_high / (2 * patch.n + 1) - 0.01  # load and pull fall about as theta_s^(2 n + 1)
    at_low = miss(low, every)
    if (at_low > 0).any():                               # cohesion pulls: its force falls about as theta_s squared
        low = np.where(at_low > 0, np.maximum(high - 2 * at_high - 0.5, np.log(1e-5)), low)
        at_low = miss(low, every)
    x = root(miss, low, high, at_low, at_high, high - at_high * (high - low) / (at_high - at_low))
    x = np.where(at_low > 0, low, x)                     # so light that it climbs a wall
    load, pull = pulled(x, every)
    alpha[lane] = np.nan_to_num(np.clip(np.degrees(np.arctan2(pull, load)), 0, limit_deg[lane]))
    return alpha


def balance(patch, load, required, low, high):
    """Slip balance; what a `SlipBalance` holds."""
    return _balanced(patch, load, required, low, high, static_angle(patch, load))


def climb(patch, weight, slope_deg, low, high, slip, limit_deg):
    """Slip balance on a slope and slope capability in degrees."""
    slope, count = np.radians(slope_deg), weight.size
    load = weight * np.cos(slope)                        # eq. required-dp
    theta_s = static_angle(patch.take(np.tile(np.arange(count), 2)), np.concatenate([load, weight]))
    return (*_balanced(patch, load, weight * np.sin(slope), low, high, theta_s[:count]),
            _slope(patch, weight, slip, limit_deg, theta_s[count:]))


def _balanced(patch, load, required, low, high, theta_s):
    """The root of pull = demand in slip, on the side of s = 0 where the pull at s = 0 says that it lies."""
    def gap(s, i):
        return np.nan_to_num(state(patch.take(i), s, load[i], theta_s[i])[0] - required[i], nan=-np.inf)

    # the slip at which the wheel has dug itself in to the axle ends the interval: (1 + s) / (1 - 0.5 s) = r / z_0
    q = 1 / (2 * np.sin(theta_s / 2) ** 2)
    dug_in = (q - 1) / (1 + q / 2) * (1 - 1e-9)
    left, right = np.maximum(low, -dug_in), np.minimum(high, dug_in)
    middle, every = np.clip(0.0, left, right), np.arange(load.size)
    g_middle, g_right = gap(np.concatenate([middle, right]), np.tile(every, 2)).reshape(2, -1)
    drives, g_left = g_middle < 0, np.full(load.shape, np.nan)
    lane = np.flatnonzero(~drives)
    if lane.size:
        g_left[lane] = gap(left[lane], lane)
    a, b = np.where(drives, middle, left), np.where(drives, right, middle)
    g_a, g_b = np.where(drives, g_middle, g_left), np.where(drives, g_right, g_middle)
    short, slides = drives & (g_b < 0), ~drives & (g_a > 0) & (low <= 0)
    # both ends alike: the pull may still peak, or dip, between them where it falls with slip at the outer end
    lane, sign = np.flatnonzero(short | slides), np.where(short, 1.0, -1.0)
    if lane.size:
        outer, inward = np.where(short, b, a)[lane], (1e-4 * sign * (b - a))[lane]
        missing = np.where(short, -g_b, g_a)[lane]
        rise = 1e4 * (sign[lane] * gap(outer - inward, lane) + missing)        # steepest there if there is one peak
        lane = lane[rise > np.where(short[lane], missing, 0)]
    if lane.size:
        s = inner_surplus(lambda s, i: sign[lane[i]] * gap(s, lane[i]), a[lane], b[lane])
        lane, s = lane[np.isfinite(s)], s[np.isfinite(s)]
        g, up = gap(s, lane), short[lane]
        a[lane], g_a[lane] = np.where(up, a[lane], s), np.where(up, g_a[lane], g)
        b[lane], g_b[lane] = np.where(up, s, b[lane]), np.where(up, g, g_b[lane])
        short[lane] = slides[lane] = False
    slip = np.where(short, high, np.where(slides, low, 0.0))
    lane = np.flatnonzero((g_a <= 0) & (g_b >= 0))
    if lane.size:
        a, b, g_a, g_b = a[lane], b[lane], g_a[lane], g_b[lane]
        guess = a + np.nan_to_num(g_a / (g_a - g_b), nan=0.5) * (b - a)
        slip[lane] = root(lambda s, i: gap(s, lane[i]), a, b, g_a, g_b, guess)
    pull, torque, theta_1, _ = state(patch, slip, load, theta_s)
    # a change of sign where no level carries any more is no balance
    pull[lane] = np.where(np.abs(pull - required)[lane] < 1e-4 * (load + np.abs(required))[lane], pull[lane], np.nan)
    buried = np.isnan(pull)
    slip[buried] = torque[buried] = theta_1[buried] = np.nan
    return (slip, pull, torque, patch.r * (1 - np.cos(theta_1)), theta_1, short | slides | buried, buried,
            slides & ~buried)
