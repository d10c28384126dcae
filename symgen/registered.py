"""The backends by name, and the words that each of them brings.

A backend is the folder of its name in `symgen/backends`.  What it reserves is data in its module `reserved`, which
imports nothing but this one: model files are checked against the words of all backends before anything else.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module

from symgen.records import dataclass

# The registration, in the order in which files are made: what a run makes as a rule, and what `--only` can ask for.
USUAL = ("c", "python")
BACKENDS = (*USUAL, "array_api", "rust", "matlab", "ros2", "fmi")


@dataclass(frozen=True, slots=True)
class Words:
    """What names must not be because of one language.

    `keywords` are refused in model files, each with what it is; `is_taken` says which names are no identifiers of the
    language, where it is built and used; `hiding` are names that a model's files must not have, in small letters, and
    `endings` those by which files and functions of one model differ: another model's name must not end so.
    """

    keywords: Mapping[str, str]
    is_taken: Callable[[str], bool]
    hiding: frozenset[str] = frozenset()
    endings: frozenset[str] = frozenset()


def words(text: str) -> frozenset[str]:
    """The words of a text."""
    return frozenset(text.split())


@cache
def words_of(backend: str) -> Words:
    """The words of a backend."""
    loaded = import_module(f"symgen.backends.{backend}.reserved").WORDS
    assert isinstance(loaded, Words)
    return loaded


@cache
def keywords() -> dict[str, str]:
    """What no name of a model file may be because of any backend, and why."""
    # told by the first language that has it
    return {word: why for backend in reversed(BACKENDS) for word, why in words_of(backend).keywords.items()}


@cache
def hiding() -> frozenset[str]:
    """What no files of a model may be called, in small letters."""
    return frozenset().union(*(words_of(backend).hiding for backend in BACKENDS))


@cache
def endings() -> frozenset[str]:
    """What no name of a model's files ends in, behind an underscore."""
    return frozenset().union(*(words_of(backend).endings for backend in BACKENDS))
