"""`symgen completion SHELL`: what a shell completes words by, made of the parsers of all commands."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from symgen.backends.render import render
from symgen.cli.arguments import USUAL
from symgen.generation.results import ALL_PARTS, AUTO, LINEARIZATION, NAMED_METHODS
from symgen.model.quantities import ROWS

# What stands in the place of a word: nothing that is known, a model file, a log, a folder, one of several words, or
# several of them with commas between.
Kind: TypeAlias = Literal["", "model", "log", "folder", "word", "list"]

MODELS = ("yaml", "yml", "urdf")
# Flags that end a run stand in every parser.
_HELP = ("-h", "--help")


@dataclass(frozen=True, slots=True)
class ValueView:
    """What may stand in one place."""

    kind: Kind
    words: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class OptionView:
    """An option by one of its names; `value` is what stands behind it, if anything does."""

    name: str
    help: str
    metavar: str
    value: ValueView | None
    repeats: bool


@dataclass(frozen=True, slots=True)
class CommandView:
    """A command, of which "" is `symgen MODEL.yaml`; `places` are the words that are no options, the last of them again
    and again if it `repeats`."""

    name: str
    help: str
    options: tuple[OptionView, ...]
    places: tuple[ValueView, ...]
    repeats: bool


@dataclass(frozen=True, slots=True)
class CompletionView:
    """All commands."""

    commands: tuple[CommandView, ...]
    models: tuple[str, ...] = MODELS

    @property
    def plain(self) -> CommandView:
        """The one without a name."""
        return self.commands[0]

    @property
    def named(self) -> tuple[CommandView, ...]:
        """The others."""
        return self.commands[1:]


def script(shell: str, parsers: Mapping[str, argparse.ArgumentParser]) -> str:
    """The script for a shell, by the parsers of the commands, of which that without a name comes first."""
    commands = tuple(_command(name, parser) for name, parser in parsers.items())
    return render(f"completion/{shell}.jinja", CompletionView(commands))


def _command(name: str, parser: argparse.ArgumentParser) -> CommandView:
    options, places, repeats = [], [], False
    for action in parser._actions:
        if not action.option_strings:
            places.append(_value(action))
            repeats = action.nargs == "+"
        elif action.option_strings != [*_HELP]:
            value = None if action.nargs == 0 else _value(action)
            again = isinstance(action, argparse._AppendAction)
            options += [
                OptionView(option, _short(action.help), str(action.metavar or action.dest), value, again)
                for option in action.option_strings
            ]
    return CommandView(name, _short(parser.description), tuple(options), tuple(places), repeats)


def _short(text: str | None) -> str:
    """The first thing that is said, in characters that are plain in every shell."""
    first = (text or "").partition("(default")[0].rstrip().partition(";")[0].partition(": ")[0].rstrip(".")
    return "".join(character for character in first if character.isalnum() or character in " -_,./")


def _value(action: argparse.Action) -> ValueView:
    if action.choices is not None:
        return ValueView("word", tuple(map(str, action.choices)))
    return _BY_METAVAR.get(str(action.metavar), ValueView(""))


def _methods() -> tuple[str, ...]:
    """As they are told: those of the inverse dynamics alone too."""
    of_others = (f"{quantity}={method}" for quantity, methods in NAMED_METHODS.items() for method in methods)
    return (AUTO, *NAMED_METHODS[USUAL], *of_others)


_BY_METAVAR: Mapping[str, ValueView] = {
    "MODEL.yaml": ValueView("model"),
    "LOG.csv": ValueView("log"),
    "DIR": ValueView("folder"),
    "PARTS": ValueView("list", ALL_PARTS),
    "A,B": ValueView("list", ("all", *ROWS)),
    "QUANTITY": ValueView("word", (*ROWS, LINEARIZATION)),
    "[QUANTITY=]METHOD": ValueView("word", _methods()),
}
