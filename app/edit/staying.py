"""Which items of a list stay when it becomes another one."""

from collections.abc import Sequence
from typing import Any

from .yaml_text import yaml_text

GONE = NEW = 0.55
"""What an item costs that goes, and one that comes: together more than any that becomes another one."""


def staying(before: Sequence[Any], after: Sequence[Any], /) -> list[bool]:
    """Return for each item of a list whether it stays, if need be with other values, in the list that comes after.

    Those that stay are the first ones after, in their order, and what follows them there is new. Of all such ways it
    is the one with the fewest changes.
    """
    texts, others = [yaml_text(item) for item in before], [yaml_text(item) for item in after]
    same = next((n for n, pair in enumerate(zip(texts, others, strict=False)) if pair[0] != pair[1]), len(after))
    same = min(same, len(before))
    costs, ways = [[0.0]], list[list[bool]]()
    for item, text in zip(before[same:], texts[same:], strict=True):
        above, row, way = costs[-1], [costs[-1][0] + GONE], [False]
        for number in range(1, min(len(above), len(after) - same) + 1):
            there = same + number - 1
            stays = above[number - 1] + (0.0 if text == others[there] else _apart(item, after[there]))
            goes = above[number] + GONE if number < len(above) else stays + GONE
            row.append(min(stays, goes))
            way.append(stays <= goes)
        costs.append(row)
        ways.append(way)
    kept = min(range(len(costs[-1])), key=lambda number: costs[-1][number] - NEW * number)
    stay = []
    for way in reversed(ways):
        stay.append(way[kept])
        kept -= way[kept]
    return [True] * same + stay[::-1]


def _apart(one: Any, other: Any) -> float:
    """Return how much two items differ, up to 1: mappings by their keys, all else a little."""
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return 1.0 if isinstance(one, dict) or isinstance(other, dict) else 0.25
    common = one.keys() & other.keys()
    alike = sum(1.0 if one[key] == other[key] else 0.5 for key in common)
    return 1.0 - alike / max(len(one), len(other), 1)
