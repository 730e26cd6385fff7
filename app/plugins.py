"""Plugins at the command line: what is installed, whether a wind keeps to the rules, and how to begin one."""

from dataclasses import astuple
from json import dumps

from ..engine.installed import Provided
from ..engine.plugged import system_plugins
from ..engine.plugins import PluginError, wind_kinds
from ..testing import NoContextError, headless_context, twin_problems, wind_problems

COLUMNS = "distribution", "version", "status"
"""Columns of the table after the name."""


def list_plugins(*, json: bool = False) -> None:
    """Print every kind of wind and every installed system, each with its package and whether it is used or left out.

    Nothing is imported: `check_plugin` and the doctor find out whether a `ready` wind can be loaded.
    """
    tables = {"kind": wind_kinds().provided(), "system": system_plugins().provided()}
    if json:
        rows = ((what, astuple(row)) for what, table in tables.items() for row in table)
        print(dumps([dict(zip((what, *COLUMNS), row, strict=True)) for what, row in rows], indent=2))
        return
    print("\n\n".join(_as_text(what, table) for what, table in tables.items() if table or what == "kind"))


def _as_text(first: str, rows: list[Provided]) -> str:
    table: list[tuple[str, ...]] = [(first, *COLUMNS), *map(astuple, rows)]
    widths = [*(max(len(line[column]) for line in table) for column in range(len(COLUMNS))), 0]
    cells = ([cell.ljust(width) for cell, width in zip(line, widths, strict=True)] for line in table)
    return "\n".join(map("  ".join, cells))


def check_plugin(kind: str) -> int:
    """Print every problem of a kind of wind with its defaults, or that it is ok.

    Returns the exit status: 0 when it is ok, 2 otherwise.
    """
    try:
        primitive = wind_kinds().find(kind)
    except PluginError as error:
        print(_system(kind) or error)
        return 2
    problems, hint = wind_problems(primitive), ""
    if not problems and primitive.twin is not None:
        try:
            with headless_context() as ctx:
                problems = twin_problems(primitive, ctx)
        except NoContextError as error:
            hint = f", but its twin was not looked at: {error}"
    default = primitive.model_fields["kind"].default
    if isinstance(default, str) and default != kind:
        problems.append(f"the field 'kind' defaults to '{default}', but the entry point is called '{kind}'")
    for line in problems or [f"ok{hint}"]:
        print(f"{kind}: {line}")
    return 2 if problems else 0


def _system(name: str) -> str | None:
    """Return a message for the check of a system instead of a wind; None where no system has that name."""
    owners = [row.distribution for row in system_plugins().provided() if row.name == name]
    if not owners:
        return None
    return (
        f"'{name}' is a system of {' and '.join(owners)}; check is for kinds of wind, systems have tests of their own"
    )
