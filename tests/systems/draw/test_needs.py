"""The ground's pixels read no more than a frame needs: of the programs that meet its needs, the cheapest draws."""

from typing import Any

import pytest

from tallgrass.systems.show.carpet.layer import Layer, cheapest, needs_of, unmet

PROGRAMS: dict[str, dict[str, str | int]] = {
    "uncut": {"PLAIN": 1, "CUT": 0, "LAMPLESS": 1},
    "cut": {"PLAIN": 1, "CUT": 1, "LAMPLESS": 1},
    "usual": {"PLAIN": 1},
    "untrodden": {},
    "all": {"TRODDEN": 1},
}


def layer(defines: dict[str, str | int]) -> Layer:
    unused: Any = None
    return Layer(unused, unused, unused, unused, unmet(defines))


@pytest.mark.parametrize(
    ("needs", "due"),
    [
        ([], "uncut"),
        (["cut"], "cut"),
        (["lamps"], "usual"),
        (["cut", "lamps"], "usual"),
        (["changes"], "untrodden"),
        (["rare", "cut"], "untrodden"),
        (["trodden"], "all"),
        (["trodden", "rare", "changes", "lamps", "cut"], "all"),
    ],
)
def test_n6_the_cheapest_program_that_meets_all_needs_draws(needs: list[str], due: str) -> None:
    layers = {name: layer(defines) for name, defines in PROGRAMS.items()}
    assert cheapest(layers, needs_of(**dict.fromkeys(needs, True))) is layers[due]
