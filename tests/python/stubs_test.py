#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of names, annotations and docstrings: what an editor can show of the package."""
import ast
import inspect
import os
import shutil
import subprocess
import sys
import unittest

from support import PACKAGE, scratch

import shoal
from shoal import client, messages, plots, record, results, run, vector, world

MODULES = [client, messages, plots, record, results, run, vector, world]


def stub(name):
    with open(os.path.join(PACKAGE, 'shoal', name), encoding='utf-8') as file:
        return ast.parse(file.read())


def public(owner):
    """Yields name and object of what a module or class defines and has no underscore in front."""
    for name, value in vars(owner).items():
        if isinstance(value, (classmethod, staticmethod)):
            value = value.__func__
        own = getattr(value, '__module__', owner.__name__) == getattr(owner, '__module__', owner.__name__)
        if (not name.startswith('_') or name == '__init__') and own:
            yield name, value


def functions():
    """Yields path, function and the class it is of (or None) of everything that a user may call."""
    for module in MODULES:
        for name, value in public(module):
            if inspect.isfunction(value):
                yield f'{module.__name__}.{name}', value, None
            if not inspect.isclass(value):
                continue
            for member, function in public(value):
                if isinstance(function, property):
                    function = function.fget
                if inspect.isfunction(function):
                    yield f'{module.__name__}.{name}.{member}', function, value


class StubsTest(unittest.TestCase):

    def test_every_name_has_a_docstring(self):
        for module in MODULES:
            self.assertTrue(module.__doc__)
            for name, value in public(module):
                if inspect.isclass(value):
                    self.assertTrue(value.__doc__, f'{module.__name__}.{name}')
        for path, function, _ in functions():
            if path.startswith('shoal.world.Subscription.__init__'):
                continue  # only World makes it
            self.assertTrue(function.__doc__, path)

    def test_every_parameter_and_result_has_an_annotation(self):
        for path, function, owner in functions():
            signature = inspect.signature(function)
            for number, (name, parameter) in enumerate(signature.parameters.items()):
                if (owner is not None and number == 0) or name in ('_', 'own'):
                    continue
                self.assertIsNot(parameter.annotation, inspect.Parameter.empty, f'{path}({name})')
            self.assertIsNot(signature.return_annotation, inspect.Signature.empty, path)

    def test_long_lists_of_parameters_are_explained(self):
        for path, function, owner in functions():
            names = [name for name in inspect.signature(function).parameters if name not in ('self', 'cls', '_', 'own')]
            text = (function.__doc__ or '') + (owner.__doc__ or '' if owner else '') + (
                inspect.getmodule(function).__doc__ or '')
            for name in names if len(names) > 1 else []:
                with self.subTest(path):
                    self.assertIn(name, text)

    def test_every_attribute_is_explained_by_its_class(self):
        found = 0
        for module in MODULES:
            for node in ast.parse(inspect.getsource(module)).body:
                if not isinstance(node, ast.ClassDef) or node.name.startswith('_'):
                    continue
                own = {each.attr for each in ast.walk(node)
                       if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and
                       isinstance(each.value, ast.Name) and each.value.id == 'self'}
                fields = {each.target.id for each in node.body if isinstance(each, ast.AnnAssign)}
                text = ast.get_docstring(node)
                for name in (own | fields) - {'metadata'}:
                    if not name.startswith('_'):
                        found += 1
                        self.assertRegex(text, rf'(?m)^(\w+, )*{name}(, \w+)*: ', f'{module.__name__}.{node.name}')
        self.assertGreater(found, 20)

    def test_all_names_of_the_package_are_in_its_stub(self):
        names = set()
        for node in stub('__init__.pyi').body:
            if isinstance(node, ast.ImportFrom):
                self.assertTrue(all(each.asname == each.name for each in node.names))
                names |= {each.name for each in node.names}
        self.assertEqual(names, {*shoal.__all__, *messages.types()})

    def test_every_message_has_a_stub_with_its_members(self):
        classes = {node.name: node for node in stub('messages.pyi').body if isinstance(node, ast.ClassDef)}
        self.assertEqual(set(classes) - {'Message'}, set(messages.types()))
        for name in messages.types():
            members = [member[0] for member in getattr(messages, name)._members]
            body = classes[name].body
            self.assertEqual([node.target.id for node in body if isinstance(node, ast.AnnAssign)], members)
            init = next(node for node in body if isinstance(node, ast.FunctionDef) and node.name == '__init__')
            self.assertEqual([each.arg for each in init.args.kwonlyargs], members)
        functions_of = {node.name for node in stub('messages.pyi').body if isinstance(node, ast.FunctionDef)}
        self.assertEqual(functions_of, {'decode', 'payload_of', 'types'})

    @unittest.skipUnless(shutil.which('mypy'), 'mypy is not installed')
    def test_mypy_finds_the_mistakes_of_a_program_and_none_of_the_package(self):
        with open(scratch('typed.py'), 'w', encoding='utf-8') as file:
            file.write("import numpy as np\n"
                       "import shoal\n"
                       "from shoal import plots, record, results, run, vector\n"
                       "world = shoal.World('minimal', seed=1)\n"
                       "steps: int = world.step(3)\n"
                       "ranges: np.ndarray = shoal.messages.planar_lidar_t(ranges=[1.0]).ranges\n"
                       "shoal.Client('a').subscribe('x', print, shoal.imu_t)\n"
                       "number: str = world.step(1)\n"
                       "shoal.messages.imu_t(no_such=1)\n")
        done = subprocess.run(['mypy', '--python-executable', sys.executable, '--ignore-missing-imports',
                               '--cache-dir', scratch('mypy'), scratch('typed.py')], capture_output=True, text=True,
                              env={**os.environ, 'MYPYPATH': PACKAGE}, check=False)
        errors = [line for line in done.stdout.splitlines() if ': error: ' in line]
        self.assertEqual([line.partition(': error: ')[0].rpartition('/')[2] for line in errors],
                         ['typed.py:8', 'typed.py:9'], done.stdout)

    def test_package_is_marked_as_typed(self):
        self.assertTrue(os.path.exists(os.path.join(PACKAGE, 'shoal', 'py.typed')))


if __name__ == '__main__':
    unittest.main()
