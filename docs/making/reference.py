"""The reference of scene files, made from the schema that editors read: every key there is, with what it takes."""

import re
from collections.abc import Iterator
from typing import Any

from tallgrass import WindPrimitive
from tallgrass.engine.declared.plant import PETALS, SIZES, USUAL
from tallgrass.engine.declared.quality import PRESETS, Quality
from tallgrass.engine.installed import OURS
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.scene import bundled_scenes
from tallgrass.engine.scene.schema import limits, scene_schema, written

Schema = dict[str, Any]

HEAD = "| key | takes | unit | range | default | what it is |\n|---|---|---|---|---|---|"
FACTS = ("Default:", "Range:")
HELD = ("default", "exclusiveMaximum", "exclusiveMinimum", "maximum", "minimum", "type")
"""Facts of a key that are recorded as public; its description may change."""
EVERYWHERE = 1e6
"""Numbers of lists have this bound at least; the page says it once."""
UNIT = re.compile(r"\s*\[([A-Za-z/²%]+)\]")
PLACES = {
    "GrassKind": "grass: NAME",
    "BladeRing": "quality: blade_rings",
    "StripRing": "quality: strip_rings",
    "Stop": "camera: path",
    "Place": "grass: NAME: place",
    "Head": "grass: NAME: head",
    "Waypoint": "wind: path",
    "Shape": "wind: outline",
}
"""Where in a scene file those models are that are not a top-level key or a kind of wind."""


def scene_reference() -> str:
    """Return the reference of all keys of scene files with the built-in winds, as Markdown."""
    schema = scene_schema(_ours())
    titles = _titles(schema)
    parts = ["## The whole file", "", _table(schema, titles)]
    for name, title in titles.items():
        model = schema["definitions"][name]
        parts += ["", f"## {title}", "", model["description"], "", _table(model, titles)]
        if name == "Quality":
            parts += ["", "The presets are these numbers:", "", _presets()]
        if name == "GrassKind":
            parts += ["", "Other plants have these in place of its defaults:", "", _plants()]
        if name == "Head":
            parts += ["", "What suits a form:", "", _forms()]
    parts += ["", "## Bundled scenes", "", _scenes()]
    return "\n".join(parts) + "\n"


def _scenes() -> str:
    """Return what each bundled scene says of itself in its first line."""
    rows = []
    for name, path in bundled_scenes().items():
        rows.append(f"| `{name}` | {path.read_text('utf-8').splitlines()[0].removeprefix('# ')} |")
    return "\n".join(["| scene | shows |", "|---|---|", *rows])


def _ours() -> dict[str, type[WindPrimitive]]:
    return {row.name: wind_kinds().find(row.name) for row in wind_kinds().provided() if row.distribution == OURS}


def public_keys() -> Iterator[tuple[str, str]]:
    """Yield every key of scene files with the built-in winds, and every word that a key takes, with what it is."""
    schema = scene_schema(_ours())
    titles = _titles(schema)
    yield from _keys("", schema)
    for name, title in titles.items():
        yield from _keys(f"{title}.", schema["definitions"][name])


def _keys(owner: str, model: Schema) -> Iterator[tuple[str, str]]:
    for key, declared in model["properties"].items():
        choices = [each for each in (declared, *declared.get("anyOf", [])) if each.get("type") != "null"]
        held = {fact: each[fact] for each in choices for fact in HELD if fact in each}
        held |= {"required": True} if key in model.get("required", []) else {}
        yield f"{owner}{key}", " ".join(f"{fact} {held[fact]!r}" for fact in sorted(held)) or "key"
        for word in (word for each in choices for word in [*each.get("enum", []), *filter(None, [each.get("const")])]):
            yield f"{owner}{key} = {word}", "word"


def _titles(schema: Schema) -> dict[str, str]:
    """Return the heading of every model, in the order of a scene file's keys."""
    titles: dict[str, str] = {}
    for key, declared in schema["properties"].items():
        for name in _named(declared):
            _entitle(name, PLACES.get(name, key if key != "wind" else f"wind: {name.lower()}"), schema, titles)
    return titles


def _entitle(name: str, title: str, schema: Schema, titles: dict[str, str]) -> None:
    if name in titles:
        return
    titles[name] = title
    for inner in _named(schema["definitions"][name]["properties"]):
        _entitle(inner, PLACES[inner], schema, titles)


def _named(node: Any) -> Iterator[str]:
    """Yield the names of the models that a piece of schema refers to, in its order."""
    if isinstance(node, dict):
        if "$ref" in node:
            yield node["$ref"].rpartition("/")[2]
        for value in node.values():
            yield from _named(value)
    elif isinstance(node, list):
        for value in node:
            yield from _named(value)


