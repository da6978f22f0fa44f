"""The contact patch: stress integrals with their derivatives, and the solvers built on them.

Works on flat lanes: `patch` is an array in SI with the rows r, b, k_eff r^n, n, gamma c, gamma tan(phi), K, c_1, c_2
and one column a wheel. `terramechanics` is the public face.
"""
from __future__ import annotations

import numpy as np

NODES = 12                                               # Gauss-Legendre nodes on each of the two arcs
BRAKING_NODES = 60                                       # the shear of a braking wheel changes sign within an arc
BLOCK = 512                                              # lanes whose (2, NODES, lanes) arrays stay in cache


def rule_of(nodes):
    """Gauss-Legendre nodes on [0, 1], as a column, and their weights."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    return (x[:, None] + 1) / 2, w / 2


DRIVING, BRAKING = rule_of(NODES), rule_of(BRAKING_NODES)
_STEP_DONE = 1e-5                                        # Newton converges quadratically: what is left is ~1e-9
_HALF_PI = np.pi / 2


def in_blocks(solve, lanes, shape):
    """`solve` on slices of lanes that fit the cache; results with the caller's shape, floats for one lane."""
    with np.errstate(all="ignore"):                      # a lane without a solution is NaN, not a warning
        blocks = [solve(lanes[:, i:i + BLOCK]) for i in range(0, lanes.shape[1], BLOCK)]
        if not blocks:                                   # nothing to solve: one lane of ones shows the kinds
            return [np.empty(shape, dtype=a.dtype) for a in solve(np.ones((len(lanes), 1)))]
    joined = [np.concatenate(parts).reshape(shape) for parts in zip(*blocks)]
    return [a if shape else a.item() for a in joined]


def forces(theta_1, s, patch, jacobian=False, rule=DRIVING):
    """Vertical load, drawbar pull and torque of the stress integrals, and their derivatives if asked.

    theta = a theta_1 with a(u) from theta_m / theta_1 = kappa to 1 on the front arc and from kappa to 0 on the
    rear one. The rear's theta* at a node is then the front's theta at the same u: one stress serves both arcs.
    """
    r, b, A, n, c, tan_phi, K, c1, c2 = patch
    u, w = rule
    kappa = c1 + c2 * np.abs(s)
    a = np.empty((2, len(u), theta_1.size))
    np.multiply(u, 1 - kappa, out=a[0])
    a[0] += kappa
    np.multiply(1 - u, kappa, out=a[1])
    theta = a * theta_1
    sin, sin_1 = np.sin(theta), np.sin(theta_1)
    cos, cos_1 = np.sqrt(1 - sin * sin), np.sqrt(1 - sin_1 * sin_1)      # angles are 0 to 90 deg; twice as fast as cos
    depth = cos[0] - cos_1
    sigma = A * (depth if (n == 1).all() else depth ** n)                # eq. sigma
    arc, chord = theta_1 - theta, sin_1 - sin
    j = arc - (1 - s) * chord                                            # shear displacement over r
    decay = np.exp(np.abs(j) * (-r / K))
    mobilised = np.copysign(1 - decay, j)
    strength = sigma * tan_phi
    strength += c
    tau = strength * mobilised                                           # eq. tau
    vertical = sigma * cos + tau * sin
    pull = tau * cos - sigma * sin
    span = np.stack([theta_1 * (1 - kappa), theta_1 * kappa]) * (b * r)  # area of each arc
    per_area_v, per_area_p = w @ vertical, w @ pull
    totals = [(span * per_area_v).sum(0), (span * per_area_p).sum(0), (span * (w @ tau)).sum(0) * r]
    if not jacobian:
        return totals
    steepness = sigma * n / depth                                        # d sigma / d depth
    fade = strength * decay * (r / K)                                    # d tau / d (j / r)
    sin_f = sin[0]

    def derivative(theta_x, sigma_x, j_x, span_x):
        tau_x = fade * j_x
        tau_x += mobilised * (sigma_x * tan_phi)
        v_x = sigma_x * cos
        v_x += tau_x * sin
        v_x += theta_x * pull
        p_x = tau_x * cos
        p_x -= sigma_x * sin
        p_x -= theta_x * vertical
        return ((span * (w @ v_x) + span_x * per_area_v).sum(0), (span * (w @ p_x) + span_x * per_area_p).sum(0))

    by_theta = derivative(a, steepness * (sin_1 - a[0] * sin_f), (1 - a) - (1 - s) * (cos_1 - a * cos), span / theta_1)
    if jacobian == "entry":
        return totals, by_theta
    kappa_s = c2 * np.copysign(1.0, s) * theta_1
    theta_s = np.empty_like(a)
    np.multiply(1 - u, kappa_s, out=theta_s[0])
    theta_s[1] = theta_s[0]
    span_s = np.stack([-kappa_s, kappa_s]) * (b * r)
    by_slip = derivative(theta_s, -steepness * sin_f * theta_s[0], chord - theta_s * (1 - (1 - s) * cos), span_s)
    return totals, by_theta, by_slip


