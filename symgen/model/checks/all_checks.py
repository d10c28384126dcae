"""What a model must be beyond well-formed names: the checks of structure and of the mechanism, all run together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.availability import lacking
from symgen.model.checks.as_numbers import with_numbers
from symgen.model.checks.bodies import check_bodies
from symgen.model.checks.empty_rows import check_empty_rows, parameters_that_count
from symgen.model.checks.feasibility import check_motion, left_by_task, measures_places
from symgen.model.checks.redundancy import check_redundancy
from symgen.model.checks.rough import check_locking, check_rates, check_rough
from symgen.model.checks.structure import check_domain, check_kinetic_energy, check_nonholonomic
from symgen.model.checks.tied import tied_parameters
from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.branches import branches
from symgen.model.configurations.friction_shares import friction_shares
from symgen.model.configurations.friction_steps import friction_steps
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.names import shown_names
from symgen.model.expressions.walk import exact_value
from symgen.model.file.reading import entries, key_span, member
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode
from symgen.model.model import Model
from symgen.model.quantities import ROWS


def check_mechanics(scope: Scope, tree: MappingNode, model: Model, kinetic: Expression | None, whole: bool) -> Model:
    """Adds to `scope` what is wrong with the model's mechanics; the model with its assembly where nothing is.

    `kinetic` is None where the kinetic energy could not be read.  `whole` says that the mechanical part of the file is
    free of mistakes, so that the mechanism as a whole can be judged too.
    """
    if not model.coordinates:
        return model
    written = mechanics = NumericSystem.of(model)
    before = len(scope.mistakes)
    # where frames hang on themselves nothing can be said about their motion
    turning = mechanics.turning() if whole else {}
    _add(scope, check_bodies(model.mechanism, mechanics.defaults, turning))
    if kinetic is not None:
        _add(scope, check_domain(mechanics, kinetic, "the kinetic energy"))
    _add(scope, check_domain(mechanics, model.potential_energy, "the potential energy"))
    for row in model.constraints:
        _add(scope, check_domain(mechanics, row.expression, f"the constraint `{row.name}`"))
    for x in model.task:
        _add(scope, check_domain(mechanics, x.expression, f"`{x.name}` of the task"))
    for column in model.inputs:
        for coordinate, coefficient in column.acts_on:
            _add(scope, check_domain(mechanics, coefficient, f"the coefficient of `{column.name}` on `{coordinate}`"))
        if column.velocity is not None:
            _add(scope, check_domain(mechanics, column.velocity, f"the direction of `{column.name}`"))
    for place in model.rough:
        _add(scope, check_domain(mechanics, place.velocity, f"the rate of the friction of `{place.name}`"))
    _add(scope, check_rates(mechanics, model.rough))
    for force in model.forces:
        _add(scope, check_domain(mechanics, force.velocity, f"the direction of `{force.name}`"))
    if len(scope.mistakes) > before:
        return model
    if kinetic is not None and not (model.mechanism.has_mass and exact_value(kinetic) == 0):
        _add(scope, check_kinetic_energy(mechanics, kinetic))
    rolling = (row for row in model.constraints if row.kind == "nonholonomic")
    not_linear = [mistake for row in rolling for mistake in check_nonholonomic(mechanics, row)]
    _add(scope, not_linear)
    if not not_linear and (whole or not model.mechanism.frames):
        numbers = parameters_that_count(mechanics)
        if numbers:
            before_numbers, model = model, with_numbers(model, numbers, mechanics.defaults)
            _add(scope, _notices_of_numbers(before_numbers, model))
            written = mechanics = NumericSystem.of(model)
        rows, reports = check_empty_rows(mechanics)
        _add(scope, reports)
        model = replace(model, constraints=rows)
        mechanics = mechanics.having(mechanics.defaults, rows)
    massive = model.mechanism.has_mass and (kinetic is not None or tree.get("kinetic_energy") is None)
    if whole and (massive or kinetic is not None) and len(scope.mistakes) == before:
        start = {name: float(value) for name, value in model.configuration}
        assembly = branches(mechanics, model.inputs, start)
        written_out = {key.value for key, _ in entries(tree.get("configuration"))}
        declared = {name: value for name, value in start.items() if name in written_out}
        chosen = model.independent_velocities, model.measured
        _add(scope, check_motion(mechanics, assembly, *chosen, declared, _block_spans(tree)))
        if isinstance(assembly, Assembly) and len(scope.mistakes) == before:
            if model.allocation is not None:
                _add(scope, check_redundancy(mechanics, assembly, model.inputs, model.allocation, model.outputs))
            if model.rough:
                _add(scope, check_rough(model, assembly))
            assembly = replace(assembly, tied=tied_parameters(written, mechanics, assembly))
            _add(scope, _notices_of_tied(model, assembly.tied))
            places = not model.measured or measures_places(mechanics, assembly, model.measured)
            left = left_by_task(mechanics, assembly, model.task)
            model = replace(model, assembly=assembly, measures_places=places, task_leaves=left)
            if model.rough and len(scope.mistakes) == before:
                steps, of_motion = (friction_steps(friction_shares(model, assembly, x)) for x in (False, True))
                _add(scope, check_locking(model, steps, of_motion))
                return replace(model, friction_steps=steps, motion_steps=of_motion)
    return model


def _notices_of_numbers(before: Model, model: Model) -> Iterator[Notice]:
    """Parameters that kernels cannot be given at run time."""
    for name, value in model.taken:
        (parameter,) = (p for p in before.parameters if p.name == name)
        despite = " in spite of its range" if parameter.range is not None else ""
        yield Notice(
            f"`{name}` is taken as the number {float(value):.6g}{despite} and is no parameter of the kernels: with "
            "other values there would be more constraints, a model with another default is a machine of its own",
            parameter.span,
        )


def _notices_of_tied(model: Model, tied: Iterable[str]) -> Iterator[Notice]:
    """The ranges of parameters that cannot have any value but one."""
    these = [parameter for parameter in model.parameters if parameter.name in tied and parameter.range is not None]
    if these:
        its = "its" if len(these) == 1 else "their"
        verb = "keeps" if len(these) == 1 else "keep"
        yield Notice(
            f"{shown_names(p.name for p in these)} {verb} {its} default in spite of {its} range: rows that depend on "
            "each other can be closed for no other value",
            these[0].span,
        )


def notice_empty_outputs(scope: Scope, tree: MappingNode, model: Model) -> None:
    """Requested quantities that this model does not have."""
    span = key_span(tree, "outputs")
    for name in model.outputs:
        if name in ROWS and (reason := lacking(ROWS[name], model)) is not None:
            scope.notices.append(Notice(f"`{name}` is not made: {reason}", span))


def notice_efforts(scope: Scope, model: Model) -> None:
    """Effort limits of a robot, and what keeps inputs within them where that is known."""
    notice = scope.efforts
    if notice is None or (model.allocation is not None and model.allocation.limits):
        return
    if model.assembly is not None and _shares_once(model, model.assembly):
        notice = Notice(f"{notice.message}: `limits` under `allocation` can", notice.span)
    scope.notices.append(notice)


def _shares_once(model: Model, assembly: Assembly) -> bool:
    """Whether there is one direction of internal force, with a sign of its own."""
    delta = model.n - assembly.ranks.constraints
    return assembly.ranks.actuation == delta == model.m - 1 and assembly.ranks.constraints == model.r


def _add(scope: Scope, reports: Iterable[Mistake | Notice]) -> None:
    for one in reports:
        if isinstance(one, Mistake):
            scope.mistakes.append(one)
        else:
            scope.notices.append(one)


def _block_spans(tree: MappingNode) -> dict[str, Span | None]:
    keys = ("constraints", "kinetic_energy", "independent_velocities", "measured", "coordinates", "configuration")
    spans = {key: key_span(tree, key) for key in keys}
    spans["kinetic_energy"] = spans["kinetic_energy"] or key_span(tree, "bodies")
    constraints = member(tree, "constraints")
    geometric = key_span(constraints, "geometric") if isinstance(constraints, MappingNode) else None
    made = [key_span(tree, key) for key in ("loops", "rolling", "joints")]
    rows = next((span for span in (spans["constraints"], *made) if span is not None), None)
    return {**spans, "constraints": rows, "geometric": geometric or rows}
