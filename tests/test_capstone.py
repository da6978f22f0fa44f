"""The briefs of the capstone: each can be met, and the judge tells by data what a design misses."""

import re
from pathlib import Path

import numpy as np
import pytest

import rdk
from exercises import capstone, check

REPO = Path(__file__).parents[1]
BRIEFS = capstone.BRIEFS
pytestmark = pytest.mark.filterwarnings("ignore:design outside the class")
NUMBERS = {"swirl": "16.4", "rim": "16.5", "scout": "16.6"}


def rashid(**changes):
    return rdk.rover("Rashid-1").replace(**changes)


# found by rdk.size with confidence, then rounded; they stand here so that no student's notebook holds them
MEETS = {
    "swirl": rashid(wheel_radius_m=0.126, wheel_width_m=0.05, grouser_height_m=0.015, grouser_count=24,
                    chassis_mass_kg=3.0, solar_area_m2=0.48, battery_capacity_wh=265, avionics_power_w=10,
                    peak_wheel_torque_nm=0.5),
    "rim": rashid(wheel_radius_m=0.102, wheel_width_m=0.05, grouser_height_m=0.015, grouser_count=16,
                  chassis_mass_kg=2.5, solar_area_m2=0.12, battery_capacity_wh=285, avionics_power_w=5,
                  peak_wheel_torque_nm=0.25),
    "scout": rashid(wheel_radius_m=0.10, wheel_width_m=0.055, grouser_height_m=0.013, grouser_count=19,
                    chassis_mass_kg=2.2, solar_area_m2=0.16, battery_capacity_wh=105, avionics_power_w=5,
                    peak_wheel_torque_nm=0.5)}


@pytest.mark.parametrize("name", BRIEFS)
def test_each_brief_can_be_met_with_room_that_no_seed_takes_away(name):
    brief, verdict = BRIEFS[name], check(NUMBERS[name], MEETS[name])
    assert verdict and "Right" in repr(verdict)
    for seed in range(3):                                # other draws than the judge's
        found = rdk.intervals(MEETS[name], brief.scenario, draws=8192, seed=seed)
        assert found.share(brief.judged) > brief.confidence + brief.tolerance


@pytest.mark.parametrize("name", BRIEFS)
def test_neither_the_first_guess_nor_the_lightest_rover_is_an_answer(name):
    brief = BRIEFS[name]
    assert not check(NUMBERS[name], brief.guess) and not capstone.judged(brief.guess, brief).joint
    lightest = rdk.size(brief.scenario, brief.demands, bounds=brief.limits)
    found = capstone.judged(lightest.design, brief)
    assert lightest.message == "" and "All demands together hold in" in found.missing and found.joint < 0.3


def test_the_briefs_differ_in_what_is_hard():
    assert len({brief.scenario.soil.friction_angle_deg for brief in BRIEFS.values()}) == 2
    rim = BRIEFS["rim"].scenario
    assert rim.skyline is not None and rim.start_utc == "2027-01-03" and rim.latitude_deg < -89
    hours = rdk.sky.julian_date(np.arange("2027-01-03", "2027-01-15", dtype="datetime64[h]"))
    sun = rdk.sky.sun_position(rim.latitude_deg, rim.longitude_deg, hours)
    dark = np.flatnonzero(rdk.sky.lit_fraction(*sun, rim.skyline) < 0.5)
    assert len(dark) == 30 == np.ptp(dark) + 1           # thirty hours at a stretch ...
    assert dark[0] // 24 == 6                            # ... from the seventh day on
    demanded = [{demand[0] for demand in brief.demands} for brief in BRIEFS.values()]
    assert len(set(map(frozenset, demanded))) == 3


