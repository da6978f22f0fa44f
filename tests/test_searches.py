"""The notebooks' helper that runs two searches at a time."""
import os
from concurrent.futures import BrokenExecutor

import numpy as np
import pytest

import rdk
from searches import TwoAtATime, fronts


@pytest.fixture
def two_at_a_time():
    with TwoAtATime() as helper:
        yield helper


def test_searches_two_at_a_time_are_the_same_as_one_by_one(two_at_a_time):
    missions = [rdk.scenario("equatorial_mare_traverse"), rdk.scenario("polar_prospecting")]
    options = dict(seeds=[1], population=8, generations=2)
    together, alone = fronts(missions, executor=two_at_a_time, **options), fronts(missions, **options)
    assert list(map(str, together)) == list(map(str, alone))
    for ours, theirs in zip(together.values(), alone.values()):
        for name, values in theirs.designs.numbers().items():
            np.testing.assert_array_equal(ours.designs.numbers()[name], values, err_msg=name)


def test_an_interrupted_search_does_not_spoil_the_next(two_at_a_time):
    assert two_at_a_time.submit(os.getpid).result() != os.getpid()
    with pytest.raises(BrokenExecutor):
        two_at_a_time.submit(os._exit, 1).result()       # as an interruption does
    assert list(two_at_a_time.map(abs, [-1, 2])) == [1, 2]
