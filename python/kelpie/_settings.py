# SPDX-License-Identifier: Apache-2.0
"""Settings of the library as parameters of an estimator, and back."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from typing import Any, Union

from . import _kelpie

# A setting whose name is a Python keyword has another name here.
_PARAMETER_OF = {"lambda": "lambda_terms"}
# What some settings are called as well: as in the paper and scikit-learn's SVR, or in words.
ALIASES = {"c": "C", "states": "velocities"}
_SEPARATORS = {"terms": ";"}  # between the parts of a list; a comma for all others
_WORDS = {"terms", "states"}  # texts that may look like lists of numbers


def parameter_name(setting: str) -> str:
    """The constructor's name for a setting of `kelpie config`."""
    return _PARAMETER_OF.get(setting, setting)


def setting_names() -> list[str]:
    """All settings in the order of `kelpie config --all`, the preset first."""
    return [name for name, _, _, _ in _kelpie.setting_docs()]


def texts(parameters: Mapping[str, Any]) -> dict[str, str]:
    """The parameters as texts for the library; those that are None are left to the preset.

    Raises ValueError where a setting is given by both its names.
    """
    given = {name: parameters[parameter_name(name)] for name in setting_names()}
    for name, alias in ALIASES.items():
        if parameters[alias] is not None:
            if given[name] is not None:
                raise ValueError(f"{alias}: is another name of {name}; give one of them")
            given[name] = parameters[alias]
    return {name: _text(name, value) for name, value in given.items() if value is not None}


def assignments(parameters: Mapping[str, Any]) -> list[str]:
    """The parameters in the form name=value of `kelpie learn --set`. ValueError on no such value."""
    settings = {parameter_name(name): name for name in setting_names()}
    settings.update({alias: name for name, alias in ALIASES.items()})
    return [f"{settings.get(name, name)}={_text(settings.get(name, name), value)}"
            for name, value in parameters.items() if value is not None]


def parameters(settings: Mapping[str, str], axes: int) -> dict[str, Any]:
    """The parameters that give these settings: the preset and all differences from it."""
    start = _kelpie.preset_values(settings["preset"], axes)
    return {parameter_name(name): _value(name, text) for name, text in settings.items()
            if name == "preset" or text != start[name]}


def describe() -> str:
    """The settings as a section of a docstring, in the groups of `kelpie config --all`."""
    lines = []
    group = ""
    for name, meaning, allowed, its_group in _kelpie.setting_docs():
        if its_group != group:
            group = its_group
            lines += ["", f"{group}:", ""]
        lines += [f"{parameter_name(name)} : {allowed}", f"    {meaning}"]
        if name in ALIASES:
            lines += [f"{ALIASES[name]} : another name of {name}", "    Give one of the two."]
    return "\n".join(lines).strip()


def _text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return str(int(value))
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return repr(float(value))
    if isinstance(value, bool) or not hasattr(value, "__iter__"):
        raise ValueError(f"{parameter_name(name)}: {value!r} is neither a number nor a text, nor "
                         "a list of them")
    return _SEPARATORS.get(name, ",").join(_text(name, part) for part in value)


def _value(name: str, text: str) -> Union[str, float, int, tuple[Any, ...]]:
    if name in _WORDS:
        return text
    if "," in text:
        return tuple(_value(name, part) for part in text.split(","))
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