@pytest.mark.parametrize("name, changes, words", [
    ("swirl", {"wheel_radius_m": 0.16}, "wheel_radius_m is 0.16, outside the limits of the brief, 0.05 to 0.15"),
    ("swirl", {"wheel_radius_m": 0.11}, "Missed before any uncertainty comes in: obstacle_capability_m"),
    ("swirl", {"battery_capacity_wh": 150.0}, "Missed before any uncertainty comes in: minimum_soc >= 0.2; it is 0.15"),
    ("swirl", {"peak_wheel_torque_nm": 0.1}, "Missed before any uncertainty comes in: feasible"),
    ("swirl", {"grouser_count": 8}, "fails most often: slope_capability_deg >= 18"),
    ("swirl", {"battery_capacity_wh": 400.0}, "fails most often: total_mass_kg <= 19"),
    ("swirl", {"battery_capacity_wh": 225.0}, "fails most often: minimum_soc >= 0.2"),
    ("rim", {"battery_capacity_wh": 200.0}, "Missed before any uncertainty comes in: unserved_h <= 0"),
    ("rim", {"chassis_mass_kg": 3.2}, "fails most often: total_mass_kg <= 14.5"),
    ("scout", {"chassis_mass_kg": 1.8}, "structure_share >= 0.2"),
    ("scout", {"wheelbase_m": 0.21}, "Missed before any uncertainty comes in: wheel_gap_m >= 0")])
def test_the_judge_says_what_is_missing(name, changes, words):
    verdict = check(NUMBERS[name], MEETS[name].replace(**changes))
    assert not verdict and words in repr(verdict)


def test_the_judge_takes_any_brief():
    mission = rdk.scenario("equatorial_mare_traverse")
    wanted = (("range_km", ">=", 30), ("total_mass_kg", "<=", 17))
    found = capstone.judged(rdk.rover("Rashid-1"), capstone.Brief(mission, wanted, 0.5))
    draws = rdk.intervals(rdk.rover("Rashid-1"), mission, draws=capstone.DRAWS, seed=capstone.SEED).draws
    holds = draws.feasible & (draws.range_km >= 30) & (draws.total_mass_kg <= 17)
    np.testing.assert_allclose(found.joint, holds.mean(), rtol=1e-12)        # the same draws
    assert found.joint <= min(found.shares) and found.missing == ("" if holds.mean() >= 0.49 else found.missing)
    assert capstone.judged(rdk.rover("Rashid-1"), capstone.Brief(mission, wanted, 0.999)).missing
    with pytest.raises(ValueError, match="range_m"):
        capstone.Brief(mission, (("range_m", ">=", 1),), 0.5)


def test_a_share_short_by_the_draws_own_error_is_forgiven_and_no_more():
    mission, wanted = rdk.scenario("equatorial_mare_traverse"), (("total_mass_kg", "<=", 16.5),)
    joint = capstone.judged(rdk.rover("Rashid-1"), capstone.Brief(mission, wanted, 0.5)).joint
    error = 2 * np.sqrt(joint * (1 - joint) / capstone.DRAWS)
    assert 0.005 < error < 0.012
    assert not capstone.judged(rdk.rover("Rashid-1"), capstone.Brief(mission, wanted, joint + 0.8 * error)).missing
    assert capstone.judged(rdk.rover("Rashid-1"), capstone.Brief(mission, wanted, joint + 1.3 * error)).missing


def test_candidates_stand_side_by_side():
    brief = BRIEFS["rim"]
    table = capstone.compare({"guess": brief.guess, "meets": MEETS["rim"]}, brief)
    assert list(table.columns) == ["guess", "meets"] and table.loc["verdict"].tolist() == ["not yet", "accepted"]
    found = capstone.judged(MEETS["rim"], brief)
    assert table.loc["all together", "meets"] == f"{100 * found.joint:.1f} %"
    mass = rdk.evaluate(MEETS["rim"], brief.scenario).total_mass_kg
    assert table.loc["mass to spare", "meets"] == f"{14.5 - mass:.2f} kg"
    assert table.loc["slope_capability_deg >= 12", "meets"].startswith(f"{found.values[3]:.4g} (")
    free = capstone.Brief(brief.scenario, brief.demands[:1], 0.5)
    assert capstone.compare({"meets": MEETS["rim"]}, free).loc["mass to spare", "meets"] == "no limit"


