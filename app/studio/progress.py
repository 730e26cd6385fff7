"""Progress: what is being done and how long it will take, shown on a terminal and nowhere else.

Bars nest: one that is shown while another is moves that one on too, as far as what is being done counts in it.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from typing import TypeVar

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

Item = TypeVar("Item")

_shown: list["_Bar"] = []
"""The bars that are shown, each one for a part of the one before."""


def counted(items: Iterable[Item], /, *, total: int, doing: str) -> Iterator[Item]:
    """Yield the items while a bar on a terminal's standard error counts them; in a pipe, only yield them."""
    with _bar(doing, total) as bar:
        for item in items:
            yield item
            bar.move(1.0)


@contextmanager
def busy(doing: str, /) -> Iterator[None]:
    """Show on a terminal's standard error that something is being done, where nobody knows how long it takes."""
    with _bar(doing, None):
        yield


class Course:
    """Work in named parts, whose lengths are known relative to one another."""

    def __init__(self, bar: "_Bar", doing: str, parts: Mapping[str, float]) -> None:
        self._bar, self._doing, self._parts = bar, doing, parts

    @contextmanager
    def part(self, name: str, /) -> Iterator[None]:
        """Do a part of the work; what is counted meanwhile moves the bar on from the part's beginning to its end."""
        self._bar.worth = self._parts[name]
        self._bar.say(f"{self._doing}: {name}")
        yield
        self._bar.move(self._parts[name])


@contextmanager
def course(doing: str, parts: Mapping[str, float], /) -> Iterator[Course]:
    """Yield a course through `parts`, each with how long it takes in terms of the others."""
    with _bar(doing, sum(parts.values())) as bar:
        yield Course(bar, doing, parts)


class _Bar:
    """A bar for so much work, or for who knows how much."""

    def __init__(self, progress: Progress, doing: str, total: float | None) -> None:
        self.progress, self._total = progress, total
        self._task: TaskID = progress.add_task(doing, total=total)
        self._done, self._furthest = 0.0, 0.0
        self.worth = 1.0
        """How much of the work the next part of it is."""

    def say(self, doing: str) -> None:
        """Say what is being done now."""
        self.progress.update(self._task, description=doing)

    def move(self, worth: float) -> None:
        """Have so much more of the work done."""
        self._done += worth
        self.show(0.0)

    def show(self, share: float) -> None:
        """Show how far the work is, with a share of its next part; a bar never goes back."""
        if self._total is not None:
            self._furthest = max(self._furthest, self._done + share * self.worth)
            self.progress.update(self._task, completed=self._furthest)
            share = self._furthest / self._total if self._total else 1.0
        if self is not _shown[0]:
            _shown[_shown.index(self) - 1].show(min(1.0, share))

    def end(self) -> None:
        """Take it away."""
        self.progress.remove_task(self._task)


@contextmanager
def _bar(doing: str, total: float | None) -> Iterator[_Bar]:
    with nullcontext(_shown[-1].progress) if _shown else display() as progress:
        bar = _Bar(progress, doing, total)
        _shown.append(bar)
        try:
            yield bar
        finally:
            _shown.remove(bar)
            bar.end()


@contextmanager
def unseen() -> Iterator[None]:
    """Let nothing be shown meanwhile: who does this for another shows it to nobody."""
    bar = _Bar(Progress(disable=True), "", None)
    _shown.append(bar)
    try:
        yield
    finally:
        _shown.remove(bar)


def display() -> Progress:
    """Return where bars are shown: on a terminal's standard error, and otherwise nowhere."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
