"""Names that compile everywhere, one for one."""

from __future__ import annotations

import keyword
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symgen.backends.c.reserved import is_taken
from symgen.backends.python.reserved import KEYWORDS
from symgen.model.quantities import QUANTITIES
from symgen.naming import c_name, identifiers, macro_name

ROOT = Path(__file__).parents[2]


def words(text: str) -> list[str]:
    return text.split()


TRICKY = st.sampled_from(["I", "I_", "I__", "F", "y1", "y1_", "double", "L", "B1", "PI", "template", "x", "p"])


@given(st.lists(TRICKY), st.frozensets(TRICKY))
def test_injective_and_never_reserved(names: list[str], taken: frozenset[str]) -> None:
    mapping = identifiers(names, is_taken, taken)
    assert list(mapping) == list(dict.fromkeys(names))
    assert len(set(mapping.values())) == len(mapping)
    assert not set(mapping.values()) & taken
    assert not any(map(is_taken, mapping.values()))


def test_a_free_name_stays_and_a_clash_moves_around_it() -> None:
    assert identifiers(["I", "I_", "L"], is_taken) == {"I": "I__", "I_": "I_", "L": "L"}


@pytest.mark.parametrize(
    "name",
    words(
        """I F B1 B0 B110 PI y0 jn min errno NULL EOF abs round and BIG_ENDIAN DBL_EPSILON EPERM EIO linux unix major
    minor NAN INFINITY isnan complex word A3 TIM2 ADC1 PB0 CS10 PIND DDRB M_PIf M_1_PI PRIu32 htobe16 st_mtime
    si_addr noreturn atomic_load signals TRUE MASS KELVIN_0"""
    ),
)
def test_known_clashes(name: str) -> None:
    assert identifiers([name], is_taken)[name] == f"{name}_"


@pytest.mark.parametrize(
    "name",
    words(
        """L m_1 e N lam theta q1 G M M_1 N_1 J_C I_1 Ixx IXX K_P EI GJ D1 R2 C1 T_2 CM COM sigma size arm MASS_ Mass a1
    b0 pin port adc tim"""
    ),
)
def test_ordinary_names_stay(name: str) -> None:
    assert identifiers([name], is_taken)[name] == name


def test_python_keywords_are_complete() -> None:
    assert set(keyword.kwlist) == set(KEYWORDS)


@pytest.mark.parametrize(
    "name",
    words(
        """math numpy queue test random servo m c help kernel aux COM1 hal x rob_f Rob_F rob_batch rob_sc_f
        rob_minimal"""
    ),
)
def test_names_that_clash_get_an_ending(name: str) -> None:
    assert c_name(name) == f"{name}_model"


@pytest.mark.parametrize("name", ["front_car", "rob", "Rob", "robot_model", "sc", "batch", "leg_force"])
def test_others_keep_theirs(name: str) -> None:
    assert c_name(name) == name


PARTS = st.sampled_from(words("rob Rob ROB f F batch sc prepared model math x minimal default"))


@given(st.lists(st.lists(PARTS, min_size=1, max_size=4).map("_".join), unique=True, max_size=6))
def test_models_share_no_file_and_no_macro(names: list[str]) -> None:
    """Files on one disk, macros in one program: endings and kinds never make one name out of two."""
    kinds = [kind + scalar for kind in ("", "_batch", "_prepared", "_sc") for scalar in ("", "_f")]
    stems = [c_name(name) + kind for name in names for kind in kinds]
    assert len(set(stems)) == len(stems)
    macros = [macro_name(stem) + tail for stem in stems for tail in ("_H", "_IMPLEMENTATION")]
    assert len(set(macros)) == len(macros)


def test_macros_of_small_letters_are_in_capitals() -> None:
    assert macro_name("front_car_sc_f") == "FRONT_CAR_SC_F"
    assert [macro_name(name) for name in ("Rob", "ROB", "ROB_f")] == ["Rob", "rob", "rob_F"]


def test_a_result_is_called_like_no_argument_of_its_function() -> None:
    """Beside states, functions take parameters, sines, and how many states there are and their statuses."""
    own = {"p", "sc", "count", "stride", "status"}
    clashing = [row.name for row in QUANTITIES if row.result in own.union(row.arguments)]
    assert clashing == []
    # the names are those that are printed
    header = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "generated/front_car/c").glob("front_car*.h"))
    calls = re.findall(r"front_car_\w+\(([^;]*)\);", header)
    printed = {word for call in calls for word in re.findall(r"(\w+)(?:\[|,|$)", call)}
    assert own | {"q", "qd", "qdd", "u"} <= printed
    assert printed - own - {"q", "qd", "qdd", "u"} <= {row.result for row in QUANTITIES} | {"prepared", "void"}
