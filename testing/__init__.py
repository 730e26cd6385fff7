"""Tools for your own tests: checks of winds, small prairies, single steps of systems, comparison of pictures.

It needs no test runner, and registers itself with none.
"""

from ..engine.gl.headless import NoContextError
from ..engine.schedule import Phase
from ..engine.world import private_world
from .clock import FixedClock, fixed_clock
from .golden import same_picture
from .heard import Heard, receivers_of
from .little import LITTLE, little_prairie, little_site, look, step, systems_on, viewer_on, watch
from .stage import Stage, headless_context, looking, stage
from .twins import twin_problems
from .winds import check_wind, wind_problems

__all__ = [
    "LITTLE",
    "FixedClock",
    "Heard",
    "NoContextError",
    "Phase",
    "Stage",
    "check_wind",
    "fixed_clock",
    "headless_context",
    "little_prairie",
    "little_site",
    "look",
    "looking",
    "private_world",
    "receivers_of",
    "same_picture",
    "stage",
    "step",
    "systems_on",
    "twin_problems",
    "viewer_on",
    "watch",
    "wind_problems",
]
