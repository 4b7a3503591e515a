# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The stubs match the module: names, arguments, defaults, docstrings."""
import ast
import inspect
from pathlib import Path

import pytest

import adasplats

FOLDER = Path(adasplats.__file__).parent


def definitions(stub):
    """Functions and classes of a stub by name: "model", "Scene", "Scene.cast"."""
    found = {}

    def visit(node, prefix):
        for child in node.body:
            if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
                name = prefix + child.name
                found.setdefault(name, []).append(child)
                if isinstance(child, ast.ClassDef):
                    visit(child, name + ".")

    visit(ast.parse((FOLDER / stub).read_text(encoding="utf-8")), "")
    return found


INIT = definitions("__init__.pyi")
EVALUATE = definitions("evaluate.pyi")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def arguments_of(node):
    """(name, kind, default) as inspect has them."""
    kinds = inspect.Parameter
    a = node.args
    missing = [kinds.empty] * (len(a.args) - len(a.defaults))
    defaults = missing + [ast.literal_eval(d) for d in a.defaults]
    found = [(x.arg, kinds.POSITIONAL_OR_KEYWORD, d) for x, d in zip(a.args, defaults)]
    found += [(x.arg, kinds.KEYWORD_ONLY, kinds.empty if d is None else ast.literal_eval(d))
              for x, d in zip(a.kwonlyargs, a.kw_defaults)]
    if a.kwarg:
        found.append((a.kwarg.arg, kinds.VAR_KEYWORD, kinds.empty))
    return found


def resolved(module, name):
    value = module
    for part in name.split("."):
        take = inspect.getattr_static if inspect.isclass(value) else getattr
        value = take(value, part)
        value = value.__func__ if isinstance(value, staticmethod) else value
    return value


CHECKED = [(module, name, nodes[0]) for module, found in ((adasplats, INIT),
                                                          (adasplats.evaluate, EVALUATE))
           for name, nodes in found.items()
           if isinstance(nodes[0], ast.FunctionDef)]
SPECIAL = {"__len__", "__iter__", "__getitem__", "__dlpack__", "__dlpack_device__"}


@pytest.mark.parametrize("module, name, node", CHECKED, ids=[name for _, name, _ in CHECKED])
def test_signature(module, name, node):
    value = resolved(module, name)
    if is_property(node):
        assert isinstance(value, property)
    elif node.name == "__init__":
        owner = resolved(module, name.rpartition(".")[0])
        expected = [a for a in arguments_of(node) if a[0] != "self"]
        assert [(p.name, p.kind, p.default)
                for p in inspect.signature(owner).parameters.values()] == expected
    elif node.name not in SPECIAL:
        assert [(p.name, p.kind, p.default)
                for p in inspect.signature(value).parameters.values()] == arguments_of(node)


def public(owner):
    return {name for name in vars(owner) if not name.startswith("_")}


def test_stubs_are_complete():
    classes = {name for name, nodes in INIT.items() if isinstance(nodes[0], ast.ClassDef)}
    stated = {name for name in INIT if "." not in name}
    constants = {"NO_PRIMITIVE", "__version__", "evaluate"}
    assert set(adasplats.__all__) == stated | constants
    assert set(adasplats.evaluate.__all__) == set(EVALUATE)
    for name in classes:
        if issubclass(resolved(adasplats, name), Exception):
            continue
        stub = {n[len(name) + 1:] for n in INIT if n.startswith(name + ".")
                and "." not in n[len(name) + 1:] and not n[len(name) + 1:].startswith("_")}
        hidden = {"ScanIterator", "BatchIterator"} if name == "Scene" else set()  # Iterators
        assert public(resolved(adasplats, name)) - hidden == stub, name


def test_everything_has_a_docstring():
    assert len(adasplats.__doc__) > 200
    for name in adasplats.__all__:
        value = getattr(adasplats, name)
        if name not in {"NO_PRIMITIVE", "__version__"}:
            assert value.__doc__, name
        if inspect.isclass(value) and not issubclass(value, Exception):
            for member in public(value):
                assert getattr(value, member).__doc__, (name, member)
    for name in adasplats.evaluate.__all__:
        assert "Raises" in getattr(adasplats.evaluate, name).__doc__


def test_array_types_of_stubs_match_docstrings():
    """A property whose docstring begins with a shape has an array type in the stub."""
    for name, nodes in INIT.items():
        node = nodes[0]
        if isinstance(node, ast.FunctionDef) and is_property(node):
            text = inspect.getdoc(resolved(adasplats, name)) or ""
            for dtype in ("float32", "float64", "uint8", "uint16", "uint32"):
                if f") {dtype}" in text[:20]:
                    assert f"NDArray[np.{dtype}]" in ast.unparse(node.returns), name
            assert ast.get_docstring(node), name


def test_docstrings_of_stubs_match_the_module():
    """Stubs have the docstrings of properties and the first paragraph of those of classes."""
    for name, nodes in INIT.items():
        node, value = nodes[0], resolved(adasplats, name)
        if isinstance(node, ast.ClassDef) and not issubclass(value, Exception):
            expected = inspect.getdoc(value).split("\n\n")[0]
        elif isinstance(node, ast.FunctionDef) and is_property(node):
            expected = inspect.getdoc(value)
        else:
            continue
        assert (ast.get_docstring(node) or "").split() == expected.split(), name


def test_package_is_typed():
    assert (FOLDER / "py.typed").exists()
