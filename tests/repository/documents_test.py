"""The document check finds what it is there for."""

import pathlib
import tempfile
import unittest

import documents


class FakeProgram(documents.Program):
    """Has the commands `plan` with `--top` and `session add` with `--candidate`, and `--version`."""

    def __init__(self):
        super().__init__(path=None)

    def output(self, *arguments):
        # `--help` lists commands and the options that most people use, `--help-all` all options.
        if arguments[-1:] == ("--help-all",):
            arguments = (*arguments[:-1], "--help")
        return {("--help",): "  --version\n  plan  says where to look\n  session  goes on\n",
                ("plan", "--help"): "  --top N  how many", ("session", "--help"): "  add  takes a scan\n",
                ("session", "add", "--help"): "  --candidate N  the view",
                ("config", "--markdown"): "| top | 5 |\n"}.get(arguments)


class Documents(unittest.TestCase):
    def messages(self, text):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "there.md").write_text("", encoding="utf-8")
            return documents.check_text("a.md", text, pathlib.Path(folder), FakeProgram())

    def test_calls_are_found_in_code_and_not_in_prose(self):
        text = "vantage points are views\n`vantage plan`\n```\n./vantage plan scans --top 3  # note --other\n```\n"
        self.assertEqual([(2, "plan", []), (4, "plan", ["--top"])], documents.commands(text))

    def test_calls_that_work_pass(self):
        self.assertEqual([], self.messages("`vantage plan --top 5`, `./vantage --version`, `./vantage test -L slow`"))

    def test_unknown_commands_and_options_are_found(self):
        self.assertEqual(["a.md:1: vantage has no command fly"], self.messages("`vantage fly`"))
        self.assertEqual(["a.md:1: vantage plan has no option --speed"], self.messages("`vantage plan x --speed 3`"))
        self.assertEqual(["a.md:1: vantage has no option --wings"], self.messages("`vantage --wings`"))

    def test_steps_of_a_command_have_options_of_their_own(self):
        self.assertEqual([], self.messages("`vantage session add DIR --candidate 3`, `vantage session`"))
        self.assertEqual(["a.md:1: vantage session add has no option --top"], self.messages("`vantage session add D --top 3`"))
        self.assertEqual(["a.md:1: vantage has no command session go"], self.messages("`vantage session go`"))

    def test_links_to_missing_files_are_found(self):
        self.assertEqual([], self.messages("[a](there.md#part) [b](https://example.org/x)"))
        self.assertEqual(["a.md:1: link to gone.md, which is not there"], self.messages("[a](gone.md)"))

    def test_the_page_of_options_is_what_the_program_prints(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "options.md")
            self.assertEqual(1, len(documents.check_options(page, FakeProgram())))
            page.write_text("| top | 4 |\n", encoding="utf-8")
            self.assertEqual(1, len(documents.check_options(page, FakeProgram())))
            page.write_text("| top | 5 |\n", encoding="utf-8")
            self.assertEqual([], documents.check_options(page, FakeProgram()))


if __name__ == "__main__":
    unittest.main()
