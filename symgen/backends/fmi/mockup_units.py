"""What stands around the C: units of plant and controller for FMI 2.0 and 3.0, and what builds them.

Each unit has one source of its own, whose functions are the interface, beside the kernels; and a description, to which
the token in the source belongs.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen import __version__
from symgen.backends.c.elsewhere import CallerNames, KernelCall, caller_names, heading, kernel_call, titled
from symgen.backends.c.names import c_members
from symgen.backends.fmi.base_units import UnitDefinition, unit_definitions
from symgen.backends.fmi.variables import Settled, UnitVariable, start_of, variables_of
from symgen.backends.literals import decimal_text
from symgen.backends.render import render
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model
from symgen.records import dataclass

# By role, the quantity that a unit works out.
WORKED_OUT = {"plant": "forward_dynamics", "controller": "inverse_dynamics"}
# What brings a plant back onto the constraints: onto geometric ones, and its rates onto all.
PROJECTIONS = ("projected_configuration", "admissible_velocity")
# Of FMI, by what stands before the point.
FMI_VERSIONS = (2, 3)
# How fast a plant in Model Exchange leads back onto the constraints, in rad/s: faster ones leave less of the violation,
# and change the motion more.
RETURN_RATE = 10.0
# Calls of two Newton steps each that a start may take, and what the last one may still move, of the size of a place.
CLOSING_ROUNDS, CLOSED_WITHIN = 25, 1e-10


@dataclass(frozen=True, slots=True)
class MockupUnitView:
    """Everything the templates of one unit print; `places` are those of its variables in C."""

    version: int
    role: str
    identifier: str
    token: str
    symgen: str
    description: str
    about: tuple[str, ...]
    c: CallerNames
    coordinates: int
    inputs: int
    start: tuple[str, ...]
    variables: tuple[UnitVariable, ...]
    places: tuple[str, ...]
    units: tuple[UnitDefinition, ...]
    worked_out: KernelCall
    placed: KernelCall | None
    admitted: KernelCall | None
    return_rate: float
    closing_rounds: int
    closed_within: float


def emit_mockup_units(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """The units whose quantity is made, what declares their interfaces, and `build.py`; nothing without any."""
    (program,) = programs
    kernels = {kernel.name: kernel for kernel in program.kernels}
    files: dict[str, str] = {}
    for role, quantity in WORKED_OUT.items():
        if quantity in kernels:
            for version in FMI_VERSIONS:
                view = _view(model, program, kernels, role, version)
                files |= _unit(view, model.text_hash)
    if not files:
        return {}
    files["build.py"] = render("fmi/build.py.jinja", None)
    files |= {f"sources/fmi{version}.h": render(f"fmi/fmi{version}.h.jinja", None) for version in FMI_VERSIONS}
    return {f"fmi/{path}": text for path, text in files.items()}


def lacking_quantities(model: Model, made: frozenset[str]) -> Iterator[str]:
    """That there are no units, or that the plant drifts."""
    if not made & {*WORKED_OUT.values()}:
        names = " or ".join(f"`{quantity}` ({role})" for role, quantity in WORKED_OUT.items())
        yield f"there are no units, only the C: they work out {names}, which outputs have not"
    lacking = _projections(model) - made if WORKED_OUT["plant"] in made else ()
    if lacking:
        names = ",".join(sorted((*made & {*WORKED_OUT.values()}, *_projections(model))))
        yield f"the plant drifts off its constraints; what brings it back comes of `--outputs {names}`"


def _projections(model: Model) -> set[str]:
    """What brings the plant of this model back."""
    geometric = any(row.kind == "geometric" for row in model.constraints)
    return {name for name, there in zip(PROJECTIONS, (geometric, model.r > 0), strict=True) if there}


def _unit(view: MockupUnitView, model_hash: str) -> dict[str, str]:
    """The files of one unit: its token is told by the model and by all that the description says of variables."""
    description = f"fmi/description{view.version}.xml.jinja"
    digest = hashlib.sha256(f"{model_hash}\n{render(description, view)}".encode()).hexdigest()
    token = "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32]))
    view = replace(view, token=f"{{{token}}}")
    files = {
        "modelDescription.xml": render(description, view),
        f"sources/{view.identifier}.c": render(f"fmi/fmi{view.version}.c.jinja", view),
    }
    if view.version > 2:
        files["sources/buildDescription.xml"] = render("fmi/sources.xml.jinja", view)
    return {f"fmi{view.version}/{view.identifier}/{path}": text for path, text in files.items()}


def _view(
    model: Model, program: Program, kernels: Mapping[str, Kernel], role: str, version: int
) -> MockupUnitView:
    calls = {name: kernel_call(model, program, kernel) for name, kernel in kernels.items()}
    is_plant = role == "plant"
    needed = _projections(model) if is_plant else set()
    placed, admitted = (calls.get(name) if name in needed else None for name in PROJECTIONS)
    variables = variables_of(model, Settled(placed is not None, admitted is not None) if is_plant else None)
    members = {f"p.{name}": f"p.{member}" for name, member in c_members(model, program).items()}
    lacking = [name for name in PROJECTIONS if name in needed and name not in kernels]
    drifts = f"; drifts off its constraints without {' and '.join(lacking)}" if lacking else ""
    description = titled(model, f" ({role}{drifts})")
    return MockupUnitView(
        version=version,
        role=role,
        identifier=f"{model.c_name}_{role}",
        token="",
        symgen=__version__,
        description=description,
        about=heading(model, description),
        c=caller_names(model, program),
        coordinates=model.n,
        inputs=model.m,
        start=tuple(decimal_text("float64", Fraction(x)) for x in start_of(model)),
        variables=variables,
        places=tuple(members.get(one.place, one.place) for one in variables),
        units=unit_definitions(one.unit for one in variables),
        worked_out=calls[WORKED_OUT[role]],
        placed=placed,
        admitted=admitted,
        return_rate=RETURN_RATE,
        closing_rounds=CLOSING_ROUNDS,
        closed_within=CLOSED_WITHIN,
    )
