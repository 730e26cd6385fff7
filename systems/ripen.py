"""Ripening: changed kinds are grown anew on another thread, and replace the old plants one by one."""

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace

from ..engine.declared.grass import GrassKind
from ..engine.executor import DaemonExecutor
from .seasons import Batch, Kinds, Seasons
from .site import Site, must_grow, ripened

Stage = Callable[[Site, Site], bool]
"""Uploads a piece of a site that will replace another; returns whether all of it is there."""


@dataclass(frozen=True, slots=True, eq=False)
class _Pending:
    """A site that is being made."""

    site: "Future[Site] | Site"
    stands: Mapping[str, GrassKind]
    """Kinds that have grown on it."""

    batch: Batch | None
    """Kinds that change on it."""


class Ripening:
    """Exchanges a site for the next when kinds of it are grown anew; otherwise it does nothing."""

    def __init__(self, seasons: Seasons, *, live: bool) -> None:
        self._seasons, self._live = seasons, live
        self._pending: _Pending | None = None
        self._executor = DaemonExecutor()
        self._batch_end = 0.0
        """Time at which the last batch of kinds had changed [s]."""

    def begin(self) -> None:
        """Drop the pending site."""
        self._pending = None

    def resume(self, site: Site, kinds: Kinds, /) -> Site:
        """Return the site with its kinds as they were when they were saved."""
        known = self._known
        self._pending = None
        self._seasons.kinds = kinds
        coming = {} if kinds.batch is None else kinds.batch.kinds
        return ripened(site, known, kinds.standing, coming)

    @property
    def _known(self) -> tuple[Mapping[str, GrassKind], Mapping[str, GrassKind]]:
        """Kinds that have grown, and those that they are changing to."""
        batch = self._seasons.kinds.batch
        return self._seasons.kinds.standing, {} if batch is None else batch.kinds

    def step(self, site: Site, time: float, stage: Stage, /) -> Site:
        """Return the site at `time` [s]; a prairie that is not live waits for what has to grow."""
        waits = not self._live
        while True:
            if self._pending is None:
                self._pending = self._next(site, time, waits=waits)
            moved = self._arrive(site, time, stage, waits=waits)
            if moved is site or not waits:
                break
            site = moved
        came = () if self._seasons.kinds.batch is None else self._seasons.kinds.batch.came(moved.scene.grass, time)
        return moved if came == moved.came else moved.come(came)

    def _next(self, site: Site, time: float, *, waits: bool) -> _Pending | None:
        """Return the next site that is due, if there is one."""
        batch = self._seasons.kinds.batch
        if batch is not None:
            if min(batch.came(batch.kinds, time)) < 1.0:
                return None
            self._batch_end = batch.since + max(batch.over.values())
            return self._made(site, batch.kinds, None, waits=waits)
        due = self._seasons.to_grow
        if not due:
            return None
        over = self._seasons.kinds.over
        grows = {name: kind for name, kind in due.items() if over.get(name, 0.0) > 0.0 and must_grow(site, name, kind)}
        at_once = {name: kind for name, kind in due.items() if name not in grows}
        since = max(self._batch_end, *(self._seasons.kinds.asked.get(name, 0.0) for name in due))
        begun = Batch(grows, since, {name: over[name] for name in grows}) if grows else None
        return self._made(site, at_once, begun, waits=waits)

    def _made(self, site: Site, changed: Mapping[str, GrassKind], batch: Batch | None, *, waits: bool) -> _Pending:
        """Return the site on which the `changed` kinds have grown and those of `batch` are changing, or its future."""
        stands = self._seasons.kinds.standing | dict(changed)
        wanted = site, self._known, stands, {} if batch is None else batch.kinds
        if waits:
            return _Pending(ripened(*wanted), stands, batch)
        return _Pending(self._executor.submit(ripened, *wanted), stands, batch)

    def _arrive(self, site: Site, time: float, stage: Stage, *, waits: bool) -> Site:
        """Return the pending site if it is complete and uploaded, otherwise the present one."""
        pending = self._pending
        if pending is None:
            return site
        made = pending.site
        if isinstance(made, Future):
            if not waits and not made.done():
                return site
            made = made.result()
        if not waits and not stage(made, site):
            return site
        self._seasons.kinds.standing, self._seasons.kinds.batch = dict(pending.stands), pending.batch
        if pending.batch is not None and not waits:
            self._seasons.kinds.batch = replace(pending.batch, since=time)
        self._pending = None
        return made

    def release(self) -> None:
        """Cancel what is pending, and grow no more."""
        self._executor.release()
