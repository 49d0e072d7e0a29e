#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace vantage {

/// Calls `body(i)` for i = 0 .. count-1 on the threads that oneTBB grants (limit them with tbb::global_control or a
/// task_arena). Each call writes to slots of its own index, so that results do not depend on the number of threads.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
#ifdef __SANITIZE_THREAD__
  // The thread sanitizer does not see into oneTBB: tell it that the loop begins before its calls and ends after them.
  char begin = 0, end = 0;
  __tsan_release(&begin);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    __tsan_acquire(&begin);
    body(i);
    __tsan_release(&end);
  });
  __tsan_acquire(&end);
#else
  tbb::parallel_for(std::size_t{0}, count, body);
#endif
}

}  // namespace vantage
