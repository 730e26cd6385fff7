"""What libyaml finds wrong with a text, in plain words."""

import re

import yaml

from ...components.colour import LONG, SHORT

DEEPEST = 64
"""Most levels of nesting; libyaml's own composer overflows the stack at some ten thousand."""

TOO_DEEP = f"nested more than {DEEPEST} levels deep"

_BARE_COLOUR = re.compile(rf"[:,\[]\s+({LONG}|{SHORT})\b")
_UNCLOSED = "the quote that opens here is never closed"
_WORDS: dict[str, str] = {
    "mapping values are not allowed in this context": (
        "a ':' cannot stand here; check the indentation of this line, or quote the text"
    ),
    "could not find expected ':'": "expected ':' after the key",
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
    """Return the line and column, from 0, and the sentence for an error of libyaml."""
    mark = error.problem_mark or error.context_mark
    if mark is None:
        return 0, 0, f"this is not YAML: {error.problem}"
    context = error.context_mark or mark
    problem = error.problem or ""
    if problem == "found unexpected end of stream" and "quoted" in (error.context or ""):
        return context.line, context.column, _UNCLOSED
    if problem == "found character that cannot start any token":
        return mark.line, mark.column, _cannot_start(lines, mark.line, mark.column)
    comment = _comment(lines, context.line, mark.line) if "expected ','" in problem else None
    if comment is not None:
        line, column, colour = comment
        return line, column, f"a colour needs quotes, '{colour}', because # begins a comment"
    words = _WORDS.get(problem, "this is not YAML: " + problem.replace("{", "{{").replace("}", "}}"))
    return mark.line, mark.column, words.format(context=f"{context.line + 1}:{context.column + 1}")


def _comment(lines: list[str], first: int, last: int) -> tuple[int, int, str] | None:
    """Return where a colour without quotes has begun a comment, and the colour; None where none has."""
    for line in range(first, min(last + 1, len(lines))):
        found = _BARE_COLOUR.search(lines[line])
        if found:
            return line, found.start(1), found[1]
    return None


def _cannot_start(lines: list[str], line: int, column: int) -> str:
    character = lines[line][column : column + 1] if line < len(lines) else ""
    if character == "\t":
        return "a tab cannot indent; use spaces"
    return f"'{character}' cannot begin a value; put the text in quotes"
