"""C around the generated kernels: states of many points, parameters of each point, walks, and what is kept of states.

Arrays hold the components of a point side by side, `[point][component][state]`; those of `group` say whose states a
point has, so that points that differ in masses alone share the states of a path.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from textwrap import dedent

from symgen.backends.c.batch import VECTOR
from symgen.backends.c.endings import BATCH
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.backends.quantities import BATCHED
from symgen.ir.kernel import Kernel
from symgen.model.model import Model
from symgen.study.reducing_loops import BINS, REDUCTIONS, ROW_LANES

# States beyond full vectors from which on the kernel for many states takes them, too: it fills their vector up.
FEWEST_BATCHED = 6
# Of the way from the model's configuration: the first step of a walk.
FIRST_STEP = 0.125
# Of the way, the step below which a walk gives up.
LEAST_STEP = 0.0009765625
# Of the length of a way, how far from its middle the ways beside it lead.
ASIDE_SHARE = 0.25


def loops_source(model: Model, kernels: Sequence[Kernel]) -> str:
    """A file of C to be compiled with those of the kernels, for float64."""
    stem = model.c_name
    batch = [f'#include "{stem}{BATCH}.h"'] if any(kernel.name in BATCHED for kernel in kernels) else []
    headers = [f'#include "{stem}.h"', *batch, *(f"#include <{name}.h>" for name in ("math", "stddef", "stdint"))]
    macros = f"#define BINS {BINS}", f"#define ROW_LANES {ROW_LANES}"
    return "\n".join(
        ["\n".join((*headers, *macros)), REDUCTIONS, *(_over(model, one) for one in kernels)]
        + [_reduced_over(model, one) for one in kernels]
        + [_walk(model, one) for one in kernels if is_walked(one)]
    )  # fmt: skip


def is_walked(kernel: Kernel) -> bool:
    """Whether a kernel makes a configuration of what is given and of a configuration near it."""
    given = [argument.name for argument in array_arguments(kernel)]
    return len(given) == 2 and given[0] in ("x_t", "q_m") and given[1] == "q"


def over_name(quantity: str) -> str:
    """The function that evaluates a quantity at the states of many points."""
    return f"study_over_{quantity}"


def reduced_name(quantity: str) -> str:
    """The function that evaluates a quantity and keeps what its entries are reduced to."""
    return f"study_reduced_{quantity}"


def walk_name(quantity: str) -> str:
    """The function that walks to configurations."""
    return f"study_walk_{quantity}"


def _over(model: Model, kernel: Kernel) -> str:
    arguments, size = array_arguments(kernel), math.prod(kernel.shape)
    params, one = global_name(model.c_name, "float64", "params"), global_name(model.c_name, "float64", kernel.name)
    given = "".join(f"const double *{a.name}_all, " for a in arguments)
    copies = "".join(
        f"            double {a.name}_one[{a.length}];\n            for (size_t i = 0; i < {a.length}; ++i) {{\n"
        f"                {a.name}_one[i] = {a.name}_all[(group[point] * {a.length} + i) * count + k];\n"
        "            }\n"
        for a in arguments
    )
    called = "".join(f"{a.name}_one, " for a in arguments)
    begin, many = "0", ""
    if kernel.name in BATCHED:
        starts = ", ".join(f"{a.name}_all + group[point] * {a.length} * count" for a in arguments)
        function = global_name(model.c_name, "float64", kernel.name, BATCH)
        begin, many = "begin", (
            f"        const size_t begin = count % {VECTOR} < {FEWEST_BATCHED} ? count - count % {VECTOR} : count;\n"
            f"        if (begin) {{\n            {function}(begin, count, {starts}, p_all + point,\n"
            f"                result_all + point * {size} * count, status_all + point * count);\n        }}\n"
        )
    return (
        f"void {over_name(kernel.name)}(size_t points, size_t count, const size_t *group, {given}\n"
        f"        const {params} *p_all, double *result_all, unsigned char *status_all)\n{{\n"
        f"    for (size_t point = 0; point < points; ++point) {{\n{many}"
        f"        for (size_t k = {begin}; k < count; ++k) {{\n{copies}"
        f"            double y_one[{size}];\n"
        f"            const int code = (int){one}({called}p_all + point, y_one);\n"
        f"            for (size_t i = 0; i < {size}; ++i) {{\n"
        f"                result_all[(point * {size} + i) * count + k] = code ? (double)NAN : y_one[i];\n"
        "            }\n            status_all[point * count + k] = (unsigned char)code;\n        }\n    }\n}\n"
    )


def _reduced_over(model: Model, kernel: Kernel) -> str:
    """Point by point, so that what is reduced has not left the nearest cache; `room` holds the entries of a point.

    Of `stride` states of a point the first `count` are reduced.
    """
    arguments, size = array_arguments(kernel), math.prod(kernel.shape)
    params = global_name(model.c_name, "float64", "params")
    given = "".join(f"const double *{a.name}_all, " for a in arguments)
    passed = "".join(f"{a.name}_all, " for a in arguments)
    return dedent(f"""\
        void {reduced_name(kernel.name)}(size_t points, size_t count, size_t stride, size_t smallest,
                const size_t *group, {given}
                const {params} *p_all, double *room, double *figures, int64_t *places, unsigned char *status_all)
        {{
            for (size_t point = 0; point < points; ++point) {{
                unsigned char *status = status_all + point * stride;
                {over_name(kernel.name)}(1, stride, group + point, {passed}p_all + point, room, status);
                study_reduced({size}, count, stride, smallest, room,
                    figures + point * {6 * size}, places + point * {size});
            }}
        }}
        """)


def _walk(model: Model, kernel: Kernel) -> str:
    """From one state to many: what is given and the parameters move together, in steps that the kernel takes.

    Where the straight way fails, others lead by places beside its middle, one for each direction and side of what is
    given; parameters change on the first half of these.
    """
    given, q = array_arguments(kernel)
    params, one = global_name(model.c_name, "float64", "params"), global_name(model.c_name, "float64", kernel.name)
    number = max(1, len(model.parameters))
    return dedent(f"""\
        static int study_leg_{kernel.name}(const double *p_start, const double *p_goal, const double *x_start,
                const double *x_goal, double *here)
        {{
            double there[{q.length}], x_one[{given.length}], way = 0.0, step = {FIRST_STEP!r};
            union {{ double all[{number}]; {params} members; }} p_one;
            int code = 0;
            while (way < 1.0 && step >= {LEAST_STEP!r}) {{
                const double next = way + step < 1.0 ? way + step : 1.0;
                for (size_t i = 0; i < {number}; ++i) {{
                    p_one.all[i] = next < 1.0 ? p_start[i] + next * (p_goal[i] - p_start[i]) : p_goal[i];
                }}
                for (size_t i = 0; i < {given.length}; ++i) {{
                    x_one[i] = next < 1.0 ? x_start[i] + next * (x_goal[i] - x_start[i]) : x_goal[i];
                }}
                code = (int){one}(x_one, here, &p_one.members, there);
                if (code) {{
                    step /= 2.0;
                    continue;
                }}
                for (size_t i = 0; i < {q.length}; ++i) {{
                    here[i] = there[i];
                }}
                way = next;
                step *= 2.0;
            }}
            return way < 1.0 ? code : 0;
        }}

        void {walk_name(kernel.name)}(size_t points, size_t count, const double *p_start, const double *p_end,
                const double *x_start, const double *x_end, const double *q_start, double *q_all,
                unsigned char *status_all)
        {{
            for (size_t state = 0; state < points * count; ++state) {{
                const double *p_goal = p_end + state / count * {number}, *x_goal = x_end + state * {given.length};
                double here[{q.length}], beside[{given.length}], length = 0.0;
                int first = 0, code = 0;
                for (size_t i = 0; i < {given.length}; ++i) {{
                    length += (x_goal[i] - x_start[i]) * (x_goal[i] - x_start[i]);
                }}
                length = sqrt(length);
                for (size_t turn = 0; turn <= 2 * {given.length} && (!turn || code); ++turn) {{
                    for (size_t i = 0; i < {q.length}; ++i) {{
                        here[i] = q_start[i];
                    }}
                    if (!turn) {{
                        first = code = study_leg_{kernel.name}(p_start, p_goal, x_start, x_goal, here);
                        continue;
                    }}
                    for (size_t i = 0; i < {given.length}; ++i) {{
                        beside[i] = x_start[i] + 0.5 * (x_goal[i] - x_start[i]);
                    }}
                    beside[(turn - 1) / 2] += (turn % 2 ? {ASIDE_SHARE!r} : -{ASIDE_SHARE!r}) * length;
                    code = study_leg_{kernel.name}(p_start, p_goal, x_start, beside, here);
                    code = code ? code : study_leg_{kernel.name}(p_goal, p_goal, beside, x_goal, here);
                }}
                status_all[state] = (unsigned char)(code ? first : 0);
                for (size_t i = 0; i < {q.length}; ++i) {{
                    q_all[(state / count * {q.length} + i) * count + state % count] = code ? (double)NAN : here[i];
                }}
            }}
        }}
        """)
