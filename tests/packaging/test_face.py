"""The face of the library: the names that other programs import."""

import subprocess
import sys

import pytest

import tallgrass
from tallgrass.components.wind import WindPrimitive
from tallgrass.engine.plugins import wind
from tallgrass.engine.scene import SceneError
from tallgrass.systems.prairie import Prairie

pytestmark = pytest.mark.packaging


def test_the_face_shows_what_programs_are_written_with() -> None:
    """All other names are recorded in docs/public.json, and compared by tests/docs/test_public.py."""
    winds = {"Blast", "Breeze", "Gust", "MeanWind", "PlacedWind", "Turbulence", "Whirlwind", "WindPrimitive"}
    assert sorted(set(tallgrass.__all__)) == sorted(tallgrass.__all__)
    assert all(issubclass(getattr(tallgrass, name), WindPrimitive) for name in winds)
    assert (tallgrass.Prairie, tallgrass.SceneError) == (Prairie, SceneError)
    assert (tallgrass.WindPrimitive, tallgrass.wind) == (WindPrimitive, wind)


def test_every_name_of_the_face_is_there_right_after_the_import_and_none_loads_another() -> None:
    program = """
import sys
for name in sys.argv[1:]:
    for module in [*sys.modules]:
        if module.partition(".")[0] in {"esper", "pyglet", "tallgrass"}:
            del sys.modules[module]
    import tallgrass
    getattr(tallgrass, name)
    print(name, *sorted({"esper", "pyglet"} & set(sys.modules)))
"""
    command = [sys.executable, "-c", program, *tallgrass.__all__]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    whole = {"Prairie", "install"}
    assert done.stdout.splitlines() == [f"{name} esper" if name in whole else name for name in tallgrass.__all__]


def test_the_import_alone_lists_every_name_and_loads_no_other_package_and_no_module_of_ours() -> None:
    program = """
import sys
before = set(sys.modules)
import tallgrass
assert set(tallgrass.__all__) <= set(dir(tallgrass))
print(*sorted({name for name in set(sys.modules) - before if name.partition(".")[0] not in sys.stdlib_module_names}))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["tallgrass"]


def test_a_prairie_loads_nothing_of_the_command_line() -> None:
    program = """
import sys
from tallgrass import Prairie
print(*sorted({"matplotlib", "rich", "typer", "tallgrass.app", "tallgrass.testing"} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_a_name_that_is_not_there_is_refused_as_python_does() -> None:
    with pytest.raises(AttributeError, match="module 'tallgrass' has no attribute 'Meadow'") as refusal:
        tallgrass.Meadow  # noqa: B018 - looking it up is the test
    assert (refusal.value.name, refusal.value.obj) == ("Meadow", tallgrass)  # Python suggests a name from these
