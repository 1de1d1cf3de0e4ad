# SPDX-License-Identifier: BSD-3-Clause
"""`key:=value` arguments with a list of what is valid."""
import math
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any


class ArgumentError(ValueError):
    """An argument is unknown or its value invalid."""


@dataclass(frozen=True)
class Argument:
    default: Any
    valid: str  # shown to people
    parse: Callable[[str], Any]  # raises ValueError
    meaning: str


def choice(*values: str) -> dict[str, Any]:
    def parse(text):
        if text not in values:
            raise ValueError
        return text
    return {"valid": "|".join(values), "parse": parse}


def boolean() -> dict[str, Any]:
    def parse(text):
        if text.lower() not in ("true", "on", "false", "off"):
            raise ValueError
        return text.lower() in ("true", "on")
    return {"valid": "true|false|on|off", "parse": parse}


def integer(low: int, high: int) -> dict[str, Any]:
    def parse(text):
        value = int(text)
        if not low <= value <= high:
            raise ValueError
        return value
    return {"valid": f"integer {low}..{high}", "parse": parse}


def number(low: float, high: float) -> dict[str, Any]:
    def parse(text):
        value = float(text)
        if not (math.isfinite(value) and low <= value <= high):
            raise ValueError
        return value
    return {"valid": f"number {low:g}..{high:g}", "parse": parse}


def plain_path(text: str) -> str:
    """The absolute path; ROS reads `:=` and `$(` in it as something else. Raises ValueError."""
    if not text or ":=" in text or "$(" in text:
        raise ValueError
    return os.path.abspath(os.path.expanduser(text))


def path() -> dict[str, Any]:
    return {"valid": "a path without := and $(", "parse": plain_path}


def choice_or_file(*values: str, endings: tuple[str, ...]) -> dict[str, Any]:
    """One of the values, or an existing file with one of the endings."""
    def parse(text):
        if text in values:
            return text
        file = plain_path(text)
        if not (file.endswith(endings) and os.path.isfile(file)):
            raise ValueError
        return file
    return {"valid": "|".join([*values, "FILE" + "|FILE".join(endings)]), "parse": parse}


def usage(arguments: dict[str, Argument]) -> str:
    width = max(len(name) for name in arguments) + 2
    return "\n".join(f"  {name + ':=':<{width}} {argument.valid:<24} {argument.meaning}"
                     f" [{show(argument.default)}]" for name, argument in arguments.items())


def show(value: Any) -> str:
    if value is None:
        return "the package's own"
    return str(value).lower() if isinstance(value, bool) else str(value)


def value(name: str, text: str, arguments: dict[str, Argument]) -> Any:
    """The parsed value of one argument."""
    if name not in arguments:
        raise ArgumentError(f"unknown argument '{name}'")
    try:
        return arguments[name].parse(text)
    except ArgumentError:
        raise
    except ValueError:
        raise ArgumentError(f"invalid {name}:={text}, valid: {arguments[name].valid}") from None


def parse(words: Iterable[str], arguments: dict[str, Argument]) -> dict[str, Any]:
    """{name: value} for every argument; defaults where `words` are silent, else the last word."""
    values = {name: argument.default for name, argument in arguments.items()}
    for word in words:
        name, separator, text = word.partition(":=")
        if not separator:
            raise ArgumentError(f"'{word}' is not of the form name:=value")
        values[name] = value(name, text, arguments)
    return values


def parse_lists(words: Iterable[str], arguments: dict[str, Argument]) -> dict[str, list]:
    """{name: [value, ...]} of the arguments that `words` name; commas part values."""
    values = {}
    for word in words:
        name, separator, text = word.partition(":=")
        if not separator:
            raise ArgumentError(f"'{word}' is not of the form name:=value")
        parsed = [value(name, part, arguments) for part in text.split(",")]
        if len(set(parsed)) < len(parsed):
            raise ArgumentError(f"{word} says a value twice")
        values[name] = parsed
    return values
