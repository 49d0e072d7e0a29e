"""The layer check finds what it is there for."""

import pathlib
import tempfile
import unittest

import layers


class Layers(unittest.TestCase):
    def messages(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                file = pathlib.Path(folder, "src", "vantage", name)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            messages, read = layers.check(folder)
            self.assertEqual(read, sum(text.count("#include") for text in files.values()))
            return messages

    def test_arrows_downwards_are_allowed(self):
        self.assertEqual([], self.messages({
            "map/a.hpp": '#include <vector>\n#include <Eigen/Core>\n#include "vantage/core/geometry.hpp"\n',
            "planning/b.cpp": '#include "vantage/map/a.hpp"\n#include "vantage/planning/b.hpp"\n',
            "model/c.cpp": '#include <png.h>\n#include "vantage/registration/icp.hpp"\n'}))

    def test_an_arrow_upwards_is_caught_with_its_place(self):
        messages = self.messages({"map/a.hpp": '#pragma once\n#include "vantage/planning/planner.hpp"\n'})
        self.assertEqual(1, len(messages))
        self.assertIn("map/a.hpp:2", messages[0])
        self.assertIn("map may include only core, map, sensor", messages[0])

    def test_an_arrow_between_neighbours_is_caught(self):
        self.assertEqual(1, len(self.messages({"visibility/a.cpp": '#include "vantage/robot/robot.hpp"\n'})))
        self.assertEqual(1, len(self.messages({"registration/a.cpp": '#include "vantage/map/grid.hpp"\n'})))
        self.assertEqual(1, len(self.messages({"formats/a.cpp": '  #include <vantage/utility/factors.hpp>\n'})))

    def test_tests_may_use_all_lower_layers_but_no_higher_ones(self):
        self.assertEqual([], self.messages({"robot/a_test.cpp": '#include "vantage/candidates/candidates.hpp"\n'}))
        self.assertEqual(1, len(self.messages({"robot/a.cpp": '#include "vantage/candidates/candidates.hpp"\n'})))
        self.assertEqual(1, len(self.messages({"map/a_test.cpp": '#include "vantage/formats/files.hpp"\n'})))
        self.assertEqual([], self.messages({"map/a_test.cpp": '#include <gtest/gtest.h>\n'}))

    def test_core_takes_no_further_library(self):
        self.assertEqual(1, len(self.messages({"search/a.cpp": '#include <fmt/format.h>\n'})))
        self.assertEqual(1, len(self.messages({"core/a.cpp": '#include <nanoflann.hpp>\n'})))

    def test_relative_paths_and_unknown_folders_are_caught(self):
        self.assertEqual(1, len(self.messages({"map/a.cpp": '#include "../formats/files.hpp"\n'})))
        self.assertEqual(1, len(self.messages({"map/a.cpp": '#include "vantage/util/all.hpp"\n'})))
        self.assertEqual(1, len(self.messages({"util/a.cpp": "int a;\n"})))


if __name__ == "__main__":
    unittest.main()
