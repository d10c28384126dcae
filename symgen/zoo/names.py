"""Names that hurt: what C, C++, Rust, Python, Arduino and the generated code itself already mean by them."""

from __future__ import annotations

from collections.abc import Iterable

from symgen.zoo.dice import Dice

# not reserved by the language of models, so they must work
LEGAL = (
    "I", "N", "F", "E", "EOF", "NULL", "BIG_ENDIAN", "DBL_EPSILON", "FLT_MAX", "HUGE_VAL", "INFINITY", "NAN", "M_PI",
    "INPUT", "OUTPUT", "HIGH", "LOW", "PI", "TWO_PI", "DEG_TO_RAD", "EULER", "B0", "B1", "B11", "A0", "LED_BUILTIN",
    "F_CPU", "DEFAULT", "bit", "word", "byte", "boolean", "sq", "y0", "y1", "yn", "j0", "j1", "jn", "gamma", "lgamma",
    "errno", "stdin", "signal", "linux", "unix", "i386", "min", "max", "abs", "round", "fabs", "fmax", "isnan",
    "isfinite", "fn", "impl", "mut", "trait", "crate", "self", "cls", "np", "p", "q", "qd", "qdd", "u", "G", "B", "M",
    "Q", "C", "status", "ready", "count", "stride", "index", "result", "size", "len", "range", "print", "list", "dict",
    "enum_", "sc", "out", "x1", "x2", "t1", "v0", "w", "S", "s", "c", "sin_a", "cos_a", "one", "Status", "StateError",
    "Parameters", "PARAMETERS", "functools", "ctypes", "os", "sys", "dataclass", "float_", "double_", "uint8_t",
    "size_t", "assert_", "defined", "pragma", "main", "memcpy", "setup", "loop", "delay", "millis", "e", "pi_", "d1",
    "OK", "NOT_FINITE", "CONSTRAINT_RANK", "det", "rank", "k", "h", "g", "nan", "inf", "object", "id", "map", "array",
)  # fmt: skip
# reserved by the language of models, and nothing that Python could not read
ILLEGAL = ("int", "namespace", "register", "short", "template", "volatile", "t", "sin")


class Namer:
    """Gives each thing a name; with some probability one that hurts."""

    def __init__(self, dice: Dice, hurt: float) -> None:
        self._dice, self._hurt = dice, hurt
        self._taken: set[str] = set()

    def __call__(self, plain: str) -> str:
        """A new name, `plain` unless it is taken or another hurts more."""
        if self._dice.chance(self._hurt):
            free = [name for name in LEGAL if name not in self._taken and f"{name}_dot" not in self._taken]
            # what is reserved is refused, and that must be told, too
            plain = self._dice.choice(free if not self._dice.chance(0.01) else ILLEGAL)
        name, count = plain, 1
        while name in self._taken:
            count += 1
            name = f"{plain}_{count}"
        self._taken.add(name)
        return name

    def take(self, names: Iterable[str]) -> None:
        """Names that are made elsewhere."""
        self._taken.update(names)
