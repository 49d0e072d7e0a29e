#include "vantage/server/without_folders.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(WithoutFolders, OnlyNamesAreLeft) {
  for (const auto& [text, expected] :
       {std::pair{"/srv/scans/mug/session/000001.scan: is damaged", "mug/session/000001.scan: is damaged"},
        {"left out scan 1, kept as /srv/scans/mug/session/000001.damaged",
         "left out scan 1, kept as mug/session/000001.damaged"},
        {"cannot write '/tmp/vantage-x1/map.nrrd' (No space left)", "cannot write 'map.nrrd' (No space left)"},
        {"/etc/robot.yaml, line 3: axes = 1: must be", "robot.yaml, line 3: axes = 1: must be"},
        {"/usr/lib/: no file.", "lib/: no file."},
        {"intrinsics=/data/cam/info.yaml.", "intrinsics=info.yaml."},
        {"pose: 3/4 m, and/or 1 m/s", "pose: 3/4 m, and/or 1 m/s"},
        {"view 5. is /", "view 5. is "},
        {"", ""}})
    EXPECT_EQ(without_folders(text, "/srv/scans/mug"), expected) << text;
}

TEST(WithoutFolders, WhateverTheFolderIsCalled) {
  EXPECT_EQ(without_folders("/a b/c d/session/1.scan: no", "/a b/c d"), "c d/session/1.scan: no");
  EXPECT_EQ(without_folders("view 5. runs/s/session/1.scan", "runs/s"), "view 5. s/session/1.scan");
  EXPECT_EQ(without_folders("s. view s", "s"), "s. view s");
  EXPECT_EQ(without_folders("view 5. ok", "."), "view 5. ok");
}

}  // namespace
}  // namespace vantage
