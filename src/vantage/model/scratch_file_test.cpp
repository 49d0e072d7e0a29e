#include "vantage/model/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <vector>

namespace vantage {
namespace {

std::vector<std::byte> bytes(std::size_t count, int seed) {
  std::vector<std::byte> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<std::byte>(seed + static_cast<int>(i) * 7);
  return result;
}

std::vector<std::byte> got(const ScratchFile& file, const ScratchFile::Piece& piece) {
  std::vector<std::byte> result(piece.size);
  file.get(piece, result);
  return result;
}

TEST(ScratchFile, PiecesComeBackInAnyOrder) {
  ScratchFile file;
  std::vector<ScratchFile::Piece> pieces;
  for (int i = 0; i < 20; ++i) pieces.push_back(file.put(bytes(static_cast<std::size_t>(i) * 1000, i)));
  for (int i = 19; i >= 0; --i) {
    EXPECT_FALSE(pieces[static_cast<std::size_t>(i)].memory);
    EXPECT_EQ(got(file, pieces[static_cast<std::size_t>(i)]), bytes(static_cast<std::size_t>(i) * 1000, i));
  }
}

TEST(ScratchFile, WhatTheDiskDoesNotTakeStaysInMemory) {
  ScratchFile file;
  const ScratchFile::Piece before = file.put(bytes(5000, 1));
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{8000, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const ScratchFile::Piece cut = file.put(bytes(5000, 2));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(cut.memory);
  const ScratchFile::Piece after = file.put(bytes(5000, 3));
  EXPECT_EQ(got(file, before), bytes(5000, 1));
  EXPECT_EQ(got(file, cut), bytes(5000, 2));
  EXPECT_EQ(got(file, after), bytes(5000, 3));
}

}  // namespace
}  // namespace vantage
