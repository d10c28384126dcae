"""Frozen dataclasses at a third of the price: `dataclass` of the standard library compiles seven functions a class.

There are more than a hundred such classes between a model file and C: with the standard library's the cold start of
`front_car` with u only takes a tenth more.  Here only `__init__` is compiled, the other methods are shared.  Fields,
defaults, `replace`, `asdict`, matching, comparison and pickling are as usual.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import MISSING, FrozenInstanceError, fields
from dataclasses import dataclass as _standard
from operator import attrgetter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(*, frozen, slots):
        """The decorator `dataclass(frozen=True, slots=True)`; there are no other kinds here."""
        assert frozen
        assert slots
        return _record


def _record(cls: type) -> type:
    """The class with slots and the methods of a frozen dataclass; methods that it has itself stay."""
    made: type = _standard(init=False, repr=False, eq=False, slots=True)(cls)
    all_fields = fields(made)
    compared = _getter(field.name for field in all_fields if field.compare)
    hashed = _getter(field.name for field in all_fields if (field.compare if field.hash is None else field.hash))

    def same(self: Any, other: Any) -> bool:
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    def digest(self: Any) -> int:
        return hash(hashed(self))

    for name, method in {"__init__": _init(made), "__eq__": same, "__hash__": digest, **_SHARED}.items():
        if cls.__dict__.get(name) is None:
            setattr(made, name, method)
    return made


def _getter(names: Iterable[str]) -> Callable[[Any], object]:
    chosen = tuple(names)
    return attrgetter(*chosen) if chosen else lambda _: ()


def _init(made: type) -> Callable[..., None]:
    """`__init__` with the fields as parameters: each goes into its slot, past the refusal of changes."""
    space: dict[str, Any] = {"missing": MISSING}
    parameters, lines = [], []
    for field in fields(made):
        name = value = field.name
        space[f"put_{name}"] = getattr(made, name).__set__
        parameters.append(name)
        if field.default is not MISSING:
            space[f"usual_{name}"] = field.default
            parameters[-1] = f"{name}=usual_{name}"
        elif field.default_factory is not MISSING:
            space[f"make_{name}"] = field.default_factory
            parameters[-1] = f"{name}=missing"
            value = f"make_{name}() if {name} is missing else {name}"
        lines.append(f"  put_{name}(self, {value})")
    exec(f"def __init__(self, {', '.join(parameters)}):\n" + ("\n".join(lines) or "  pass"), space)
    init: Callable[..., None] = space["__init__"]
    return init


def _repr(self: Any) -> str:
    entries = ", ".join(f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if field.repr)
    return f"{self.__class__.__qualname__}({entries})"


def _refuse_change(self: Any, name: str, value: object) -> None:
    del self, value
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_removal(self: Any, name: str) -> None:
    del self
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[object]:
    return [getattr(self, field.name) for field in fields(self)]


def _restore(self: Any, state: list[object]) -> None:
    for field, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, field.name, value)


_SHARED: dict[str, Callable[..., object]] = {
    "__repr__": _repr,
    "__setattr__": _refuse_change,
    "__delattr__": _refuse_removal,
    "__getstate__": _state,
    "__setstate__": _restore,
}
