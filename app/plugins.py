"""Plugins at the command line: what is installed, whether a wind keeps to the rules, and how to begin one."""

from dataclasses import asdict
from json import dumps

from ..engine.plugged import system_plugins
from ..engine.plugins import PluginError, wind_kinds
from ..testing import NoContextError, headless_context, twin_problems, wind_problems


def list_plugins(*, json: bool = False) -> None:
    """Print every kind of wind and every installed system, each with its package and whether it is used or left out.

    Nothing is imported: `check_plugin` and the doctor find out whether a `ready` wind can be loaded.
    """
    winds, systems = wind_kinds().provided(), system_plugins().provided()
    if json:
        print(dumps([*map(asdict, winds), *map(asdict, systems)], indent=2))
        return
    _print_table("kind", [(row.kind, row.distribution, row.version, row.status) for row in winds])
    if systems:
        print()
        _print_table("system", [(row.system, row.distribution, row.version, row.status) for row in systems])


def _print_table(first: str, rows: list[tuple[str, str, str, str]]) -> None:
    table = [(first, "distribution", "version", "status"), *rows]
    widths = [max(len(line[column]) for line in table) for column in range(3)]
    for line in table:
        cells = [cell.ljust(width) for cell, width in zip(line, widths, strict=False)]
        print("  ".join([*cells, line[3]]))


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
    owners = [row.distribution for row in system_plugins().provided() if row.system == name]
    if not owners:
        return None
    return (
        f"'{name}' is a system of {' and '.join(owners)}; check is for kinds of wind, systems have tests of their own"
    )
