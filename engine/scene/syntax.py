"""Errors of libyaml in plain words."""

import re

import yaml

from ...components.colour import LONG, SHORT

DEEPEST = 64
"""Greatest number of nested levels; libyaml's own composer overflows the stack at some ten thousand."""

TOO_DEEP = f"nested more than {DEEPEST} levels deep"

_BARE_COLOUR = re.compile(rf"[:,\[]\s+({LONG}|{SHORT})\b")
_TIGHT = re.compile(r"(?:^|[{,]|- )\s*([a-z][\w-]*):(?=[^\s:])")
"""A key whose colon no space follows."""

_UNCLOSED = "the quote that opens here is never closed"
_WORDS: dict[str, str] = {
    "mapping values are not allowed in this context": (
        "a ':' cannot stand here; check the indentation of this line, or quote the text"
    ),
    "could not find expected ':'": "expected ': ' after this key",
    "did not find expected key": "expected a key; check the indentation of this line",
    "did not find expected '-' indicator": "expected '- ' and a further item; check the indentation of this line",
    "did not find expected ',' or ']'": "expected ',' or ']'; the list that opens at {context} is never closed",
    "did not find expected ',' or '}'": "expected ',' or '}}'; the mapping that opens at {context} is never closed",
    "did not find expected <document start>": "the file ends before this; check the indentation of this line",
    "found unknown escape character": "unknown escape after '\\' in double quotes; use single quotes or '\\\\'",
    "block sequence entries are not allowed in this context": "a '- ' cannot stand here; begin the list on a new line",
    "found incompatible YAML document": "only YAML 1.1 and 1.2 are read",
    "exceeded maximum nesting depth": TOO_DEEP,
}


def explain(error: yaml.MarkedYAMLError, lines: list[str]) -> tuple[int, int, str]:
    """Return line and column, from 0, and the message for an error of libyaml."""
    mark = error.problem_mark or error.context_mark
    if mark is None:
        return 0, 0, f"this is not YAML: {error.problem}"
    context = error.context_mark or mark
    problem = error.problem or ""
    if problem == "found unexpected end of stream" and "quoted" in (error.context or ""):
        return context.line, context.column, _UNCLOSED
    if problem == "found character that cannot start any token":
        return mark.line, mark.column, _cannot_start(lines, mark.line, mark.column)
    if "expected ','" in problem or "node content" in problem:  # the latter does not tell where its list began
        comment = _comment(lines, context.line if "," in problem else 0, mark.line)
        if comment is not None:
            line, column, colour = comment
            return line, column, f"a colour needs quotes, '{colour}', because # begins a comment"
    if "':'" in problem or "mapping values" in problem:
        tight = _tight(lines, mark.line)
        if tight is not None:
            line, column, key = tight
            return line, column, f"a space is missing after '{key}:'"
    if problem == "could not find expected ':'":
        mark = context  # the key itself: libyaml may notice the missing colon lines later
    words = _WORDS.get(problem, "this is not YAML: " + problem.replace("{", "{{").replace("}", "}}"))
    return mark.line, mark.column, words.format(context=f"{context.line + 1}:{context.column + 1}")


def _comment(lines: list[str], first: int, last: int) -> tuple[int, int, str] | None:
    """Return line and column of the last unquoted colour, which YAML takes for a comment, and the colour; or None."""
    for line in range(min(last, len(lines) - 1), first - 1, -1):
        found = _BARE_COLOUR.search(lines[line])
        if found:
            return line, found.start(1), found[1]
    return None


def _tight(lines: list[str], last: int) -> tuple[int, int, str] | None:
    """Return line and column after a colon without a space, and its key, in one of two lines up to `last`; or None."""
    for line in [line for line in range(min(last, len(lines) - 1), -1, -1) if lines[line].strip()][:2]:
        found = _TIGHT.search(lines[line])
        if found:
            return line, found.end(), found[1]
    return None


def _cannot_start(lines: list[str], line: int, column: int) -> str:
    character = lines[line][column : column + 1] if line < len(lines) else ""
    if character == "\t":
        return "a tab cannot indent; use spaces"
    return f"'{character}' cannot begin a value; put the text in quotes"
