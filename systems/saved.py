"""The format of a prairie's saved state: records and arrays, packed as bytes."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from hashlib import blake2b
from io import BytesIO
from numbers import Real
from types import NoneType
from typing import Annotated, Any, Literal, NoReturn
from zlib import compress, decompressobj

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from ..components.declaration import Declaration, Number
from ..components.lamp import Lamp
from ..components.presser import Presser
from ..components.shade import Shade
from ..components.tree import Tree
from ..engine.declared.light import Light
from .light.shining import Way

FORMAT, OLDEST = 4, 3
"""Version of the format, and the oldest version that is read.

Version 3 has no `SavedScene`, but a hash of the scene's whole text, defaults too."""

MAGIC = b"tallgrass state\n"
"""First bytes of a state."""

_DIGEST = 20
"""Length of the checksum [bytes]."""

_MOST = 2**28
"""Maximum size of a state when it is unpacked [bytes]."""

Arrays = Mapping[str, NDArray[Any]]
"""Arrays of a state, by name."""

Standing = Annotated[list[Number], Field(min_length=3, max_length=4)]
"""A `Pose`: x, z [m], yaw [rad], and the height [m] if it has one."""

Kind = Literal["presser", "lamp", "shade", "tree"]
Thing = Presser | Lamp | Shade | Tree

THINGS: Mapping[Kind, type[Thing]] = {"presser": Presser, "lamp": Lamp, "shade": Shade, "tree": Tree}
"""Classes of saved components, by their names in a state."""


class SavedCourse(Declaration):
    """The course of the phases of a wind whose rates a game has changed."""

    times: list[float]
    rates: list[list[float]]
    offsets: list[list[float]]
    """Fields of `Course`."""

    first: dict[str, Any]
    """Values of the wind before the first change."""


class SavedWind(Declaration):
    """A wind that a game has made, or one of the scene's as a game has left it."""

    entity: int
    """Its entity when it was saved."""

    kind: str
    name: str
    values: dict[str, Any]
    pose: Standing | None
    """Pose of its entity; None without a `Pose`."""

    course: SavedCourse | None


class SavedThing(Declaration):
    """One component of a game's entity; an entity with several components has several records."""

    entity: int
    kind: Kind
    fields: dict[str, Any]
    """Fields of the component."""

    pose: Standing | None
    """Pose of the entity; None without a `Pose`."""


class SavedWalk(Declaration):
    """The walk of some pressers; their trail and their poses are arrays."""

    time: float = Field(ge=0.0, le=1e9)
    """Time that they have reached [s]."""

    begun: int = Field(ge=-(2**40), le=2**40)
    """Number of the way that begins next."""

    who: list[tuple[int, dict[str, Any]]]
    """Entity and `Presser` fields of each; entity -1 - n is the presser with number n in the scene."""


class SavedTreading(Declaration):
    """The state of all pressers, as `Treading` has it; the marks are arrays."""

    walks: list[SavedWalk] = Field(min_length=2, max_length=2)
    """Walk of the scene's pressers, and that of the game's."""

    since: float = Field(ge=-1.0, le=1e9)
    """Time at which marks settled last [s]."""

    trodden: float | None = Field(ge=0.0, le=1e9)
    """Time of the marks trodden last [s]; None if there are none."""

    anew: bool
    """Whether the whole way of the scene's pressers is still to be replayed."""

    declared: list[dict[str, Any] | None]
    """Fields of each of the scene's pressers; None for one that a game has deleted."""

    worn: list[tuple[int, Number, Number]] = Field(default=[])
    """Entity of each presser that wears grass off, and the place (x, z) up to which its way is worn [m]."""


class SavedEase(Declaration):
    """One value of a kind of grass that is being interpolated, as `Ease` has it."""

    key: str
    before: str | float
    after: str | float
    since: float = Field(ge=0.0, le=1e9)
    over: float = Field(ge=0.0, le=1e9)
    """Beginning and duration [s]."""


class SavedSeason(Declaration):
    """A kind of grass that a game has changed."""

    name: str
    due: dict[str, Any]
    """Its keys as they will be in the end, without `place`."""

    stands: dict[str, Any]
    """Its keys as it has grown, without `place`."""

    over: float | None = Field(ge=0.0, le=1e9)
    """Duration in which new plants come in [s]; None if nothing must be grown."""

    asked: float = Field(ge=0.0, le=1e9)
    """Time at which they were asked for [s]."""

    comes: dict[str, Any] | None
    """Keys that it is changing to now, if it is."""

    since: float = Field(ge=0.0, le=1e9)
    lasts: float = Field(ge=0.0, le=1e9)
    """Beginning and duration of this change [s]."""

    eases: list[SavedEase]


class SavedScene(Declaration):
    """Values that a scene must share with the one of the state; heights of its ground are an array."""

    seed: int
    size: tuple[float, float]
    """Width (x) and depth (z) of its ground [m]."""

    cell: float
    """Distance between its samples [m]."""

    patch: float
    """Side of a patch [m]."""

    grass: list[str]
    """Names of the kinds of grass, in their order."""

    wind: list[str]
    """Kinds of the winds that it declares, in their order."""


