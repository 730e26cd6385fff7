"""Seasons: the changes that a game makes to kinds of grass while they are shown."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from reprlib import repr as shortened

import numpy as np
from pydantic import ValidationError

from ..engine.declared.grass import GrassKind
from ..engine.declared.scene import Scene
from ..engine.handed import LONGEST, NUMBER_TYPES
from ..engine.scene.validate import changed_kind
from .saved import SavedEase, SavedSeason, refuse

EASED = "root", "tip", "variety", "translucency", "gloss", "understorey"
"""Keys of a kind that only shaders read: their values are interpolated, and nothing is grown."""

ELSEWHERE = {
    "place": "where a kind grows is changed by sow and clear",
    "slope": "up to which slope a kind grows is changed by reading the scene again",
    "plant": "a kind that becomes another plant is changed by reading the scene again",
    "segments": "how finely a kind is drawn is changed by reading the scene again",
}
"""Keys of a kind that cannot change by seasons, and what changes them instead."""

Value = str | float


@dataclass(frozen=True, slots=True)
class Ease:
    """One value of a kind, interpolated from `before` to `after`."""

    before: Value
    after: Value
    since: float
    """Time at which it begins [s]."""

    over: float
    """Duration [s]."""

    def at(self, time: float, /) -> Value:
        """Return the value at `time` [s]."""
        return interpolated(self.before, self.after, progress_at(time, self.since, self.over))


def progress_at(time: float, since: float, over: float, /) -> float:
    """Return the progress at `time`, from 0 to 1, of a change that begins at `since` and takes `over` [s]."""
    if time < since:
        return 0.0
    return min((time - since) / over, 1.0) if over > 0.0 else 1.0


def interpolated(before: Value, after: Value, progress: float, /) -> Value:
    """Return the value between two at a progress from 0 to 1; colours are interpolated channel by channel, in sRGB."""
    if isinstance(before, str) or isinstance(after, str):
        first, last = (np.array([int(str(text)[i : i + 2], 16) for i in (1, 3, 5)]) for text in (before, after))
        mixed = np.rint(first + progress * (last - first)).astype(int)
        return "#" + "".join(f"{value:02x}" for value in mixed.tolist())
    return before + progress * (after - before)


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Kinds that change together."""

    kinds: Mapping[str, GrassKind]
    """Kinds that they change to, by name."""

    since: float
    """Time at which they begin [s]."""

    over: Mapping[str, float]
    """Duration of each change [s]."""

    def came(self, names: Iterable[str], time: float, /) -> tuple[float, ...]:
        """Return the progress of each named kind's change at `time` [s], from 0 to 1; 0 for kinds without a change."""
        return tuple(progress_at(time, self.since, self.over[name]) if name in self.kinds else 0.0 for name in names)


@dataclass(frozen=True, slots=True, eq=False)
class Recalled:
    """The state of `Seasons` when it was saved."""

    due: dict[str, GrassKind]
    standing: dict[str, GrassKind]
    over: dict[str, float]
    asked: dict[str, float]
    eases: dict[str, dict[str, Ease]]
    batch: Batch | None


