"""Errors of commands."""

import importlib
from typing import Any


class InputError(Exception):
    """Bad input; its text is one line per problem, each with its place."""


class MachineError(Exception):
    """Valid input that this machine cannot process; its text is one sentence with the remedy."""


def needed(module: str, what: str, /, *, extra: str) -> Any:
    """Import an optional module; raises MachineError with its purpose and the command that installs it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise MachineError(f"{what}: pip install 'tallgrass[{extra}]'") from None
