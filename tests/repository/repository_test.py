"""The repository check finds what it is there for."""

import pathlib
import tempfile
import unittest

import repository


class Repository(unittest.TestCase):
    def test_long_sources_are_found_and_long_documents_are_not(self):
        self.assertEqual([], repository.check_file("a.cpp", "\n" * 400))
        for name in ("a.cpp", "a_test.cpp", "b.hpp", "c.ts", "d.py"):
            messages = repository.check_file(name, "\n" * 401)
            self.assertEqual(1, len(messages), name)
            self.assertIn("401 lines", messages[0])
        self.assertEqual([], repository.check_file("README.md", "\n" * 1000))

    def test_paths_of_one_machine_and_registries_are_found_with_their_line(self):
        for folder in ("wo" "rk", "ho" "me", "ro" "ot"):
            messages = repository.check_file("a.md", f"text\nsee /{folder}/someone/x\n")
            self.assertEqual(1, len(messages), folder)
            self.assertTrue(messages[0].startswith("a.md:2:"))
        self.assertEqual(1, len(repository.check_file("lock.json", "https://registry." + "npmjs.org/three")))

    def test_ordinary_text_passes(self):
        self.assertEqual([], repository.check_file("a.md", "src/home/page.ts, ../shared/data, https://example.org/work/\n"))

    def test_made_and_binary_files_are_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "build").mkdir()
            (root / "build" / "a.cpp").write_text("\n" * 500, encoding="utf-8")
            (root / "src").mkdir()
            (root / "src" / "b.cpp").write_text("\n" * 500, encoding="utf-8")
            (root / "picture.png").write_bytes(b"\x89PNG\0\0")
            messages, read = repository.check(root)
            self.assertEqual((1, 1), (len(messages), read))


if __name__ == "__main__":
    unittest.main()
