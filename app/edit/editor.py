"""The editor of a scene: changes, undo and saving, without a window."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel

from ...components.arrays import Place
from ...components.wind import WindPrimitive
from ...engine.complaint import said
from ...engine.declared.scene import Scene
from ...engine.plugins import wind_kinds
from ...engine.scene import LoadedScene, SceneError, load_maps
from ...engine.scene.document import Document, noded
from ...engine.scene.read import load_document
from ...engine.terrain.density import Picture
from ...systems.prairie import Prairie
from ...systems.wind.quarantine import QuarantinedError
from .anchors import PLACE, Anchor, declared_anchors
from .brush import Brush, new_picture, read_picture, stroked
from .fields import first_part, keys_of
from .history import Draft, History
from .pen import Pen
from .remake import Remaking
from .values import NOTHING, Way, value_at, with_value

log = logging.getLogger("tallgrass")

CENTIMETRES = 2
"""Decimals of a dragged place [m]."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """A change that was refused."""

    way: Way
    """Way to the key of the change."""

    reasons: tuple[str, ...]
    """Reasons, a sentence each."""


class Editor:
    """Changes the scene of a running prairie.

    An impossible change is refused: then nothing changes, and `refusal` has the reasons until the next change.
    """

    def __init__(self, prairie: Prairie) -> None:
        self.prairie = prairie
        self.remaking = Remaking(prairie)
        self.pen: Pen
        self.history: History
        self.loaded: LoadedScene
        self.refusal: Refusal | None = None
        self.picked: int | None = None
        """Index of the picked wind."""
        self.brush: Brush | None = None
        """The brush of strokes; None while the mouse picks winds."""
        self.spot: Place = (0.0, 0.0)
        """Ground position of a new wind, (x, z) [m]."""
        self._strokes = count()
        self._stroke: int | None = None
        self._shown: Draft
        self._unpainted: dict[str, Picture]
        """Painted maps as they were before, by name."""
        self._begin(prairie.loaded)

    @property
    def scene(self) -> Scene:
        """The scene of the draft; the prairie shows it once it has grown."""
        return self.loaded.scene

    @property
    def winds(self) -> Sequence[WindPrimitive]:
        """The winds of the draft."""
        return self.scene.wind

    @property
    def picked_wind(self) -> WindPrimitive | None:
        """The picked wind, None if it is gone."""
        return self.winds[self.picked] if self.picked is not None and self.picked < len(self.winds) else None

    def is_said(self, way: Way) -> bool:
        """Return whether the file has a value at a way."""
        return value_at(self.history.now.values, way) is not NOTHING

    def set(self, way: Way, value: Any, *, subject: object = None) -> bool:
        """Set a key's value; return whether it was accepted. Successive changes of one subject are undone together."""
        return self.set_all({way: value}, subject=subject)

    def set_all(self, values: dict[Way, Any], *, subject: object) -> bool:
        """Set the values of several keys in one step; NOTHING removes a key. Return whether they were accepted."""
        draft = self.history.now
        try:
            for way, value in values.items():
                whole = self._whole(draft.values, way) if value is not NOTHING else draft.values
                draft = replace(draft, values=with_value(whole, way, value))
        except LookupError:
            self.refusal = Refusal(next(iter(values)), ("there is no such place in the scene any more",))
            return False
        return self._take(draft, way=next(iter(values)), subject=subject)

    def add_wind(self, values: dict[str, Any]) -> bool:
        """Add a wind with these values of its keys, and pick it; return whether it was accepted."""
        number = len(self.winds)
        done = self.set(("wind", number), values)
        self.picked = number if done else self.picked
        return done

    def add_wind_of(self, kind: str) -> bool:
        """Add a wind of a kind: at `spot` if it has a place, and starting now if it would be over already."""
        try:
            model = wind_kinds().find(kind)
        except ValueError as error:
            self.refusal = Refusal(("wind",), (str(error),))
            return False
        values = first_part(model, kind=kind)
        if any(key.name == PLACE and key.form == "numbers" for key in keys_of(model)):
            values[PLACE] = [round(each, CENTIMETRES) for each in self.spot]
        if not self.add_wind(values):
            return False
        if self._is_over(self.winds[-1]):
            self.history.undo()
            return self.add_wind(values | {"start": round(self.prairie.time, 1)})
        return True

    def remove(self, way: Way) -> bool:
        """Remove a key, which returns to its default, or an item of a list."""
        if way[:1] == ("wind",):
            self.picked = None  # the indices of later winds change
        return self.set(way, NOTHING)

    def rest(self) -> None:
        """Let the next change be a step of its own."""
        self.history.rest()
        self._stroke = None

    def undo(self) -> None:
        """Undo the last step."""
        self._go(done=self.history.undo())

    def redo(self) -> None:
        """Redo the step that was undone last."""
        self._go(done=self.history.redo())

    def drag(self, moved: Sequence[Anchor], by: Place) -> None:
        """Move anchors `by` (x, z) [m] from their places at the beginning of the drag."""
        places = {
            each.way: [round(each.place[0] + by[0], CENTIMETRES), round(each.place[1] + by[1], CENTIMETRES)]
            for each in moved
        }
        if places:
            self.set_all(places, subject=("drag", tuple(places)))

    def paint(self, line: Sequence[Place], brush: Brush) -> None:
        """Continue a stroke of a brush along ground positions (x, z) [m]; `rest` ends the stroke."""
        if not {brush.kind} <= self.scene.grass.keys() & self.prairie.scene.grass.keys():
            return
        if self._stroke is None:
            self._stroke = next(self._strokes)
        draft = self.history.now
        others = [kind for kind, grass in self.scene.grass.items() if grass.place is not None and kind != brush.kind]
        way = ("grass", brush.kind, "place")
        try:
            for each in [brush, *(brush.making_room(kind) for kind in others if brush.alone and brush.density > 0.0)]:
                draft = self._stroked(draft, each, line)
        except (ValueError, OSError) as error:
            self.refusal = Refusal(way, (str(error),))
        else:
            self._take(draft, way=way, subject=("stroke", self._stroke))

    def anchors(self) -> list[tuple[int, Anchor]]:
        """Return the anchors of all winds, each with its wind's index."""
        return [(number, each) for number, wind in enumerate(self.winds) for each in declared_anchors(wind, number)]

    def step(self) -> None:
        """Take over what has grown since the last frame; undo what could not grow."""
        try:
            self.remaking.step()
        except Exception as error:  # memory may run out: what is unsaved must not be lost with it
            log.debug("growing", exc_info=error)
            reasons = _reasons(error) if isinstance(error, SceneError) else (f"it cannot grow: {said(error)}",)
            self.refusal = Refusal((), reasons)
            self.history.change(self._shown, subject=None)
            self._go(done=True, keep=self.refusal)
        if not self.remaking.is_growing:
            self._shown = self.history.now

    def save(self) -> str:
        """Write the scene and its maps, and return a sentence about the files written; it is empty on a refusal."""
        self.rest()
        try:
            if self.remaking.is_growing:
                load_maps(self.loaded)  # what has not grown yet may still be refused
            draft = self.history.now
            names = self.pen.write(draft.values, self._pictures(draft))
        except ValueError as error:
            self.refusal = Refusal((), _reasons(error) if isinstance(error, SceneError) else (str(error),))
            return ""
        self.history.save()
        self.refusal = None
        self.loaded = self._loaded(self.history.now)
        self.prairie.loaded = replace(self.prairie.loaded, path=self.pen.path, folder=self.pen.path.parent)
        return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'} written" if names else "nothing has changed"

    def read_again(self) -> None:
        """Read the files again, and discard the draft. Raises SceneError with every problem; then nothing changes."""
        self.prairie.reload(self.pen.path)
        self.remaking.forget()
        self._begin(self.prairie.loaded)

    def close(self) -> None:
        """Cancel what is still growing."""
        self.remaking.close()

    def copy(self, name: str) -> list[Path]:
        """Write the draft as a file of this name beside the scene; return the files. Raises ValueError or OSError."""
        return self.pen.copy(self.history.now.values, self._pictures(self.history.now), name)

    def _is_over(self, wind: WindPrimitive) -> bool:
        """Return whether a wind has no parts now; False for a plugin's that fails."""
        time, winds = self.prairie.time, self.prairie.winds
        source = next((each for each in winds.sources() if each.primitive == wind), None)
        try:
            return source is not None and not winds.quarantine.ask(
                source, "parts", lambda: wind.parts(time=time, seed=self.scene.seed)
            )
        except QuarantinedError:
            return False

    def _begin(self, loaded: LoadedScene) -> None:
        self.pen, self.loaded = Pen(loaded), loaded
        self.history = History(Draft(loaded.document.root.data))
        self._unpainted = {}
        self._shown, self.refusal = self.history.now, None

    def _go(self, *, done: bool, keep: Refusal | None = None) -> None:
        self._stroke, self.refusal = None, keep
        if done:
            self.loaded = self._loaded(self.history.now)
            self.remaking.follow(self.loaded)

    def _take(self, draft: Draft, *, way: Way, subject: object) -> bool:
        try:
            loaded = self._loaded(draft)
            self.remaking.follow(loaded)
        except SceneError as error:
            self.refusal = Refusal(way, _reasons(error))
            return False
        self.loaded, self.refusal = loaded, None
        self.history.change(draft, subject=subject)
        if not self.remaking.is_growing:
            self._shown = draft
        return True

    def _loaded(self, draft: Draft) -> LoadedScene:
        root = noded(draft.values, self.loaded.document.root)
        document = Document(self.loaded.document.file, self.loaded.document.lines, root, [])
        return load_document(document, self.pen.path, pictures=self._pictures(draft))

    def _pictures(self, draft: Draft) -> dict[str, Picture]:
        """Return the maps that any draft has painted, as they are in this draft; all others are read from files."""
        return {**self._unpainted, **draft.pictures}

    def _whole(self, values: dict[str, Any], way: Way) -> dict[str, Any]:
        """Return values with the default lists on a way written out: an item needs the others in the file."""
        for number, step in enumerate(way):
            if isinstance(step, int) and not isinstance(value_at(values, way[:number]), list):
                values = with_value(values, way[:number], _plain(self.scene, way[:number]))
        return values

    def _stroked(self, draft: Draft, brush: Brush, line: Sequence[Place]) -> Draft:
        draft, name, channel, picture = self._canvas(draft, brush.kind)
        places, size = np.array(line, np.float64).reshape(-1, 2), self.prairie.site.ground.terrain.size
        return replace(draft, pictures={**draft.pictures, name: stroked(picture, channel, brush, places, size)})

    def _canvas(self, draft: Draft, kind: str) -> tuple[Draft, str, str, Picture]:
        """Return a draft in which a kind has a density map, the map's name, its channel, and its current pixels."""
        place = self.scene.grass[kind].place
        if place is not None and isinstance(place.map, str):  # only `none` is read as an array
            name = place.map
            if name not in self._pictures(draft):
                self._unpainted[name] = read_picture(self.loaded.folder / name)
                self.pen.know(name, self._unpainted[name])
            return draft, name, place.channel, self._pictures(draft)[name]
        name = self.pen.new_map(kind, draft.pictures)
        values = with_value(draft.values, ("grass", kind, "place"), {"map": name, "channel": "red"})
        ground, number = self.prairie.site.ground, list(self.prairie.scene.grass).index(kind)
        return replace(draft, values=values), name, "red", new_picture(ground.density, number)


def _plain(scene: Scene, way: Way) -> Any:
    """Return the scene's list at a way in the form of a file; NOTHING where the value is no list."""
    found: Any = scene
    for step in way:
        found = getattr(found, str(step)) if isinstance(found, BaseModel) else found[step]
    if not isinstance(found, list):
        return NOTHING
    return [each.model_dump(exclude_unset=True) if isinstance(each, BaseModel) else each for each in found]


def _reasons(error: SceneError) -> tuple[str, ...]:
    return tuple(dict.fromkeys(problem.message for problem in error.problems[:4]))
