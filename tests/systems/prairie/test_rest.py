"""A viewer that stands still: systems rest, but every change shows in the same frame (R3)."""

from collections.abc import Callable

import esper
import pytest

from tallgrass.components.footprint import Footprint
from tallgrass.components.patch import Lod, Patch
from tallgrass.components.pose import Pose
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.see import See
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import looking, watch

from .conftest import Load

STOOD = 90
"""Number of frames after which all transitions of a new viewer are over."""


def follow(prairie: Prairie, *, x: float = 0.0, height: float = 4.0, yaw: float = 0.0, view: float = 45.0) -> None:
    prairie.advance(1 / 60)
    watch(prairie, looking(x, height, 10.0, yaw=yaw, pitch=-15, view=view))


def patch(prairie: Prairie) -> int:
    return int(prairie.patch_at([(0.0, 2.0)])[0])


def hold(prairie: Prairie) -> None:
    esper.component_for_entity(patch(prairie), Lod).hold = "carpet"


def clear(prairie: Prairie) -> None:
    esper.component_for_entity(patch(prairie), Patch).grows = False


def mow(prairie: Prairie) -> None:
    prairie.cut(Footprint(radius=20.0), 0.02, pose=Pose(0.0, 0.0))


def dig(prairie: Prairie) -> None:
    terrain = prairie.site.ground.terrain
    corner = [edge + 20 * terrain.cell for edge in terrain.origin]
    prairie.set_heights(corner, terrain.heights[20:40, 20:40] - 3.0)


def blow(prairie: Prairie) -> None:
    prairie.add(Breeze(strength=1.0, gustiness=0.0), pose=Pose())


def nothing(prairie: Prairie) -> None:
    del prairie


def look_on(outlook: Outlook, _: object, __: object, run: Callable[[], None], **___: object) -> None:
    """Make a system run for a viewer, even if it would rest."""
    del outlook
    run()


def seen(prairie: Prairie) -> list[bytes]:
    outlook = prairie.viewers["main"]
    return [outlook.patches.changing.tobytes(), outlook.appearance.cover.tobytes(), outlook.appearance.growth.tobytes()]


def test_r3_for_a_viewer_who_stands_still_nothing_is_seen_anew(load: Load, monkeypatch: pytest.MonkeyPatch) -> None:
    prairie, seen_anew = load(), list[float]()
    run = See._run  # noqa: SLF001

    def noted(system: See, outlook: Outlook) -> None:
        seen_anew.append(prairie.time)
        run(system, outlook)

    monkeypatch.setattr(See, "_run", noted)
    for _ in range(STOOD):
        follow(prairie)
    came = len(seen_anew)
    for _ in range(20):
        follow(prairie)
    assert len(seen_anew) == came > 1
    follow(prairie, x=0.1)
    assert len(seen_anew) == came + 1


@pytest.mark.parametrize(
    ("change", "then"),
    [
        *((each, {}) for each in (hold, clear, mow, dig, blow)),
        *((nothing, way) for way in ({"x": 0.7}, {"height": 9.0}, {"yaw": 50.0}, {"view": 20.0})),
    ],
)
def test_r3_after_a_rest_a_viewer_sees_what_it_would_have_without(
    load: Load, monkeypatch: pytest.MonkeyPatch, change: Callable[[Prairie], None], then: dict[str, float]
) -> None:
    before: list[list[bytes]] = []

    def frames() -> list[list[bytes]]:
        prairie = load()
        for _ in range(STOOD):
            follow(prairie)
        before.append(seen(prairie))
        change(prairie)
        found = []
        for _ in range(8):
            follow(prairie, **then)
            found.append(seen(prairie))
        return found

    rested = frames()
    monkeypatch.setattr(Outlook, "unless_at_rest", look_on)
    assert rested == frames()
    assert rested[-1] != before[0]
