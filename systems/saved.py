"""The format of a prairie's saved state: a record with arrays, packed as bytes."""

from hashlib import blake2b
from io import BytesIO
from typing import Annotated, Any
from zlib import compress, decompressobj

import numpy as np
from pydantic import Field, ValidationError

from ..components.arrays import Bytes, Floats, Ints, Mask, Place
from ..components.course import Course
from ..components.declaration import Declaration
from ..components.lamp import Lamp
from ..components.pose import Pose
from ..components.presser import Presser
from ..components.shade import Shade
from ..components.tree import Tree
from ..engine.declared.light import Light
from ..engine.stored import AS_FIELDS, Stored, Time, refuse
from ..engine.terrain.change import LIE
from ..engine.terrain.plots import CELLS
from ..engine.zipped import zipped
from .light.shining import Way
from .pressers import Treading
from .seasons import SavedSeason

FORMAT = 5
"""Version of the format."""

MAGIC = b"tallgrass state\n"
"""First bytes of a state."""

_DIGEST = 20
"""Length of the checksum [bytes]."""

_MOST = 2**28
"""Maximum size of a state when it is unpacked [bytes]."""

Thing = Presser | Lamp | Shade | Tree
THINGS: tuple[type[Thing], ...] = Presser, Lamp, Shade, Tree
"""Classes of a game's components that are saved, besides winds."""

SavedPose = Annotated[Pose, AS_FIELDS] | None
"""Pose of an entity; None without a `Pose`."""


class SavedWind(Declaration):
    """A wind that a game has made, or one of the scene's as a game has left it."""

    entity: int
    """Its entity when it was saved."""

    kind: str
    name: str
    values: dict[str, Any]
    pose: SavedPose
    course: Course | None
    """Course of its phases, if a game has changed their rates."""

    first: dict[str, Any] | None
    """Values of the wind before the first of these changes."""


class SavedThing(Declaration):
    """One component of a game's entity; an entity with several components has several records."""

    entity: int
    component: Annotated[Thing, AS_FIELDS]
    pose: SavedPose


class SavedScene(Declaration):
    """Values that a scene must share with the one of the state."""

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
    """Everything in a state."""

    scene: SavedScene
    """The scene on which it was made."""

    lie: Annotated[Floats, Stored(np.float32, None)]
    """Samples of its ground's heights as it was loaded [m]; NaN in holes."""

    time: Time
    light: Light
    light_since: Time
    """Time at which the light had its hour [s]."""

    light_way: Way
    """Progress of the light towards `light`."""

    declared: list[SavedWind | None]
    """The scene's winds; None for one that a game has deleted."""

    added: list[SavedWind]
    """Winds that a game has added."""

    winds: list[SavedWind]
    """A game's own entities that are winds."""

    things: list[SavedThing]
    """Other components of a game's own entities."""

    brought: dict[str, list[int]]
    """Entities that packages made while they added their systems, by the systems' names, in the order of making."""

    treading: Treading
    felled: list[int]
    """Numbers of the scene's trees that are gone, or have become others among `things`."""

    wild_felled: list[tuple[int, int, int]]
    """Gone trees of a forest too large to number them all: each tree's square, and its number in that."""

    stood: list[Place]
    """Places (x, z) [m] of the trees of `felled` and then of `wild_felled`."""

    seasons: list[SavedSeason]
    cleared: Annotated[Ints, Stored(np.int32, None, 2)]
    """Cells of cleared patches."""

    mown: Annotated[Ints, Stored(np.int32, None, 3)]
    mown_heights: Annotated[Floats, Stored(np.float32, None, CELLS, CELLS)]
    sown: Annotated[Ints, Stored(np.int32, None, 3)]
    sown_densities: Annotated[Bytes, Stored(np.uint8, None, CELLS, CELLS, None)]
    """Plots that are cut and sown, and their pages: what `Plots.saved` returned."""

    ground: Annotated[Ints, Stored(np.int32, None, 2)]
    ground_heights: Annotated[Floats, Stored(np.float32, None)]
    ground_holes: Annotated[Mask, Stored(np.bool_, None)]
    """Changed squares of the ground: what `changed_squares` returned."""

    ground_lies: Annotated[Floats, Stored(np.float32, None, LIE)] = Field(
        default_factory=lambda: np.zeros((0, LIE), np.float32)
    )
    """What `changed_lies` returned; nothing in states of before there was that."""


def packed(state: State, /) -> bytes:
    """Return a state as bytes: magic bytes, a checksum, the version, and the compressed rest."""
    arrays = list[np.ndarray[Any, Any]]()
    head = np.frombuffer(state.model_dump_json(context=arrays).encode(), np.uint8)
    named = {"head": head} | {f"arr_{number}": array for number, array in enumerate(arrays)}
    body = FORMAT.to_bytes(2) + compress(zipped(named), 6)
    return MAGIC + blake2b(body, digest_size=_DIGEST).digest() + body


def unpacked(state: object, /) -> State:
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
    if version != FORMAT:
        raise ValueError(f"this state is of format {version}, and this release reads format {FORMAT}")
    try:
        unpacking = decompressobj()
        plain = unpacking.decompress(body[2:], _MOST)
        if unpacking.unconsumed_tail or not unpacking.eof:
            refuse("its compressed data do not end where they should")
        with np.load(BytesIO(plain), allow_pickle=False) as file:
            arrays = [file[f"arr_{number}"] for number in range(len(file.files) - 1)]
            return State.model_validate_json(file["head"].tobytes(), context=arrays)
    except ValidationError as error:
        refuse(str(error.errors(include_url=False)[0]["msg"]))
    except Exception as error:  # noqa: BLE001 - zlib, zipfile and numpy raise anything on a forged file
        refuse(str(error))
