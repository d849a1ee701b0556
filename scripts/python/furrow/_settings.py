"""Scenario keys as Python writes them, and as the program takes them."""
from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as JSON knows them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} is no value of a scenario: expected a number, a text, true, false, None, a list or a "
                    f"dict")


def as_json(value: Any) -> str:
    return json.dumps(value, default=_plain)


def arguments(settings: Mapping[str, Any] | None, keys: Mapping[str, Any]) -> list[str]:
    """`--set` options of dotted keys ({"rig.slip": 0.5}) and of keyword arguments (rig__slip=0.5).

    Raises TypeError for a keyword without a section.
    """
    for key in keys:
        if "__" not in key.strip("_"):
            raise TypeError(f"unexpected keyword '{key}': write a key of the scenario as section__key, for example "
                            f"rig__slip")
    dotted = {**(settings or {}), **{key.replace("__", "."): value for key, value in keys.items()}}
    return [f"--set={key}={as_json(value)}" for key, value in dotted.items()]
