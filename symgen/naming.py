"""Names that compile wherever the generated C is built: no keyword, library function or widespread macro.

A name that clashes gets trailing underscores, so the mapping is deterministic, injective and easy to guess.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


C_KEYWORDS = _words(
    """auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while asm fortran
    typeof bool complex imaginary"""
)
CPP_KEYWORDS = _words(
    """alignas alignof and and_eq asm bitand bitor bool catch char16_t char32_t char8_t class compl concept consteval
    constexpr constinit const_cast co_await co_return co_yield decltype delete dynamic_cast explicit export false friend
    mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public reinterpret_cast
    requires static_assert static_cast template this thread_local throw true try typeid typename using virtual wchar_t
    xor xor_eq final override import module"""
)
PYTHON_KEYWORDS = _words(
    """False None True and as assert async await break class continue def del elif else except finally for from global
    if import in is lambda nonlocal not or pass raise return try while with yield"""
)
_MATH_FUNCTIONS = _words(
    """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma
    fmax fmin fmod frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan
    nearbyint nextafter nexttoward pow remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma trunc
    sincos exp10 pow10 drem gamma significand scalb finite j0 j1 jn y0 y1 yn"""
)
LIBRARY_NAMES = frozenset(name + suffix for name in _MATH_FUNCTIONS for suffix in ("", "f", "l")) | _words(
    """abs labs llabs div ldiv lldiv abort exit atexit malloc calloc realloc free
    signgam isfinite isinf isnan isnormal signbit fpclassify isgreater isless isunordered INFINITY
    NAN HUGE_VAL NULL EOF errno assert offsetof stdin stdout stderr main
    size_t ptrdiff_t int8_t int16_t int32_t int64_t uint8_t uint16_t
    uint32_t uint64_t float_t double_t RAND_MAX EXIT_SUCCESS EXIT_FAILURE BUFSIZ CHAR_BIT DOMAIN SING OVERFLOW
    UNDERFLOW PLOSS TLOSS HUGE MAXFLOAT M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI
    M_SQRT2 M_SQRT1_2 FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL"""
)
# complex.h, POSIX and Windows
PLATFORM_MACROS = _words(
    """I linux unix i386 near far small hyper interface min max major minor CONST VOID TRUE FALSE BOOL IN OUT OPTIONAL
    ERROR DELETE"""
)
ARDUINO_MACROS = (
    _words(
        """F HIGH LOW INPUT OUTPUT INPUT_PULLUP PI HALF_PI TWO_PI DEG_TO_RAD RAD_TO_DEG EULER SERIAL DISPLAY LSBFIRST
        MSBFIRST CHANGE FALLING RISING DEFAULT EXTERNAL INTERNAL constrain radians degrees sq interrupts noInterrupts
        lowByte highByte bit bitRead bitSet bitClear bitWrite word boolean byte cli sei SP SS SCK MOSI MISO SDA SCL
        LED_BUILTIN"""
    )
    | {f"A{k}" for k in range(16)}
    | {f"B{k:0{width}b}" for width in range(1, 9) for k in range(2**width)}
)
RESERVED = C_KEYWORDS | CPP_KEYWORDS | PYTHON_KEYWORDS | LIBRARY_NAMES | PLATFORM_MACROS | ARDUINO_MACROS

# A model of one of these names would hide a header or a module that the generated files include.
_HIDING_STEMS = _words(
    """assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdarg stdbool stddef
    stdint stdio stdlib string tgmath time wchar wctype numpy enum dataclasses ctypes functools hashlib inspect os
    pathlib platform shutil subprocess tempfile typing types sys re io abc site warnings"""
)


def c_identifiers(names: Iterable[str], taken: Collection[str] = frozenset()) -> dict[str, str]:
    """Maps each name to a C identifier that is neither reserved, nor in `taken`, nor given to another of the names."""
    wanted = tuple(dict.fromkeys(names))
    forbidden = RESERVED | frozenset(taken)
    result = {name: name for name in wanted if name not in forbidden}
    used = set(wanted)
    for name in wanted:
        if name in result:
            continue
        candidate = name + "_"
        while candidate in forbidden or candidate in used:
            candidate += "_"
        used.add(candidate)
        result[name] = candidate
    return {name: result[name] for name in wanted}


def file_stem(model_name: str) -> str:
    """File name and function prefix of a model: its own name, unless that would hide a header or module in use."""
    return f"{model_name}_model" if model_name.lower() in _HIDING_STEMS else model_name
