"""What the documents say must exist: documents.py ROOT PROGRAM. Exit code 1 and one line per finding.

Checked: commands of the program and their options, links to files of the repository, and docs/options.md, which is what
`vantage config --markdown` prints.
"""

import pathlib
import re
import subprocess
import sys

COMMAND = re.compile(r"(?:^|[\s`(])(?:\./|build/release/)?vantage[ ]+([a-z]+|--[a-z-]+)((?:[ ]+[^`\n|#]*)?)")
OPTION = re.compile(r"(?:^|\s)(--[a-z][a-z-]*)")
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
# Commands of the wrapper script, not of the program.
WRAPPER_COMMANDS = {"test"}
# Commands whose next word is a command too.
COMMANDS_WITH_STEPS = {"session", "recording"}


def commands(text):
    """(line number, command, options) for every call of the program in code spans and code blocks."""
    found, in_block = [], False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            in_block = not in_block
            continue
        is_code = in_block or line.startswith("    ")
        for piece in [line] if is_code else re.findall(r"`[^`]+`", line):
            for match in COMMAND.finditer(piece):
                step = re.match(r"[ ]+([a-z]+)(?=[ ]|$)", match[2]) if match[1] in COMMANDS_WITH_STEPS else None
                command = f"{match[1]} {step[1]}" if step else match[1]
                found.append((number, command, OPTION.findall(match[2])))
    return found


def links(text):
    """(line number, target) for every link that is no web address."""
    return [(number, target) for number, line in enumerate(text.splitlines(), 1)
            for target in LINK.findall(line) if "://" not in target and not target.startswith("mailto:")]


class Program:
    """The help texts of the program, each asked for once."""

    def __init__(self, path):
        self.path = path
        self.help_texts = {}

    def output(self, *arguments):
        done = subprocess.run([self.path, *arguments], capture_output=True, text=True, timeout=60, check=False)
        return done.stdout if done.returncode == 0 else None

    def help(self, command=None):
        """The help text of a command, None where there is no such command; without a command the program's own."""
        if command not in self.help_texts:
            words = command.split() if command else []
            parent = self.help(" ".join(words[:-1]) or None) if words else None
            known = not words or (parent and re.search(rf"^\s+{re.escape(words[-1])}\s", parent, re.MULTILINE))
            texts = [self.output(*words, option) for option in ("--help", "--help-all")] if known else [None]
            self.help_texts[command] = None if None in texts else "\n".join(texts)
        return self.help_texts[command]

    def why_wrong(self, command, options):
        """Why a call in a document cannot work, or None."""
        if command in WRAPPER_COMMANDS:
            return None
        if command.startswith("--"):
            return None if command in self.help() else f"vantage has no option {command}"
        text = self.help(command)
        if text is None:
            return f"vantage has no command {command}"
        words = set(re.findall(r"--[a-z][a-z-]*", text))
        missing = [option for option in options if option not in words]
        return f"vantage {command} has no option {', '.join(missing)}" if missing else None


def check_text(name, text, folder, program):
    messages = []
    for number, command, options in commands(text):
        reason = program.why_wrong(command, options)
        if reason:
            messages.append(f"{name}:{number}: {reason}")
    for number, target in links(text):
        if not (folder / target).exists():
            messages.append(f"{name}:{number}: link to {target}, which is not there")
    return messages


def check_options(file, program):
    """The page of options is what the program prints; there is none where the program prints none."""
    written = file.read_text(encoding="utf-8") if file.exists() else None
    if written == program.output("config", "--markdown"):
        return []
    return ["docs/options.md: run `build/release/vantage config --markdown > docs/options.md`"]


def main():
    root, program = pathlib.Path(sys.argv[1]), Program(sys.argv[2])
    documents = sorted([*root.glob("*.md"), *root.glob("docs/**/*.md")])
    messages, calls = [], 0
    for document in documents:
        text = document.read_text(encoding="utf-8")
        calls += len(commands(text))
        messages += check_text(document.relative_to(root), text, document.parent, program)
    messages += check_options(root / "docs" / "options.md", program)
    print(*messages, f"{len(documents)} documents and {calls} calls read, {len(messages)} findings", sep="\n")
    return 1 if messages or calls == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
