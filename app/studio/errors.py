"""Errors of commands."""

import importlib
from typing import Any


class InputError(Exception):
    """What a person asked for cannot be done as asked: its text is one line per problem, each with its place."""


class MachineError(Exception):
    """The asked is right, but this machine cannot do it: its text is one sentence that says what would help."""


def needed(module: str, what: str, /, *, extra: str) -> Any:
    """Return a module that only some commands need; raises MachineError with what it is for, and how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise MachineError(f"{what}: pip install 'tallgrass[{extra}]'") from None
