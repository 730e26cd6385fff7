"""Writing changed values back into a YAML text, without touching any other character."""

from collections.abc import Iterator, Sequence
from itertools import compress, groupby, takewhile
from operator import eq, le
from typing import Any

from ...engine.scene import SceneError
from ...engine.scene.compose import read_document
from ...engine.scene.document import Node
from .values import Way, value_at, yaml_text

Splice = tuple[int, int, str]
"""A replacement: the index of its first character, the index after its last, and the new text."""

GONE = NEW = 0.55
"""Costs of removing and of adding an item: together more than the largest cost of altering one."""


class RewriteError(ValueError):
    """A change that cannot be written; its text has the reason and the remedy."""


def rewritten(text: str, values: dict[str, Any], /) -> str:
    """Return a YAML text changed to read as `values`; comments, order, quotes and spaces of all else stay.

    `read_document` must be able to read the text. Raises RewriteError where the change cannot be written.
    """
    splices = sorted(_splices(text, read_document(text, file="").root, values), key=lambda splice: splice[:2])
    result = text
    for start, end, new in reversed(splices):  # from the back; of several at one index the first one stands first
        result = result[:start] + new + result[end:]
    try:
        read = read_document(result, file="").root.data
    except SceneError as error:
        raise RewriteError(f"what was changed {_REPEATED}") from error
    if not _same(read, values):
        raise RewriteError(
            f"with what was changed, {'.'.join(map(str, _other(read, values)))} changes, too: it {_REPEATED}"
        )
    return result


_REPEATED = "is written once and used at several places (& and *); change it in the file itself"


def _other(one: Any, other: Any) -> Way:
    """Return the way to the first difference of two values."""
    steps = one if isinstance(one, dict) else range(len(one)) if isinstance(one, list) else ()
    found = (step for step in steps if not _same(value_at(one, (step,)), value_at(other, (step,))))
    step = next(found, None)
    return () if step is None else (step, *_other(value_at(one, (step,)), value_at(other, (step,))))


