#include <gmock/gmock.h>

#include <atomic>
#include <cstdint>

#include "support/limited_memory.hpp"
#include "support/test_folder.hpp"
#include "vantage/session/session.hpp"
#include "vantage/session/session_test_util.hpp"

// What a session does where memory runs out. Memory of a size that only one scan's pixels take is refused on demand.
namespace vantage {
namespace {

constexpr std::size_t pixels = std::size_t{41} * 41;
std::atomic<bool> is_short = false;
std::atomic<std::size_t> largest = SIZE_MAX;

bool refuses(std::size_t size) { return size > largest || (is_short && size > 0 && size % (4 * pixels) == 0); }

[[maybe_unused]] const bool is_installed = [] {
  test::refuses_memory = refuses;
  return true;
}();

using testing::ElementsAre;
using testing::HasSubstr;

/// Scan 1 alone has images of 41x41 pixels.
std::vector<SessionScan> some_scans() {
  std::vector<SessionScan> scans = {plate_from({0, 0, 2}), plate_from({1.5, 0.5, 1}), plate_from({-1, 1.5, 0.8}),
                                    plate_from({0.3, -2, 0.4})};
  RangeImage image{camera_from_apertures(radians(45), radians(45), {41, 41}), std::vector<float>(pixels, 1.9F)};
  image.camera.max_depth = 4.5;
  scans[1].scan = scan_of(std::move(image));
  return scans;
}

TEST(SessionMemory, GoesOnWithoutAScanWhoseMergingBreaksOff) {
  const TestFolder folder;
  Session::create(folder / "broken", small_options());
  Session::create(folder / "without", small_options());
  {
    Session broken(folder / "broken"), without(folder / "without");
    for (const SessionScan& scan : some_scans()) {
      const int number = broken.store(scan);
      if (number == 1) {
        is_short = true;
        const std::string error = error_of([&] { (void)broken.integrate(1); });
        is_short = false;
        EXPECT_THAT(error, HasSubstr("scan 1 is safe on disk"));
        EXPECT_EQ(broken.next().state->numbers, std::vector<int>{0});
      } else {
        EXPECT_TRUE(broken.integrate(number).merged);
        (void)without.add(scan);
      }
    }
    const SessionStatus status = broken.status();
    EXPECT_EQ(status.stored, 4U);
    EXPECT_EQ(status.integrated, 3U);
    EXPECT_THAT(status.left_out, ElementsAre(testing::Key(1)));
    EXPECT_THAT(status.state->numbers, ElementsAre(0, 2, 3));
    EXPECT_TRUE(same_map(status.state->map, without.status().state->map));
  }
  // Opened again, it is merged with the others, in its place.
  Session again(folder / "broken");
  EXPECT_THAT(again.status().left_out, testing::IsEmpty());
  EXPECT_THAT(again.status().state->numbers, ElementsAre(0, 1, 2, 3));
  Session::create(folder / "at once", small_options());
  Session at_once(folder / "at once");
  for (const SessionScan& scan : some_scans()) (void)at_once.add(scan);
  EXPECT_TRUE(same_map(again.status().state->map, at_once.status().state->map));
}

TEST(SessionMemory, WritesAScanWholeOrNotAtAll) {
  const SessionScan scan = some_scans()[1];
  const std::string whole = scan_bytes(scan);
  int written = 0, refused = 0;
  for (std::size_t limit = 500; limit < 32'000; limit += 500) {
    std::string bytes;
    largest = limit;
    try {
      bytes = scan_bytes(scan);
      largest = SIZE_MAX;
      EXPECT_EQ(bytes, whole) << "with at most " << limit << " bytes at once";
      ++written;
    } catch (const std::bad_alloc&) {
      largest = SIZE_MAX;
      ++refused;
    }
  }
  EXPECT_GT(written, 10);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace vantage
