"""Texture units: those of OpenGL 3.3 suffice for every program (D6)."""

from collections.abc import Callable
from typing import Any

import esper
import moderngl
import pytest

from tallgrass import Footprint, Pose, Presser
from tallgrass.components.body import Body
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.units import BORROWED, FIRST_UNIT, SCRATCH_UNIT
from tallgrass.systems.features import STAGE, assign_units
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

COMBINED = 48
"""Least GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS of OpenGL 3.3."""

SAMPLERS = {*range(0x8B5D, 0x8B65), *range(0x8DC0, 0x8DD9)}
"""Types of uniforms that read textures."""


@pytest.mark.usefixtures("ahead", "undrawn")
@pytest.mark.parametrize("scene", ["meadow", "storm"])
def test_d6_every_program_of_a_scene_reads_few_textures_from_units_that_every_card_has(
    load: Load, stage: Stage, camera: Aim, monkeypatch: pytest.MonkeyPatch, scene: str
) -> None:
    programs: list[moderngl.Program] = []
    make = moderngl.Context.program

    def noted(*args: Any, **options: Any) -> moderngl.Program:
        programs.append(make(*args, **options))
        return programs[-1]

    monkeypatch.setattr(moderngl.Context, "program", noted)
    prairie = load(scene, preset="low")
    presser, body = esper.create_entity(Presser(radius=0.5), Pose(1.0, 2.0)), esper.create_entity(Body((0, 6, 0)))
    prairie.cut(Footprint(radius=2.0), 0.05)
    stage.shot(prairie, camera(0.0, 1.7, 10.0))
    for entity in (presser, body):
        esper.delete_entity(entity, immediate=True)
    assert len(programs) > 12
    for made in programs:
        if isinstance(made.mglo, moderngl.InvalidObject):
            continue  # it was made to see whether it can be
        members = [made[name] for name in made]
        units = [each.value for each in members if isinstance(each, moderngl.Uniform) and each.gl_type in SAMPLERS]  # type: ignore[attr-defined]
        assert len(units) == len(set(units))
        assert len(set(units) - set(BORROWED)) <= STAGE
        assert all(unit in BORROWED or FIRST_UNIT <= unit < COMBINED for unit in units)


def test_no_shadow_map_is_read_where_textures_are_loaded(ctx: moderngl.Context) -> None:
    """A colour texture left there would make drivers compile programs again: once this stalled the first cut."""
    assert not {SCRATCH_UNIT, ctx.default_texture_unit} & set(BORROWED)


def test_each_of_those_that_draw_has_the_same_units_for_its_own_textures_and_they_meet_no_others() -> None:
    units = assign_units(["a", "b"], ["wind"], {"one": (["heard"], ["heard", "drawn"]), "other": ([], ["x", "y", "z"])})
    assert [units[name] for name in "ab"] == [FIRST_UNIT, FIRST_UNIT + 1]
    assert units["heard"] == units["x"] == FIRST_UNIT + 2
    assert units["drawn"] == units["y"]
    assert units["wind"] == FIRST_UNIT + STAGE - 1


def test_too_many_textures_are_told_by_name_before_anything_is_drawn() -> None:
    most = [f"t{number}" for number in range(STAGE - 1)]
    assert max(assign_units(most, [], {"moss": ([], ["green"])}).values()) == COMBINED - 1
    with pytest.raises(RuntimeError, match=r"^moss reads 17 textures at once where OpenGL 3\.3 has 16: t0, .*, brown$"):
        assign_units(most, [], {"moss": ([], ["green", "brown"])})
    with pytest.raises(RuntimeError, match=r"^moss reads 17 textures .*, green, wind$"):
        assign_units(most, ["wind"], {"moss": (["green"], [])})