class Seasons:
    """The kinds of a scene, as a game has changed them."""

    def __init__(self, scene: Scene) -> None:
        self.begin(scene)

    def begin(self, scene: Scene) -> None:
        """Start again with the kinds that a scene declares."""
        self.declared = scene
        self.due: dict[str, GrassKind] = dict(scene.grass)
        """Each kind as it will be in the end."""
        self.standing: dict[str, GrassKind] = dict(scene.grass)
        """Each kind as it has grown."""
        self.over: dict[str, float] = {}
        """Duration in which the new plants of each kind come in [s]."""
        self.asked: dict[str, float] = {}
        """Time at which they were asked for [s]."""
        self.eases: dict[str, dict[str, Ease]] = {}
        """Interpolations that have begun, by kind and key."""
        self.batch: Batch | None = None
        """Kinds that are changing now."""

    def change(self, name: str, keys: Mapping[str, object], /, *, over: float, time: float) -> None:
        """Change keys of a kind over `over` seconds from `time` [s] on; raises ValueError for what cannot change."""
        if not isinstance(over, NUMBER_TYPES) or not 0.0 <= over <= LONGEST:
            raise ValueError(f"a kind changes over a time of 0 s to {LONGEST:g} s, not {shortened(over)}")
        for key, why in ELSEWHERE.items():
            if key in keys:
                raise ValueError(f"grass.{name}.{key}: {why}")
        scene = self.declared.model_copy(update={"grass": self.due})
        kind, before = changed_kind(scene, name, keys), self.kind_at(name, time)
        for key in EASED:
            now = getattr(before, key)
            if getattr(kind, key) != getattr(self.due[name], key):
                self.eases.setdefault(name, {})[key] = Ease(now, getattr(kind, key), time, float(over))
        if _grown(kind) != _grown(self.due[name]):
            self.over[name], self.asked[name] = float(over), time
        self.due[name] = kind

    @property
    def to_grow(self) -> dict[str, GrassKind]:
        """Kinds that have not grown yet as they are to be, by name."""
        return {name: self.due[name] for name in self.over if _grown(self.due[name]) != _grown(self.standing[name])}

    def kind_at(self, name: str, time: float, /) -> GrassKind:
        """Return a kind as it is at `time` [s]."""
        eases, kind = self.eases.get(name), self.standing[name]
        return kind.model_copy(update={key: ease.at(time) for key, ease in eases.items()}) if eases else kind

    def saved(self) -> list[SavedSeason]:
        """Return the kinds that a game has changed, for a state."""
        return [self._saved(name) for name in self.due if name in self.eases or name in self.over]

    def _saved(self, name: str) -> SavedSeason:
        batch = self.batch if self.batch is not None and name in self.batch.kinds else None
        return SavedSeason(
            name=name,
            due=_keys_of(self.due[name]),
            stands=_keys_of(self.standing[name]),
            over=self.over.get(name),
            asked=self.asked.get(name, 0.0),
            comes=None if batch is None else _keys_of(batch.kinds[name]),
            since=0.0 if batch is None else batch.since,
            lasts=0.0 if batch is None else batch.over[name],
            eases=[
                SavedEase(key=key, before=ease.before, after=ease.after, since=ease.since, over=ease.over)
                for key, ease in self.eases.get(name, {}).items()
            ],
        )

    def read(self, saved: Sequence[SavedSeason], /) -> Recalled:
        """Return what a state says of kinds, for `resume`; raises ValueError for what cannot be."""
        found = Recalled(dict(self.declared.grass), dict(self.declared.grass), {}, {}, {}, None)
        coming = [each for each in saved if each.comes is not None]
        for each in saved:
            if each.name not in found.due or any(ease.key not in EASED for ease in each.eases):
                refuse("it has changed kinds of grass or keys of them that do not exist")
            declared = self.declared.grass[each.name]
            found.due[each.name] = _kind_of(declared, each.due)
            found.standing[each.name] = _kind_of(declared, each.stands)
            if each.over is not None:
                found.over[each.name], found.asked[each.name] = each.over, each.asked
            for ease in each.eases:
                for value in (ease.before, ease.after):
                    _kind_of(declared, each.due | {ease.key: value})
                eases = found.eases.setdefault(each.name, {})
                eases[ease.key] = Ease(ease.before, ease.after, ease.since, ease.over)
        if not coming:
            return found
        kinds = {each.name: _kind_of(self.declared.grass[each.name], each.comes or {}) for each in coming}
        return replace(found, batch=Batch(kinds, coming[0].since, {each.name: each.lasts for each in coming}))

    def resume(self, recalled: Recalled, /) -> None:
        """Go on with what `read` returned."""
        self.due, self.standing, self.over = recalled.due, recalled.standing, recalled.over
        self.asked, self.eases, self.batch = recalled.asked, recalled.eases, recalled.batch

    def scene_at(self, scene: Scene, time: float, /) -> Scene:
        """Return a scene with its kinds as they are at `time` [s]: the same object if none differs."""
        if not self.eases and self.standing == scene.grass:
            return scene
        kinds = {name: self.kind_at(name, time) for name in scene.grass}
        return scene if kinds == scene.grass else scene.model_copy(update={"grass": kinds})


def _grown(kind: GrassKind) -> dict[str, object]:
    """Return the values of a kind that it is grown from: all that are not eased."""
    return {name: getattr(kind, name) for name in GrassKind.model_fields if name not in EASED}


def _keys_of(kind: GrassKind) -> dict[str, object]:
    """Return the keys of a kind as JSON has them, without `place`, which does not change."""
    return kind.model_dump(mode="json", exclude_unset=True, exclude={"place"})


def _kind_of(declared: GrassKind, keys: Mapping[str, object]) -> GrassKind:
    """Return the kind with these keys, and with the place of the `declared` one."""
    place = {} if declared.place is None else {"place": declared.place}
    try:
        return GrassKind.model_validate({**keys, **place})
    except ValidationError as error:
        refuse(str(error.errors(include_url=False)[0]["msg"]))
