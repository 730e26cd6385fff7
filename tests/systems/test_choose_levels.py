"""The system `lod`, which chooses the representations that are due."""

from typing import Any

import numpy as np
import pytest

from tallgrass.components.viewer import Viewer
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.lod import ChooseLevels
from tallgrass.systems.show.registry import NAMES, REPRESENTATIONS
from tallgrass.systems.show.strips.representation import StripRepresentation

_, STRIPS, CARPET = range(3)
REACH = (2, 5, 9)


def test_x1_only_what_was_and_is_seen_is_kept_finer_than_is_due_and_nothing_else_is_written() -> None:
    outlook = Outlook(Viewer(jumped=False), 0, PatchTable.allocate(3, NAMES))
    patches = outlook.patches
    patches.away[:] = np.arange(9)
    patches.visible[:] = patches.was_visible[:] = True
    patches.visible[3] = patches.was_visible[6] = False
    patches.representation[:] = patches.previous[:] = [0, 0, 0, 0, 1, 1, 1, 2, 2]
    patches.hold[2] = CARPET
    before = patches.representation.copy()
    ChooseLevels([outlook], REACH).run()
    assert patches.wanted.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]  # row 3 is not seen, row 6 was not
    patches.visible[:] = patches.was_visible[:] = True
    ChooseLevels([outlook], REACH).run()
    assert patches.wanted.tolist() == [0, 0, 0, 0, 1, 1, 1, 2, 2]
    ChooseLevels([outlook], REACH, slack=0).run()
    assert patches.wanted.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    outlook.viewer.jumped = True
    ChooseLevels([outlook], REACH).run()
    assert patches.wanted.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    np.testing.assert_array_equal(patches.representation, before)
    assert (patches.progress == 1.0).all()


class Choosy(StripRepresentation):
    """Strips that do not suit the patch in row 3."""

    def unfit(self, outlook: Outlook, rows: Any, has: Any, /, *, slack: int) -> Any:
        del outlook, has, slack
        return rows == 3


@pytest.mark.parametrize(("nearest", "passes"), [(2, [3]), (0, [3]), (-2, [])])
def test_f2_a_representation_passes_patches_that_it_would_not_do_for_on_to_the_next_unless_it_replaces_all(
    nearest: int, passes: list[int]
) -> None:
    reach = nearest, *REACH[1:]
    outlook = Outlook(Viewer(jumped=False), 0, PatchTable.allocate(3, NAMES))
    outlook.patches.away[:] = np.arange(9)
    outlook.patches.visible[:] = True
    ChooseLevels([outlook], reach).run()
    alone = outlook.patches.wanted.copy()
    first, _, last = (object.__new__(each) for each in REPRESENTATIONS)
    ChooseLevels([outlook], reach, (first, object.__new__(Choosy), last)).run()
    assert np.flatnonzero(outlook.patches.wanted != alone).tolist() == passes
    assert alone[3] == STRIPS
    assert outlook.patches.wanted[3] == (CARPET if passes else STRIPS)
