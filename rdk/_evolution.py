"""Adaptive differential evolution of several populations at once.

JADE without its archive (Zhang & Sanderson 2009, doi:10.1109/TEVC.2009.2014613), with Deb's rules for constraints (Deb
2000, doi:10.1016/S0045-7825(99)00389-8): less violation wins, then the better objective.
"""
import numpy as np

ELITE = 4                                                # a trial moves towards one of so many best
SPARED = 0.4                                             # share of the generations in which both populations live


def _sorted(genes, objective, violation):
    """Populations with the best first: least violation, then least objective."""
    order = np.lexsort((objective, violation), axis=-1)
    return (np.take_along_axis(genes, order[..., None], 1), np.take_along_axis(objective, order, 1),
            np.take_along_axis(violation, order, 1))


def evolve(score, genes, random, generations, fixed):
    """Evolve genes of shape (populations, designs, genes) in the unit cube; no trial changes the gene `fixed`.

    `score(genes)`, later `score(trials, objective, violation)` with the values of the parents, returns the objective
    and the violation of the constraints, of shape (populations, designs). Yields (genes, objective, violation), sorted,
    after each generation. Of two populations the one that lies behind all of the other late in the search is given up.
    """
    objective, violation = score(genes)
    genes, objective, violation = _sorted(genes, objective, violation)
    scale_mean, cross_mean = np.full((2, len(genes), 1), [[[0.5]], [[0.8]]])
    for generation in range(generations):
        if len(genes) == 2 and generation >= SPARED * generations:
            behind = [(violation[k, 0], objective[k, 0]) > (violation[1 - k, -1], objective[1 - k, -1]) for k in (0, 1)]
            if any(behind):
                kept = np.flatnonzero(~np.array(behind))
                genes, objective, violation = genes[kept], objective[kept], violation[kept]
                scale_mean, cross_mean = scale_mean[kept], cross_mean[kept]
        shape = objective.shape
        scale = np.clip(scale_mean + 0.1 * random.standard_cauchy(shape), 0.05, 1)
        rate = np.clip(random.normal(cross_mean, 0.1, shape), 0, 1)
        this, others = np.arange(shape[1]), random.integers(1, shape[1], (2, *shape))
        best, one, two = (np.take_along_axis(genes, index[..., None], 1) for index in (
            random.integers(ELITE, size=shape), (this + others[0]) % shape[1], (this + others[1]) % shape[1]))
        crossed = random.random(genes.shape) < rate[..., None]
        np.put_along_axis(crossed, random.integers(genes.shape[2], size=(*shape, 1)), True, 2)
        crossed[..., fixed] = False
        # a trial beyond a bound lands on it: light rovers have many variables there
        trial = np.clip(np.where(crossed, genes + scale[..., None] * (best - genes + one - two), genes), 0, 1)
        new_objective, new_violation = score(trial, objective, violation)
        better = (new_violation < violation) | (new_violation == violation) & (new_objective < objective)
        even = (new_violation == violation) & (new_objective == objective)
        count = better.sum(1, keepdims=True)
        sums = [np.where(better, x, 0).sum(1, keepdims=True) for x in (scale**2, scale, rate)]
        with np.errstate(invalid="ignore", divide="ignore"):
            scale_mean = np.where(count, 0.9 * scale_mean + 0.1 * sums[0] / sums[1], scale_mean)
            cross_mean = np.where(count, 0.9 * cross_mean + 0.1 * sums[2] / count, cross_mean)
        taken = better | even
        genes, objective, violation = _sorted(
            np.where(taken[..., None], trial, genes), np.where(taken, new_objective, objective),
            np.where(taken, new_violation, violation))
        yield genes, objective, violation
