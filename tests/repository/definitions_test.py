"""The check for second definitions finds what it is there for."""

import pathlib
import tempfile
import unittest

import definitions


class Definitions(unittest.TestCase):
    def messages(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                file = pathlib.Path(folder, "src", "vantage", name)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return definitions.check(folder)[0]

    def test_two_classes_of_one_name_are_caught_with_both_places(self):
        messages = self.messages({"robot/a.hpp": "namespace vantage {\nclass FreeSpace {\n  int a;\n};\n}\n",
                                  "registration/b.hpp": "namespace vantage {\nstruct FreeSpace final : Base<int> {};\n}\n"})
        self.assertEqual(1, len(messages))
        self.assertIn("vantage::FreeSpace", messages[0])
        self.assertIn("robot/a.hpp", messages[0])
        self.assertIn("registration/b.hpp", messages[0])

    def test_namespaces_members_and_declarations_are_told_apart(self):
        self.assertEqual([], self.messages({
            "a/a.hpp": "namespace vantage { class A { struct Part {}; enum class Kind { one }; }; class B; }\n",
            "b/b.hpp": "namespace vantage { class C { struct Part {}; enum class Kind { two }; }; class B; }\n",
            "c/c.hpp": "namespace vantage::other { class A {}; }\n",
            "c/d.cpp": "namespace vantage { void f() { struct A {}; } }  // class A {\nauto t = \"class A {\";\n"}))

    def test_anonymous_types_may_repeat_in_other_folders_only(self):
        text = "namespace vantage { namespace { struct Row {}; } }\n"
        self.assertEqual([], self.messages({"a/a.cpp": text, "b/b.cpp": text, "a/a_test.cpp": text}))
        self.assertEqual(1, len(self.messages({"a/a.cpp": text, "a/b.cpp": text})))

    def test_an_implementation_behind_a_pointer_is_its_own_type(self):
        self.assertEqual([], self.messages({
            "a/a.hpp": "namespace vantage { class A { class Impl; }; }\n",
            "a/a.cpp": "namespace vantage { class A::Impl {}; }\n"}))


if __name__ == "__main__":
    unittest.main()
