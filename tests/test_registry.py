"""The mass check as an interval: what is known is fixed, the rest drawn from other rovers, and counted."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from scipy import stats

import rdk
import registry
import validation
from rdk import catalog
from rdk.mass import mass_breakdown


@pytest.fixture(scope="module")
def masses():
    return registry.mass_intervals().set_index("rover")


def test_facts_keep_both_masses_of_moonranger_and_the_status_of_each():
    facts = registry.published_facts().set_index(["rover", "field", "table"])
    assert facts.value["MoonRanger", "total_mass_kg", "rovers.csv"] == 13
    later = facts.loc[("MoonRanger", "total_mass_kg", "rovers_more.csv")]
    assert (later.value, later.status, later.mass_kg) == (18, "derived", 18)
    assert facts.mass_kg["MoonRanger", "chassis_mass_kg", "rovers.csv"] == 13            # a size of the earlier design
    assert facts.mass_kg["Sojourner", "length_m", "rovers_more.csv"] == 11.5             # from the other table
    # a fact is counted once: the mass check's row, not the design vector's
    assert facts.loc[("Rashid-1", "chassis_mass_kg", "rovers.csv")].value == 2.0
    assert facts.loc[("Rashid-1", "wheel_radius_m", "rovers.csv")].status == "published"
    assert facts.status.isin(["published", "derived", "imputed"]).all() and facts.value.notna().all()


def test_coverage_in_class_and_out_of_it(masses):
    """11 of 13 and 5 of 5; the paper's own rovers among them 5 of 6 and 2 of 2."""
    for found in (masses, registry.mass_intervals(seed=7).set_index("rover")):
        count = found.groupby("in_class").inside.agg(["sum", "count"])
        assert count.loc[True].tolist() == [11, 13] and count.loc[False].tolist() == [5, 5]
        assert set(found.index[~found.inside]) == {"Tenacious", "KIST rover"}            # both lighter than expected
    assert np.all(masses.published_mass_kg[~masses.inside] < masses.low_kg[~masses.inside])
    assert not {"Yaoki", "LUPEX rover", "Apollo LRV"} & set(masses.index)                # two wheels, tracks, no mass
    inside = (masses.share_below > 0.05) & (masses.share_below < 0.95)
    assert (inside == masses.inside).all()


def test_the_papers_own_numbers_lie_in_intervals_that_know_them():
    """With the imputed values fixed too, only the coefficients vary about the prediction of the mass check."""
    known = registry.mass_intervals(fixed=("published", "derived", "imputed")).set_index("rover")
    paper = validation.published_masses().set_index("rover").predicted_mass_kg
    assert np.all(known.known[paper.index] == 10)
    assert np.all((known.low_kg[paper.index] < paper) & (paper < known.high_kg[paper.index]))
    # the one skewed coefficient, of the array (0.8 to 2 times), lifts the middle by two fifths of the array's mass
    area = catalog.table("rovers.csv").query("use == 'mass check'").set_index("rover").solar_area_m2[paper.index]
    lifted = paper + 0.4 * 2.5 * area * 1.08 * 1.05 * 1.2
    assert_allclose(known.median_kg[paper.index], lifted, rtol=0.015)


def test_a_rover_of_which_only_the_mass_is_known_by_another_draw():
    """MAGPIE with scipy's regression and independent random numbers; 2 %: quantiles of 40,000 draws, and of 1,024."""
    facts = registry.published_facts().drop_duplicates(["rover", "field"], keep="last")
    random, n, mass = np.random.default_rng(3), 40_000, 30.0
    sizes = {}
    for name in registry.GROWING:
        rows = facts[(facts.field == name) & facts.mass_kg.notna()]
        x, y = np.log(rows.mass_kg.to_numpy()), np.log(rows.value.to_numpy())
        fit, k = stats.linregress(x, y), len(rows)
        error = np.sqrt(np.sum((y - fit.intercept - fit.slope * x) ** 2) / (k - 2))
        wide = error * np.sqrt(1 + 1 / k + (np.log(mass) - x.mean()) ** 2 / np.sum((x - x.mean()) ** 2))
        sizes[name] = np.exp(fit.intercept + fit.slope * np.log(mass) + wide * random.standard_t(k - 2, n))
    for name in registry.PLAIN:
        rows = facts[(facts.field == name) & facts.mass_kg.notna()]
        sizes[name] = random.choice(rows.value.to_numpy(), n)
    table = [r for r in catalog.rows("uncertainties.csv") if r["name"] in rdk.mission.MASS_COEFFICIENTS]
    names = rdk.uncertainty.uncertain_names(table)
    coefficients = rdk.uncertainty.inputs_at(random.random((n, len(names))), rdk.scenario("mare_micro"), table=table)
    torque = validation.anchor_torque_nm(mass, sizes["wheel_count"], sizes["wheel_radius_m"])
    drawn = rdk.Model(**coefficients)
    total = mass_breakdown(**sizes, peak_wheel_torque_nm=torque, coefficients=drawn).total_kg
    row = registry.mass_intervals(draws=8192).set_index("rover").loc["MAGPIE"]
    assert row.known == 0
    assert_allclose([row.low_kg, row.median_kg, row.high_kg], np.quantile(total, [0.05, 0.5, 0.95]), rtol=0.02)


def test_no_rover_is_its_own_donor(monkeypatch, masses):
    """Another assumed chassis of Tenacious moves the intervals of others and not its own."""
    original = catalog.table

    def changed(name):
        table = original(name).copy()
        if name == "rovers.csv":
            table.loc[table.rover == "Tenacious", "chassis_mass_kg"] *= 2
        return table

    monkeypatch.setattr(catalog, "table", changed)
    moved = registry.mass_intervals().set_index("rover").median_kg / masses.median_kg
    assert moved["Tenacious"] == 1 and np.all(moved.drop("Tenacious") != 1)


def test_level_seed_and_model_act_as_named(masses):
    again, half = registry.mass_intervals(), registry.mass_intervals(level=0.5)
    pd.testing.assert_frame_equal(again.set_index("rover"), masses)
    assert np.all((half.low_kg > again.low_kg) & (half.high_kg < again.high_kg))
    dry = registry.mass_intervals(model=rdk.Model(growth_fraction=0.0))
    assert np.all(dry.median_kg < again.median_kg)
    # a payload is added after growth, so that a bus without it is 1 / 1.2 of its mass at least
    assert np.all(dry.median_kg > again.median_kg / 1.2)


@pytest.mark.parametrize("change, words", [(dict(draws=0), "draws"), (dict(level=1.0), "level")])
def test_bad_input_is_named(change, words):
    with pytest.raises(ValueError, match=words):
        registry.mass_intervals(**change)
