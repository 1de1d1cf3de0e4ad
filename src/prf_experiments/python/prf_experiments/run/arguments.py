# SPDX-License-Identifier: BSD-3-Clause
"""`key:=value` arguments with a list of what is valid; errors of one line that guess what was meant."""
import argparse
import difflib
import math
import os
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, NoReturn


class ArgumentError(ValueError):
    """An argument is unknown or its value invalid."""


def meant(word: str, *candidates: str) -> str:
    """"; did you mean X?" for the nearest candidate, "" when none is near."""
    near = difflib.get_close_matches(word, candidates, 1, 0.6)
    return f"; did you mean {near[0]}?" if near else ""


class Parser(argparse.ArgumentParser):
    """argparse whose errors are one line, without usage; no option may be shortened, so that none
    is taken for a longer one."""

    def __init__(self, **named: Any):
        super().__init__(**{"allow_abbrev": False, **named})

    def error(self, message: str) -> NoReturn:
        print(f"{self.prog}: {self._guess(message)} (--help lists what is valid)", file=sys.stderr)
        sys.exit(2)

    def _guess(self, message):
        options = [name for action in self._actions for name in action.option_strings]
        unknown = re.fullmatch(r"unrecognized arguments: (--[\w-]+).*", message)
        if unknown:
            return message + meant(unknown[1], *options)
        wrong = re.fullmatch(r"(?:argument (\S+): )?invalid choice: '(.*)' \(choose from (.*)\)", message)
        if wrong:
            choices = [word.strip("'") for word in wrong[3].split(", ")]  # quoted before Python 3.12
            return (f"'{wrong[2]}' is no {wrong[1] or 'choice'}, must be one of {', '.join(choices)}"
                    + meant(wrong[2], *choices))
        return message


@dataclass(frozen=True)
class Argument:
    default: Any
    valid: str  # shown to people
    parse: Callable[[str], Any]  # raises ValueError
    meaning: str


def choice(*values: str) -> dict[str, Any]:
    def parse(text):
        if text not in values:
            raise ValueError(meant(text, *values))
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
        if not text.endswith(endings):
            raise ValueError(meant(text, *values))
        file = plain_path(text)
        if not os.path.isfile(file):
            raise ArgumentError(f"{text}: " + ("it is no file" if os.path.exists(file)
                                               else "there is no such file"))
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
        raise ArgumentError(f"unknown argument '{name}'" + meant(name, *arguments)
                            + " (--help lists them)")
    try:
        return arguments[name].parse(text)
    except ArgumentError:
        raise
    except ValueError as error:
        guess = str(error) if str(error).startswith("; ") else ""
        raise ArgumentError(f"invalid {name}:={text}, valid: {arguments[name].valid}{guess}") from None


def named_value(word: str, arguments: dict[str, Argument]) -> tuple[str, str]:
    """(name, value as text) of name:=value."""
    name, separator, text = word.partition(":=")
    if separator:
        return name, text
    name, separator, text = word.lstrip("-").partition("=")
    near = difflib.get_close_matches(name, arguments, 1, 0.6)
    if near:
        raise ArgumentError(f"'{word}' is not of the form name:=value; did you mean "
                            f"{near[0]}:={text or '...'}?")
    raise ArgumentError(f"'{word}' is not of the form name:=value (--help lists the names)")


def parse(words: Iterable[str], arguments: dict[str, Argument]) -> dict[str, Any]:
    """{name: value} for every argument; defaults where `words` are silent, else the last word."""
    values = {name: argument.default for name, argument in arguments.items()}
    for word in words:
        name, text = named_value(word, arguments)
        values[name] = value(name, text, arguments)
    return values


def parse_lists(words: Iterable[str], arguments: dict[str, Argument]) -> dict[str, list]:
    """{name: [value, ...]} of the arguments that `words` name; commas part values."""
    values = {}
    for word in words:
        name, text = named_value(word, arguments)
        parsed = [value(name, part, arguments) for part in text.split(",")]
        if len(set(parsed)) < len(parsed):
            raise ArgumentError(f"{word} says a value twice")
        values[name] = parsed
    return values
