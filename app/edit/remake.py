"""A prairie that follows its draft: at once where nothing has to grow, else after growing in the background."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace

from ...engine.scene import LoadedScene, SceneError
from ...systems.prairie import Prairie
from ...systems.site import Site, is_grown

SLOW = ("terrain", "grass", "seed", "quality")
"""Keys of a scene whose changes may need growing."""


class Remaking:
    """Brings new readings of a scene into its running prairie."""

    def __init__(self, prairie: Prairie) -> None:
        self._prairie = prairie
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="tallgrass-grow")
        self._growing: tuple[LoadedScene, Future[Site]] | None = None
        self._wanted: LoadedScene | None = None

    @property
    def is_growing(self) -> bool:
        """Whether a reading is still growing."""
        return self._wanted is not None

    def follow(self, loaded: LoadedScene) -> None:
        """Turn to another reading: its light and winds show at once, whatever has to grow shows later.

        Raises SceneError with the problems of its maps that are found at once; then nothing has changed.
        """
        if is_grown(self._prairie.site, loaded.scene, preset=self._prairie.preset):
            self._prairie.reload(loaded)
            self._wanted = None
            return
        with suppress(SceneError):  # a camera that fits only the new terrain waits for it
            self._prairie.reload(_meanwhile(loaded, self._prairie.loaded))
        self._wanted = loaded
        self._start()

    def forget(self) -> None:
        """Discard what is growing: the prairie has got another scene meanwhile."""
        self._wanted = None

    def step(self) -> None:
        """Take over what has grown since the last frame; raises the error of what could not grow."""
        if self._growing is None or not self._growing[1].done():
            return
        loaded, future = self._growing
        wanted, self._growing = self._wanted, None
        if wanted is None:
            return
        try:
            self._prairie.reload(loaded, site=future.result())
        except Exception:
            self._wanted = None if wanted is loaded else wanted
            self._start()
            raise
        self.follow(wanted)

    def wait(self) -> None:
        """Wait until everything has grown; raises the error of what could not grow."""
        while self._growing is not None:
            self._growing[1].exception()
            self.step()

    def close(self) -> None:
        """Cancel what is still growing."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _start(self) -> None:
        if self._growing is None and self._wanted is not None:
            find = self._prairie.finding(self._wanted)
            self._growing = self._wanted, self._pool.submit(_prepared, find, self._prairie.site)


def _prepared(find: Callable[[], Site], shown: Site) -> Site:
    """Find a site; prepare its representations, which takes long, if its grass differs from the `shown` site's."""
    site = find()
    if site.growths != shown.growths or site.quality != shown.quality:
        for each in site.representations:
            each.prepare()
    return site


def _meanwhile(loaded: LoadedScene, shown: LoadedScene) -> LoadedScene:
    """Return a reading with the ground and the grass of the reading `shown`."""
    kept = {name: getattr(shown.scene, name) for name in SLOW}
    scene = loaded.scene.model_copy(update=kept)
    return replace(loaded, scene=scene, files=shown.files, pictures=shown.pictures)
