"""Looking: a viewer takes its new place, view cone and time, before the systems run for it."""

from collections.abc import Sequence
from functools import partial

from ..engine.camera import View
from .around.outlook import Outlook, Outlooks
from .frame.feature import Feature, overriding
from .room import get_ready
from .screen import Screen
from .site import Site, outlook_on
from .streaming import Streaming

LEAP = 2.0
"""Distance beyond which a viewer's move in one frame counts as a jump [patch sides]."""


class Looking:
    """Lets the viewers of a prairie look, and streaming ground and features follow them."""

    def __init__(self, viewers: Outlooks, features: Sequence[Feature], *, live: bool) -> None:
        self._viewers, self._streaming = viewers, Streaming(live=live)
        self._stepping, self._looking = (overriding(Feature, name, features) for name in ("step", "look"))

    def follow(self, site: Site, viewer: str, seen: View, *, time: float) -> None:
        """Let streaming ground and features follow the viewers, one of whom now sees by `seen`."""
        others = [outlook.viewer for outlook in self._viewers.values() if outlook.viewer.name != viewer]
        self._streaming.follow(site.ground.terrain, seen.eye, others, time=time)
        for feature in self._stepping:
            feature.step(viewer, seen.eye, time=time)

    def look(self, site: Site, viewer: str, seen: View, *, time: float, goes_on: bool = False) -> Outlook:
        """Let a viewer look, unless it `goes_on` with its last frame; return its outlook."""
        outlook = self._viewers.looking(viewer, partial(outlook_on, site))
        if goes_on:
            return outlook
        for feature in self._looking:
            feature.look(outlook)
        outlook.look(seen, time=time, leap=LEAP * site.ground.patch)
        return outlook

    def stage(self, screen: Screen, site: Site, before: Site) -> bool:
        """Upload a piece of another site, or prepare one viewer's pools for it; return whether all of it is there."""
        if not screen.stage(site):
            return False
        ready = (get_ready(each, site.representations, before.representations) for each in self._viewers.values())
        return all(ready)  # stops at the first viewer that was not ready

    def release(self) -> None:
        """End the thread of streaming ground."""
        self._streaming.release()
