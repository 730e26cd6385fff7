"""Progress: shown on a terminal, and nowhere else."""

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

Item = TypeVar("Item")


def counted(items: Iterable[Item], /, *, total: int, doing: str) -> Iterator[Item]:
    """Yield the items while a bar on a terminal's standard error counts them; in a pipe, only yield them."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        yield from bar.track(items, total=total, description=doing)


def busy(doing: str, /) -> AbstractContextManager[object]:
    """Return a context in which a terminal's standard error shows that something is being done."""
    console = Console(stderr=True)
    return console.status(doing) if console.is_terminal else nullcontext()
