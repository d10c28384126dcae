"""Names that compile everywhere, one for one."""

from __future__ import annotations

import keyword

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symgen.naming import PYTHON_KEYWORDS, RESERVED, c_identifiers, file_stem

TRICKY = st.sampled_from(["I", "I_", "I__", "F", "y1", "y1_", "double", "L", "B1", "PI", "template", "x", "p"])


@given(st.lists(TRICKY), st.frozensets(TRICKY))
def test_injective_and_never_reserved(names: list[str], taken: frozenset[str]) -> None:
    mapping = c_identifiers(names, taken)
    assert list(mapping) == list(dict.fromkeys(names))
    assert len(set(mapping.values())) == len(mapping)
    assert not set(mapping.values()) & (RESERVED | taken)


def test_a_free_name_stays_and_a_clash_moves_around_it() -> None:
    assert c_identifiers(["I", "I_", "L"]) == {"I": "I__", "I_": "I_", "L": "L"}


@pytest.mark.parametrize(
    "name", ["I", "F", "B1", "PI", "y0", "jn", "min", "errno", "NULL", "EOF", "abs", "round", "and"]
)
def test_known_clashes(name: str) -> None:
    assert c_identifiers([name])[name] == f"{name}_"


@pytest.mark.parametrize("name", ["L", "m_1", "e", "N", "lam", "theta", "q1", "G"])
def test_ordinary_names_stay(name: str) -> None:
    assert c_identifiers([name])[name] == name


def test_python_keywords_are_complete() -> None:
    assert set(keyword.kwlist) == PYTHON_KEYWORDS


def test_files_hide_no_header_or_module() -> None:
    assert file_stem("math") == "math_model"
    assert file_stem("numpy") == "numpy_model"
    assert file_stem("front_car") == "front_car"
