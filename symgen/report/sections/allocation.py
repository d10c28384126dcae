"""How redundant inputs share the work: the formulas behind the model's `allocation`."""

from __future__ import annotations

from symgen.model.model import Allocation, Model
from symgen.report.document import Block, InlineCode, displayed
from symgen.report.mathematics.layout import Application, Fenced, Fraction, Layout, Letter, Root, Row, Scripts, Sum
from symgen.report.prose import (
    ONE,
    ZERO,
    B,
    M,
    Mt,
    bold,
    delta_diff,
    equals,
    juxtaposed,
    listed,
    minus_sum,
    paragraph,
    plus,
    pseudoinverse,
    small_m,
    tau,
    transposed,
    u,
)

D, p, z = bold("D"), bold("p"), bold("z")
c, k = Letter("c"), Letter("k")
u_0, w_k, z_k, d_k = Scripts(u, ZERO), Scripts(Letter("w"), k), Scripts(Letter("z"), k), Scripts(Letter("d"), k)
M_k = Scripts(M, Fenced(k))
HALF_INVERSE = Scripts(D, None, Sum((("-", Row((ONE, Letter("/"), Letter("2")))),)))
LOW, HIGH = Scripts(c, Letter("low", "upright")), Scripts(c, Letter("high", "upright"))


def allocated_inputs(model: Model, allocation: Allocation, determined: bool) -> list[Block]:
    """From all inputs that produce the motion to the ones the model asks for, if they are not determined by it."""
    share = _utilisation(allocation) if len(allocation.limits) == model.m else []
    if determined:
        return share
    if model.keeps_limits:
        return [*_nearest(allocation), *_nearest_within(allocation), *share]
    return [
        *_nearest(allocation),
        *(_direction(allocation) if allocation.directed else []),
        *(_limits(allocation) if allocation.limits else []),
        *share,
    ]


def _nearest(allocation: Allocation) -> list[Block]:
    inverse = juxtaposed(HALF_INVERSE, pseudoinverse(Fenced(juxtaposed(Mt, HALF_INVERSE))))
    if not allocation.weights:
        inverse = juxtaposed(pseudoinverse(Mt))
    right: Layout = juxtaposed(*inverse.factors, tau)
    if allocation.preferred:
        right = plus(p, juxtaposed(*inverse.factors, Fenced(minus_sum((tau,), (juxtaposed(M, p),)))))
    blocks: list[Block] = [
        paragraph("Among all inputs that produce the motion, the model's {} chooses.", InlineCode("allocation")),
        displayed((equals(u_0, right),), "u_0"),
    ]
    norm = juxtaposed(transposed(u), D, u)
    if allocation.preferred:
        distance = Fenced(minus_sum((u,), (p,)))
        norm = juxtaposed(transposed(distance), D, distance)
        named = ", ".join(name for name, _ in allocation.preferred)
        blocks.append(paragraph("Here {} holds the preferred values of {}, zero for the others.", p, named))
    if allocation.weights:
        named = ", ".join(name for name, _ in allocation.weights)
        text = "It makes {} least, with the diagonal matrix {} of the weights: those of {} are parameters, others 1."
        blocks.append(paragraph(text, norm, D, named))
    return blocks


def _direction(allocation: Allocation) -> list[Block]:
    minor = Application(Letter("det", "upright"), Fenced(listed((M_k, transposed(B))), "["))
    sign = Scripts(Fenced(Sum((("-", ONE),))), None, minus_sum((k,), (ONE,)))
    squares = juxtaposed(Scripts(Letter("Σ"), k), w_k, Scripts(Letter("d"), k, Letter("2")))
    share = "{} is the parameter {}." if allocation.preload else "{} would be zero without limits."
    slots = (c, InlineCode(allocation.preload)) if allocation.preload else (c,)
    return [
        paragraph(
            "With one input more than needed, {}, the inputs that move nothing are the multiples of one direction. It "
            "consists of determinants, {} being {} without its column {}:",
            equals(small_m, plus(delta_diff, ONE)),
            M_k,
            M,
            k,
        ),
        displayed((equals(d_k, juxtaposed(sign, minor)), equals(z_k, Fraction(d_k, Root(squares)))), "z"),
        paragraph(
            "So {}, and {}: a share {} of it adds its square to the norm. The inputs are",
            equals(juxtaposed(Mt, z), ZERO),
            equals(juxtaposed(transposed(z), D, z), ONE),
            c,
        ),
        displayed((equals(u, plus(u_0, juxtaposed(c, z))),), "u_c"),
        paragraph(share, *slots),
    ]


