"""Roots and peaks of functions of one variable, many lanes at once: `function(x, lane)`, `lane` being their numbers."""
import numpy as np


def inner_surplus(function, low, high):
    """Where inside an interval `function(x, lane)` is positive, although not at its ends; NaN where its peak is not."""
    found, lane, left, right = np.full(low.shape, np.nan), np.arange(low.size), low, high
    for _ in range(6):                                   # each round narrows the peak's place to a fifth
        x = left + np.linspace(0, 1, 11)[1:-1, None] * (right - left)
        value = np.nan_to_num(function(x.ravel(), np.tile(lane, 9)).reshape(x.shape), nan=-np.inf)
        best, every = value.argmax(0), np.arange(lane.size)
        peak, top, step = x[best, every], value[best, every], (right - left) / 10
        beside = np.minimum(value[np.minimum(best + 1, 8), every], value[np.maximum(best - 1, 0), every])
        found[lane[top > 0]] = peak[top > 0]
        keep = (top <= 0) & (top + (top - beside) > 0)   # a smooth peak rises above the best point by a quarter of that
        lane, left, right = lane[keep], (peak - step)[keep], (peak + step)[keep]
        if not lane.size:
            break
    return found


def root(function, a, b, f_a, f_b, guess):
    """Roots of `function(x, lane)` between a and b, where its values have two signs: Chandrupatla's method."""
    found, lane, x, c, f_c = np.full(a.shape, np.nan), np.arange(a.size), guess, a, f_a
    for _ in range(80):
        f_x = function(x, lane)
        # a is the newest point, b lies beyond the root, c is the point before
        same = np.sign(f_x) == np.sign(f_a)
        c, f_c, b, f_b = np.where(same, a, b), np.where(same, f_a, f_b), np.where(same, b, a), np.where(same, f_b, f_a)
        a, f_a = x, f_x
        # inverse quadratic interpolation where it is safe, else bisection
        xi, phi = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        smooth = (phi * phi < xi) & ((1 - phi) ** 2 < 1 - xi)
        inverse = (f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b))
        step = np.where(smooth, inverse, 0.5) * (b - a)
        x = np.where(f_a == 0, a, a + step)
        done = (smooth & (np.abs(step) < 1e-6)) | (np.abs(b - a) < 1e-12) | (f_a == 0) | np.isnan(f_a)
        if done.any():
            found[lane[done]] = x[done]                  # the last step is left with the square of its size
            keep = np.flatnonzero(~done)
            lane, x, a, b, c, f_a, f_b, f_c = (v[keep] for v in (lane, x, a, b, c, f_a, f_b, f_c))
            if not lane.size:
                break
    return found
