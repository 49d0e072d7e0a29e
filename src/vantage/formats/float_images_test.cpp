#include "vantage/formats/float_images.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/test_folder.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string npy(const std::string& type, const std::string& shape, const std::string& values) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8U);
  return bytes + header + values;
}

TEST(Npy, WholeNumbersAreUnitsAndOthersFloats) {
  const std::string six("\x01\0\x02\0\x03\0\x04\0\x05\0\xff\xff", 12);
  const auto grey = std::get<Gray16>(decode_npy(npy("<u2", "(2, 3)", six), "a.npy"));
  EXPECT_EQ(grey.resolution, (Resolution{3, 2}));
  EXPECT_THAT(grey.values, ElementsAre(1, 2, 3, 4, 5, 65535));
  const auto swapped = std::get<Gray16>(decode_npy(npy(">u2", "(1, 2, 3)", six), "a.npy"));
  EXPECT_THAT(swapped.values, ElementsAre(256, 512, 768, 1024, 1280, 65535));
  std::string floats;
  append_float32(floats, 1.5);
  append_float32(floats, -2);
  EXPECT_THAT(std::get<FloatImage>(decode_npy(npy("<f4", "(1, 2)", floats), "a")).values, ElementsAre(1.5F, -2.0F));
  // 1, the largest, the least, infinite; as numpy.float16 writes them.
  const std::string halves("\x00\x3c\xff\x7b\x01\x00\x00\x7c", 8);
  EXPECT_THAT(std::get<FloatImage>(decode_npy(npy("<f2", "(2, 2)", halves), "a")).values,
              ElementsAre(1.0F, 65504.0F, std::ldexp(1.0F, -24), std::numeric_limits<float>::infinity()));
}

TEST(Npy, WhatIsWrongIsNamed) {
  const auto error = [](const std::string& bytes) { return input_error_of([&] { (void)decode_npy(bytes, "a.npy"); }); };
  EXPECT_THAT(error(npy("<u2", "(2, 3)", "12345")), HasSubstr("a.npy: has 5 bytes of values, must be 12"));
  EXPECT_THAT(error(npy("<c8", "(2, 3)", "")), HasSubstr("must be uint16 or another whole number, or a float"));
  EXPECT_THAT(error(npy("<u2", "(2, 3, 3)", "")), HasSubstr("has 3 axes, must be rows and columns"));
  EXPECT_THAT(error(npy("<u2", "(99999, 3)", "")), HasSubstr("a side of 99999: must be within 1 and 16384"));
  EXPECT_THAT(error(npy("<i4", "(1, 1)", std::string("\xff\xff\xff\xff", 4))), HasSubstr("element 0 is -1"));
  EXPECT_THAT(error("\x93NUMPY"), HasSubstr("is no NumPy array file"));
  const FuzzCount count = read_damaged(npy("<u2", "(2, 3)", "123456789012"), 2000,
                                       [](const std::string& damaged) { (void)decode_npy(damaged, "a"); });
  EXPECT_EQ(count.accepted + count.refused, 2000);
}

TEST(Pfm, RowsRunUpwards) {
  std::string values;
  for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) append_float32(values, value);
  EXPECT_THAT(decode_pfm("Pf\n3 2\n-1.0\n" + values, "a.pfm").values, ElementsAre(4, 5, 6, 1, 2, 3));
  EXPECT_THAT(input_error_of([&] { (void)decode_pfm("PF\n3 2\n-1.0\n" + values, "a.pfm"); }),
              HasSubstr("has colours (PF)"));
  EXPECT_THAT(input_error_of([&] { (void)decode_pfm("Pf\n3 3\n-1.0\n" + values, "a.pfm"); }),
              HasSubstr("a.pfm: has 24 bytes of values, must be 36"));
  const FuzzCount count = read_damaged("Pf\n3 2\n-1.0\n" + values, 2000,
                                       [](const std::string& damaged) { (void)decode_pfm(damaged, "a"); });
  EXPECT_EQ(count.accepted + count.refused, 2000);
}

}  // namespace
}  // namespace vantage