def _table(model: Schema, titles: dict[str, str]) -> str:
    required = model.get("required", [])
    rows = [_row(key, declared, key in required, titles) for key, declared in model["properties"].items()]
    return "\n".join([HEAD, *rows])


def _row(key: str, declared: Schema, required: bool, titles: dict[str, str]) -> str:  # noqa: FBT001 - one of many cells
    paragraphs = [text for text in declared["description"].split("\n\n") if not text.startswith(FACTS)]
    sentence = " ".join(paragraphs)
    unit = UNIT.search(sentence)
    choices = [each for each in declared.get("anyOf", [declared]) if each.get("type") != "null"]
    takes = " or ".join(_takes(each, titles) for each in choices)
    limits = "; ".join(filter(None, (_range(each) for each in choices)))
    default = "required" if required or key == "kind" else _written(declared.get("default"))
    cells = (f"`{key}`", takes, unit[1] if unit else "", limits, default, UNIT.sub("", sentence))
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"


def _takes(declared: Schema, titles: dict[str, str]) -> str:
    """Return what a key takes, in words."""
    match declared:
        case {"oneOf": choices}:
            return ", or ".join(_takes(each, titles) for each in choices)
        case {"allOf": [{"$ref": place}]} | {"$ref": place}:
            return _link(titles[place.rpartition("/")[2]])
        case {"type": "array", "items": items}:
            return _list(declared, items, titles)
        case {"type": "object", "additionalProperties": dict(inner)}:
            least, most = declared.get("minProperties", 0), declared["maxProperties"]
            return f"{least} to {most} names, each with {_takes(inner, titles)}"
    return _word(declared)


def _word(declared: Schema) -> str:
    """Return what a key takes that takes one value."""
    if "const" in declared or "enum" in declared:
        return " or ".join(f"`{value}`" for value in declared.get("enum", [declared.get("const")]))
    if "pattern" in declared:
        return "a colour, `#a8b65a` or `red`"
    words = {"integer": "a whole number", "number": "a number", "boolean": "`true` or `false`", "string": "a text"}
    return words[declared["type"]]


def _list(declared: Schema, items: Schema, titles: dict[str, str]) -> str:
    least, most = declared.get("minItems", 0), declared["maxItems"]
    if least == most:
        return f"{least} numbers"
    kinds = items.get("properties", {}).get("kind", {}).get("enum")
    each = _takes(items, titles) if kinds is None else " or ".join(_link(f"wind: {kind}") for kind in kinds)
    return f"a list of {f'{least} to' if least else 'up to'} {most}, each with {each}"


def _link(title: str) -> str:
    return f"[the keys of `{title}`](#{anchor(title)})"


def anchor(title: str, /) -> str:
    """Return what a heading is linked by."""
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", title).strip().lower())


def _range(declared: Schema) -> str:
    numbers = declared.get("items", declared)
    if numbers.get("maximum") == -numbers.get("minimum", 0.0) == EVERYWHERE:
        return ""
    return ", ".join(limits(numbers))


def _written(value: object) -> str:
    return "" if value is None else written(value)


def _plants() -> str:
    keys = list(dict.fromkeys(key for usual in USUAL.values() for key in usual if key != "head"))
    rows = [f"| plant | {' | '.join(f'`{key}`' for key in keys)} |", "|---" * (len(keys) + 1) + "|"]
    rows += [f"| {plant} | {' | '.join(_written(usual.get(key)) for key in keys)} |" for plant, usual in USUAL.items()]
    return "\n".join(rows)


def _forms() -> str:
    rows = ["| form | size [m] | petals |", "|---|---|---|"]
    rows += [f"| {form} | {_written(list(size))} | {PETALS[form]} |" for form, size in SIZES.items()]
    return "\n".join([*rows, "", "Shrubs have half as many, as each of their branches bears a head."])


def _presets() -> str:
    rows = [
        "| preset | blades a patch | blades: up to distance, segments | strips: up to distance, strips | carpet to |",
        "|---|---|---|---|---|",
    ]
    rows += [_preset(name, quality) for name, quality in PRESETS.items()]
    fewer = (f"{quality.pixels:g} in `{name}`" for name, quality in PRESETS.items() if quality.pixels < 1.0)
    rows += ["", f"`pixels` is {', '.join(fewer)}, and 1 in all others."]
    return "\n".join(rows)


def _preset(name: str, quality: Quality) -> str:
    blades = "; ".join(f"{ring.to}: {ring.segments}" for ring in quality.blade_rings)
    strips = "; ".join(f"{ring.to}: {ring.strips}" for ring in quality.strip_rings)
    return f"| `{name}` | {quality.blades} | {blades} | {strips} | {quality.carpet_to} |"