def _same(one: Any, other: Any) -> bool:
    """Return whether two values are equal in the digits that are written."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(value, other[key]) for key, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return yaml_text(one) == yaml_text(other)


def _splices(text: str, node: Node, value: Any, key: Node | None = None) -> Iterator[Splice]:
    """Yield the splices that make the text of `node` read as `value`; `key` is the node of its key in a mapping."""
    if _same(node.data, value):
        return
    if text.startswith("*", node.start):  # an alias: what it repeats stays
        yield from _replacement(text, node, value, key)
    elif isinstance(node.data, dict) and isinstance(value, dict) and node.keys.keys() & value.keys():
        yield from _mapping(text, node, value)
    elif isinstance(node.data, list) and isinstance(value, list) and node.below and value:
        yield from _list(text, node, value)
    else:
        yield from _replacement(text, node, value, key)


def _replacement(text: str, node: Node, value: Any, key: Node | None) -> Iterator[Splice]:
    new = yaml_text(value)
    if isinstance(value, str) and text[node.start : node.start + 1] == "'" and "'" not in value and value.isprintable():
        new = f"'{value}'"
    if key is not None and node.below and not node.flow:  # a block: comments may stand beside its key
        colon = text.index(":", key.end) + 1
        yield colon, colon, " " + new
        yield _line_start(text, node.start), _line_end(text, node.end), ""
    else:
        end = node.start + len(text[node.start : node.end].rstrip())  # a block text spans its last line break
        yield node.start, end, " " + new if text[node.start - 1 : node.start] in (":", "-") else new


def _mapping(text: str, node: Node, value: dict[str, Any]) -> Iterator[Splice]:
    for key, where in node.keys.items():
        if key in value:
            yield from _splices(text, node.below[key], value[key], where)
    starts = [each.start for each in node.keys.values()]
    for first, last in _runs([key not in value for key in node.keys]):
        yield _removal(text, node, starts, first, last)
    new = [f"{yaml_text(key)}: {yaml_text(each)}" for key, each in value.items() if key not in node.keys]
    if new:
        yield _addition(text, node, new)


def _list(text: str, node: Node, value: list[Any]) -> Iterator[Splice]:
    items = [*node.below.values()]
    starts = [item.start if node.flow else _dash(text, item) for item in items]
    stays = _staying(node.data, value)
    for first, last in _runs([not each for each in stays]):
        yield _removal(text, node, starts, first, last)
    for item, new in zip(compress(items, stays), value, strict=False):
        yield from _splices(text, item, new)
    added = [yaml_text(item) for item in value[sum(stays) :]]
    if added:
        yield _addition(text, node, added if node.flow else [f"- {each}" for each in added])


def _runs(gone: list[bool]) -> Iterator[tuple[int, int]]:
    """Yield the runs of entries that are gone, each as its first index and the index after its last."""
    for is_gone, run in groupby(range(len(gone)), gone.__getitem__):
        if is_gone:
            first, *others = run
            yield first, first + len(others) + 1


def _dash(text: str, item: Node) -> int:
    return text.rindex("-", 0, item.start)


def _removal(text: str, node: Node, starts: list[int], first: int, last: int) -> Splice:
    """Return the splice that removes the entries from `first` to the one before `last`."""
    ends = [item.end for item in node.below.values()]
    if node.flow and last < len(starts):
        return starts[first], starts[last], ""
    if node.flow:
        return (ends[first - 1] if first else starts[0]), ends[last - 1], ""
    line = _line_start(text, starts[first])
    if text[line : starts[first]].strip() and last < len(starts):  # it shares its line with a dash
        return starts[first], starts[last], ""
    return line, _line_end(text, ends[last - 1]), ""


def _addition(text: str, node: Node, new: list[str]) -> Splice:
    """Return the splice that appends entries."""
    items = [*node.below.values()]
    end = items[-1].end
    if node.flow:
        return end, end, "".join(f", {each}" for each in new)
    newline = "\r\n" if "\r\n" in text else "\n"
    start = node.start if node.keys else _dash(text, items[0])
    indent = " " * (start - _line_start(text, start))
    lines = newline.join(indent + each for each in new)
    place = _line_end(text, end)
    return place, place, lines + newline if text[:place].endswith("\n") else newline + lines


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    """Return the index at which the next line begins; it is `at` itself right after a line break."""
    if at and text[at - 1] == "\n":
        return at
    found = text.find("\n", at)
    return len(text) if found < 0 else found + 1


def _staying(before: Sequence[Any], after: Sequence[Any], /) -> list[bool]:
    """Return for each item of a list whether it stays in the list `after`, perhaps with altered values.

    The items that stay become the first ones of `after`, in their order; all that follow are new. Of all such choices
    this one has the least cost of changes (dynamic programming over both lists).
    """
    texts, others = [yaml_text(item) for item in before], [yaml_text(item) for item in after]
    same = sum(takewhile(bool, map(eq, texts, others)))
    # Least costs of making the rest of `before`, at first nothing, into the rest of `after` from each place on.
    costs, stays_at = [NEW * new for new in range(len(after) - same, -1, -1)], list[list[bool]]()
    for item, text in zip(reversed(before[same:]), reversed(texts[same:]), strict=True):
        stays = [
            cost + (0.0 if text == other else _difference(item, new))
            for cost, other, new in zip(costs[1:], others[same:], after[same:], strict=True)
        ]
        goes = [cost + GONE for cost in costs]
        costs = [*map(min, stays, goes), goes[-1]]
        stays_at.append([*map(le, stays, goes), False])
    found, there = [True] * same, 0
    for stays_by_place in reversed(stays_at):
        found.append(stays_by_place[there])
        there += found[-1]
    return found


def _difference(one: Any, other: Any) -> float:
    """Return the difference of two items, 0 to 1: mappings by their keys, two other values 0.25."""
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return 1.0 if isinstance(one, dict) or isinstance(other, dict) else 0.25
    common = one.keys() & other.keys()
    alike = sum(1.0 if one[key] == other[key] else 0.5 for key in common)
    return 1.0 - alike / max(len(one), len(other), 1)
