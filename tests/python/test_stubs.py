# SPDX-License-Identifier: Apache-2.0
"""The stubs say what the module has, and everything public is typed and described."""

import ast
import inspect
import re
import typing
from pathlib import Path

import kelpie
from kelpie import _kelpie

FOLDER = Path(kelpie.__file__).parent
OWN = {"__init__", "__version__"}


def stub_parameters(function):
    return [argument.arg for argument in function.args.args if argument.arg != "self"]


def module_parameters(function):
    """pybind11 writes the signature as the docstring's first line."""
    listed = re.match(r"\w+\((.*)\) -> ", function.__doc__).group(1)
    names = [part.split(":")[0].strip() for part in re.split(r", (?=\w+: )", listed) if part]
    return [name for name in names if name != "self"]


def public(names):
    return {name for name in names if not name.startswith("_") or name in OWN}


def compare(body, holder, optional=()):
    stub = {}
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            stub[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            stub[node.target.id] = node
    there = public(vars(holder)) - (set() if "__init__" in stub else {"__init__"})
    assert set(stub) == there - set(optional)
    for name, node in stub.items():
        found = inspect.getattr_static(holder, name)
        if isinstance(node, ast.ClassDef):
            compare(node.body, found)
        elif isinstance(node, ast.FunctionDef) and not isinstance(found, property):
            assert stub_parameters(node) == module_parameters(getattr(holder, name)), name
        elif isinstance(found, property):
            assert isinstance(node, ast.FunctionDef) and node.decorator_list, name


def test_the_stub_is_that_of_the_module():
    compare(ast.parse((FOLDER / "_kelpie.pyi").read_text()).body, _kelpie)


def test_the_package_says_that_it_is_typed():
    assert (FOLDER / "py.typed").exists()


def test_everything_public_is_typed_and_described():
    for name in kelpie.__all__:
        thing = getattr(kelpie, name)
        if not inspect.isclass(thing):
            continue
        assert thing.__doc__, name
        for member, function in inspect.getmembers(thing, inspect.isfunction):
            if member.startswith("_") or not function.__module__.startswith("kelpie"):
                continue
            assert function.__doc__, member
            hints = typing.get_type_hints(function)
            wanted = set(inspect.signature(function).parameters) - {"self", "params"} | {"return"}
            assert wanted <= set(hints), member
