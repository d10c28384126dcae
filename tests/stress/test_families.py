"""`symgen stress` finds by itself where a model is in trouble, and tells choices from mechanisms."""

from __future__ import annotations

from functools import cache

import pytest
from shipped import model

from symgen.laboratory.stress.determinants import Choices, choices
from symgen.laboratory.stress.families import SingularFamilies, search
from symgen.laboratory.stress.zeros import places
from symgen.verify.reference.reference import Reference


@cache
def reference(name: str) -> Reference:
    return Reference(model(name))


@cache
def families_of(name: str) -> SingularFamilies:
    return search(reference(name))


@cache
def known(name: str) -> Choices:
    return choices(reference(name))


def singular(name: str) -> dict[str, str]:
    kinds = ("constraint", "input", "parameter")
    return {family.label: family.kind for family in families_of(name).families if family.kind in kinds}


def test_front_car_has_parameter_singularities_only() -> None:
    assert singular("front_car") == dict.fromkeys(("cos θ", "sin θ", "cos φ", "sin φ"), "parameter")
    failing = {family.label: set(family.partitions) for family in families_of("front_car").families}
    # coordinates x, y, theta, phi: (x, phi) fails at cos theta cos phi = 0, (y, phi) at sin theta cos phi = 0
    assert [label for label in failing if (0, 3) in failing[label]] == ["cos θ", "cos φ"]
    assert {label for label in failing if (1, 3) in failing[label]} == {"sin θ", "cos φ"}
    assert "the degree of actuation drops nowhere" in families_of("front_car").nowhere


def test_every_choice_of_coordinates_that_can_fail_does_along_a_family() -> None:
    # no row of the car holds the rate of phi, so that phi is in each of the choices
    assert known("front_car").partitions == ((0, 3), (1, 3), (2, 3))
    assert (families_of("front_car").partitions, families_of("front_car").failing) == (3, 3)
    # the rod is never upright
    assert (families_of("slider_crank").partitions, families_of("slider_crank").failing) == (3, 2)
    assert any(line.startswith("cos β = 0: not found") for line in families_of("slider_crank").nowhere)


def test_rear_car_has_an_input_singularity() -> None:
    assert singular("rear_car")["cos φ"] == "input"
    assert singular("rear_car")["cos θ"] == "parameter"


def test_slider_crank() -> None:
    # the slider as a coordinate fails at the dead centres, the rod where the crank is upright
    assert singular("slider_crank") == {"cos α": "parameter", "sin(α + β)": "parameter"}
    kinds = {family.kind for family in families_of("slider_crank").families}
    assert kinds >= {"large angles", "small angles", "mass ratios", "drift", "incompatible inputs"}
    masses = {family.label for family in families_of("slider_crank").families if family.kind == "mass ratios"}
    assert masses == {"m_crank", "m_rod", "m_s", "J_crank", "J_rod"}


def test_pairs_of_drives_fail_where_their_middle_links_are_parallel_or_the_third_arm_is_stretched() -> None:
    troubles = {trouble.label: trouble.inputs for trouble in known("rapkm_2rrr_rr").troubles if trouble.inputs}
    assert troubles == {
        "sin b₃": ((0, 1),),
        "sin(a₁ − a₂ + b₁ − b₂)": ((0, 1),),
        "sin b₂": ((0, 2),),
        "sin(a₁ − a₃ + b₁ − b₃)": ((0, 2),),
        "sin b₁": ((1, 2),),
        "sin(a₂ − a₃ + b₂ − b₃)": ((1, 2),),
    }


@pytest.mark.parametrize(("name", "measure"), [("rapkm_2rrr_rr", None), ("rapkm_two_drives", 0.0)])
def test_two_drives_lose_what_three_keep(name: str, measure: float | None) -> None:
    given = reference(name)
    (trouble,) = [t for t in known(name).troubles if t.label == "sin(a₁ − a₂ + b₁ − b₂)"]
    (place,) = places(given, trouble, 1)
    zero = (0,) * 6
    from symgen.verify.reference.reference import State

    state = State(place.q, zero, zero, (0,) * given.model.m, place.parameters)
    first, second = (float(x) for x in given.matrices(state, ("singularity",), 256)["singularity"].entries())
    assert first > 1e-4
    if measure is None:
        assert second > 1e-4
    else:
        assert abs(second) < 1e-40


def test_places_lie_on_the_constraints_at_the_distance_asked_for() -> None:
    given = reference("slider_crank")
    (trouble,) = [t for t in known("slider_crank").troubles if t.label == "cos α"]
    (place,) = places(given, trouble, 1)
    for d in (1e-2, 1e-6, 1e-12):
        q = place.at(given, d)
        assert q is not None
        size = sum(float(a - b) ** 2 for a, b in zip(q, place.q, strict=True)) ** 0.5
        assert size == pytest.approx(d, rel=1e-2)
        assert abs(float(trouble.values(q, place.parameters)[0])) == pytest.approx(d, rel=0.9)
