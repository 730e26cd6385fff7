"""A whole scene, as a file declares it."""

from collections.abc import Callable
from math import isqrt
from pathlib import Path
from typing import Annotated, Any, Literal, NotRequired, TypedDict

from pydantic import (
    Discriminator,
    Field,
    SerializeAsAny,
    Tag,
    ValidationError,
    ValidationInfo,
    WrapValidator,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from ...components.declaration import Declaration, DeclarationError
from ...components.wind import Mixing, WindPrimitive
from ...components.words import suggestion
from ..handed import MOST_SEED, must_be_known
from .camera import CameraSource
from .grass import MOST_KINDS, NOWHERE, GrassKind
from .lamp import LampOnPath
from .light import Light
from .parts import PARTS, PartName
from .presser import PresserOnPath
from .quality import PRESETS, PresetName, Quality
from .terrain import TerrainSource
from .tree import TreeKind

MOST_TREES = 16
"""Greatest number of kinds of trees in a scene."""

FORMAT = 2
"""Version of the scene format that this release writes."""

_MISSING_KIND = "the key 'kind' is missing, which says what wind it is, such as 'breeze'"


class Reading(TypedDict):
    """The validation context that a scene's winds need: `Scene.model_validate(data, context=Reading(wind=...))`."""

    wind: Callable[[str], type[WindPrimitive]]
    """Returns the class of a kind, or raises ValueError with a sentence."""

    folder: NotRequired[Path]
    """Folder to which the file names in winds are relative; without it these files are not read yet."""


def _of_its_kind(value: Any, _: object, info: ValidationInfo) -> WindPrimitive:
    if isinstance(value, WindPrimitive):
        return value
    if not isinstance(value, dict):
        raise PydanticCustomError("model_type", "a wind must be a mapping of keys")
    if not info.context:
        raise PydanticCustomError("no_kinds", "winds written as mappings need the validation context Reading(wind=...)")
    kind = value.get("kind")
    if "kind" not in value:
        raise _at_kind(PydanticCustomError("missing_kind", _MISSING_KIND), value)
    if not isinstance(kind, str):
        raise _at_kind("string_type", kind)
    try:
        primitive = info.context["wind"](kind)
    except ValueError as error:
        raise _at_kind(PydanticCustomError("unknown_kind", "{why}", {"why": str(error)}), kind) from error
    return _validated(primitive, value, info)


def _at_kind(error: str | PydanticCustomError, value: Any) -> ValidationError:
    details = InitErrorDetails(type=error, loc=("kind",), input=value)
    return ValidationError.from_exception_data("WindPrimitive", [details])


def _validated(primitive: type[WindPrimitive], value: dict[str, Any], info: ValidationInfo) -> WindPrimitive:
    try:
        return primitive.model_validate(value, context=info.context)
    except ValidationError:
        raise
    except (Exception, SystemExit) as error:  # a plugin's own validators may raise anything
        raise ValueError(f"kind '{value['kind']}' failed on these values: {type(error).__name__}: {error}") from error


Wind = Annotated[SerializeAsAny[WindPrimitive], WrapValidator(_of_its_kind)]
"""A wind primitive of the class of its `kind`; classes are looked up when a scene is read."""


def _quality_form(value: Any) -> str:
    return "numbers" if isinstance(value, dict | Quality) else "preset"


MOST_BLADES = 1 << 23
"""Greatest number of blades around a viewer: half of the texels of the largest texture of messages, 1,024 by 16,384,
with a texel for each blade. Edges of strips have the other half."""


class Scene(Declaration):
    """A prairie: grass kinds, terrain, winds, camera, light and quality."""

    tallgrass: Literal[2]
    """Version of the scene format; by custom the first key."""

    seed: int = Field(default=1, ge=0, le=MOST_SEED)
    """Seed of everything random in the scene."""

    terrain: TerrainSource = TerrainSource(noise="flat")
    """Ground that the grass stands on."""

    grass: dict[str, GrassKind] = Field(min_length=1, max_length=MOST_KINDS)
    """Grass kinds by name."""

    wind: list[Wind] = Field(default=[], max_length=200)
    """Wind primitives."""

    mixing: Mixing = "weight"
    """Rule for winds that meet: by weight, each sets in softly over those of lower priority; by priority, it cancels
    them."""

    pressers: list[PresserOnPath] = Field(default=[], max_length=200)
    """Pressers, which walk through the grass and tread it down."""

    camera: CameraSource = CameraSource()
    """Camera, at a fixed place or on a path."""

    light: Light = Light()
    """Sun, sky and haze."""

    lamps: list[LampOnPath] = Field(default=[], max_length=256)
    """Lamps, in addition to sun and sky."""

    trees: dict[str, TreeKind] = Field(default={}, max_length=MOST_TREES)
    """Kinds of trees and bushes by name."""

    parts: list[PartName] = Field(default=list(PARTS), max_length=len(PARTS))
    """Parts that are drawn, unless a game asks `draw` for others. A game draws the rest itself."""

    quality: Annotated[
        Annotated[PresetName, Tag("preset")] | Annotated[Quality, Tag("numbers")], Discriminator(_quality_form)
    ] = "high"
    """A preset, or its numbers."""

    @model_validator(mode="after")
    def _has_room_for_its_blades(self) -> "Scene":
        quality = self.numbers()
        blades = max(kind.blades or quality.blades for kind in self.grass.values())
        most = (isqrt(MOST_BLADES // blades) - 1) // 2
        for number, ring in enumerate(quality.blade_rings):
            if ring.to > most:
                why = f"with {blades} blades a patch: around a viewer there is room for {MOST_BLADES:,}"
                raise DeclarationError(f"to must be at most {most} {why}", "quality", "blade_rings", number, "to")
        return self

    @model_validator(mode="after")
    def _kinds_have_names(self) -> "Scene":
        for key, kinds in (("grass", self.grass), ("trees", self.trees)):
            if any(not name.strip() for name in kinds):
                raise DeclarationError("a kind has a name that is not empty", key)
        return self

    @model_validator(mode="after")
    def _trees_grow_on_its_grass(self) -> "Scene":
        for name, kind in self.trees.items():
            if kind.among is not None and kind.among not in self.grass:
                why = f"no kind of grass is called '{kind.among}'{suggestion(kind.among, self.grass)}"
                raise DeclarationError(why, "trees", name, "among")
        return self

    @model_validator(mode="after")
    def _has_an_edge_where_it_needs_one(self) -> "Scene":
        if self.terrain.window is None:
            return self
        for name, kind in self.grass.items():
            if kind.place not in (None, NOWHERE):
                why = "a map has no place on ground without an edge, as terrain.window makes it: use slope, none or sow"
                raise DeclarationError(why, "grass", name, "place")
        return self

    def numbers(self, preset: str | None = None) -> Quality:
        """Return the numbers of `preset`, or of the scene's own quality. Raises ValueError for an unknown preset."""
        must_be_known("preset", preset, PRESETS)
        chosen = preset or self.quality
        return PRESETS[chosen] if isinstance(chosen, str) else chosen

    def number_of(self, kind: str | None) -> int | None:
        """Return the number of a grass kind by its name, from 0; None for None. Raises ValueError for others."""
        must_be_known("grass", kind, self.grass)
        return None if kind is None else list(self.grass).index(kind)
