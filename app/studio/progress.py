"""Progress bars: the current work and its remaining time, on a terminal only.

Bars nest: an inner bar also moves the outer bar, through the part of the outer work that the inner one stands for.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from typing import TypeVar

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

Item = TypeVar("Item")

_shown: list["Bar"] = []
"""Bars that are shown, each for a part of the one before."""


def counted(items: Iterable[Item], /, *, total: int, doing: str) -> Iterator[Item]:
    """Yield the items while a bar on a terminal's standard error counts them; in a pipe, only yield them."""
    with _bar(doing, total, {}) as bar:
        for item in items:
            yield item
            bar.move(1.0)


@contextmanager
def busy(doing: str, /) -> Iterator[None]:
    """Show work of unknown length on a terminal's standard error."""
    with _bar(doing, None, {}):
        yield


class Bar:
    """A bar for an amount of work, of which parts may have names, or for an unknown amount."""

    def __init__(self, progress: Progress, doing: str, total: float | None, parts: Mapping[str, float]) -> None:
        self.progress, self._doing, self._total, self._parts = progress, doing, total, parts
        self.task = progress.add_task(doing, total=total)
        self._done, self._furthest, self._worth = 0.0, 0.0, 1.0

    @contextmanager
    def part(self, name: str, /) -> Iterator[None]:
        """Do a part of the work; bars inside it move this bar from the part's beginning to its end."""
        self._worth = self._parts[name]
        self.progress.update(self.task, description=f"{self._doing}: {name}")
        yield
        self.move(self._worth)

    def move(self, worth: float) -> None:
        """Move the bar on by an amount of work."""
        self._done += worth
        self.show(0.0)

    def show(self, fraction: float) -> None:
        """Show the work done, including a fraction of the present part; a bar never goes back."""
        if self._total is not None:
            self._furthest = max(self._furthest, self._done + fraction * self._worth)
            self.progress.update(self.task, completed=self._furthest)
            fraction = self._furthest / self._total if self._total else 1.0
        if self is not _shown[0]:
            _shown[_shown.index(self) - 1].show(min(1.0, fraction))


@contextmanager
def course(doing: str, parts: Mapping[str, float], /) -> Iterator[Bar]:
    """Yield a bar for work in named parts, which have relative durations."""
    with _bar(doing, sum(parts.values()), parts) as bar:
        yield bar


@contextmanager
def _bar(doing: str, total: float | None, parts: Mapping[str, float]) -> Iterator[Bar]:
    with nullcontext(_shown[-1].progress) if _shown else display() as progress:
        bar = Bar(progress, doing, total, parts)
        _shown.append(bar)
        try:
            yield bar
        finally:
            _shown.remove(bar)
            progress.remove_task(bar.task)


@contextmanager
def unseen() -> Iterator[None]:
    """Show no bars meanwhile, as in a worker."""
    bar = Bar(Progress(disable=True), "", None, {})
    _shown.append(bar)
    try:
        yield
    finally:
        _shown.remove(bar)


def display() -> Progress:
    """Return a display of bars: on a terminal's standard error, or disabled where that is no terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
