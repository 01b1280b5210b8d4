"""``quintet schema``: the keys of scene files as a JSON schema, by which editors help.

Only keywords of draft 7 are used, which editors of TOML know.
"""

import json
import re
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import TypeAdapter
from pydantic.errors import PydanticInvalidForJsonSchema
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from quintet.coupler.coupling.links import known_links, maker
from quintet.coupler.coupling.links.keys import LinkKeys
from quintet.coupler.reference.sections import SCENE_TITLE
from quintet.coupler.scene.kinds import named_kind
from quintet.coupler.scene.quantity_texts import OF_OTHERS
from quintet.coupler.scene.scene import ComponentKeys, SceneFile
from quintet.coupler.scene.tables import SceneTables
from quintet.interfaces.errors import SceneError
from quintet.interfaces.keys import Key, about, keys
from quintet.interfaces.manifest import known_kinds
from quintet.interfaces.quantities import PATTERN, is_in_si

Schema = dict[str, Any]
REFERENCE = "#/definitions/{model}"
BOUNDS = {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"}
OWN_CLASS = {"type": "string", "pattern": ":", "description": "module:Class"}


class Described(GenerateJsonSchema):
    """Schemas of parameter classes, with the meaning and unit of every key."""

    def dataclass_schema(self, schema: Any) -> JsonSchemaValue:
        """Add what the class says of itself and of its keys."""
        table = super().dataclass_schema(schema)
        params = schema["cls"]
        table["description"] = about(params)
        for key in keys(params):
            entry = table["properties"][key.name]
            unit = f" Unit: {key.unit}." if key.unit else ""
            entry["description"] = (key.meaning + unit).strip()
            if key.unit:
                entry["unit"] = key.unit
            if key.inner is not None and hasattr(key.inner, "MATERIAL"):
                table["properties"][key.name] = _or_name(entry, key)
            if key.numeric and (is_in_si(key.unit) or key.unit in OF_OTHERS):
                table["properties"][key.name] = _or_quantity(entry)
        if constants := getattr(params, "MATERIAL", None):  # which a material may have
            table["required"] = [
                name for name in table.get("required", ()) if name not in constants
            ]
        return table


def scene_schema(more_kinds: Iterable[str] = ()) -> Schema:
    """Make the schema of a scene file; `more_kinds` are ``module:Class`` that it knows too."""
    kinds = {kind: _params(kind) for kind in sorted({*known_kinds(), *more_kinds})}
    links = {kind: maker(kind).keys for kind in sorted(known_links())}
    wanted: dict[tuple[str, str], type] = {("scene", "file"): SceneFile}
    wanted |= {("scene", "tables"): SceneTables}
    wanted |= {("common", "components"): ComponentKeys, ("common", "links"): LinkKeys}
    wanted |= {("component", kind): params for kind, params in kinds.items() if params}
    wanted |= {("link", kind): params for kind, params in links.items() if params}
    schemas, inner = TypeAdapter.json_schemas(
        [(name, "validation", TypeAdapter(params)) for name, params in wanted.items()],
        ref_template=REFERENCE,
        schema_generator=Described,
    )
    definitions: Schema = inner.get("$defs", {})
    table = {name: _inside(schemas[name, "validation"], definitions) for name in wanted}
    file, tables = table["scene", "file"], table["scene", "tables"]
    properties = {**file["properties"], **tables["properties"]}
    of_components = _of_kinds("component", kinds, table, table["common", "components"])
    of_links = _of_kinds("link", links, table, table["common", "links"])
    definitions |= of_components | of_links
    properties["components"] |= {"minProperties": 1, "additionalProperties": _to("component")}
    properties["links"] |= {"items": _to("link")}
    properties["stand_ins"] |= {
        "additionalProperties": {
            "type": "object",
            "properties": {k: _to(f"keys.component.{k}") for k, schema in kinds.items() if schema},
            "additionalProperties": {"type": "object"},
        }
    }
    whole = {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": SCENE_TITLE,
        "type": "object",
        "properties": properties,
        "required": [*file["required"], *tables["required"]],
        "additionalProperties": False,
        "definitions": definitions,
    }
    return dict(_plain(_used(whole)))


def _or_name(schema: Schema, key: Key) -> Schema:
    """Accept the name of a material in the place of a table that takes constants."""
    if key.place == "names":
        inner = schema["additionalProperties"]
        return {**schema, "additionalProperties": {"anyOf": [inner, {"type": "string"}]}}
    if "anyOf" in schema:
        return schema
    others = {name: part for name, part in schema.items() if name in ("default", "description")}
    table = {name: part for name, part in schema.items() if name not in others}
    return {**others, "anyOf": [table, {"type": "string"}]}


def _or_quantity(schema: Any) -> Any:
    """Accept a text with a unit in the place of each number of a key."""
    if isinstance(schema, list):
        return [_or_quantity(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("type") != "number":
        return {key: _or_quantity(part) for key, part in schema.items()}
    bounds = {key: schema[key] for key in schema.keys() & BOUNDS}
    others = {key: part for key, part in schema.items() if key not in (*bounds, "type")}
    number = {"type": "number", **dict(sorted(bounds.items()))}
    return {**others, "anyOf": [number, {"type": "string", "pattern": PATTERN}]}


def _params(kind: str) -> type | None:
    """Return the parameter class of a kind; None where it cannot be told as a schema."""
    try:
        params = named_kind(kind, "schema").params
        TypeAdapter(params).json_schema()
    except (SceneError, PydanticInvalidForJsonSchema):
        return None
    return params


def as_text(schema: Schema) -> str:
    """Write a schema as JSON."""
    return json.dumps(schema, indent=1, ensure_ascii=False)


def _inside(schema: Schema, definitions: Schema) -> Schema:
    """Return the table that a schema refers to."""
    name = schema.get("$ref", "").rpartition("/")[2]
    return dict(definitions[name]) if name else dict(schema)


def _to(name: str) -> Schema:
    return {"$ref": REFERENCE.format(model=_in_address(name))}


def _in_address(name: str) -> str:
    """Write a name as it may stand in an address: editors refuse all others."""
    return re.sub(r"[^\w.:-]", "_", name, flags=re.ASCII)


def _of_kinds(
    subject: str, kinds: Iterable[str], table: Mapping[tuple[str, str], Schema], common: Schema
) -> Schema:
    """Define what a table of any kind may say: by its kind, those of all kinds and its own keys."""
    definitions, known = {}, [kind for kind in kinds if (subject, kind) in table]
    for kind in known:
        of_kind = table[subject, kind]
        properties = {**common["properties"], **of_kind.get("properties", {})}
        definitions[_in_address(f"keys.{subject}.{kind}")] = of_kind
        definitions[_in_address(f"{subject}.{kind}")] = {**of_kind, "properties": properties}
    free = [] if subject == "link" else [OWN_CLASS]
    names = {"anyOf": [{"enum": list(kinds)}, *free]}
    kind_key = {**common["properties"]["kind"], **names}
    kind_key.pop("type", None)
    definitions[subject] = {
        "type": "object",
        "description": common["description"],
        "properties": {**common["properties"], "kind": kind_key},
        "required": ["kind"],
        "allOf": [
            {
                "if": {"properties": {"kind": {"const": kind}}, "required": ["kind"]},
                "then": _to(f"{subject}.{kind}"),
            }
            for kind in known
        ],
        # Always met: for editors that look for keys here, and not below "then".
        "anyOf": [*(_to(f"{subject}.{kind}") for kind in known), {}],
    }
    return definitions


def _used(schema: Schema) -> Schema:
    """Leave out definitions that nothing refers to."""
    definitions = schema["definitions"]
    queue: list[Schema] = [{**schema, "definitions": {}}]
    reached: set[str] = set()
    while queue:
        text = json.dumps(queue.pop())
        for name in definitions.keys() - reached:
            if json.dumps(REFERENCE.format(model=name)) in text:
                reached.add(name)
                queue.append(definitions[name])
    used = {name: definition for name, definition in definitions.items() if name in reached}
    return {**schema, "definitions": used}


def _plain(schema: Any) -> Any:
    """Write what draft 7 lacks as it has it: tuples, and what stands beside a reference."""
    if isinstance(schema, list):
        return [_plain(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    plain = {key: _plain(part) for key, part in schema.items()}
    if plain.get("title") != SCENE_TITLE and isinstance(plain.get("title"), str):
        del plain["title"]  # a class's or key's name once more
    if "prefixItems" in plain:
        items = plain.pop("prefixItems")
        plain["items"] = items[0] if all(part == items[0] for part in items) else items
    if "$ref" in plain and len(plain) > 1:
        plain["allOf"] = [{"$ref": plain.pop("$ref")}]
    return plain
