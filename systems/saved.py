"""A prairie's state as bytes: what a game has done to it, to be kept and brought back."""

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
"""Version of what a state holds, and the oldest that is read.

A 3 has no `SavedScene`: a hash of all that its scene said, defaults too, told it from others."""

MAGIC = b"tallgrass state\n"
"""What a state begins with."""

_DIGEST = 20
_MOST = 2**28
"""Most bytes that a state comes to when it is unpacked."""

Arrays = Mapping[str, NDArray[Any]]
"""What a state holds of arrays, by name."""

Standing = Annotated[list[Number], Field(min_length=3, max_length=4)]
"""A `Pose`: x, z [m], yaw [rad], and a height [m] where it has one."""

Kind = Literal["presser", "lamp", "shade", "tree"]
Thing = Presser | Lamp | Shade | Tree

THINGS: Mapping[Kind, type[Thing]] = {"presser": Presser, "lamp": Lamp, "shade": Shade, "tree": Tree}
"""Components that are saved, by what a state calls them."""


class SavedCourse(Declaration):
    """How the phases of a wind have run whose rates a game has changed."""

    times: list[float]
    rates: list[list[float]]
    offsets: list[list[float]]
    """As `Course` has them."""

    first: dict[str, Any]
    """The values of the wind before that."""


class SavedWind(Declaration):
    """A wind that a game has made, or one of the scene's as a game has left it."""

    entity: int
    """The entity that it was."""

    kind: str
    name: str
    values: dict[str, Any]
    pose: Standing | None
    """Where its entity has a `Pose`."""

    course: SavedCourse | None


class SavedThing(Declaration):
    """An entity of a game's with one of its components: one that has several comes several times."""

    entity: int
    kind: Kind
    fields: dict[str, Any]
    """Of that component."""

    pose: Standing | None
    """Where its entity has a `Pose`."""


class SavedWalk(Declaration):
    """Pressers that have gone together; their trail and their poses are arrays."""

    time: float = Field(ge=0.0, le=1e9)
    """The instant to which they have come [s]."""

    begun: int = Field(ge=-(2**40), le=2**40)
    """The number of the way that begins next."""

    who: list[tuple[int, dict[str, Any]]]
    """Their entities, and what they press with; -1 - n is the nth that the scene declares."""


class SavedTreading(Declaration):
    """What pressers have done; the marks are arrays."""

    walks: list[SavedWalk] = Field(min_length=2, max_length=2)
    """Those that the scene declares, and the game's."""

    since: float = Field(ge=-1.0, le=1e9)
    """When marks settled last [s]."""

    trodden: float | None = Field(ge=0.0, le=1e9)
    """The instant of what was trodden last [s], if anything was."""

    anew: bool
    """Whether those that the scene declares have their whole way still to go."""

    declared: list[dict[str, Any] | None]
    """What those press with that the scene declares; None of one that a game has deleted."""


class SavedEase(Declaration):
    """One value of a kind of grass on its way."""

    key: str
    before: str | float
    after: str | float
    since: float = Field(ge=0.0, le=1e9)
    over: float = Field(ge=0.0, le=1e9)
    """Both [s]."""


class SavedSeason(Declaration):
    """A kind of grass that a game has changed."""

    name: str
    due: dict[str, Any]
    """What it comes to in the end: all that it says but where it grows."""

    stands: dict[str, Any]
    """What it has grown to, likewise."""

    over: float | None = Field(ge=0.0, le=1e9)
    """How long what must be grown takes to come in [s], if anything must."""

    asked: float = Field(ge=0.0, le=1e9)
    """When that was asked for [s]."""

    comes: dict[str, Any] | None
    """What it is becoming, if anything."""

    since: float = Field(ge=0.0, le=1e9)
    lasts: float = Field(ge=0.0, le=1e9)
    """When that began, and how long it takes [s]."""

    eases: list[SavedEase]


class SavedScene(Declaration):
    """What a scene must be like for a state to fit; the lie of its ground is an array."""

    seed: int
    size: tuple[float, float]
    """Width (x) and depth (z) of its ground [m]."""

    cell: float
    """How far apart its samples are [m]."""

    patch: float
    """Side of a patch [m]."""

    grass: list[str]
    """Names of the kinds of grass, in their order."""

    wind: list[str]
    """Kinds of the winds that it declares, likewise."""


