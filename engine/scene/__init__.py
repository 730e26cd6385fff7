"""Reading scene files: YAML with positions, problems with carets."""

from .maps import load_maps
from .problem import Problem, SceneError, printable
from .read import LoadedScene, bundled_scenes, must_be_read, parse_scene, read_scene, stamp_of

__all__ = [
    "LoadedScene",
    "Problem",
    "SceneError",
    "bundled_scenes",
    "load_maps",
    "must_be_read",
    "parse_scene",
    "printable",
    "read_scene",
    "stamp_of",
]
