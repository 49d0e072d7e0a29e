"""The check for names that meet finds what it is there for."""

import pathlib
import tempfile
import unittest

import joined_names

CMAKE = "vantage_library(base a b)\nvantage_unity(vantage_base b)\nvantage_library(other c)\n"


def source(code):
    return "namespace vantage {\nnamespace {\n\n" + code + "\n}  // namespace\n}  // namespace vantage\n"


class JoinedNames(unittest.TestCase):
    def messages(self, files):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "CMakeLists.txt").write_text(CMAKE, encoding="utf-8")
            for name, text in files.items():
                file = pathlib.Path(folder, "src", "vantage", name)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return joined_names.check(folder)[0]

    def test_constants_and_functions_that_meet_are_named_with_both_files(self):
        for code in ["constexpr double margin = 0.05;\n", "constexpr int sizes[] = {1, 2};\n",
                     "int half(int a) { return a / 2; }\n", "bool fits(const Box3& box,\n          int a) {\n}\n"]:
            messages = self.messages({"a/one.cpp": source(code), "a/two.cpp": source(code)})
            self.assertEqual(1, len(messages), code)
            self.assertIn("a/one.cpp and src/vantage/a/two.cpp", messages[0])

    def test_what_never_meets_may_repeat(self):
        code = source("constexpr double margin = 0.05;\n")
        self.assertEqual([], self.messages({"a/one.cpp": code, "c/one.cpp": code}), "other libraries")
        self.assertEqual([], self.messages({"b/one.cpp": code, "b/two.cpp": code}), "compiled alone")
        self.assertEqual([], self.messages({"a/one.cpp": code, "a/one_test.cpp": code}), "tests")

    def test_overloads_are_told_apart(self):
        self.assertEqual([], self.messages({"a/one.cpp": source("int half(int a) { return a / 2; }\n"),
                                            "a/two.cpp": source("int half(double a) { return 0; }\n")}))
        self.assertEqual(1, len(self.messages({"a/one.cpp": source("int half(int a) { return a / 2; }\n"),
                                               "a/two.cpp": source("int half(int b) { return b / 2; }\n")})))


if __name__ == "__main__":
    unittest.main()
