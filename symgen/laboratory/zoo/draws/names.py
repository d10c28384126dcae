"""Names that hurt: what C, C++, Rust, Python, Arduino and the generated code itself already mean by them."""

from __future__ import annotations

from collections.abc import Iterable

from symgen.laboratory.zoo.dice import Dice

# not reserved by the language of models, so they must work
LEGAL_BY_LANGUAGE = {
    "C": (
        "I", "EOF", "NULL", "BIG_ENDIAN", "DBL_EPSILON", "FLT_MAX", "HUGE_VAL", "INFINITY", "NAN", "M_PI", "y0", "y1",
        "yn", "j0", "j1", "jn", "gamma", "lgamma", "errno", "stdin", "signal", "linux", "unix", "i386", "fabs", "fmax",
        "isnan", "isfinite", "uint8_t", "size_t", "defined", "pragma", "main", "memcpy", "TIM2", "DAC", "assert_", "OK",
        "nan", "PAGE_SIZE", "OVERFLOW", "RAND_MAX", "complex", "asm_", "major", "index", "CHAR_BIT", "SIGINT",
    ),
    "Rust": ("fn", "impl", "mut", "trait", "crate", "self", "pub", "loop", "match", "dyn", "where", "mod", "f64",
             "move", "ref", "unsafe", "Self", "box", "let", "super", "u8", "usize", "vec"),
    "Python": (
        "cls", "np", "range", "print", "list", "dict", "functools", "ctypes", "os", "sys", "dataclass", "object", "id",
        "map", "inf", "len", "array", "abs", "min", "max", "round", "type", "numpy", "math", "None_", "match_",
    ),
    "Arduino": (
        "INPUT", "OUTPUT", "HIGH", "LOW", "PI", "TWO_PI", "DEG_TO_RAD", "EULER", "B0", "B1", "B11", "A0", "F_CPU",
        "LED_BUILTIN", "DEFAULT", "bit", "word", "byte", "boolean", "sq", "setup", "delay", "millis", "F", "interrupts",
    ),
    "the generated code": (
        "p", "q", "qd", "qdd", "u", "G", "B", "M", "Q", "C", "status", "ready", "count", "stride", "result", "size",
        "enum_", "sc", "out", "x1", "x2", "t1", "v0", "w", "S", "s", "c", "sin_a", "cos_a", "one", "Status",
        "StateError", "Parameters", "PARAMETERS", "float_", "double_", "e", "pi_", "d1", "NOT_FINITE",
        "CONSTRAINT_RANK", "det", "rank", "k", "h", "g", "N", "E", "zoo_params", "lambda_", "time",
    ),
}  # fmt: skip
LEGAL = tuple(dict.fromkeys(name for names in LEGAL_BY_LANGUAGE.values() for name in names))
# reserved by the language of models, and nothing that Python could not read
ILLEGAL = (
    "int", "namespace", "register", "short", "template", "volatile", "t", "sin", "static",
    "double", "extern", "union", "delete", "typename",
)  # fmt: skip


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