def test_the_trade_moves_one_thing_at_a_time_within_the_limits():
    brief, design = BRIEFS["swirl"], MEETS["swirl"].replace(solar_area_m2=0.5, grouser_count=0, grouser_height_m=0.0)
    table = capstone.trade(design, brief)
    assert table.loc["solar_area_m2", "mass (kg)"] == 0 and np.isnan(table.loc["solar_area_m2", "points for a kg"])
    heavier = rdk.evaluate(design.replace(chassis_mass_kg=3.3), brief.scenario).total_mass_kg
    lighter = rdk.evaluate(design, brief.scenario).total_mass_kg
    np.testing.assert_allclose(table.loc["chassis_mass_kg", "mass (kg)"], heavier - lighter, rtol=1e-12)   # rounding
    assert table.loc["grousers (height, count)", "mass (kg)"] > 0        # from none: both grow
    larger = design.replace(wheel_radius_m=table.loc["wheel_radius_m", "to"])
    asked = rdk.evaluate(larger, brief.scenario).wheel_torque_nm
    np.testing.assert_allclose(table.loc["wheel_radius_m", "torque to spare (N m)"],
                               design.peak_wheel_torque_nm - asked, rtol=1e-9)     # a difference of near numbers


def test_what_the_notebook_says_of_the_lightest_rover_and_of_the_doubts():
    brief = BRIEFS["swirl"]
    lightest = rdk.size(brief.scenario, brief.demands, bounds=brief.limits).design
    draws = rdk.intervals(lightest, brief.scenario, draws=8192, seed=1).draws      # not the judge's draws
    assert (draws.wheel_torque_nm > lightest.peak_wheel_torque_nm).mean() > 0.5 and (draws.range_km == 0).mean() > 0.5
    bought = capstone.trade(lightest, brief)
    assert bought["all together (points)"].idxmax() == "peak_wheel_torque_nm"
    losers = bought[bought["all together (points)"] < -1]
    assert set(losers.index) == {"wheel_radius_m", "chassis_mass_kg"} and (losers["torque to spare (N m)"] < 0).all()
    mine = brief.guess.replace(grouser_count=20, grouser_height_m=0.015)
    soil = brief.scenario.soil
    weaker = brief.scenario.replace(soil=soil.replace(friction_angle_deg=soil.friction_angle_deg - 8))
    now, weak, dusty, slow, poor = (rdk.evaluate(mine, where, model=rdk.Model(**changed)) for where, changed in (
        (brief.scenario, {}), (weaker, {}), (brief.scenario, {"dust_factor": 0.6}),
        (brief.scenario, {"hub_no_load_speed_rad_s": 3.3}), (brief.scenario, {"battery_specific_energy_wh_kg": 96})))
    assert {found.minimum_soc for found in (now, weak, dusty, slow, poor)} == {0.15}
    text = (REPO / "notebooks/16_design_your_rover.ipynb").read_text(encoding="utf-8")
    for words in (f"{now.unserved_h:.0f} as it stands, {dusty.unserved_h:.0f} with a third of the power lost",
                  f"takes {now.slope_capability_deg - weak.slope_capability_deg:.1f}° of slope capability",
                  f"add {poor.total_mass_kg - now.total_mass_kg:.2f} kg"):
        assert words in text
    assert 0.6 < slow.cruise_speed_m_s / now.cruise_speed_m_s < 0.7 and slow.range_km == now.range_km == 20


# ---- exemplars -------------------------------------------------------------------------------------------------

def report_of(name):
    """The text of an exemplary report, and the design in its first table."""
    text = (REPO / f"notebooks/exemplars/{name}.md").read_text(encoding="utf-8")
    values = re.findall(r"^\| (\w+) \| ([\d.]+) \|$", text, re.M)
    assert [field for field, _ in values] == list(rdk.DESIGN_SPACE)
    return text, rdk.Design(**{field: int(value) if field.endswith("count") else float(value)
                               for field, value in values})


