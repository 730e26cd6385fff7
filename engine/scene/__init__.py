"""Reading scenes, from YAML or from a program's values, with problems that name the line or the path of keys."""

from .maps import load_maps
from .problem import Problem, SceneError, printable
from .read import LoadedScene, SceneLike, bundled_scenes, must_be_read, parse_scene, read_again, read_scene, stamp_of

__all__ = [
    "LoadedScene",
    "Problem",
    "SceneError",
    "SceneLike",
    "bundled_scenes",
    "load_maps",
    "must_be_read",
    "parse_scene",
    "printable",
    "read_again",
    "read_scene",
    "stamp_of",
]
