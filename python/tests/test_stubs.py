"""The type stubs agree with the module."""

import ast
import pathlib
import sys
import unittest

import vantage
from vantage import _vantage

PYTHON = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(PYTHON))
import make_stubs  # noqa: E402

STUBS = (PYTHON / "vantage" / "__init__.pyi").read_text()


class Stubs(unittest.TestCase):
    def test_they_are_what_the_module_says(self):
        self.assertEqual(STUBS, make_stubs.stubs(),
                         "generate them again: PYTHONPATH=build/release/python python3 python/make_stubs.py "
                         "> python/vantage/__init__.pyi")

    def test_they_are_python_and_name_everything(self):
        declared = {node.name for node in ast.parse(STUBS).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        public = {name for name in vars(_vantage) if not name.startswith("_")}
        self.assertEqual(declared, public)
        self.assertTrue(all(hasattr(vantage, name) for name in declared))

    def test_every_member_of_a_class_is_declared(self):
        compared = 0
        for node in ast.parse(STUBS).body:
            cls = getattr(vantage, getattr(node, "name", ""), None)
            if not isinstance(node, ast.ClassDef) or issubclass(cls, Exception) or hasattr(cls, "__members__"):
                continue
            declared = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            members = {name for name in vars(cls) if not name.startswith("_")}
            self.assertEqual(declared - set(make_stubs.SPECIAL), members, node.name)
            compared += 1
        self.assertGreater(compared, 20)

    def test_everything_public_says_what_it_is(self):
        silent = [name for name, value in vars(_vantage).items()
                  if not name.startswith("_") and not make_stubs.summary(value.__doc__)]
        self.assertEqual(silent, [])


if __name__ == "__main__":
    unittest.main()
