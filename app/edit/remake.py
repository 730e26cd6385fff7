"""A prairie that follows its draft: at once where nothing has to grow, and otherwise behind the frames."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace

from ...engine.scene import LoadedScene, SceneError
from ...systems.prairie import Prairie
from ...systems.site import Site, is_grown

SLOW = ("terrain", "grass", "seed", "quality")
"""The keys of a scene that may need something to grow."""


class Remaking:
    """Lets a prairie become another reading of its scene while it goes on."""

    def __init__(self, prairie: Prairie) -> None:
        self._prairie = prairie
        self._hand = ThreadPoolExecutor(1, thread_name_prefix="tallgrass-grow")
        self._growing: tuple[LoadedScene, Future[Site]] | None = None
        self._wanted: LoadedScene | None = None

    @property
    def is_growing(self) -> bool:
        """Whether something is still to grow."""
        return self._wanted is not None

    def follow(self, loaded: LoadedScene) -> None:
        """Turn to another reading; what it says of light and wind shows at once, what has to grow later.

        Raises SceneError with every problem of its maps that can be told at once, and then nothing has changed.
        """
        if is_grown(self._prairie.site, loaded.scene, preset=self._prairie.preset):
            self._prairie.reload(loaded)
            self._wanted = None
            return
        with suppress(SceneError):  # a camera that stands on the new terrain alone shows with it
            self._prairie.reload(_meanwhile(loaded, self._prairie.loaded))
        self._wanted = loaded
        self._start()

    def forget(self) -> None:
        """Let what is growing come to nothing: the prairie has become something else meanwhile."""
        self._wanted = None

    def step(self) -> None:
        """Take over what has grown since the last frame; raises SceneError where it could not."""
        if self._growing is None or not self._growing[1].done():
            return
        loaded, future = self._growing
        wanted, self._growing = self._wanted, None
        if wanted is None:
            return
        try:
            self._prairie.reload(loaded, site=future.result())
        except SceneError:
            self._wanted = None if wanted is loaded else wanted
            self._start()
            raise
        self.follow(wanted)

    def wait(self) -> None:
        """Return when everything has grown; raises SceneError where it could not."""
        while self._growing is not None:
            self._growing[1].exception()
            self.step()

    def close(self) -> None:
        """Let go of what is still growing."""
        self._hand.shutdown(wait=False, cancel_futures=True)

    def _start(self) -> None:
        if self._growing is None and self._wanted is not None:
            find = self._prairie.finding(self._wanted)
            self._growing = self._wanted, self._hand.submit(_prepared, find, self._prairie.site)


def _prepared(find: Callable[[], Site], shown: Site) -> Site:
    """Return the site that is found, with what painters take long to make where it has other grass than is shown."""
    site = find()
    if site.growths != shown.growths or site.quality != shown.quality:
        for each in site.representations:
            each.prepare()
    return site


def _meanwhile(loaded: LoadedScene, shown: LoadedScene) -> LoadedScene:
    """Return a reading with the ground and the grass that are shown."""
    kept = {name: getattr(shown.scene, name) for name in SLOW}
    scene = loaded.scene.model_copy(update=kept)
    return replace(loaded, scene=scene, files=shown.files, pictures=shown.pictures)