def test_the_numbers_of_the_strong_report_are_computed():
    (text, design), brief = report_of("strong"), BRIEFS["swirl"]
    found, now = capstone.judged(design, brief), rdk.evaluate(design, brief.scenario)
    assert found.missing == "" and f"{100 * found.joint:.1f} % of 8,192 draws" in text
    assert f"rover of {now.total_mass_kg:.2f} kg" in text and f"{19 - now.total_mass_kg:.2f} kg of the" in text
    candidates = {"first guess": brief.guess, "lightest (`rdk.size`)": rdk.size(
        brief.scenario, brief.demands, bounds=brief.limits).design, "wide wheels": design.replace(
        wheel_width_m=0.10, battery_capacity_wh=235.0), "**proposed**": design}
    for name, candidate in candidates.items():
        seen = capstone.judged(candidate, brief)
        slope, charge, mass = (f"{100 * share:.0f} %" for share in seen.shares[3:])
        assert f"| {name} | {seen.values[-1]:.2f} | {slope} | {charge} | {mass} | {100 * seen.joint:.1f} % |" in text
    gain = rdk.attribution(design, brief.guess, brief.scenario).to_frame()
    assert f"{gain.slope_capability_deg['grouser_count']:.1f}° of slope" in text
    assert f"for {gain.total_mass_kg['grouser_count']:.2f} kg" in text
    assert f"give {-gain.total_mass_kg['wheel_width_m']:.2f} kg back" in text
    battery = capstone.trade(design, brief).loc["battery_capacity_wh"]
    assert f"adds {battery['mass (kg)']:.2f} kg and costs {-battery['all together (points)']:.1f} points" in text
    assert f"asks for {now.wheel_torque_nm:.2f} N m" in text
    assert f"{100 * now.structure_share:.0f} % of the mass" in text
    lightest = candidates["lightest (`rdk.size`)"]
    assert (f"buys {lightest.peak_wheel_torque_nm:.2f} N m, and it drives in "
            f"{100 * capstone.judged(lightest, brief).shares[1]:.0f} % of the draws") in text
    weak = rdk.evaluate(design, brief.scenario.replace(soil=rdk.soil("sourcebook-trafficability")))
    assert f"a slip of {weak.slip:.2f}" in text and f"capability is {weak.slope_capability_deg:.1f}°" in text
    assert rdk.evaluate(design, brief.scenario, model=rdk.Model(dust_factor=0.6)).minimum_soc == 0.15
    web = rdk.evaluate(design, brief.scenario, model=rdk.Model(wheel_web_factor=1.0)).total_mass_kg
    assert f"weighs {web:.2f} kg, {web - 19:.2f} kg above" in text


def test_the_numbers_of_the_weak_report_are_computed():
    (text, design), brief = report_of("weak"), BRIEFS["swirl"]
    found, now = capstone.judged(design, brief), rdk.evaluate(design, brief.scenario)
    assert "All demands together" in found.missing and "total_mass_kg" in found.missing
    assert f"hold in {100 * found.joint:.1f} % of the draws where 70 %" in text
    _, _, _, slope, _, mass = (f"{100 * share:.0f} %" for share in found.shares)
    assert f"holds in {slope} of the draws" in text and f"mass in {mass}" in text
    assert f"| {now.slope_capability_deg:.1f}° |" in text and f"| {100 * now.minimum_soc:.0f} % |" in text
    assert text.count(f"{now.total_mass_kg:.2f} kg") == 2 and f"{19 - now.total_mass_kg:.2f} kg on the mass" in text
    soft = rdk.evaluate(design, brief.scenario.replace(soil=rdk.soil("sourcebook-trafficability")))
    assert f"at 35° the slope capability is {soft.slope_capability_deg:.1f}°" in text


@pytest.mark.parametrize("name", ["strong", "weak"])
def test_marks_follow_the_rubric_and_add_up(name):
    text, _ = report_of(name)
    notebook = (REPO / "notebooks/16_design_your_rover.ipynb").read_text(encoding="utf-8")
    marks = re.findall(r"^\| (\w+) \| (\d+) of (\d+) \| .+ \|$", text, re.M)
    assert [(what, points) for what, _, points in marks] == re.findall(r'"\| (\w+) \| (\d+) \| ', notebook)
    assert f"**{sum(int(given) for _, given, _ in marks)} of 100**" in text
    assert all(int(given) <= int(points) for _, given, points in marks)
