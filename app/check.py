"""Checking scene files, maps included, and their JSON schema for editors."""

import json
import sys
from warnings import catch_warnings

from .. import __version__
from ..components.wind import WindPrimitive
from ..engine.plugins import PluginError, WindKinds, wind_kinds
from ..engine.scene import SceneError, load_maps, printable, read_scene
from ..engine.scene.schema import Schema, scene_schema


def check(scenes: list[str]) -> int:
    """Print every problem of every scene (paths or bundled names), or that it is ok.

    Returns the exit status: 0 when all are ok, 2 otherwise.
    """
    status = 0
    for scene in scenes:
        try:
            load_maps(read_scene(scene))
        except SceneError as error:
            print(error)
            status = 2
        else:
            print(f"{printable(scene)}: ok")
    return status


def schema() -> None:
    """Print the schema of scene files, installed plugins included, and warn of plugins without a description."""
    made, warnings = described(wind_kinds())
    print(json.dumps(made, indent=2))
    for line in warnings:
        print(line, file=sys.stderr)


def described(kinds: WindKinds, /) -> tuple[Schema, list[str]]:
    """Return the schema of scene files, and a warning for each kind of wind that it leaves out or cannot describe."""
    winds: dict[str, type[WindPrimitive] | None] = {}
    warnings = []
    for kind in kinds.names():
        try:
            winds[kind] = _describable(kinds.find(kind))
        except PluginError as error:
            warnings.append(f"{error}; it is left out")
        except Exception as error:  # noqa: BLE001 - a plugin's own types may raise anything
            winds[kind] = None
            warnings.append(
                f"kind '{kind}' has no schema, any keys are taken as right: {type(error).__name__}: {error}"
            )
    made = scene_schema(winds)
    made["$comment"] = (
        f"Made by tallgrass {__version__} with the winds {', '.join(winds)}: make it again after a change."
    )
    return made, warnings


def _describable(primitive: type[WindPrimitive]) -> type[WindPrimitive]:
    with catch_warnings(action="ignore"):
        primitive.model_json_schema()
    return primitive
