"""Seasons: the changes that a game makes to kinds of grass while they are shown."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from reprlib import repr as shortened
from typing import Any

import numpy as np
from pydantic import ValidationError

from ..components.declaration import Declaration
from ..engine.declared.grass import GrassKind
from ..engine.declared.scene import Scene
from ..engine.handed import LONGEST, NUMBER_TYPES
from ..engine.scene.validate import changed_kind
from ..engine.stored import Time, refuse

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
    since: Time
    """Time at which it begins [s]."""

    over: Time
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


class SavedSeason(Declaration):
    """A kind of grass that a game has changed, as a state has it."""

    name: str
    due: dict[str, Any]
    """Its keys as it will be in the end, without `place`."""

    stands: dict[str, Any]
    """Its keys as it has grown, without `place`."""

    over: Time | None
    """Duration in which new plants come in [s]; None if nothing must be grown."""

    asked: Time
    """Time at which they were asked for [s]."""

    comes: dict[str, Any] | None
    """Keys that it is changing to now, if it is."""

    since: Time
    lasts: Time
    """Beginning and duration of this change [s]."""

    eases: dict[str, Ease]
    """Interpolations that have begun, by key."""


@dataclass(slots=True, eq=False)
class Kinds:
    """The kinds of a scene as they are now, and as they will be."""

    due: dict[str, GrassKind]
    """Each kind as it will be in the end."""

    standing: dict[str, GrassKind]
    """Each kind as it has grown."""

    over: dict[str, float] = field(default_factory=dict)
    """Duration in which the new plants of each kind come in [s]."""

    asked: dict[str, float] = field(default_factory=dict)
    """Time at which they were asked for [s]."""

    eases: dict[str, dict[str, Ease]] = field(default_factory=dict)
    """Interpolations that have begun, by kind and key."""

    batch: Batch | None = None
    """Kinds that are changing now."""

    @classmethod
    def of(cls, scene: Scene, /) -> "Kinds":
        """Return the kinds that a scene declares."""
        return cls(dict(scene.grass), dict(scene.grass))


class Seasons:
    """The kinds of a scene, as a game has changed them."""

    def __init__(self, scene: Scene) -> None:
        self.begin(scene)

    def begin(self, scene: Scene) -> None:
        """Start again with the kinds that a scene declares."""
        self.declared, self.kinds = scene, Kinds.of(scene)

    def change(self, name: str, keys: Mapping[str, object], /, *, over: float, time: float) -> None:
        """Change keys of a kind over `over` seconds from `time` [s] on; raises ValueError for what cannot change."""
        if not isinstance(over, NUMBER_TYPES) or not 0.0 <= over <= LONGEST:
            raise ValueError(f"a kind changes over a time of 0 s to {LONGEST:g} s, not {shortened(over)}")
        for key, why in ELSEWHERE.items():
            if key in keys:
                raise ValueError(f"grass.{name}.{key}: {why}")
        scene = self.declared.model_copy(update={"grass": self.kinds.due})
        kind, before = changed_kind(scene, name, keys), self.kind_at(name, time)
        for key in EASED:
            now = getattr(before, key)
            if getattr(kind, key) != getattr(self.kinds.due[name], key):
                self.kinds.eases.setdefault(name, {})[key] = Ease(now, getattr(kind, key), time, float(over))
        if _grown(kind) != _grown(self.kinds.due[name]):
            self.kinds.over[name], self.kinds.asked[name] = float(over), time
        self.kinds.due[name] = kind

    @property
    def to_grow(self) -> dict[str, GrassKind]:
        """Kinds that have not grown yet as they are to be, by name."""
        kinds = self.kinds
        return {name: kinds.due[name] for name in kinds.over if _grown(kinds.due[name]) != _grown(kinds.standing[name])}

    def kind_at(self, name: str, time: float, /) -> GrassKind:
        """Return a kind as it is at `time` [s]."""
        eases, kind = self.kinds.eases.get(name), self.kinds.standing[name]
        return kind.model_copy(update={key: ease.at(time) for key, ease in eases.items()}) if eases else kind

    def saved(self) -> list[SavedSeason]:
        """Return the kinds that a game has changed, for a state."""
        return [self._saved(name) for name in self.kinds.due if name in self.kinds.eases or name in self.kinds.over]

    def _saved(self, name: str) -> SavedSeason:
        batch = self.kinds.batch if self.kinds.batch is not None and name in self.kinds.batch.kinds else None
        return SavedSeason(
            name=name,
            due=_keys_of(self.kinds.due[name]),
            stands=_keys_of(self.kinds.standing[name]),
            over=self.kinds.over.get(name),
            asked=self.kinds.asked.get(name, 0.0),
            comes=None if batch is None else _keys_of(batch.kinds[name]),
            since=0.0 if batch is None else batch.since,
            lasts=0.0 if batch is None else batch.over[name],
            eases=self.kinds.eases.get(name, {}),
        )

    def read(self, saved: Sequence[SavedSeason], /) -> Kinds:
        """Return what a state says of kinds, for `resume`; raises ValueError for what cannot be."""
        found = Kinds.of(self.declared)
        coming = [each for each in saved if each.comes is not None]
        for each in saved:
            if each.name not in found.due or not each.eases.keys() <= {*EASED}:
                refuse("it has changed kinds of grass or keys of them that do not exist")
            declared = self.declared.grass[each.name]
            found.due[each.name] = _kind_of(declared, each.due)
            found.standing[each.name] = _kind_of(declared, each.stands)
            if each.over is not None:
                found.over[each.name], found.asked[each.name] = each.over, each.asked
            for key, ease in each.eases.items():
                for value in (ease.before, ease.after):
                    _kind_of(declared, each.due | {key: value})
            if each.eases:
                found.eases[each.name] = each.eases
        if coming:
            kinds = {each.name: _kind_of(self.declared.grass[each.name], each.comes or {}) for each in coming}
            found.batch = Batch(kinds, coming[0].since, {each.name: each.lasts for each in coming})
        return found

    def scene_at(self, scene: Scene, time: float, /) -> Scene:
        """Return a scene with its kinds as they are at `time` [s]: the same object if none differs."""
        if not self.kinds.eases and self.kinds.standing == scene.grass:
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