class State(Declaration):
    """All of a state but its arrays."""

    scene: SavedScene | str
    """The scene that it was made on; of format 3 the hash."""

    time: float = Field(ge=0.0, le=1e9)
    light: Light
    light_since: float = Field(ge=0.0, le=1e9)
    """The instant that the light's hour is that of [s]."""

    light_way: Way | None = Field(default=None)
    """How far it has come; of a state that does not say, all the way."""

    declared: list[SavedWind | None]
    """The winds that the scene declares; None where a game has deleted one."""

    added: list[SavedWind]
    winds: list[SavedWind]
    """Entities of a game's that are winds."""

    things: list[SavedThing]
    """What else a game's entities have of ours."""

    treading: SavedTreading
    felled: list[int] = Field(default=[])
    """Which of the scene's own trees are gone, or have become others among `things`, by their numbers."""

    wild_felled: list[tuple[int, int, int]] = Field(default=[])
    """And which of a forest that is too large for numbers: each by its square's, and its own on that."""

    stood: list[tuple[float, float]] | None = Field(default=None)
    """Where those stood, the one after the other (x, z) [m]; a state of format 3 does not say."""

    seasons: list[SavedSeason] = Field(default=[])


@dataclass(frozen=True, slots=True, eq=False)
class Saved:
    """A state as it is packed."""

    state: State
    arrays: Arrays


def packed(saved: Saved, /) -> bytes:
    """Return a state as bytes: what it is, a checksum, and the compressed rest."""
    head = np.frombuffer(saved.state.model_dump_json().encode(), np.uint8)
    file = BytesIO()
    np.savez(file, allow_pickle=False, head=head, **saved.arrays)
    body = FORMAT.to_bytes(2) + compress(file.getvalue(), 6)
    return MAGIC + blake2b(body, digest_size=_DIGEST).digest() + body


def unpacked(state: object, /) -> Saved:
    """Return what bytes hold. Raises TypeError for what are no bytes, ValueError for what is no whole state of ours."""
    if not isinstance(state, bytes | bytearray | memoryview):
        raise TypeError(f"a state is the bytes that state() returned, not {type(state).__name__}")
    data = bytes(state)
    if not data.startswith(MAGIC):
        raise ValueError("these bytes are no state of a prairie")
    digest, body = data[len(MAGIC) :][:_DIGEST], data[len(MAGIC) + _DIGEST :]
    if blake2b(body, digest_size=_DIGEST).digest() != digest:
        raise ValueError("this state has been altered or is broken off")
    version = int.from_bytes(body[:2])
    if not OLDEST <= version <= FORMAT:
        due = f"formats {OLDEST} to {FORMAT}"
        raise ValueError(f"this state is of format {version}, and this release reads {due}")
    try:
        unpacking = decompressobj()
        plain = unpacking.decompress(body[2:], _MOST)
        if unpacking.unconsumed_tail or not unpacking.eof:
            refuse("it does not end where it should")
        with np.load(BytesIO(plain), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return Saved(State.model_validate_json(arrays.pop("head").tobytes()), arrays)
    except ValidationError as error:
        refuse(str(error.errors(include_url=False)[0]["msg"]))
    except Exception as error:  # noqa: BLE001 - zlib, zipfile and numpy raise what they like on a file that was forged
        refuse(str(error))


def refuse(why: str, /) -> NoReturn:
    """Raise ValueError for a state that cannot be right, though its checksum is."""
    raise ValueError(f"this state cannot be right: {' '.join(why.split())[:200]}")


def unfit(why: str, /) -> NoReturn:
    """Raise ValueError for a state that a scene cannot take."""
    raise ValueError(f"this state does not fit this scene: {why}")


def planes(heights: NDArray[np.float32], /) -> NDArray[np.uint8]:
    """Return numbers byte by byte, all first bytes before all second ones, (4, n): they compress far better so."""
    return np.ascontiguousarray(heights.reshape(-1).view(np.uint8).reshape(-1, 4).T)


def from_planes(bytes_: NDArray[np.uint8], shape: tuple[int, ...], /) -> NDArray[np.float32]:
    """Return the numbers that `planes` took apart."""
    return np.ascontiguousarray(bytes_.T).view(np.float32).reshape(shape)


def fields_of(thing: Thing, /) -> dict[str, Any]:
    """Return the fields of a component, as JSON has them."""
    return {name: _plain(value) for name, value in asdict(thing).items()}


def _plain(value: object) -> object:
    if isinstance(value, bool | str | NoneType):
        return value
    return float(value) if isinstance(value, Real) else [_plain(each) for each in value]  # type: ignore[attr-defined]


def component_of(kind: Kind, fields: Mapping[str, Any], /) -> Thing:
    """Return the component of these fields; raises ValueError for what is none."""
    make: Any = THINGS[kind]
    try:
        made: Thing = make(**{name: tuple(each) if isinstance(each, list) else each for name, each in fields.items()})
    except TypeError as error:
        raise ValueError(f"what was a {kind} is none: {error}") from error
    return made