class State(Declaration):
    """Everything in a state but its arrays."""

    scene: SavedScene | str
    """The scene on which it was made; in format 3 the hash."""

    time: float = Field(ge=0.0, le=1e9)
    light: Light
    light_since: float = Field(ge=0.0, le=1e9)
    """Time at which the light had its hour [s]."""

    light_way: Way | None = Field(default=None)
    """Progress of the light towards `light`; None in older states, in which it has arrived."""

    declared: list[SavedWind | None]
    """The scene's winds; None for one that a game has deleted."""

    added: list[SavedWind]
    """Winds that a game has added."""

    winds: list[SavedWind]
    """A game's own entities that are winds."""

    things: list[SavedThing]
    """Other components of a game's own entities."""

    brought: dict[str, list[int]] = Field(default={})
    """Entities that packages made while they added their systems, by the systems' names, in the order of making."""

    treading: SavedTreading
    felled: list[int] = Field(default=[])
    """Numbers of the scene's trees that are gone, or have become others among `things`."""

    wild_felled: list[tuple[int, int, int]] = Field(default=[])
    """Gone trees of a forest too large to number them all: each tree's square, and its number in that."""

    stood: list[tuple[float, float]] | None = Field(default=None)
    """Places (x, z) [m] of the trees of `felled` and then of `wild_felled`; None in format 3."""

    seasons: list[SavedSeason] = Field(default=[])


@dataclass(frozen=True, slots=True, eq=False)
class Saved:
    """A state, unpacked."""

    state: State
    arrays: Arrays


def packed(saved: Saved, /) -> bytes:
    """Return a state as bytes: magic bytes, a checksum, the version, and the compressed rest."""
    head = np.frombuffer(saved.state.model_dump_json().encode(), np.uint8)
    file = BytesIO()
    np.savez(file, allow_pickle=False, head=head, **saved.arrays)
    body = FORMAT.to_bytes(2) + compress(file.getvalue(), 6)
    return MAGIC + blake2b(body, digest_size=_DIGEST).digest() + body


def unpacked(state: object, /) -> Saved:
    """Return the state in some bytes. Raises TypeError for anything but bytes, ValueError for no or a damaged state."""
    if not isinstance(state, bytes | bytearray | memoryview):
        raise TypeError(f"a state is the bytes that state() returned, not {type(state).__name__}")
    data = bytes(state)
    if not data.startswith(MAGIC):
        raise ValueError("these bytes are no state of a prairie")
    digest, body = data[len(MAGIC) :][:_DIGEST], data[len(MAGIC) + _DIGEST :]
    if blake2b(body, digest_size=_DIGEST).digest() != digest:
        raise ValueError("this state has been altered or truncated")
    version = int.from_bytes(body[:2])
    if not OLDEST <= version <= FORMAT:
        due = f"formats {OLDEST} to {FORMAT}"
        raise ValueError(f"this state is of format {version}, and this release reads {due}")
    try:
        unpacking = decompressobj()
        plain = unpacking.decompress(body[2:], _MOST)
        if unpacking.unconsumed_tail or not unpacking.eof:
            refuse("its compressed data do not end where they should")
        with np.load(BytesIO(plain), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return Saved(State.model_validate_json(arrays.pop("head").tobytes()), arrays)
    except ValidationError as error:
        refuse(str(error.errors(include_url=False)[0]["msg"]))
    except Exception as error:  # noqa: BLE001 - zlib, zipfile and numpy raise anything on a forged file
        refuse(str(error))


def refuse(why: str, /) -> NoReturn:
    """Raise ValueError for an invalid state, whose checksum matches nevertheless."""
    raise ValueError(f"this state is invalid: {' '.join(why.split())[:200]}")


def unfit(why: str, /) -> NoReturn:
    """Raise ValueError for a state that does not fit a scene."""
    raise ValueError(f"this state does not fit this scene: {why}")


def planes(heights: NDArray[np.float32], /) -> NDArray[np.uint8]:
    """Return float32 numbers as four planes of bytes, (4, n), which compress far better."""
    return np.ascontiguousarray(heights.reshape(-1).view(np.uint8).reshape(-1, 4).T)


def from_planes(bytes_: NDArray[np.uint8], shape: tuple[int, ...], /) -> NDArray[np.float32]:
    """Return the numbers whose bytes `planes` returned, in a `shape`."""
    return np.ascontiguousarray(bytes_.T).view(np.float32).reshape(shape)


def fields_of(thing: Thing, /) -> dict[str, Any]:
    """Return the fields of a component as JSON values."""
    return {name: _plain(value) for name, value in asdict(thing).items()}


def _plain(value: object) -> object:
    if isinstance(value, bool | str | NoneType):
        return value
    return float(value) if isinstance(value, Real) else [_plain(each) for each in value]  # type: ignore[attr-defined]


def component_of(kind: Kind, fields: Mapping[str, Any], /) -> Thing:
    """Return the component with these fields; raises ValueError for fields that do not fit."""
    make: Any = THINGS[kind]
    try:
        made: Thing = make(**{name: tuple(each) if isinstance(each, list) else each for name, each in fields.items()})
    except TypeError as error:
        raise ValueError(f"a {kind} of this state cannot be made: {error}") from error
    return made
