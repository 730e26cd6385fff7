"""Ripening: what must be grown anew of changed kinds grows beside, and comes in plant by plant."""

from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

from ..engine.declared.grass import GrassKind
from .seasons import Batch, Recalled, Seasons
from .site import Site, is_other, ripened

Stage = Callable[[Site, Site], bool]
"""Makes ready for a piece of a site in place of another, and says whether all of it is there."""


@dataclass(frozen=True, slots=True, eq=False)
class _Asked:
    """A site that is being made."""

    site: "Future[Site] | Site"
    stands: Mapping[str, GrassKind]
    """What stands on it."""

    batch: Batch | None
    """What becomes another on it."""


class Ripening:
    """Carries a site from season to season. While nothing grows anew, it does nothing."""

    def __init__(self, seasons: Seasons, *, live: bool) -> None:
        self._seasons, self._live = seasons, live
        self._asked: _Asked | None = None
        self._hands = ThreadPoolExecutor(1, thread_name_prefix="tallgrass")  # without a thread, until it is asked
        self._free = 0.0
        """When the last kinds had become others that did so together [s]."""

    def begin(self) -> None:
        """Begin anew with what stands."""
        self._asked = None

    def resume(self, site: Site, recalled: Recalled, /) -> Site:
        """Return a site as it was when its kinds were saved."""
        known = self._known
        self._asked = None
        self._seasons.resume(recalled)
        coming = {} if recalled.batch is None else recalled.batch.kinds
        return ripened(site, known, recalled.standing, coming)

    @property
    def _known(self) -> tuple[Mapping[str, GrassKind], Mapping[str, GrassKind]]:
        """The kinds that stand, and those that are coming."""
        batch = self._seasons.batch
        return self._seasons.standing, {} if batch is None else batch.kinds

    def step(self, site: Site, time: float, stage: Stage, /) -> Site:
        """Return the site as it is at a time [s]; it waits for what has to grow where nobody watches."""
        waits = not self._live
        while True:
            if self._asked is None:
                self._asked = self._ask(site, time, waits=waits)
            moved = self._arrive(site, time, stage, waits=waits)
            if moved is site or not waits:
                break
            site = moved
        return self._at(moved, time)

    def _ask(self, site: Site, time: float, *, waits: bool) -> _Asked | None:
        """Return the site that is due next, if another is."""
        batch = self._seasons.batch
        if batch is not None:
            if min(batch.came(batch.kinds, time)) < 1.0:
                return None
            self._free = batch.since + max(batch.over.values())
            return self._made(site, batch.kinds, None, waits=waits)
        due = self._seasons.to_grow
        if not due:
            return None
        over = self._seasons.over
        grows = {name: kind for name, kind in due.items() if over.get(name, 0.0) > 0.0 and is_other(site, name, kind)}
        at_once = {name: kind for name, kind in due.items() if name not in grows}
        since = max(self._free, *(self._seasons.asked.get(name, 0.0) for name in due))
        begun = Batch(grows, since, {name: over[name] for name in grows}) if grows else None
        return self._made(site, at_once, begun, waits=waits)

    def _made(self, site: Site, stood: Mapping[str, GrassKind], batch: Batch | None, *, waits: bool) -> _Asked:
        stands = self._seasons.standing | dict(stood)
        wanted = site, self._known, stands, {} if batch is None else batch.kinds
        if waits:
            return _Asked(ripened(*wanted), stands, batch)
        return _Asked(self._hands.submit(ripened, *wanted), stands, batch)

    def _arrive(self, site: Site, time: float, stage: Stage, *, waits: bool) -> Site:
        """Return the site that has been asked for, if all of it is there; otherwise the one that stands."""
        asked = self._asked
        if asked is None:
            return site
        made = asked.site
        if isinstance(made, Future):
            if not waits and not made.done():
                return site
            made = made.result()
        if not waits and not stage(made, site):
            return site
        self._seasons.standing, self._seasons.batch = dict(asked.stands), asked.batch
        if asked.batch is not None and not waits:
            self._seasons.batch = replace(asked.batch, since=time)
        self._asked = None
        return made

    def _at(self, site: Site, time: float) -> Site:
        came = () if self._seasons.batch is None else self._seasons.batch.came(site.scene.grass, time)
        return site if came == site.came else site.come(came)

    def release(self) -> None:
        """Let nothing grow any more."""
        self._hands.shutdown(wait=False, cancel_futures=True)
