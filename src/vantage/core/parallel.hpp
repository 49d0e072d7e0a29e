#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

namespace vantage {

/// Calls `body(i)` for i = 0 .. count-1 on the threads that oneTBB grants (limit them with tbb::global_control or a
/// task_arena). Each call writes to slots of its own index, so that results do not depend on the number of threads.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}

}  // namespace vantage