def entry_angle(patch, s, target, with_pull, rule=DRIVING):
    """Entry angle where F_z = target, or sqrt(F_z^2 + DP^2) = target in lanes with `with_pull` = 1; F_z and DP there.

    NaN where there is none. Newton in log-log coordinates: the load is close to a power of the entry angle, so few
    steps are needed. The forces come with the last one.
    """
    r, b, A, n = patch[:4]
    # Bekker's closed form for a smooth free-rolling wheel, z^(n + 1/2) = 3 W / ((3 - n) b k_eff sqrt(2 r)), starts it
    z = (3 * target / (np.maximum(3 - n, 0.5) * b * r * A * np.sqrt(2))) ** (2 / (2 * n + 1))
    theta = np.minimum(np.sqrt(2 * z), 1.2)
    result = np.full((3, target.size), np.nan)
    lane = np.flatnonzero(np.isfinite(theta))
    if lane.size < theta.size:
        patch, s, target, with_pull, theta = patch[:, lane], s[lane], target[lane], with_pull[lane], theta[lane]
    low, high = np.zeros_like(theta), np.full_like(theta, _HALF_PI)
    for _ in range(60):                                  # bisection alone needs 50; Newton needs 4 or 5
        if not lane.size:
            break
        (load, pull, _), (load_t, pull_t) = forces(theta, s, patch, "entry", rule)
        held = np.sqrt(load * load + with_pull * pull * pull)
        slope = (load * load_t + with_pull * pull * pull_t) / held * theta
        held = np.where(load > 0, held, 0.0)
        low = np.where(held < target, theta, low)
        high = np.where(held < target, high, theta)
        miss = np.log(target / held)
        step = held / slope * miss
        newton = theta * np.exp(np.clip(step, -1, 1))
        done = (np.abs(step) < _STEP_DONE) & (np.abs(miss) < 10 * _STEP_DONE)
        inside = (newton > low) & (newton < high)
        # beyond the far end: look there once, since a wheel that does not hold there is buried
        new = np.where(inside, newton, np.where((newton >= high) & (high == _HALF_PI) & (low < _HALF_PI), _HALF_PI,
                                                (low + high) / 2))
        shut = high - low < 1e-14
        gone = (low == _HALF_PI) | (shut & (high == _HALF_PI))             # not carried below 90 degrees: buried
        done = (done | shut) & ~gone
        if done.any() or gone.any():
            last = np.where(inside, newton - theta, 0.0)
            result[:, lane[done]] = np.stack([theta + last, load + load_t * last, pull + pull_t * last])[:, done]
            keep = ~(done | gone)
            lane, patch, s, target, with_pull = lane[keep], patch[:, keep], s[keep], target[keep], with_pull[keep]
            low, high, new = low[keep], high[keep], new[keep]
        theta = new
    return result


def carried(patch, s, load):
    """Pull, torque, sinkage and entry angle of wheels that carry `load` at slip s."""
    theta = np.empty_like(load)
    for lane, rule in ((s >= 0, DRIVING), (s < 0, BRAKING)):
        if lane.any():
            theta[lane] = entry_angle(patch[:, lane], s[lane], load[lane], np.zeros(lane.sum()), rule)[0]
    return *settled(theta, s, patch)[1:], patch[0] * (1 - np.cos(theta)), theta


def settled(theta, s, patch):
    """Load, pull and torque, each lane by the rule for its slip: what is handed out once angle and slip are found."""
    found, brakes = forces(theta, s, patch), np.flatnonzero(s < 0)
    if brakes.size:
        for whole, part in zip(found, forces(theta[brakes], s[brakes], patch[:, brakes], False, BRAKING)):
            whole[brakes] = part
    return found


def slope(patch, slip, theta_1, load, pull, limit_deg):
    """Slope in degrees from entry angle and forces at the capability slip; 0 for buried lanes and where nothing pulls."""
    load = load.copy()
    deep = np.flatnonzero(theta_1 > 0.7)                 # might be buried on the flat, where the load is largest
    if deep.size:
        flat = forces(np.full(deep.size, _HALF_PI), slip[deep], patch[:, deep])[0]
        load[deep[flat < np.hypot(load[deep], pull[deep])]] = np.nan
    return np.where(load > 0, np.clip(np.degrees(np.arctan2(pull, load)), 0, limit_deg), 0.0)


