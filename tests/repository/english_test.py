"""The check of words finds what it is there for."""

import unittest

import english


class English(unittest.TestCase):
    def found(self, text):
        return [message.split("'")[1] for message in english.check_text("a.md", text)]

    def test_words_of_the_right_column_are_found_with_their_place(self):
        messages = english.check_text("a.md", "fine\nHow to mend it, anew.\n")
        self.assertEqual(2, len(messages))
        self.assertIn("a.md:2: 'mend': write fix", messages[0])
        self.assertEqual(["Lest"], self.found("Lest it breaks"))
        self.assertEqual(["stands in"], self.found("its size stands in the file"))
        self.assertEqual(["was told"], self.found("the planner was told the error"))

    def test_other_words_and_readings_are_left_alone(self):
        self.assertEqual([], self.found("always, recommended, both ways, two ways, told apart, are told apart"))
        self.assertEqual([], self.found("the robot resumes where a killed run left off"))


if __name__ == "__main__":
    unittest.main()