def _limits(allocation: Allocation) -> list[Block]:
    lower, upper, start = (Scripts(Letter(x), k) for x in ("l", "h", "u"))
    start = Scripts(Letter("u"), listed((ZERO, k)))
    ends = listed(tuple(Fraction(minus_sum((x,), (start,)), z_k) for x in (lower, upper)))

    def choice(outer: str, inner: str) -> Layout:
        inside = Application(Letter(inner, "upright"), Fenced(ends))
        return Application(Scripts(Letter(outer, "upright"), k), inside)

    named = ", ".join(limit.input for limit in allocation.limits)
    return [
        paragraph("Limits {} and {} are given for {}. They are kept between", lower, upper, named),
        displayed((equals(LOW, choice("max", "min")), equals(HIGH, choice("min", "max"))), "c_low"),
        paragraph(
            "and of {}, {} and the preload, or zero, the middle one is taken. Where {} is above {} no inputs keep all "
            "limits and produce the motion: {} then lies between them, where no limit gains without another's loss, "
            "and {} is outside its limits. An input with {} takes no part.",
            LOW,
            HIGH,
            LOW,
            HIGH,
            c,
            u,
            equals(z_k, ZERO),
        ),
        _kinks(allocation),
    ]


def _nearest_within(allocation: Allocation) -> list[Block]:
    """The quadratic program, and how it ends without a loop."""
    lower, upper, start = (Scripts(Letter(x), k) for x in ("l", "h", "u"))
    between = equals(u, plus(u_0, juxtaposed(bold("Z"), bold("c"))))
    named = ", ".join(limit.input for limit in allocation.limits)
    return [
        paragraph(
            "Limits {} and {} are given for {}. Inputs that move nothing are combinations of the columns of {}, which "
            "are orthonormal in the norm above, the last ones of an orthogonal factorisation:",
            lower,
            upper,
            named,
            bold("Z"),
        ),
        displayed((between, equals(juxtaposed(Mt, bold("Z")), ZERO)), "u_c"),
        paragraph(
            "The norm grows by the square of {}, so that the shortest {} is taken that keeps all limits. They are "
            "taken in one after the other: where the inputs so far leave the next {} outside, the nearest lie where it "
            "is at its limit, which is the same problem along one direction less, with the limits before; along one "
            "direction the limits leave an interval (incremental insertion after Seidel, 1991). All of this is worked "
            "out at every state and one end is taken, without a loop. An input that these forces change by less than "
            "a ten-thousandth of what they may takes no part. Where no inputs within the limits produce the motion the "
            "function returns {} and leaves its result as it was.",
            bold("c"),
            bold("c"),
            start,
            InlineCode("LIMITS"),
        ),
        _kinks(allocation),
    ]


def _kinks(allocation: Allocation) -> Block:
    """Where the inputs are not differentiable by the motion."""
    lower, upper, own = (Scripts(Letter(x), k) for x in ("l", "h", "u"))
    text = (
        "As functions of the motion the inputs have kinks: where one of them reaches or leaves its limit, {} or {}, "
        "and where one that is at its limit takes the place of another. {} is continuous there, its derivatives are "
        "not; everywhere else it is smooth. {} is that of one side."
    )
    slots = (equals(own, lower), equals(own, upper), u, InlineCode("inverse_dynamics_jacobian"))
    if not allocation.scale:
        return paragraph(text, *slots)
    return paragraph(f"{text} A further one is where {{}}.", *slots, equals(Letter("ρ"), ONE))


def _utilisation(allocation: Allocation) -> list[Block]:
    """The share of their limits that inputs need, and what is made of it."""
    J, i, rho = Letter("J"), Letter("i"), Letter("ρ")
    middle, half = Scripts(Letter("a"), i), Scripts(Letter("h"), i)

    def volume(*columns: Layout) -> Layout:
        return Fenced(Application(Letter("det", "upright"), Fenced(listed((*columns, transposed(B))), "[")), "|")

    M_J, M_i = Scripts(M, J), Scripts(M, i)
    load = minus_sum((tau,), (juxtaposed(M, bold("a")),))
    reach = juxtaposed(Scripts(Letter("Σ"), i), volume(M_J, M_i), half)
    largest = Application(Scripts(Letter("max", "upright"), J), Fraction(volume(M_J, load), reach))
    blocks: list[Block] = [
        paragraph(
            "With {} the middles of the limits and {} half their widths, the inputs need at least the share {} of what "
            "the limits leave, whatever they do beside the motion. It is possible exactly if {} is 1 at most:",
            middle,
            half,
            rho,
            rho,
        ),
        displayed((equals(rho, largest),), "rho"),
        paragraph(
            "Here {} runs over all choices of {} columns of {}; where another one becomes the largest, {} has a kink.",
            J,
            minus_sum((delta_diff,), (ONE,)),
            M,
            rho,
        ),
    ]
    if allocation.scale:
        supplied, text = juxtaposed(M, bold("a")), "Where it is more, {} produces {} times the load {} beside {}."
        blocks.append(paragraph(text, u, Fraction(ONE, rho), load, supplied))
    return blocks