def _brakes(patch, load, low):
    """Lanes whose pull at the low end of the slip interval is surely negative.

    Where (1 - s) cos(theta_1) > 1 the soil slides forward under the whole arc, so shear only brakes. A wheel that
    carries its load within that angle brakes; one evaluation shows it, where the exact pull would take a solve.
    """
    theta_limit = np.arccos(np.minimum(1 / (1 - low), 1))
    return forces(theta_limit, low, patch)[0] > load


def slip_balance(patch, *lanes):
    """Slip balance of flat lanes, given angle and pull at the high end of the slip interval and a first guess of slip.

    Lanes that turn out to brake are balanced once more by the rule for braking.
    """
    found = _slip_balance(patch, *lanes, DRIVING)
    brakes = np.flatnonzero(found[0] < 0)
    if brakes.size:
        again = _slip_balance(patch[:, brakes], *(a[brakes] for a in lanes), BRAKING)
        for whole, part in zip(found, again):
            whole[brakes] = part
    return found


def _slip_balance(patch, load, required, low, high, theta_high, pull_high, guess, rule):
    unsure = np.flatnonzero(~((required >= 0) & _brakes(patch, load, low)))
    surplus_low = np.zeros(load.shape, bool)
    if unsure.size:
        _, _, pull_low = entry_angle(patch[:, unsure], low[unsure], load[unsure], np.zeros(unsure.size), rule)
        surplus_low[unsure] = pull_low > required[unsure]
    buried = np.isnan(pull_high)
    crossing = ~buried & (surplus_low == (pull_high < required))
    stalled = buried | (~crossing & (pull_high < required))
    slip = np.where(stalled, high, 0.0)
    theta = np.where(stalled, theta_high, np.nan)
    lane = np.flatnonzero(crossing)
    if lane.size:
        slip[lane], theta[lane] = _newton_balance(patch[:, lane], load[lane], required[lane], low[lane], high[lane],
                                                  theta_high[lane], guess[lane], rule)
    free = np.flatnonzero(~crossing & ~stalled)
    if free.size:                                        # surplus at both ends: the wheel rolls without slip
        theta[free], _, _ = entry_angle(patch[:, free], slip[free], load[free], np.zeros(free.size), rule)
    _, pull, torque = forces(theta, slip, patch, False, rule)
    buried = np.isnan(pull)                              # also where the soil gives way inside the slip interval
    slip[buried] = np.nan
    return slip, pull, torque, patch[0] * (1 - np.cos(theta)), theta, stalled | buried, buried


def _newton_balance(patch, load, required, low, high, theta, guess, rule):
    """Entry angle and slip of lanes whose balance is bracketed: Newton on both, bisection on slip for the rest."""
    s = np.clip(guess, low, high)
    slip_out, theta_out = np.full(load.shape, np.nan), np.full(load.shape, np.nan)
    lane = np.arange(load.size)
    everything = patch, load, required, low, high
    for _ in range(12):
        if not lane.size:
            break
        (fz, dp, _), (fz_t, dp_t), (fz_s, dp_s) = forces(theta, s, patch, "entry and slip", rule)
        f, g = load - fz, required - dp
        det = fz_t * dp_s - fz_s * dp_t
        d_theta, d_s = (f * dp_s - g * fz_s) / det, (g * fz_t - f * dp_t) / det
        new_theta = np.clip(theta + d_theta, theta / 2, np.minimum(theta * 1.5, _HALF_PI))
        new_s = np.clip(s + np.clip(d_s, -0.3, 0.3), low, high)
        done = (np.abs(d_theta) < _STEP_DONE) & (np.abs(d_s) < _STEP_DONE) & (np.abs(new_s - s - d_s) < _STEP_DONE)
        if done.any():
            slip_out[lane[done]], theta_out[lane[done]] = new_s[done], new_theta[done]
            keep = ~done
            lane, patch, load, required = lane[keep], patch[:, keep], load[keep], required[keep]
            low, high, new_theta, new_s = low[keep], high[keep], new_theta[keep], new_s[keep]
        theta, s = new_theta, new_s
    lost = np.flatnonzero(np.isnan(slip_out))
    if lost.size:
        patch, load, required, low, high = everything
        slip_out[lost], theta_out[lost] = _bracketed_balance(patch[:, lost], load[lost], required[lost], low[lost],
                                                             high[lost], rule)
    return slip_out, theta_out


def _bracketed_balance(patch, load, required, low, high, rule):
    """Slip balance by a bracketing root finder on slip alone, the entry angle solved anew at each slip."""
    from scipy.optimize.elementwise import find_root

    def surplus(s, index):
        i = index.astype(int)
        return entry_angle(patch[:, i], s, load[i], np.zeros(i.size), rule)[2] - required[i]

    s = find_root(surplus, (low, high), args=(np.arange(load.size),), tolerances={"xatol": 1e-12}).x
    return s, entry_angle(patch, s, load, np.zeros_like(load), rule)[0]
